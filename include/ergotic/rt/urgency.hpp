// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::rt {

/// Decides whether a thread that others can keep busy may have real-time priority: as long as it
/// uses little of a processor. Otherwise a flood of requests would keep the machine from
/// everything, and, where the kernel allots real-time threads 95 % of each second, the ticks as
/// well. Thread: one
class Urgency {
 public:
  static constexpr double kShare = 0.25;                  ///< permitted share of a processor
  static constexpr std::int64_t kWindowNs = 200'000'000;  ///< shortest window of measurement

  /// Whether the thread may stay urgent; call it often. \param now_ns  CLOCK_MONOTONIC. \param
  /// used_ns  CPU time of the thread
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
