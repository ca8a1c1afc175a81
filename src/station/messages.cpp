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

const char* toString(Refusal refusal) {
  switch (refusal) {
    case Refusal::kFault:
      return "there was a fault: recover first";
    case Refusal::kUncalibrated:
      return "a slice in use is not calibrated: calibrate it first";
    case Refusal::kPresence:
      return "the presence switch is not held";
    case Refusal::kBusy:
      return "the model is still busy, try again in a moment";
    case Refusal::kOutdated:
      return "force was taken away after this was asked for: ask again";
  }
  return "?";
}

}  // namespace ergotic::station
