// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/messages.hpp"

#include <sstream>

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

std::string explainStall(double stall_s, std::uint64_t stalls_borne) {
  std::ostringstream text;
  text.precision(3);
  if (stalls_borne == 0) {
    text << "the real-time thread stood still for " << 1e3 * stall_s
         << " ms, longer than max_stall allows";
  } else if (stall_s > 0.0) {
    text << "the real-time thread stood still more often than max_stalls allows (" << stalls_borne
         << " in a second), the last time for " << 1e3 * stall_s << " ms";
  } else {
    text << "a tick was not done in time more often than max_stalls allows (" << stalls_borne
         << " in a second)";
  }
  text << ": close what keeps the processors busy, use a real-time kernel, or raise that limit";
  return text.str();
}

}  // namespace ergotic::station
