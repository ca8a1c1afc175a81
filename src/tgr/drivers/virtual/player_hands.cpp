// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/player_hands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kShortestGlideS = 1e-3;
constexpr double kPauseS = 0.1;      // an interval of that length is a pause, no rhythm
constexpr double kClockJumpS = 0.1;  // between stamps and arrivals: the source has begun anew
constexpr double kRecentS = 10.0;    // older arrivals tell nothing: clocks drift
constexpr double kMarginS = 5e-4;

}  // namespace

ERGOTIC_REALTIME bool HandMove::isValid(int slices) const noexcept {
  const bool is_time = !std::isinf(time_s) && timeout_s >= 0.0 &&  // NaN is neither
                       delay_s >= 0.0 && delay_s <= kMaxDelayS && glide_s >= 0.0 &&
                       glide_s <= kMaxGlideS;
  return slice >= 0 && slice < slices && source < kMaxHandSources && is_time &&
         (lets_go || std::abs(target_m) <= kMaxTargetM);
}

ERGOTIC_REALTIME void MoveTiming::count(double interval_s, double late_s) noexcept {
  if (interval_s > 0.0 && interval_s < kPauseS) {
    waits_[counted_ % kWaits] = interval_s + late_s + kMarginS;
    ++counted_;
  }
}

/// The second largest of 16, or the largest of fewer.
ERGOTIC_REALTIME double MoveTiming::delay() const noexcept {
  double largest = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i < std::min(counted_, kWaits); ++i) {
    second = std::max(second, std::min(largest, waits_[i]));
    largest = std::max(largest, waits_[i]);
  }
  return std::min(counted_ < kWaits ? largest : second, kMaxDelayS);
}

ERGOTIC_REALTIME double MoveTiming::leastOffset(double now_s) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(arrived_, kArrivals); ++i) {
    if (now_s - arrivals_[i].time_s <= kRecentS) {
      least = std::min(least, arrivals_[i].offset_s);
    }
  }
  return least;
}

ERGOTIC_REALTIME double MoveTiming::dueAt(double stamp_s, double now_s) noexcept {
  if (arrived_ > 0 && stamp_s == last_stamp_s_ && now_s == last_now_s_) {
    return last_due_s_;  // another slice of the same message
  }
  const double interval_s = stamp_s - last_stamp_s_;
  const bool begins = arrived_ == 0 || std::abs(interval_s - (now_s - last_now_s_)) > kClockJumpS;
  if (begins) {
    *this = MoveTiming();
  }
  arrivals_[arrived_ % kArrivals] = {now_s, now_s - stamp_s};
  ++arrived_;
  const double offset_s = leastOffset(now_s);
  if (!begins) {
    count(interval_s, now_s - stamp_s - offset_s);
  }
  last_stamp_s_ = stamp_s;
  last_now_s_ = now_s;
  last_due_s_ = std::max(stamp_s + offset_s + delay(), now_s);
  return last_due_s_;
}

ERGOTIC_REALTIME void PlayerHands::Hand::add(const Knot& knot, double now_s) noexcept {
  if (count == 0 && from.glide_s == 0.0) {
    from = {std::max(now_s, from.time_s), from.target_m};
  }
  while (count > 0 && (count == kKnots || newest().time_s > knot.time_s)) {
    --count;  // a later wish counts more than what was wanted for later
  }
  const double before_s = count == 0 ? from.time_s : newest().time_s;
  knots[(first + count) % kKnots] = {std::max(knot.time_s, before_s), knot.target_m, knot.glide_s};
  ++count;
}

/// 10 t^3 - 15 t^4 + 6 t^5, the least integral of squared jerk between two rests (Flash and Hogan,
/// J. Neurosci. 5(7), 1985).
ERGOTIC_REALTIME double PlayerHands::Glide::placeAt(double time_s) const noexcept {
  const double t = std::clamp((time_s - begin_s) / length_s, 0.0, 1.0);
  return from_m + way_m * t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

ERGOTIC_REALTIME double PlayerHands::Glide::accelerationAt(double time_s) const noexcept {
  const double t = std::clamp((time_s - begin_s) / length_s, 0.0, 1.0);
  return way_m / (length_s * length_s) * t * (60.0 + t * (-180.0 + 120.0 * t));
}

ERGOTIC_REALTIME double PlayerHands::Hand::placeAt(double time_s) noexcept {
  while (count > 0 && knots[first].time_s <= time_s) {
    from = knots[first];
    first = (first + 1) % kKnots;
    --count;
    if (from.glide_s > 0.0) {  // from where it is now: a repeated key begins where it was left
      const double way = from.target_m - target_m;
      const double shortest =
          std::max(HandMove::kPeakOfMean * std::abs(way) / kMaxSpeed, kShortestGlideS);
      glide = {from.time_s, std::max(from.glide_s, shortest), target_m, way};
    }
  }
  if (from.glide_s > 0.0) {
    return glide.placeAt(time_s);
  }
  if (count == 0 || knots[first].glide_s > 0.0) {
    return from.target_m;
  }
  const Knot& to = knots[first];
  const double share = std::max(time_s - from.time_s, 0.0) / (to.time_s - from.time_s);
  return from.target_m + share * (to.target_m - from.target_m);
}

ERGOTIC_REALTIME void PlayerHands::take(const HandMove& move, double now_s) noexcept {
  Hand& hand = hands_[static_cast<std::size_t>(move.slice)];
  if (move.lets_go) {
    if (hand.state == State::kTakesHold) {
      hand.strength = 0.0;  // it has not pulled yet
    }
    if (hand.state != State::kNever) {
      hand.state = State::kLetsGo;
    }
    return;
  }
  const bool begins = hand.state == State::kNever || hand.state == State::kLetsGo;
  hand.jumps = move.jumps;
  hand.grip = move.grip;
  hand.timeout_s = move.timeout_s;
  hand.heard_s = now_s;
  if (hand.jumps) {
    hand.state = State::kHolds;
    hand.count = 0;
    hand.target_m = move.target_m;
    hand.from = {now_s, move.target_m};
    return;
  }
  if (begins) {  // the line begins where the slice is, which the next step knows
    hand.state = State::kTakesHold;
    hand.count = 0;
    hand.from = {now_s, move.target_m};
  }
  const double due_s = std::isnan(move.time_s) ? now_s + move.delay_s
                                               : timings_[move.source].dueAt(move.time_s, now_s);
  hand.add({due_s, move.target_m, move.glide_s}, now_s);
}

ERGOTIC_REALTIME PlayerHands::Holding PlayerHands::fade(Hand& hand,
                                                        const HandTarget& present,
                                                        double step_s) noexcept {
  if (hand.strength == 1.0) {
    hand.stretch_m = hand.target_m - present.position;
  }
  hand.strength = std::max(hand.strength - step_s / kFadeS, 0.0);
  hand.target_m = present.position + hand.stretch_m;
  return {{hand.target_m, present.velocity}, 0.0, hand.grip, hand.strength};
}

ERGOTIC_REALTIME PlayerHands::Holding PlayerHands::step(int slice,
                                                        const HandTarget& present,
                                                        double now_s,
                                                        double step_s) noexcept {
  Hand& hand = hands_[static_cast<std::size_t>(slice)];
  if (hand.state == State::kTakesHold) {
    hand.state = State::kHolds;
    hand.target_m = present.position;
    hand.from.target_m = present.position;
  }
  if (hand.timeout_s > 0.0 && now_s - hand.heard_s > hand.timeout_s) {
    hand.state = State::kLetsGo;
  }
  if (hand.state == State::kLetsGo) {
    return fade(hand, present, step_s);
  }
  hand.strength = 1.0;
  if (hand.jumps) {
    return {{hand.target_m}, 0.0, hand.grip};
  }
  const double begin = hand.target_m;
  const double most = kMaxSpeed * step_s;
  const double way = std::clamp(hand.placeAt(now_s + step_s) - begin, -most, most);
  hand.target_m = begin + way;
  const double acceleration =
      hand.from.glide_s > 0.0 ? hand.glide.accelerationAt(now_s + 0.5 * step_s) : 0.0;
  return {{begin, way / step_s}, acceleration, hand.grip};
}

}  // namespace ergotic::tgr
