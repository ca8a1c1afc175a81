// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/tgr/fault.hpp"

namespace ergotic::tgr {

/// Has the model gone mad? Looks at the raw force of one slice. Realtime: yes
///
/// A hard contact is no fault, however hard: under a force law F = k x^p its force changes by
/// k ((n + 1)^p - n^p) in the n-th tick, so that the ratio of one change to the one before soon
/// falls towards 1. Of a model that diverges it stays what it is. kModelBlowUp is therefore
///   - a force that is not finite;
///   - |F| > limit after kGrowths changes in a row that were each kGrowth times the one before, the
///     first of those more than limit / 25, the last of all more than limit / 4. p <= 2 never gets
///     there; p = 2.5 would have to go from nothing to 3 times the limit within 4 ticks;
///   - a swing from beyond the limit on one side to beyond it on the other, within a tick.
/// kForceTooHigh is a force beyond `raw_limit`, however it came about.
class BlowUpDetector {
 public:
  static constexpr double kGrowth = 1.8;
  static constexpr int kGrowths = 3;

  /// \param limit      N, of what reaches the hand
  /// \param raw_limit  N
  BlowUpDetector(double limit, double raw_limit) noexcept;

  /// \param force  N, as the model wants it. \return kNone, kModelBlowUp or kForceTooHigh
  FaultReason look(double force) noexcept;

  /// The next force may be anything.
  void forget() noexcept;

 private:
  bool grows(double change) noexcept;

  double limit_;
  double raw_limit_;
  double least_base_;
  double least_change_;
  bool knows_last_ = false;
  double last_ = 0.0;
  double last_change_ = 0.0;
  int growths_ = 0;
};

}  // namespace ergotic::tgr
