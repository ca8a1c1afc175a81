// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/message_log.hpp"

#include <iterator>

namespace ergotic::panel {

void MessageLog::add(const std::string& time, const std::string& text, const std::string& kind) {
  ++version_;
  int times = 1;
  for (auto line = lines_.rbegin(); !kind.empty() && line != lines_.rend(); ++line) {
    if (line->kind == kind) {
      times = line->times + 1;
      lines_.erase(std::next(line).base());
      break;
    }
    if (line->kind.empty()) {
      break;  // what happened in between shall stay between them
    }
  }
  lines_.push_back({time, text, kind, times});
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
