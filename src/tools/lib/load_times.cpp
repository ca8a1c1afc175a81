// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/load_times.hpp"

#include <malloc.h>

#include <algorithm>

namespace ergotic::tools {
namespace {

std::size_t heapInUse() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace

LoadTimes::LoadTimes() : heap_(heapInUse()) {}

void LoadTimes::begin(const std::string& key, const std::string& what) {
  end();
  key_ = key;
  line_.show(what);
  begun_ = Clock::now();
}

void LoadTimes::end() {
  if (!key_.empty()) {
    report_[key_] = std::chrono::duration<double>(Clock::now() - begun_).count();
  }
}

Json LoadTimes::finish(std::size_t parts) {
  end();
  line_.clear();
  const std::size_t heap = heapInUse();
  const std::size_t grown = heap - std::min(heap, heap_);
  const auto each = static_cast<double>(std::max<std::size_t>(parts, 1));
  report_["bytes"] = grown;
  report_["bytes_per_module_or_link"] = static_cast<double>(grown) / each;
  return report_;
}

}  // namespace ergotic::tools
