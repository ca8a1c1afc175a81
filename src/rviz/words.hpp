// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <ergotic/Event.h>
#include <ergotic/Parameters.h>
#include <ergotic/Status.h>

/// Texts and symbols for a station in a window of rviz.
namespace ergotic::panel {

/// Age at which a status is stale, s. A status comes once a second.
constexpr double kStaleAfterS = 3.0;

/// Symbol of the lamp: a shape of its own for each state, for users who see no colours.
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
/// Name of the state: one word, in capitals.
const char* wordOf(Lamp lamp);
/// Colour as 0xRRGGBB.
std::uint32_t colourOf(Lamp lamp);

/// Explains the state, or says what to do next, as one sentence.
/// \param station      its name
/// \param has_master   the ROS master answers
std::string reasonOf(
    Lamp lamp, const Status& status, double age_s, const std::string& station, bool has_master);

/// Whether a player wants to read of it: not of what the panel shows already, nor of recordings.
bool isWorthALine(const Event& event);
/// Key by which similar messages are summed up to one line.
std::string kindOf(const Event& event);

/// Formats a number with just enough digits that neighbours on a slider differ: "0.00015",
/// "2.5e-06", "440".
std::string numberText(double value);

/// Turns entered text into the name of a take or a preset, with `_` for blanks, which such names
/// may not have.
std::string nameText(const std::string& written);

/// Formats the rates, as far as known: "3150 ticks/s, force after 0.32 ms, sound 44.1 kHz".
std::string ratesText(const Status& status);

}  // namespace ergotic::panel
