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
constexpr int kLastNote = 127;
constexpr double kSoftest = 2.0 / 3.0;  // of the velocity, with the soft pedal down

double speedOf(const KeyMove& move, double velocity) {
  return move.slowest *
         std::pow(move.fastest / move.slowest, (velocity - 1.0) / (kFastestVelocity - 1.0));
}

double glideOf(double way_m, double speed) {
  return std::min(HandMove::kPeakOfMean * std::abs(way_m) / speed, HandMove::kMaxGlideS);
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
    for (const KeyMove& move : line.moves) {
      for (std::size_t i = 0; move.release != Release::kReturns && i < move.indices.size(); ++i) {
        ways_.letGo(move.handOf(i), strokes);
      }
    }
  }
  map_ = std::move(map);
  placed_.clear();
  needed_s_.clear();
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
  placed_.clear();
  needed_s_.clear();
  ways_.clear();
}

std::optional<Keyboard::Note> Keyboard::lineOf(int note) const {
  const int sounding = note + map_.transpose;
  for (const KeyLine& line : map_.keys) {
    if (sounding >= line.first_note && sounding <= line.last_note) {
      return Note{&line, static_cast<std::size_t>(sounding - line.first_note)};
    }
  }
  return std::nullopt;
}

std::vector<Keyboard::Key> Keyboard::keysOf(int note) const {
  std::vector<Key> keys;
  if (const auto found = lineOf(note)) {
    for (const KeyMove& move : found->line->moves) {
      keys.push_back({&move, found->number, move.handOf(found->number)});
    }
  }
  return keys;
}

std::optional<int> Keyboard::noteOf(const HandWays::Hand& hand) const {
  std::optional<int> among_others;
  for (const KeyLine& line : map_.keys) {
    for (int sounding = line.first_note; sounding <= line.last_note; ++sounding) {
      const int note = sounding - map_.transpose;
      const std::vector<Key> keys = keysOf(note);
      const auto found = std::find_if(keys.begin(), keys.end(),
                                      [&hand](const Key& key) { return key.hand == hand; });
      if (found == keys.end() || lineOf(note)->line != &line || note < 0 || note > kLastNote) {
        continue;
      }
      if (found == keys.begin()) {
        return note;
      }
      among_others = among_others.value_or(note);
    }
  }
  return among_others;
}

double Keyboard::depthOf(const Down& down) const {
  return down.is_held || down.is_caught ? 1.0 : pedal_depth_;
}

Keyboard::Wish Keyboard::wishOf(const HandWays::Hand& hand) const {
  Wish wish;
  std::int64_t last = -1;
  for (const auto& [name, down] : down_) {
    for (const Key& key : keysOf(name.second)) {
      if (key.hand != hand || key.move->strikes) {
        continue;
      }
      wish.pressure = std::max(wish.pressure, down.is_held ? down.pressure : 0.0);
      const double depth = depthOf(down);
      if (depth > wish.depth || (depth == wish.depth && down.order > last)) {
        last = down.order;
        wish.key = key;
        wish.depth = depth;
      }
    }
  }
  return wish;
}

/// \pre a note is down
double Keyboard::placeOf(const Wish& wish) {
  const KeyMove& move = *wish.key->move;
  const double to_m = move.toOf(wish.key->number);
  if (wish.pressure > 0.0) {  // a finger is there, so that it is down
    return to_m + wish.pressure * (move.pressure_to_m.value_or(to_m) - to_m);
  }
  const bool is_down = wish.depth == 1.0 || move.release != Release::kReturns;
  return is_down ? to_m : move.from_m + wish.depth * (to_m - move.from_m);
}

/// Strikes a key: the hand glides for the time that the whole way between the two ends takes; one
/// that need not begin at its rest, for as long as its own way takes. One that is there, as far as
/// is known, is sent there again: somebody else may have moved it.
/// \return for how long, s
double Keyboard::strike(
    const Key& key, double target_m, double speed, double after_s, Strokes& strokes) {
  const KeyMove& move = *key.move;
  const double whole_m = move.toOf(key.number) - move.from_m;
  const bool has_ends = move.release == Release::kReturns && move.legato == Legato::kLifts;
  double way_m =
      has_ends ? whole_m : target_m - ways_.placeAt(key.hand, move.from_m, now_s_ + after_s);
  if (target_m == move.from_m && !move.strikes) {
    way_m = ways_.toldOf(key.hand, move.from_m) - move.from_m;
  }
  way_m = way_m == 0.0 ? whole_m : way_m;
  const double glide_s = way_m == 0.0 ? HandWays::kLagS : glideOf(way_m, speed);
  ways_.glide(key.hand, target_m, move.from_m, glide_s, after_s, now_s_, strokes);
  return glide_s;
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
  const std::vector<Key> keys = keysOf(name.second);
  const double softened = std::max(velocity * (1.0 - soft_ * (1.0 - kSoftest)), 1.0);
  Down down;
  down.is_held = true;
  down.order = pressed_++;
  for (const Key& key : keys) {
    press(key, softened, strokes);
  }
  keepTogether(keys);
  const auto strikes = [](const Key& key) { return key.move->strikes; };
  if (!std::all_of(keys.begin(), keys.end(), strikes)) {
    Down& known = down_[name];
    down.is_caught = known.is_caught;
    known = down;
  }
}

/// Hands that begin one after the other need each other: a finger stays on its string until the
/// plectrum has plucked it, however soon the key is released.
void Keyboard::keepTogether(const std::vector<Key>& keys) {
  constexpr double kMostS = 0.25;  // a bow may be drawn for longer
  double last_s = now_s_;
  bool is_staggered = false;
  for (const Key& key : keys) {
    is_staggered = is_staggered || key.move->after_s != keys.front().move->after_s;
    if (key.move->release != Release::kStops) {
      last_s = std::max(last_s, ways_.arrivalOf(key.hand));
    }
  }
  for (const Key& key : keys) {
    needed_s_[key.hand] = is_staggered ? std::min(last_s, now_s_ + kMostS) : now_s_;
  }
}

void Keyboard::press(const Key& key, double velocity, Strokes& strokes) {
  const KeyMove& move = *key.move;
  const double to_m = move.toOf(key.number);
  const double speed = speedOf(move, velocity);
  double after_s = move.after_s;
  if (move.strikes) {
    const double there_s = strike(key, to_m, speed, after_s, strokes);
    strike(key, move.from_m, move.back, after_s + there_s, strokes);
    return;
  }
  if (move.legato == Legato::kTurns) {
    return turn(key, speed, strokes);
  }
  if (move.legato == Legato::kLifts && wishOf(key.hand).key) {
    after_s = std::max(after_s, strike(key, move.from_m, move.fastest, 0.0, strokes));
  }
  strike(key, to_m, speed, after_s, strokes);
  if (move.release == Release::kStays) {
    const auto [least, most] = std::minmax_element(move.to_m.begin(), move.to_m.end());
    placed_[key.hand] = {to_m, *least, *most};
  }
}

/// Draws a hand to the farther end of its way; one that stops with its key turns there, and goes to
/// and fro as long as that is held. One that has not moved yet is at 0.
void Keyboard::turn(const Key& key, double speed, Strokes& strokes) {
  constexpr int kManyTurns = 16;
  const KeyMove& move = *key.move;
  const double to_m = move.toOf(key.number);
  const double place_m = ways_.placeAt(key.hand, 0.0, now_s_ + move.after_s);
  const bool goes_back = std::abs(place_m - to_m) < std::abs(place_m - move.from_m);
  HandWays::Swing swing;
  swing.to_m = goes_back ? move.from_m : to_m;
  swing.other_m = goes_back ? to_m : move.from_m;
  swing.turns = move.release == Release::kStops ? kManyTurns : 0;
  ways_.draw(key.hand, swing, speed, move.after_s, now_s_, strokes);
}

void Keyboard::release(const Name& name, Strokes& strokes) {
  const auto found = down_.find(name);
  if (found == down_.end()) {
    return;
  }
  const std::vector<Key> keys = keysOf(name.second);
  std::vector<Wish> before;
  for (const Key& key : keys) {
    before.push_back(wishOf(key.hand));
  }
  Down& down = found->second;
  down.is_held = false;
  down.pressure = 0.0;
  if (depthOf(down) == 0.0) {
    down_.erase(found);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (wishOf(keys[i].hand).key) {
      goOn(keys[i], before[i], strokes);
    } else {
      goBack(keys[i], strokes);
    }
  }
}

/// A key that nothing keeps down.
void Keyboard::goBack(const Key& key, Strokes& strokes) {
  const KeyMove& move = *key.move;
  if (move.strikes || move.release == Release::kStays) {
    return;
  }
  if (move.release == Release::kStops) {
    return ways_.stop(key.hand, now_s_, strokes);
  }
  const double way_m = ways_.toldOf(key.hand, move.from_m) - move.from_m;
  if (way_m != 0.0) {
    const double after_s = std::max(needed_s_[key.hand] - now_s_, 0.0);
    ways_.glide(key.hand, move.from_m, move.from_m, glideOf(way_m, move.back), after_s, now_s_,
                strokes);
  }
}

/// A hand that other notes, or pedals, keep where they want it.
void Keyboard::goOn(const Key& key, const Wish& before, Strokes& strokes) {
  const Wish wish = wishOf(key.hand);
  const KeyMove& move = *wish.key->move;
  const double place_m = placeOf(wish);
  if (key.move->strikes || move.legato == Legato::kTurns ||
      (before.key && place_m == placeOf(before))) {
    return;
  }
  if (move.legato == Legato::kGlides) {
    strike(*wish.key, place_m, move.fastest, 0.0, strokes);
  } else if (wish.depth == 1.0) {
    settle(*wish.key, strokes);
  } else {
    const double way_m = place_m - ways_.toldOf(key.hand, move.from_m);
    ways_.glide(key.hand, place_m, move.from_m, glideOf(way_m, move.back), 0.0, now_s_, strokes);
  }
}

/// Follows a pedal, or a finger that presses more or less.
void Keyboard::settle(const Key& key, Strokes& strokes) {
  const KeyMove& move = *key.move;
  const bool follows = move.release == Release::kReturns || move.pressure_to_m;
  if (!move.strikes && move.legato != Legato::kTurns && follows) {
    ways_.follow(key.hand, placeOf(wishOf(key.hand)), move.from_m, move.back, now_s_, strokes);
  }
}

void Keyboard::followPressure(int note, Strokes& strokes) {
  for (const Key& key : keysOf(note)) {
    if (key.move->pressure_to_m) {
      settle(key, strokes);
    }
  }
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
  std::map<HandWays::Hand, std::pair<std::int64_t, Key>> kept;  // the last key of each hand
  for (auto next = down_.begin(); next != down_.end();) {
    const auto [name, down] = *next;
    for (const Key& key : down.is_held ? std::vector<Key>() : keysOf(name.second)) {
      const auto [known, is_new] = kept.try_emplace(key.hand, down.order, key);
      if (!key.move->strikes &&
          (down.order > known->second.first || known->second.second.move->strikes)) {
        known->second = {down.order, key};
      }
    }
    next = depthOf(down) == 0.0 ? down_.erase(next) : std::next(next);
  }
  for (const auto& [hand, last] : kept) {
    if (wishOf(hand).key) {
      settle(last.second, strokes);
    } else {
      goBack(last.second, strokes);
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
