// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/fault.hpp"

namespace ergotic::tgr {

const char* toString(FaultReason reason) noexcept {
  switch (reason) {
    case FaultReason::kNone:
      return "none";
    case FaultReason::kDeviceLost:
      return "the device does not answer";
    case FaultReason::kMissingSamples:
      return "positions were missing for too long";
    case FaultReason::kBadPosition:
      return "a position is not a number or beyond the range of its slice";
    case FaultReason::kModelBlowUp:
      return "the model blew up: a force, a displacement or a sample is not finite";
    case FaultReason::kStall:
      return "the real-time thread stood still for too long (max_stall) or too often (max_stalls)";
    case FaultReason::kMadeSafe:
      return "made safe by a signal or a watchdog";
    case FaultReason::kJump:
      return "a position jumped further than a hand can move";
    case FaultReason::kFrozen:
      return "a sensor gave the very same value for too long: look for a broken wire";
    case FaultReason::kWriteFailed:
      return "the device did not take a force";
    case FaultReason::kForceTooHigh:
      return "the model asked for more force than any hand should meet";
    case FaultReason::kEnergy:
      return "a port of the model gave out more energy than it may";
    case FaultReason::kEmergencyStop:
      return "emergency stop";
    case FaultReason::kPresence:
      return "the presence switch is not held";
    case FaultReason::kWorkspace:
      return "an end-effector is where its linkage cannot be";
    case FaultReason::kWatchdog:
      return "ticks stopped coming";
    case FaultReason::kMasterLost:
      return "the ROS master does not answer, or does not know the station any more";
    case FaultReason::kGuardianLost:
      return "the guardian of the devices died or does not look: nobody would take the force away "
             "if this process died";
  }
  return "?";
}

}  // namespace ergotic::tgr
