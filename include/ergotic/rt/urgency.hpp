// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::rt {

/// Whether a thread that others can keep busy may go before ordinary programs: as long as it takes
/// little of a processor. Else whoever floods it would keep the machine from everything, and, where
/// the kernel allots real-time threads 95 % of each second, the ticks as well. Thread: one
class Urgency {
 public:
  static constexpr double kShare = 0.25;                  ///< of a processor, that it may take
  static constexpr std::int64_t kWindowNs = 200'000'000;  ///< in which that is looked at, at least

  /// To be asked often. \param now_ns  CLOCK_MONOTONIC. \param used_ns  of processors, by the
  /// thread
  bool allows(std::int64_t now_ns, std::int64_t used_ns) noexcept {
    if (now_ns - from_ns_ >= kWindowNs) {
      const auto used = static_cast<double>(used_ns - used_from_ns_);
      allows_ = used <= kShare * static_cast<double>(now_ns - from_ns_);
      from_ns_ = now_ns;
      used_from_ns_ = used_ns;
    }
    return allows_;
  }

 private:
  std::int64_t from_ns_ = 0;
  std::int64_t used_from_ns_ = 0;
  bool allows_ = true;
};

}  // namespace ergotic::rt
