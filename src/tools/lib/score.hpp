// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/players/play_map.hpp"
#include "replay/offline_station.hpp"
#include "tools/lib/song.hpp"

namespace ergotic::tools {

/// Events at a station, in addition to those of its device. Times are in s since the first tick.
struct Score {
  struct Move {
    double time_s = 0.0;  ///< reference time of the delay in the move
    tgr::HandMove move;
  };
  struct Value {
    double time_s = 0.0;
    int parameter = 0;  ///< index
    double value = 0.0;
  };
  std::vector<Move> moves;            ///< in order of time
  std::vector<Value> values;          ///< in order of time
  double end_s = 0.0;                 ///< time of the last event of its source
  std::vector<std::string> warnings;  ///< messages that are skipped
};

/// Brings a score to a station, each part at its tick: what happens during a tick is there from the
/// beginning of that tick on, but for hands, which know the time within it.
class ScoreReader {
 public:
  /// \param parameters  values that the model begins with
  ScoreReader(Score score, std::vector<double> parameters);

  /// \pre `tick` is the next one of the station, and ticks increase
  /// \param instrument  that plays there
  /// \throws Exception if the station does not take it
  void bring(std::int64_t tick,
             const physics::Instrument& instrument,
             replay::OfflineStation& station);

 private:
  Score score_;
  std::vector<double> parameters_;
  std::size_t next_move_ = 0;
  std::size_t next_value_ = 0;
};

/// The rows of a gesture file that set parameters; the hands are moved by a virtual device.
/// \throws TextError also of parameters that the scene does not have, or not with such a value
Score scoreOfGesture(const std::string& file, const scene::Scene& scene);

/// The map by which notes play a scene, as at a live station.
struct SongMap {
  tgr::PlayMap map;
  std::string name;  ///< name, for messages
};
/// \param file  of the map; empty: that beside the scene, or else each slice a key
/// \throws TextError, Exception from the file
SongMap songMapFor(const scene::Scene& scene, const std::string& file);

/// Makes the score of hands and parameters for a song that plays a scene.
/// \param slices  number of slices of the device, whose hands can be moved
/// \throws Exception if no note of the song has a key
Score scoreOf(const Song& song,
              SongMap map,
              const scene::Scene& scene,
              const tgr::EndEffectors& end_effectors,
              int slices);

}  // namespace ergotic::tools
