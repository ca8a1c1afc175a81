// SPDX-License-Identifier: BSD-3-Clause
// Notes, and the pedals that keep them.
#include "ergotic/tgr/keyboard.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kFastestVelocity = 127.0;
constexpr int kNoChannel = 16;
constexpr double kSoftest = 2.0 / 3.0;  // of the velocity, with the soft pedal down

double speedOf(const KeyLine& line, double velocity) {
  return line.slowest *
         std::pow(line.fastest / line.slowest, (velocity - 1.0) / (kFastestVelocity - 1.0));
}

}  // namespace

Strokes Keyboard::use(PlayMap map, double now_s) {
  Strokes strokes = releaseAll(now_s);
  const auto let_go = [&](const Motion& motion) {
    for (const int index : motion.indices) {
      ways_.letGo({motion.end_effector, index}, strokes);
    }
  };
  for (const ControlLine& line : map_.controls) {
    if (line.control.kind != Control::Kind::kAxis || hasMoved(line.control.number)) {
      let_go(line.motion);
    }
  }
  for (const KeyLine& line : map_.keys) {
    let_go(line.bend.value_or(Motion()));
    let_go(line.slide.value_or(Motion()));
  }
  map_ = std::move(map);
  for (auto& [number, pad] : pads_) {
    pad.axes.clear();
  }
  if (!map_.has_gamepad) {
    useUsualGamepad();
  }
  zones_.use(map_.mpe);
  return strokes;
}

void Keyboard::forgetHands() {
  down_.clear();
  ways_.clear();
}

std::optional<Keyboard::Key> Keyboard::keyOf(int note) const {
  const int sounding = note + map_.transpose;
  for (const KeyLine& line : map_.keys) {
    if (sounding >= line.first_note && sounding <= line.last_note) {
      const auto number = static_cast<std::size_t>(sounding - line.first_note);
      return Key{&line, number, {line.end_effector, line.indices[number % line.indices.size()]}};
    }
  }
  return std::nullopt;
}

std::optional<int> Keyboard::noteOf(const HandWays::Hand& hand) const {
  constexpr int kNotes = 128;
  for (int note = 0; note < kNotes; ++note) {
    if (const auto key = keyOf(note); key && key->hand == hand) {
      return note;
    }
  }
  return std::nullopt;
}

double Keyboard::depthOf(const Down& down) const {
  return down.is_held || down.is_caught ? 1.0 : pedal_depth_;
}

/// Depth of a key: the largest of all notes that play it.
double Keyboard::depthOf(const Key& key) const {
  double depth = 0.0;
  for (const auto& [name, down] : down_) {
    if (keyOf(name.second)->hand == key.hand) {
      depth = std::max(depth, depthOf(down));
    }
  }
  return depth;
}

double Keyboard::placeOf(const Key& key) const {
  const KeyLine& line = *key.line;
  double pressure = 0.0;
  for (const auto& [name, down] : down_) {
    if (down.is_held && keyOf(name.second)->hand == key.hand) {
      pressure = std::max(pressure, down.pressure);
    }
  }
  if (pressure > 0.0) {  // a finger is there, so that it is down
    return line.to_m + pressure * (line.pressure_to_m.value_or(line.to_m) - line.to_m);
  }
  const double depth = depthOf(key);
  return depth == 1.0 ? line.to_m : line.from_m + depth * (line.to_m - line.from_m);
}

/// Strikes a key: the hand glides for the time that the whole way between the two ends takes.
void Keyboard::strike(
    const Key& key, double target_m, double speed, double after_s, Strokes& strokes) {
  const double way = std::abs(key.line->to_m - key.line->from_m);
  ways_.glide(key.hand, target_m,
              std::min(HandMove::kPeakOfMean * way / speed, HandMove::kMaxGlideS), after_s, now_s_,
              strokes);
}

Strokes Keyboard::note(int note, int velocity, double now_s) {
  now_s_ = now_s;
  Strokes strokes;
  if (velocity > 0) {
    press({kNoChannel, note}, velocity, strokes);
  } else {
    release({kNoChannel, note}, strokes);
  }
  return strokes;
}

void Keyboard::press(const Name& name, int velocity, Strokes& strokes) {
  const auto key = keyOf(name.second);
  if (!key) {
    return;
  }
  const KeyLine& line = *key->line;
  const double speed = speedOf(line, std::max(velocity * (1.0 - soft_ * (1.0 - kSoftest)), 1.0));
  if (line.strikes) {
    strike(*key, line.to_m, speed, 0.0, strokes);
    strike(*key, line.from_m, line.back, strokes.back().glide_s, strokes);
    return;
  }
  double after_s = 0.0;
  if (depthOf(*key) > 0.0) {  // it has to come up before it can be pressed again
    strike(*key, line.from_m, line.fastest, 0.0, strokes);
    after_s = strokes.back().glide_s;
  }
  strike(*key, line.to_m, speed, after_s, strokes);
  Down& down = down_[name];
  down.is_held = true;
  down.pressure = 0.0;
}

void Keyboard::release(const Name& name, Strokes& strokes) {
  const auto found = down_.find(name);
  if (found == down_.end()) {
    return;
  }
  const Key key = *keyOf(name.second);
  Down& down = found->second;
  down.is_held = false;
  down.pressure = 0.0;
  if (depthOf(down) == 0.0) {
    down_.erase(found);
  }
  goBack(key, strokes);
}

/// Returns a key as far as its other notes and the pedals permit.
void Keyboard::goBack(const Key& key, Strokes& strokes) {
  const double place_m = placeOf(key);
  const double told_m = ways_.toldOf(key.hand, key.line->from_m);
  if (place_m == told_m) {
    return;
  }
  if (depthOf(key) == 1.0) {
    return settle(key, strokes);
  }
  const double glide_s = HandMove::kPeakOfMean * std::abs(place_m - told_m) / key.line->back;
  ways_.glide(key.hand, place_m, std::min(glide_s, HandMove::kMaxGlideS), 0.0, now_s_, strokes);
}

/// Follows a pedal, or a finger that presses more or less.
void Keyboard::settle(const Key& key, Strokes& strokes) {
  ways_.follow(key.hand, placeOf(key), key.line->from_m, key.line->back, now_s_, strokes);
}

/// Handles pedals; other controllers have no effect.
void Keyboard::setPedal(int number, int value, Strokes& strokes) {
  constexpr int kSustain = 64;
  constexpr int kSostenuto = 66;
  constexpr int kSoft = 67;
  constexpr int kHalf = 64;  // a pedal that only is down or up is down from there on
  const double share = value / kFastestVelocity;
  switch (number) {
    case kSustain:
      pedal_depth_ = std::clamp(2.0 * share - 0.5, 0.0, 1.0);
      return settleKept(strokes);
    case kSostenuto:
      return catchKeys(value >= kHalf, strokes);
    case kSoft:
      soft_ = share;
      return;
    default:
      return;
  }
}

void Keyboard::catchKeys(bool is_down, Strokes& strokes) {
  if (is_down == sostenuto_) {
    return;
  }
  sostenuto_ = is_down;
  for (auto& [name, down] : down_) {
    down.is_caught = is_down && down.is_held;
  }
  settleKept(strokes);
}

/// Keys that no finger holds are as far down as pedals keep them.
void Keyboard::settleKept(Strokes& strokes) {
  std::map<HandWays::Hand, Key> kept;
  for (auto next = down_.begin(); next != down_.end();) {
    const auto [name, down] = *next;
    if (!down.is_held) {
      const Key key = *keyOf(name.second);
      kept.emplace(key.hand, key);
    }
    next = depthOf(down) == 0.0 ? down_.erase(next) : std::next(next);
  }
  for (const auto& [hand, key] : kept) {
    if (depthOf(key) == 0.0) {
      goBack(key, strokes);
    } else {
      settle(key, strokes);
    }
  }
}

Strokes Keyboard::releaseAll(double now_s) {
  now_s_ = now_s;
  pedal_depth_ = 0.0;
  sostenuto_ = false;
  key_pressures_.clear();
  for (auto& [name, down] : down_) {
    down = Down();
  }
  Strokes strokes;
  settleKept(strokes);
  return strokes;
}

}  // namespace ergotic::tgr
