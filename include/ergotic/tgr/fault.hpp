// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::tgr {

/// Reason why force is latched at zero. The numbers are part of the ROS interface (Status.msg).
enum class FaultReason : std::uint8_t {
  kNone = 0,
  kDeviceLost = 1,      ///< the device does not answer
  kMissingSamples = 2,  ///< positions were missing for longer than `max_missing`
  kBadPosition = 3,     ///< not a number, or beyond the range of its slice
  kModelBlowUp = 4,     ///< a force, a displacement or a sample of the model is not finite
  kStall = 5,           ///< the real-time thread stopped for too long or too often
  kMadeSafe = 6,        ///< made safe by a signal, or at the end of a program
  kJump = 7,            ///< a position moved faster than a hand can
  kFrozen = 8,          ///< a sensor gave the very same value for too long: a broken wire
  kWriteFailed = 9,     ///< the device did not take a force
  kForceTooHigh = 10,   ///< the model asks for more than any hand should meet
  kEnergy = 11,         ///< a port of the model gave out more energy than it may
  kEmergencyStop = 12,  ///< the operator's emergency stop
  kPresence = 13,       ///< the presence switch was released, or its messages stopped
  kWorkspace = 14,      ///< an end-effector is where its linkage cannot be
  kWatchdog = 15,       ///< ticks stopped coming
  kMasterLost = 16,     ///< the ROS master is gone, and with it the way to an emergency stop
  kGuardianLost = 17,   ///< no guardian would take the force away if this process died
};

/// Describes a reason in words, for operators. Realtime: yes.
const char* toString(FaultReason reason) noexcept;

}  // namespace ergotic::tgr
