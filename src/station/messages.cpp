// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/messages.hpp"

namespace ergotic::station {

const char* toString(ForceState state) {
  switch (state) {
    case ForceState::kDisconnected:
      return "disconnected";
    case ForceState::kUncalibrated:
      return "uncalibrated";
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

}  // namespace ergotic::station
