// SPDX-License-Identifier: BSD-3-Clause
// What players without a device do: targets of hands, notes, MIDI, gamepads.
#include <ros/console.h>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/tgr/players/scene_map.hpp"
#include "files/printable.hpp"
#include "ros/display/handles.hpp"
#include "ros/interface/station_controller.hpp"
#include "scene/names.hpp"

namespace ergotic::node {
namespace {

const char kKeyboard[] = "keyboard";  // as a sender of targets: no node has a name without a slash
// From a period after a MIDI message came to the stroke: the thread that reads it is there by
// then, so that all messages keep their distances in time.
constexpr double kMidiDelayS = 0.002;
constexpr double kAtOnce = station::Station::kAtOnce;
constexpr std::size_t kShownName = 64;  // of what a stranger says, bytes

double nowS() {
  return static_cast<double>(rt::monotonicNs()) / kNsPerS;
}

HandTargets targetsOf(const tgr::Stroke& stroke) {
  HandTargets wanted;
  wanted.end_effector = stroke.end_effector;
  wanted.indices = {static_cast<std::uint32_t>(stroke.index)};
  wanted.targets = {stroke.target_m};
  wanted.glide = stroke.glide_s;
  wanted.grip = HandTargets::KEY;
  wanted.release = stroke.lets_go ? 1U : 0U;
  return wanted;
}

}  // namespace

std::string StationController::moveHands(const HandTargets& wanted, const std::string& sender) {
  try {
    return move(players_.read(wanted, sender, nowS()));
  } catch (const std::exception& refusal) {
    return refusal.what();
  }
}

std::string StationController::move(const std::vector<tgr::HandMove>& moves, double due_tick) {
  const std::lock_guard lock(engine_mutex_);
  if (!engine_) {
    return kNothingPlays;
  }
  station::Station& station = engine_->station();
  for (const tgr::HandMove& move : moves) {
    // Not a number, as `due_tick`, if it is due at once: the move says it then.
    const double delay_ticks = move.delay_s * station.config().rates.gesturalHz();
    if (!station.move(move, due_tick + delay_ticks)) {
      return "slice " + std::to_string(move.slice) +
             ": the station has no simulated hand there, or too many moves wait";
    }
  }
  return "";
}

void StationController::play(const tgr::Strokes& strokes, double due_tick) {
  for (const tgr::Stroke& stroke : strokes) {
    try {
      std::vector<tgr::HandMove> moves = players_.read(targetsOf(stroke), kKeyboard, 0.0);
      for (tgr::HandMove& move : moves) {
        move.time_s = tgr::HandMove::kOnArrival;
        move.delay_s = stroke.after_s;
      }
      if (const std::string refusal = move(moves, due_tick); !refusal.empty()) {
        throw Exception(refusal);
      }
    } catch (const std::exception& refusal) {
      ROS_WARN_STREAM_THROTTLE(1.0, "a note moves nothing: " << refusal.what());
    }
  }
}

std::string StationController::hold(const HoldTarget& wanted, const std::string& sender) {
  {
    const std::lock_guard lock(engine_mutex_);
    if (!engine_) {
      return kNothingPlays;
    }
  }
  try {
    return hold(holders_.read(wanted, sender, nowS()));
  } catch (const std::exception& refusal) {
    return refusal.what();
  }
}

void StationController::expireHolds() {
  hold(holders_.expire(nowS()));
}

std::string StationController::hold(const std::vector<Holders::Wish>& wishes) {
  const std::lock_guard lock(engine_mutex_);
  for (const Holders::Wish& wish : wishes) {
    if (!engine_ || !engine_->station().hold(wish.hand, wish.hold, wish.model)) {
      return kNothingPlays;
    }
  }
  return "";
}

/// Modules that can be held; none at a device where a person may be, as holding the model would
/// push there, too.
std::vector<std::uint8_t> StationController::modulesToHold() const {
  return engine_->hands().canHurt() ? std::vector<std::uint8_t>()
                                    : modulesThatCanBeHeld(*playing_->instrument);
}

void StationController::showHandles() {
  Handles handles = handlesOf(playing_->instrument->scene(), endEffectors());
  handles.can_be_held = modulesToHold();
  publishers_.showHandles(std::move(handles));
}

void StationController::playNote(int note, int velocity) {
  const std::lock_guard lock(keyboard_mutex_);
  play(keyboard_.note(note, velocity, nowS()), kAtOnce);
}

std::optional<int> StationController::tap(const std::string& end_effector,
                                          int index,
                                          int velocity) {
  const std::lock_guard lock(keyboard_mutex_);
  const std::optional<int> note = keyboard_.noteOf({end_effector, index});
  if (note) {
    play(keyboard_.note(*note, velocity, nowS()), kAtOnce);
  }
  return note;
}

void StationController::releaseKeys() {
  const std::lock_guard lock(keyboard_mutex_);
  play(keyboard_.releaseAll(nowS()), kAtOnce);
}

PlayersWishes StationController::playMidi() {
  PlayersWishes wishes;
  const std::lock_guard keyboard_lock(keyboard_mutex_);
  station::MidiArrival arrival;
  double delay_ticks = 0.0;
  const auto next = [&] {
    const std::lock_guard lock(engine_mutex_);
    if (!engine_ || !engine_->popMidi(arrival)) {
      return false;
    }
    delay_ticks = kMidiDelayS * engine_->station().config().rates.gesturalHz();
    return true;
  };
  while (next()) {
    const auto& message = arrival.message;
    const auto played = keyboard_.play(message.bytes.data(), message.size, arrival.time_s);
    play(played.strokes, arrival.tick + delay_ticks);
    play(played, wishes);
  }
  return wishes;
}

PlayersWishes StationController::playGamepad(int pad, const tgr::GamepadMove& move) {
  PlayersWishes wishes;
  const std::lock_guard lock(keyboard_mutex_);
  const auto played = keyboard_.play(move, pad, nowS());
  play(played.strokes, kAtOnce);
  play(played, wishes);
  return wishes;
}

void StationController::unplugGamepad(int pad) {
  const std::lock_guard lock(keyboard_mutex_);
  play(keyboard_.unplug(pad, nowS()), kAtOnce);
}

/// Executes the results of a message that are not strokes.
void StationController::play(const tgr::Keyboard::Played& played, PlayersWishes& wishes) {
  for (const tgr::ParameterChange& change : played.changes) {
    if (const auto range = ranges_.find(change.parameter); range != ranges_.end()) {
      wishes.parameters.emplace_back(change.parameter, tgr::valueOf(change, range->second));
    }
  }
  if (played.learnt) {
    wishes.news.push_back(nameOf(played.learnt->control) + " moves " +
                          scene::quoted(played.learnt->parameter) +
                          " from now on, until another model plays");
  }
  wishes.program = played.program ? played.program : wishes.program;
}

Answer StationController::learnControl(const std::string& parameter) {
  const std::lock_guard lock(keyboard_mutex_);
  if (parameter.empty()) {
    keyboard_.learner().wait("");
    return {true, "no control is waited for"};
  }
  if (ranges_.empty()) {
    return {false, "nothing plays that has parameters: load a model first"};
  }
  if (ranges_.count(parameter) == 0) {
    std::string known;
    for (const auto& [name, unused] : ranges_) {
      known += (known.empty() ? "" : ", ") + name;
    }
    return {false, "the model has no parameter " +
                       scene::quoted(files::printable(parameter, kShownName)) +
                       ", it has: " + known};
  }
  keyboard_.learner().wait(parameter);
  return {true, "waits for a control: move the one that shall move " + scene::quoted(parameter)};
}

std::string StationController::usePlayMap(const std::string& map) {
  std::string refusal = readPlayMap(map);
  if (refusal.empty()) {
    const std::lock_guard lock(keyboard_mutex_);
    players_map_ = map;
    keyboard_.learner().forget();
  }
  return refusal;
}

std::string StationController::readPlayMap(const std::string& map) {
  try {
    const bool is_text = map.find('\n') != std::string::npos;
    tgr::PlayMap read = is_text ? tgr::readPlayMap(map, "play_map") : tgr::readPlayMapFile(map);
    tgr::leaveOut(read, [this](const std::string& tool) { return players_.has(tool); });
    const std::lock_guard lock(keyboard_mutex_);
    play(keyboard_.use(std::move(read), nowS()), kAtOnce);
    return "";
  } catch (const Exception& refusal) {
    return refusal.what();
  }
}

/// \param keeps_the_players  a map that was requested explicitly stays
void StationController::findPlayMap(const scene::Scene& scene, bool keeps_the_players) {
  std::string map;
  {
    const std::lock_guard lock(keyboard_mutex_);
    players_map_ = keeps_the_players ? players_map_ : "";
    map = players_map_;
    if (!keeps_the_players) {
      keyboard_.learner().forget();
    }
    ranges_ = tgr::rangesOf(scene);
    play(keyboard_.use(tgr::usualMap(scene), nowS()), kAtOnce);
  }
  if (map.empty()) {
    map = tgr::mapBeside(scene.file);
  }
  if (const std::string refusal = map.empty() ? "" : readPlayMap(map); !refusal.empty()) {
    ROS_WARN_STREAM(refusal);
    publishers_.addMessage(refusal);
  }
}

}  // namespace ergotic::node
