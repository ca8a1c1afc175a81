// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <ergotic/Event.h>
#include <ergotic/Parameters.h>
#include <ergotic/Status.h>

/// What a player sees of a station, and does with it, in a window of rviz.
namespace ergotic::panel {

/// No status for so long, and the lamp tells nothing any more. It comes once a second, s.
constexpr double kStaleAfterS = 3.0;

/// What the lamp shows: a shape of its own for each, for those who see no colours.
enum class Lamp : std::uint8_t {
  kStale,         ///< ring with a question mark
  kDisconnected,  ///< ring with a bar
  kUncalibrated,  ///< triangle with an exclamation mark
  kReady,         ///< square: force is held at zero
  kEngaging,      ///< ramp
  kPlaying,       ///< disc with a triangle, as on every player
  kFault,         ///< octagon with a cross
};

/// \param age_s  of the status, s; negative: none came yet
Lamp lampOf(std::uint8_t state, double age_s);
/// One word, in capitals.
const char* wordOf(Lamp lamp);
/// 0xRRGGBB
std::uint32_t colourOf(Lamp lamp);

/// Why it is so, or what to do next, as one sentence.
/// \param station      its name
/// \param has_master   the ROS master answers
std::string reasonOf(
    Lamp lamp, const Status& status, double age_s, const std::string& station, bool has_master);

/// Whether a player wants to read of it: not of what the panel shows already, nor of recordings.
bool isWorthALine(const Event& event);
/// What sums up with others of its kind to one line.
std::string kindOf(const Event& event);

/// With so many digits that neighbours on a slider differ, and no more: "0.00015", "2.5e-06",
/// "440".
std::string numberText(double value);

/// What a player has written as the name of a take or a preset, with `_` for blanks, as such names
/// have none.
std::string nameText(const std::string& written);

/// "3150 ticks/s, force after 0.32 ms, sound 44.1 kHz", as far as it is known.
std::string ratesText(const Status& status);

}  // namespace ergotic::panel
