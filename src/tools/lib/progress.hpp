// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace ergotic::tools {

/// A bar on stderr while a long job runs; nothing where stderr is not a terminal.
class Progress {
 public:
  explicit Progress(std::int64_t total);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::int64_t done);

 private:
  std::int64_t total_;
  bool visible_;
  int shown_percent_ = -1;
};

/// Progress line on stderr; nothing is printed if stderr is not a terminal.
class StageLine {
 public:
  StageLine();
  ~StageLine() { clear(); }
  StageLine(const StageLine&) = delete;
  StageLine& operator=(const StageLine&) = delete;

  void show(const std::string& stage);
  void clear();

 private:
  bool visible_;
  std::size_t width_ = 0;  // of what stands there
};

}  // namespace ergotic::tools
