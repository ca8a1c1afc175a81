// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

namespace ergotic::tools {
namespace {
constexpr int kWidth = 50;
}

Progress::Progress(std::int64_t total)
    : total_(std::max<std::int64_t>(total, 1)), visible_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (visible_) {
    std::cerr << '\r' << std::string(kWidth + 8, ' ') << '\r' << std::flush;
  }
}

void Progress::show(std::int64_t done) {
  const int percent = static_cast<int>(100 * done / total_);
  if (!visible_ || percent == shown_percent_) {
    return;
  }
  shown_percent_ = percent;
  std::string bar(static_cast<std::size_t>(percent * kWidth / 100), '#');
  bar.resize(kWidth, '.');
  std::cerr << "\r[" << bar << "] " << percent << '%' << std::flush;
}

StageLine::StageLine() : visible_(isatty(STDERR_FILENO) != 0) {}

void StageLine::show(const std::string& stage) {
  clear();
  if (visible_) {
    std::cerr << stage << " ..." << std::flush;
    width_ = stage.size() + 4;
  }
}

void StageLine::clear() {
  if (width_ > 0) {
    std::cerr << '\r' << std::string(width_, ' ') << '\r' << std::flush;
    width_ = 0;
  }
}

}  // namespace ergotic::tools
