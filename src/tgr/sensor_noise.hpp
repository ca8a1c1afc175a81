// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

/// Seeded noise of zero mean and unit variance, nearly Gaussian: a sum of four uniform numbers, so
/// that it never exceeds 2 sqrt(3). The same seed gives the same numbers on every machine.
///
/// Realtime: yes. Source: S. Vigna, "splitmix64" (public domain); Irwin-Hall distribution, n = 4.
class SensorNoise {
 public:
  explicit SensorNoise(std::uint64_t seed) noexcept : state_(seed) {}

  ERGOTIC_REALTIME double next() noexcept {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    z ^= z >> 31U;
    // The four 16-bit pieces are uniform on 0...65535: mean 32767.5, variance (2^32 - 1) / 12.
    const std::uint64_t sum =
        (z & 0xffffU) + ((z >> 16U) & 0xffffU) + ((z >> 32U) & 0xffffU) + (z >> 48U);
    constexpr double kMean = 4.0 * 32767.5;
    constexpr double kDeviation = 37837.22723720648;  // sqrt(4 (2^32 - 1) / 12)
    return (static_cast<double>(sum) - kMean) / kDeviation;
  }

 private:
  std::uint64_t state_;
};

}  // namespace ergotic::tgr
