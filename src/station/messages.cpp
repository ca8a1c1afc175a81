// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/messages.hpp"

namespace ergotic::station {

const char* toString(ForceState state) {
  switch (state) {
    case ForceState::kDisconnected:
      return "disconnected";
    case ForceState::kReady:
      return "ready";
    case ForceState::kEngaging:
      return "engaging";
    case ForceState::kPlaying:
      return "playing";
    case ForceState::kFault:
      return "fault";
  }
  return "?";
}

const char* toString(FaultReason reason) {
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
      return "the real-time thread stood still for longer than max_stall";
    case FaultReason::kMadeSafe:
      return "made safe by a signal or a watchdog";
  }
  return "?";
}

}  // namespace ergotic::station
