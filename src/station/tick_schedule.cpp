// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/tick_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace ergotic::station {

TickSchedule::TickSchedule(double period_ns, std::int64_t first_due_ns) noexcept
    : period_ns_(period_ns), due_ns_(first_due_ns) {}

TickSchedule::Step TickSchedule::at(std::int64_t now_ns) const noexcept {
  const std::int64_t late_ns = now_ns - due_ns_;
  if (late_ns < 0) {
    return {Step::Kind::kWait, 0, 0};
  }
  const auto missed =
      static_cast<std::int64_t>((static_cast<double>(late_ns) - fraction_ns_) / period_ns_);
  if (missed < kStallTicks) {
    return {Step::Kind::kRun, 1, late_ns};
  }
  return {Step::Kind::kCatchUp, missed + 1, late_ns};
}

void TickSchedule::advance(std::int64_t ticks) noexcept {
  move(static_cast<double>(ticks) * period_ns_);
}

void TickSchedule::follow(std::int64_t master_due_ns) noexcept {
  const double error_ns = static_cast<double>(master_due_ns - due_ns_) - fraction_ns_;
  const double most_ns = kMaxSlew * period_ns_;
  move(std::clamp(error_ns, -most_ns, most_ns));
}

void TickSchedule::move(double ns) noexcept {
  const double exact_ns = fraction_ns_ + ns;
  const double whole_ns = std::floor(exact_ns);
  due_ns_ += static_cast<std::int64_t>(whole_ns);
  fraction_ns_ = exact_ns - whole_ns;
}

}  // namespace ergotic::station
