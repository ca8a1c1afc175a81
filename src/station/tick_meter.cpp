// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/tick_meter.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::station {
namespace {

constexpr int kPartBits = 5;
static_assert(TickHistogram::kParts == 1 << kPartBits);

}  // namespace

/// The leading bit says the octave, the next ones the part of it.
ERGOTIC_REALTIME std::size_t TickHistogram::indexOf(std::int64_t ns) noexcept {
  const auto value = static_cast<std::uint64_t>(ns);
  if (value < kParts) {
    return value;
  }
  const int shift = 63 - __builtin_clzll(value) - kPartBits;
  return static_cast<std::size_t>(shift) * kParts + (value >> static_cast<unsigned>(shift));
}

TickHistogram::Bin TickHistogram::binAt(std::size_t index) noexcept {
  const auto at = static_cast<std::int64_t>(index);
  const std::int64_t shift = std::max<std::int64_t>(at / kParts - 1, 0);
  const std::int64_t low = (at - shift * kParts) << shift;
  return {low, low + (std::int64_t{1} << shift) - 1, 0};
}

ERGOTIC_REALTIME void TickHistogram::add(std::int64_t ns) noexcept {
  const std::int64_t clipped = std::clamp<std::int64_t>(ns, 0, kMaxNs);
  std::atomic<std::int64_t>& count = counts_[indexOf(clipped)];
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (clipped > maxNs()) {
    max_ns_.store(clipped, std::memory_order_relaxed);
  }
}

std::vector<TickHistogram::Bin> TickHistogram::bins() const {
  std::vector<Bin> list;
  for (std::size_t i = 0; i < kBins; ++i) {
    Bin bin = binAt(i);
    bin.count = counts_[i].load(std::memory_order_relaxed);
    if (bin.count > 0) {
      list.push_back(bin);
    }
  }
  return list;
}

std::int64_t TickHistogram::count() const noexcept {
  std::int64_t sum = 0;
  for (const std::atomic<std::int64_t>& count : counts_) {
    sum += count.load(std::memory_order_relaxed);
  }
  return sum;
}

std::int64_t TickHistogram::quantileNs(double part) const noexcept {
  const double wanted = std::max(1.0, std::ceil(part * static_cast<double>(count())));
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    sum += counts_[i].load(std::memory_order_relaxed);
    if (static_cast<double>(sum) >= wanted) {
      return std::min(binAt(i).high_ns, maxNs());
    }
  }
  return maxNs();
}

}  // namespace ergotic::station
