// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "tools/lib/progress.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// What it takes to load a scene: the time of every stage and what stays in memory. Says on the
/// terminal what is being done.
class LoadTimes {
 public:
  LoadTimes();

  /// Begins a stage, and ends the one before.
  /// \param key   of its duration in the report, such as `certify_s`
  /// \param what  is being done, for the terminal
  void begin(const std::string& key, const std::string& what);
  /// Ends the last stage.
  /// \param parts  number of modules and links that the memory is for
  Json finish(std::size_t parts);

 private:
  using Clock = std::chrono::steady_clock;
  void end();

  StageLine line_;
  std::string key_;
  Clock::time_point begun_;
  std::size_t heap_;  // bytes in use when all began
  Json report_ = Json::object();
};

}  // namespace ergotic::tools
