// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Faults that can be injected between a device and its station. The numbers are part of the ROS
/// interface (InjectFault.srv).
enum class InjectedFault : std::uint8_t {
  kNotANumber = 0,  ///< position NaN
  kInfinite = 1,    ///< position infinite
  kJump = 2,        ///< position off by `amount` m
  kFrozen = 3,      ///< position stays as it is
  kRail = 4,        ///< position at +`amount` m
  kMissing = 5,     ///< samples missing
  kSlow = 6,        ///< exchange takes `amount` s longer: busy up to 1 ms, asleep beyond
  kWriteFails = 7,  ///< forces are not taken: the last one stays, until made safe
  kUnplugged = 8,   ///< the device does not answer until reconnected
  kNoise = 9,       ///< position with noise of `amount` m rms
};

struct FaultOrder {
  InjectedFault kind = InjectedFault::kMissing;
  int slice = -1;          ///< -1: all
  std::int64_t ticks = 1;  ///< duration; kUnplugged: until reconnect
  double amount = 0.0;     ///< amount, in the unit of the kind
};

/// A device between which and the station faults can be injected. Without orders it is exactly the
/// device inside.
class FaultyDriver : public Driver {
 public:
  /// Checks whether `inject` accepts an order. Thread: command thread, after `open`
  /// \throws Exception if a number is out of its range
  virtual void check(const FaultOrder& order) const = 0;
  /// Takes effect with the next exchange, in place of an earlier order; but what is unplugged stays
  /// so until `reconnect` or `open`. Thread: command thread
  /// \throws Exception as `check`
  virtual void inject(const FaultOrder& order) = 0;
};
std::unique_ptr<FaultyDriver> makeFaultyDriver(std::unique_ptr<Driver> inside);

/// Returns the fault of a name, as `frozen`.
/// \param others  names of faults that are not of this kind, for the message
/// \throws Exception naming those that exist
InjectedFault faultNamed(const std::string& name, const std::vector<std::string>& others = {});

}  // namespace ergotic::tgr
