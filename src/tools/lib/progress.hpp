// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

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

}  // namespace ergotic::tools
