// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/station/performer.hpp"
#include "replay/replay.hpp"
#include "tools/lib/song.hpp"
#include "tools/lib/sound_inputs.hpp"

namespace ergotic::tools {

/// Something that makes sound tick by tick, offline.
class Player {
 public:
  virtual ~Player() = default;

  virtual const physics::Rates& rates() const = 0;
  virtual int outputChannels() const = 0;
  virtual const physics::Instrument& instrument() const = 0;  ///< instrument that plays

  /// \param[out] frames  [R][output channels], where R frames make a tick
  /// \return false if there is no more; `frames` is untouched then
  /// \throws Exception if the model blows up; a recorded one does what it did
  virtual bool next(double* frames) = 0;

  /// Error so far that leaves the sound valid; empty: none.
  virtual std::string trouble() const { return {}; }

  /// Reasons for which the sound differs from the recorded performance, in order; empty: it is
  /// equal.
  virtual std::vector<std::string> flaws() const { return {}; }

  /// Number of ticks left to play; -1: no end.
  virtual std::int64_t ticksLeft() const { return -1; }

  /// Default duration, s.
  virtual double usualSeconds() const { return kUsualSeconds; }
  static constexpr double kUsualSeconds = 10.0;

  /// Warnings about parts of the gesture that are not played as written, if `seconds` are played.
  /// Rows may be `late_s` later without a warning.
  virtual std::vector<std::string> gestureWarnings(double /*seconds*/, double /*late_s*/) const {
    return {};
  }
};

/// Makes a player of the instrument alone, without hands: the slices rest at the zero of the hand.
/// The sound keeps the precision of the instrument's outputs.
std::unique_ptr<Player> makeFreePlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs);

/// The instrument in a station that is engaged from the first tick on: safety, the tick of delay
/// and single-precision sound as when played live.
/// \param csv  targets for the hand of a virtual device and values of parameters, or recorded
/// positions
/// \throws TextError from the file
std::unique_ptr<Player> makeHandPlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs,
                                       const std::string& csv);

/// The same, but a song plays: by a map of notes as at a live station, each stroke when it is due.
/// \param end_effectors  that the performer has. \param map  file; empty: as songMapFor says
/// \throws TextError from the map, Exception if no note of the song has a key
std::unique_ptr<Player> makeSongPlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs,
                                       const tgr::EndEffectors& end_effectors,
                                       const Song& song,
                                       const std::string& map);

/// A recorded performance. \pre `recorded` is not null
std::unique_ptr<Player> makeRecordedPlayer(std::unique_ptr<replay::Replay> recorded);

}  // namespace ergotic::tools
