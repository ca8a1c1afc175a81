// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace ergotic::station {

/// Durations counted in bins: each power of two of nanoseconds is cut into `kParts` equal ones, so
/// that a bin is at most 1/32 of what it holds. Below 32 ns a bin is a nanosecond wide.
class TickHistogram {
 public:
  static constexpr int kParts = 32;
  /// 68 s; what is longer counts as this.
  static constexpr std::int64_t kMaxNs = (std::int64_t{1} << 36) - 1;
  struct Bin {
    std::int64_t low_ns = 0;  ///< first and last that it holds
    std::int64_t high_ns = 0;
    std::int64_t count = 0;
  };

  /// \param ns  below 0: counts as 0. Realtime: yes. Thread: one, the tick's
  void add(std::int64_t ns) noexcept;

  // Any thread, also while another one adds; what is added meanwhile may be in or not.
  /// Returns the bins that are not empty, shortest durations first.
  std::vector<Bin> bins() const;
  std::int64_t count() const noexcept;
  std::int64_t maxNs() const noexcept { return max_ns_.load(std::memory_order_relaxed); }
  /// Quantile: the share `part` of all durations is at most this long, rounded up to the end of a
  /// bin, but not beyond the longest. \param part  0...1 \return 0 if there are none
  std::int64_t quantileNs(double part) const noexcept;

 private:
  static constexpr int kOctaves = 32;  // from 32 ns on
  static constexpr std::size_t kBins = static_cast<std::size_t>(kOctaves) * kParts;
  static std::size_t indexOf(std::int64_t ns) noexcept;
  static Bin binAt(std::size_t index) noexcept;

  std::array<std::atomic<std::int64_t>, kBins> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

/// Cost of the ticks of a station that is driven by a clock. See Station::setMeter.
struct TickMeter {
  TickHistogram wake_up;   ///< begin after the due time; a stall counts once, with its length
  TickHistogram exchange;  ///< the device
  TickHistogram compute;   ///< the rest of the tick
  TickHistogram whole;     ///< both together

  /// Realtime: yes. Thread: tick
  void add(std::int64_t late_ns, std::int64_t exchange_ns, std::int64_t compute_ns) noexcept {
    wake_up.add(late_ns);
    exchange.add(exchange_ns);
    compute.add(compute_ns);
    whole.add(exchange_ns + compute_ns);
  }
};

}  // namespace ergotic::station
