// SPDX-License-Identifier: BSD-3-Clause
// What players without a device do: targets of hands, notes, MIDI.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <ros/console.h>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "files/read_file.hpp"
#include "ros/conversation/performance.hpp"

namespace ergotic::node {
namespace {

const char kKeyboard[] = "keyboard";  // as a sender of targets: no node has a name without a slash
// From the period in which a MIDI message came to the stroke: the thread that reads it is there by
// then, so that all messages keep their distances in time.
constexpr double kMidiDelayS = 0.002;
constexpr double kDecades = 100.0;  // a range over more of them is gone through by its logarithm

constexpr std::size_t kMostBytes = std::size_t{1} << 20U;  // of a map

/// Of a scene `folder/NAME.yaml`.
std::filesystem::path mapBeside(const std::string& scene) {
  const std::filesystem::path path(scene);
  return path.parent_path() / "maps" / (path.stem().string() + ".yaml");
}

/// Of a scene without a map: each slice a key, from middle C on.
tgr::PlayMap usualMap(const scene::Scene& scene) {
  constexpr int kMiddleC = 60;
  constexpr double kWayM = 0.02;
  tgr::PlayMap map;
  tgr::KeyLine line;
  line.first_note = kMiddleC;
  line.to_m = kWayM;
  for (const scene::Port& port : scene.ports) {
    if (port.slice >= 0) {
      line.indices.push_back(port.slice);
    }
  }
  if (!line.indices.empty()) {
    std::sort(line.indices.begin(), line.indices.end());
    map.keys.push_back(line);
  }
  return map;
}

HandTargets targetsOf(const tgr::Stroke& stroke) {
  HandTargets wanted;
  wanted.end_effector = stroke.end_effector;
  wanted.indices = {static_cast<std::uint32_t>(stroke.index)};
  wanted.targets = {stroke.target_m};
  wanted.glide = stroke.glide_s;
  wanted.grip = HandTargets::KEY;
  return wanted;
}

}  // namespace

std::string Performance::moveHands(const HandTargets& wanted, const std::string& sender) {
  try {
    return move(players_.read(wanted, sender, static_cast<double>(rt::monotonicNs()) / kNsPerS));
  } catch (const std::exception& refusal) {
    return refusal.what();
  }
}

std::string Performance::move(const std::vector<tgr::HandMove>& moves) {
  const std::lock_guard lock(engine_mutex_);
  if (!engine_) {
    return kNothingPlays;
  }
  for (const tgr::HandMove& move : moves) {
    if (!engine_->station().driver().move(move)) {
      return "slice " + std::to_string(move.slice) +
             ": the station has no simulated hand there, or too many moves wait";
    }
  }
  return "";
}

void Performance::play(const std::vector<tgr::Stroke>& strokes, double delay_s) {
  for (const tgr::Stroke& stroke : strokes) {
    try {
      std::vector<tgr::HandMove> moves = players_.read(targetsOf(stroke), kKeyboard, 0.0);
      for (tgr::HandMove& move : moves) {
        move.time_s = tgr::HandMove::kOnArrival;
        move.delay_s = std::max(delay_s + stroke.after_s, 0.0);
      }
      if (const std::string refusal = move(moves); !refusal.empty()) {
        throw Exception(refusal);
      }
    } catch (const std::exception& refusal) {
      ROS_WARN_STREAM_THROTTLE(1.0, "a note moves nothing: " << refusal.what());
    }
  }
}

void Performance::playNote(int note, int velocity) {
  const std::lock_guard lock(keyboard_mutex_);
  play(keyboard_.note(note, velocity), 0.0);
}

void Performance::releaseKeys() {
  const std::lock_guard lock(keyboard_mutex_);
  play(keyboard_.releaseAll(), 0.0);
}

std::vector<std::pair<std::string, double>> Performance::playMidi() {
  std::vector<std::pair<std::string, double>> changes;
  const std::lock_guard keyboard_lock(keyboard_mutex_);
  station::MidiArrival arrival;
  const auto next = [&] {
    const std::lock_guard lock(engine_mutex_);
    return engine_ && engine_->popMidi(arrival);
  };
  while (next()) {
    const auto played = keyboard_.play(arrival.message.bytes.data(), arrival.message.size);
    const double passed_s = static_cast<double>(rt::monotonicNs() - arrival.period_ns) / kNsPerS;
    play(played.strokes, kMidiDelayS + arrival.offset_s - passed_s);
    if (const auto range = ranges_.find(played.parameter); range != ranges_.end()) {
      const auto [low, high] = range->second;
      const double value = low > 0.0 && high > kDecades * low
                               ? low * std::pow(high / low, played.share)
                               : low + played.share * (high - low);
      changes.emplace_back(played.parameter, value);
    }
  }
  return changes;
}

std::string Performance::usePlayMap(const std::string& map) {
  std::string refusal = readPlayMap(map);
  if (refusal.empty()) {
    const std::lock_guard lock(keyboard_mutex_);
    players_map_ = map;
  }
  return refusal;
}

std::string Performance::readPlayMap(const std::string& map) {
  try {
    const bool is_text = map.find('\n') != std::string::npos;
    tgr::PlayMap read = is_text ? tgr::readPlayMap(map, "play_map")
                                : tgr::readPlayMap(files::readFile(map, kMostBytes), map);
    auto& keys = read.keys;
    keys.erase(std::remove_if(keys.begin(), keys.end(),
                              [this](const tgr::KeyLine& line) {
                                return !line.end_effector.empty() &&
                                       !players_.has(line.end_effector);
                              }),
               keys.end());
    const std::lock_guard lock(keyboard_mutex_);
    play(keyboard_.use(std::move(read)), 0.0);
    return "";
  } catch (const Exception& refusal) {
    return refusal.what();
  }
}

/// \param keeps_the_players  the map that somebody asked for stays
void Performance::findPlayMap(const scene::Scene& scene, bool keeps_the_players) {
  std::string map;
  {
    const std::lock_guard lock(keyboard_mutex_);
    players_map_ = keeps_the_players ? players_map_ : "";
    map = players_map_;
    ranges_.clear();
    for (const scene::Parameter& parameter : scene.parameters) {
      ranges_[parameter.name] = {parameter.minimum, parameter.maximum};
    }
    play(keyboard_.use(usualMap(scene)), 0.0);
  }
  std::error_code error;
  const std::filesystem::path file = mapBeside(scene.file);
  if (map.empty() && std::filesystem::is_regular_file(file, error)) {
    map = file.string();
  }
  if (const std::string refusal = map.empty() ? "" : readPlayMap(map); !refusal.empty()) {
    ROS_WARN_STREAM(refusal);
    feed_.addMessage(refusal);
  }
}

}  // namespace ergotic::node
