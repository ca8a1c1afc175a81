// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/device_process.hpp"

#include <iostream>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/tgr/gesture.hpp"

namespace ergotic::tools {

Signals::Signals() {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
}

void Signals::attend(double seconds, const std::function<bool()>& each) const {
  constexpr double kNsPerS = 1e9;
  constexpr timespec kPause{0, 10'000'000};
  const std::int64_t start_ns = rt::monotonicNs();
  const auto isOver = [&] {
    return seconds > 0.0 && static_cast<double>(rt::monotonicNs() - start_ns) > seconds * kNsPerS;
  };
  while (sigtimedwait(&set_, nullptr, &kPause) < 0 && each() && !isOver()) {
  }
}

void warnOfValues(const std::string& process, const std::string& gesture_file) {
  const auto values = tgr::readGestureValues(gesture_file);
  if (!values.empty()) {
    std::cerr << process << ": warning: " << gesture_file << ": " << values.size()
              << (values.size() == 1 ? " row sets a parameter" : " rows set parameters")
              << " of a scene, the first in line " << values.front().name_at.line
              << ". A device process knows no scene, so they have no effect: let the station play "
                 "the file (gesture:=), or scripts/play_gesture\n";
  }
}

ForceLog::ForceLog(std::string path) : path_(std::move(path)) {
  if (path_.empty()) {
    return;
  }
  file_.open(path_);
  file_ << "time_ns,slice,force_n\n" << std::flush;
  if (!file_) {
    throw Exception(path_ + ": cannot be written");
  }
}

void ForceLog::requireAll(std::int64_t dropped) const {
  if (!path_.empty() && (!file_ || dropped > 0)) {
    throw Exception(path_ + ": incomplete, " + std::to_string(dropped) + " records dropped");
  }
}

}  // namespace ergotic::tools
