// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/message_log.hpp"

namespace ergotic::panel {

void MessageLog::add(const std::string& time, const std::string& text, const std::string& kind) {
  ++version_;
  if (!kind.empty() && !lines_.empty() && lines_.back().kind == kind) {
    Line& last = lines_.back();
    last = {time, text, kind, last.times + 1};
    return;
  }
  lines_.push_back({time, text, kind});
  if (lines_.size() > kLines) {
    lines_.pop_front();
  }
}

std::string MessageLog::text() const {
  std::string all;
  for (const Line& line : lines_) {
    all += (all.empty() ? "" : "\n") + line.time + " " + line.text;
    if (line.times > 1) {
      all += " (" + std::to_string(line.times) + " times)";
    }
  }
  return all;
}

}  // namespace ergotic::panel
