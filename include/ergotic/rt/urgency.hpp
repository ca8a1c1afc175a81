// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace ergotic::rt {

/// Decides whether a thread that others can keep busy may have real-time priority: as long as it
/// uses little of a processor. Otherwise a flood of requests would keep the machine from
/// everything, and, where the kernel allots real-time threads 95 % of each second, the ticks as
/// well. A token bucket: it fills by `kShare` of the time that passes, up to `kBurstNs`, and is
/// emptied by what the thread uses while it is urgent. So within any time T that is `kShare` T +
/// `kBurstNs` of processor time at most, and what it used between two questions; and a burst, such
/// as all that is sent when another model takes over, does not cost it its priority. Between two
/// questions no more than `kBurstNs` counts, for where its host stops a virtual machine, that often
/// looks like use: who keeps the thread from asking for longer than that gets more. Thread: one
class Urgency {
 public:
  static constexpr double kShare = 0.25;                 ///< permitted share of a processor
  static constexpr std::int64_t kBurstNs = 100'000'000;  ///< processor time a burst may use beyond

  /// Whether the thread may be urgent until this is asked again; ask often. One that had used up
  /// what it may use comes back when the half of `kBurstNs` is there again. \param now_ns
  /// CLOCK_MONOTONIC. \param used_ns  CPU time of the thread
  bool allows(std::int64_t now_ns, std::int64_t used_ns) noexcept {
    left_ns_ += kShare * static_cast<double>(now_ns - last_ns_);
    if (allows_) {
      left_ns_ -= std::min(static_cast<double>(used_ns - used_last_ns_), kFullNs);
    }
    left_ns_ = std::min(left_ns_, kFullNs);
    last_ns_ = now_ns;
    used_last_ns_ = used_ns;
    allows_ = left_ns_ > (allows_ ? 0.0 : kFullNs / 2.0);
    return allows_;
  }

 private:
  static constexpr auto kFullNs = static_cast<double>(kBurstNs);

  std::int64_t last_ns_ = 0;
  std::int64_t used_last_ns_ = 0;
  double left_ns_ = kFullNs;
  bool allows_ = true;
};

}  // namespace ergotic::rt
