// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/score.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "ergotic/tgr/keyboard.hpp"
#include "ergotic/tgr/players/scene_map.hpp"
#include "ergotic/tgr/players/tool_hands.hpp"

namespace ergotic::tools {
namespace {

constexpr int kNoNote = -1;

/// The tick in which a time is; what is by rounding just before a tick belongs to it.
std::int64_t tickOf(double time_s, double rate_hz) {
  constexpr double kRounding = 1e-6;
  return static_cast<std::int64_t>(std::floor(time_s * rate_hz + kRounding));
}

/// \return the note that begins with a message; kNoNote if none does
int noteOf(const Song::Message& message) {
  constexpr unsigned kNoteOn = 0x90;
  const bool begins =
      message.size == 3 && (message.bytes[0] & 0xf0U) == kNoteOn && message.bytes[2] > 0;
  return begins ? message.bytes[1] : kNoNote;
}

std::string rangesText(const std::vector<std::pair<int, int>>& ranges) {
  std::string text;
  for (const auto& [first, last] : ranges) {
    text += (text.empty() ? "" : ", ") + std::to_string(first) +
            (last > first ? "..." + std::to_string(last) : "");
  }
  return text;
}

/// Plays a song on a keyboard, and writes down what hands and parameters do.
class SongScorer {
 public:
  SongScorer(const Song& song,
             SongMap map,
             const scene::Scene& scene,
             const tgr::EndEffectors& end_effectors,
             int slices)
      : song_(song),
        map_(std::move(map)),
        scene_(scene),
        ranges_(tgr::rangesOf(scene)),
        hands_(end_effectors),
        slices_(slices) {
    score_.warnings = song.warnings;
    for (const std::string& name :
         tgr::leaveOut(map_.map, [this](const std::string& tool) { return hands_.has(tool); })) {
      warn(map_.name, "the lines of the end-effector '" + name +
                          "' are passed over, as it does not stand on the slices "
                          "(--end-effectors)");
    }
  }

  Score run() {
    checkKeys();
    keyboard_.use(map_.map, 0.0);
    for (const Song::Message& message : song_.messages) {
      take(keyboard_.play(message.bytes.data(), message.size, message.time_s), message.time_s);
    }
    score_.end_s = song_.messages.back().time_s;
    return std::move(score_);
  }

 private:
  /// Adds a warning; each text once.
  void warn(const std::string& place, const std::string& what) {
    const std::string line = place + ": warning: " + what;
    if (std::find(score_.warnings.begin(), score_.warnings.end(), line) == score_.warnings.end()) {
      score_.warnings.push_back(line);
    }
  }

  void checkKeys() {
    const std::vector<std::pair<int, int>> ranges = tgr::notesWithKeys(map_.map);
    std::map<int, int> without;  // how often each note begins that has no key
    int notes = 0;
    int keyless = 0;
    for (const Song::Message& message : song_.messages) {
      const int note = noteOf(message);
      if (note == kNoNote) {
        continue;
      }
      ++notes;
      if (std::none_of(ranges.begin(), ranges.end(), [note](const auto& range) {
            return note >= range.first && note <= range.second;
          })) {
        ++without[note];
        ++keyless;
      }
    }
    if (keyless == 0) {
      return;
    }
    const std::string keys =
        map_.name + " has " + (ranges.empty() ? "no keys" : "keys for " + rangesText(ranges));
    const std::string span =
        std::to_string(without.begin()->first) + "..." + std::to_string(without.rbegin()->first);
    if (keyless == notes) {
      throw Exception(song_.file + ": error: no note has a key: its notes are " + span + ", " +
                      keys);
    }
    warn(song_.file, std::to_string(keyless) + " of " + std::to_string(notes) +
                         " notes have no key and are passed over: they are within " + span + ", " +
                         keys);
  }

  void take(const tgr::Keyboard::Played& played, double time_s) {
    for (const tgr::Stroke& stroke : played.strokes) {
      move(stroke, time_s);
    }
    for (const tgr::ParameterChange& change : played.changes) {
      set(change, time_s);
    }
    if (played.program) {
      warn(song_.file, "program changes are passed over: one instrument plays");
    }
  }

  void move(const tgr::Stroke& stroke, double time_s) {
    try {
      for (const tgr::HandMove& move : hands_.moves(stroke)) {
        if (move.slice >= slices_) {
          throw Exception("slice is " + std::to_string(move.slice) + ", allowed: 0..." +
                          std::to_string(slices_ - 1) + ", as the device has slices");
        }
        score_.moves.push_back({time_s, move});
      }
    } catch (const Exception& refusal) {
      warn(map_.name, std::string("a note or a control moves nothing: ") + refusal.what());
    }
  }

  void set(const tgr::ParameterChange& change, double time_s) {
    const auto& known = scene_.parameters;
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& parameter) {
      return parameter.name == change.parameter;
    });
    if (found == known.end()) {
      return warn(map_.name, "the scene has no parameter '" + change.parameter +
                                 "', and what moves it is passed over");
    }
    score_.values.push_back({time_s, static_cast<int>(found - known.begin()),
                             tgr::valueOf(change, ranges_.at(change.parameter))});
  }

  const Song& song_;
  SongMap map_;
  const scene::Scene& scene_;
  std::map<std::string, tgr::ParameterRange> ranges_;
  tgr::ToolHands hands_;
  int slices_;
  tgr::Keyboard keyboard_;
  Score score_;
};

}  // namespace

ScoreReader::ScoreReader(Score score, std::vector<double> parameters)
    : score_(std::move(score)), parameters_(std::move(parameters)) {}

void ScoreReader::bring(std::int64_t tick,
                        const physics::Instrument& instrument,
                        replay::OfflineStation& station) {
  const double rate_hz = station.rates().gesturalHz();
  for (; next_move_ < score_.moves.size(); ++next_move_) {
    const Score::Move& next = score_.moves[next_move_];
    if (tickOf(next.time_s, rate_hz) > tick) {
      break;
    }
    station.move(next.move, (next.time_s + next.move.delay_s) * rate_hz);
  }
  std::map<int, double> changes;  // of several of a parameter in a tick the last one counts
  for (; next_value_ < score_.values.size(); ++next_value_) {
    const Score::Value& next = score_.values[next_value_];
    if (tickOf(next.time_s, rate_hz) > tick) {
      break;
    }
    changes[next.parameter] = next.value;
  }
  for (const auto& [parameter, value] : changes) {
    parameters_[static_cast<std::size_t>(parameter)] = value;
    station.setParameter(instrument, parameters_, parameter);
  }
}

Score scoreOfGesture(const std::string& file, const scene::Scene& scene) {
  Score score;
  for (const tgr::GestureValue& value : tgr::readGestureValues(file)) {
    const std::size_t index = tgr::parameterOf(value, scene.parameters);
    score.values.push_back({value.time_s, static_cast<int>(index), value.value});
  }
  return score;
}

SongMap songMapFor(const scene::Scene& scene, const std::string& file) {
  const std::string path = file.empty() ? tgr::mapBeside(scene.file) : file;
  if (path.empty()) {
    return {tgr::usualMap(scene), "a scene without a map"};
  }
  return {tgr::readPlayMapFile(path), path};
}

Score scoreOf(const Song& song,
              SongMap map,
              const scene::Scene& scene,
              const tgr::EndEffectors& end_effectors,
              int slices) {
  return SongScorer(song, std::move(map), scene, end_effectors, slices).run();
}

}  // namespace ergotic::tools
