// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/words.hpp"

#include <algorithm>
#include <cstdio>

namespace ergotic::panel {
namespace {

std::string printed(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// "playing", "fault: emergency stop": what follows the colon.
std::string behindColon(const std::string& text) {
  const std::size_t colon = text.find(": ");
  return colon == std::string::npos ? "" : text.substr(colon + 2);
}

std::string uncalibratedSlices(const Status& status) {
  std::string text = status.uncalibrated.size() == 1 ? "Slice" : "Slices";
  for (std::size_t i = 0; i < status.uncalibrated.size(); ++i) {
    text += (i == 0 ? " " : ", ") + std::to_string(status.uncalibrated[i]);
  }
  return text +
         (status.uncalibrated.size() == 1 ? " has no calibration." : " have no calibration.");
}

std::string whyStale(double age_s, const std::string& station, bool has_master) {
  if (!has_master) {
    return "The ROS master does not answer.";
  }
  return age_s < 0.0 ? "No station " + station + " was heard yet."
                     : station + " said nothing for " + printed("%.0f s.", age_s);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

/// The first line, without the place in a file that it speaks of.
std::string firstLine(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  const char mark[] = ": error: ";
  const std::size_t error = line.find(mark);
  return error == std::string::npos ? line : line.substr(error + sizeof mark - 1);
}

}  // namespace

Lamp lampOf(std::uint8_t state, double age_s) {
  if (age_s < 0.0 || age_s > kStaleAfterS) {
    return Lamp::kStale;
  }
  switch (state) {
    case Status::UNCALIBRATED:
      return Lamp::kUncalibrated;
    case Status::READY:
      return Lamp::kReady;
    case Status::ENGAGING:
      return Lamp::kEngaging;
    case Status::PLAYING:
      return Lamp::kPlaying;
    case Status::FAULT:
      return Lamp::kFault;
    default:
      return Lamp::kDisconnected;
  }
}

const char* wordOf(Lamp lamp) {
  switch (lamp) {
    case Lamp::kStale:
      return "STALE";
    case Lamp::kDisconnected:
      return "DISCONNECTED";
    case Lamp::kUncalibrated:
      return "UNCALIBRATED";
    case Lamp::kReady:
      return "READY";
    case Lamp::kEngaging:
      return "ENGAGING";
    case Lamp::kPlaying:
      return "PLAYING";
    case Lamp::kFault:
      return "FAULT";
  }
  return "";
}

std::uint32_t colourOf(Lamp lamp) {
  switch (lamp) {
    case Lamp::kStale:
    case Lamp::kDisconnected:
      return 0x808080;
    case Lamp::kUncalibrated:
      return 0xd08700;
    case Lamp::kReady:
      return 0x2874c8;
    case Lamp::kEngaging:
      return 0xd0a000;
    case Lamp::kPlaying:
      return 0x1e9646;
    case Lamp::kFault:
      return 0xcc2222;
  }
  return 0;
}

std::string reasonOf(
    Lamp lamp, const Status& status, double age_s, const std::string& station, bool has_master) {
  switch (lamp) {
    case Lamp::kStale:
      return whyStale(age_s, station, has_master);
    case Lamp::kDisconnected:
      return status.message.empty() ? "No device is open."
                                    : capital(firstLine(status.message)) + ".";
    case Lamp::kUncalibrated:
      return uncalibratedSlices(status);
    case Lamp::kReady:
      return "Force is held at zero until Engage.";
    case Lamp::kEngaging:
      return "Force ramps in.";
    case Lamp::kPlaying:
      return "Forces reach the hand.";
    case Lamp::kFault:
      return capital(behindColon(status.state_text)) + ". Recover ends it, then Engage.";
  }
  return "";
}

bool isWorthALine(const Event& event) {
  return event.type != Event::PARAMETER && event.type != Event::KEYFRAME;
}

std::string kindOf(const Event& event) {
  switch (event.type) {
    case Event::LATE_TICK:
    case Event::STALL:
    case Event::TICKS_LOST:
    case Event::UNDERRUN:
    case Event::AUDIO_SKIPPED:
      return std::to_string(event.type);
    default:
      return "";
  }
}

std::string numberText(double value) {
  return printed("%.4g", value);
}

std::string ratesText(const Status& status) {
  if (status.gestural_rate <= 0.0) {
    return "";
  }
  std::string text = printed("%.0f ticks/s", status.gestural_rate);
  if (status.delay_ticks > 0.0) {
    text += printed(", force after %.2g ms", 1e3 * status.delay_ticks / status.gestural_rate);
  }
  return text + printed(", sound %.4g kHz", 1e-3 * status.audio_rate);
}

std::string nameText(const std::string& written) {
  const std::size_t first = written.find_first_not_of(' ');
  if (first == std::string::npos) {
    return "";
  }
  std::string name = written.substr(first, written.find_last_not_of(' ') + 1 - first);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace ergotic::panel
