// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/players/hand_ways.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {
namespace {

Stroke lineTo(const HandWays::Hand& hand, double target_m, double after_s) {
  return {hand.first, hand.second, target_m, 0.0, after_s, false};
}

}  // namespace

double HandWays::Way::placeAt(double time_s) const {
  if (turns > 0 && time_s > end_s) {
    const double past = std::min((time_s - end_s) / turn_s, static_cast<double>(turns));
    const double whole = std::floor(past);
    const bool is_even = std::fmod(whole, 2.0) == 0.0;
    const double begin_m = is_even ? to_m : other_m;
    return begin_m + (past - whole) * ((is_even ? other_m : to_m) - begin_m);
  }
  const double share =
      end_s > begin_s ? std::clamp((time_s - begin_s) / (end_s - begin_s), 0.0, 1.0) : 1.0;
  const double part =
      is_glide ? share * share * share * (10.0 + share * (-15.0 + 6.0 * share)) : share;
  return share == 1.0 ? to_m : from_m + part * (to_m - from_m);
}

double HandWays::toldOf(const Hand& hand, double rest_m) const {
  const auto found = ways_.find(hand);
  return found == ways_.end() ? rest_m : found->second.to_m;
}

double HandWays::placeAt(const Hand& hand, double rest_m, double time_s) const {
  const auto found = ways_.find(hand);
  return found == ways_.end() ? rest_m : found->second.placeAt(time_s);
}

double HandWays::arrivalOf(const Hand& hand) const {
  const auto found = ways_.find(hand);
  return found == ways_.end() ? 0.0 : found->second.end_s;
}

void HandWays::glide(const Hand& hand,
                     double target_m,
                     double rest_m,
                     double glide_s,
                     double after_s,
                     double now_s,
                     Strokes& strokes) {
  const auto [way, is_new] = ways_.try_emplace(hand);
  Way& last = way->second;
  const bool is_on_line = !is_new && !last.is_glide && last.begin_s < now_s && now_s < last.overS();
  if (is_on_line) {
    strokes.push_back(lineTo(hand, last.placeAt(now_s), 0.0));
  }
  strokes.push_back({hand.first, hand.second, target_m, glide_s, after_s, false});
  const double begin_s = now_s + after_s;
  const double from_m = is_new ? rest_m : last.placeAt(begin_s);
  last = {begin_s, begin_s + glide_s, from_m, target_m, true};
}

void HandWays::draw(const Hand& hand,
                    const Swing& swing,
                    double speed,
                    double after_s,
                    double now_s,
                    Strokes& strokes) {
  const double begin_s = now_s + after_s;
  const double from_m = placeAt(hand, 0.0, begin_s);
  const auto known = ways_.find(hand);
  if (known != ways_.end() && now_s < known->second.overS()) {
    strokes.push_back(lineTo(hand, known->second.placeAt(now_s), 0.0));
  }
  if (known != ways_.end() && after_s > 0.0) {
    strokes.push_back(lineTo(hand, from_m, after_s));
  }
  const auto secondsOf = [speed](double way_m) {
    return std::min(std::abs(way_m) / speed, HandMove::kMaxGlideS);
  };
  Way way{begin_s, begin_s + secondsOf(swing.to_m - from_m), from_m, swing.to_m, false};
  way.other_m = swing.other_m;
  way.turn_s = secondsOf(swing.to_m - swing.other_m);
  if (way.turn_s > 0.0) {  // a slow hand turns less often: no command may wait for longer
    const double left_s = HandMove::kMaxDelayS - (way.end_s - now_s);
    way.turns = std::min(swing.turns, static_cast<int>(left_s / way.turn_s));
  }
  for (int k = 0; k <= way.turns; ++k) {
    strokes.push_back(
        lineTo(hand, k % 2 == 0 ? swing.to_m : swing.other_m, way.end_s + k * way.turn_s - now_s));
  }
  ways_[hand] = way;
}

void HandWays::follow(const Hand& hand,
                      double target_m,
                      double rest_m,
                      double speed,
                      double now_s,
                      Strokes& strokes) {
  const auto [way, is_new] = ways_.try_emplace(hand);
  Way& last = way->second;
  if (is_new) {
    last = {now_s, now_s, rest_m, rest_m, false};
  }
  if (last.to_m == target_m && last.turns == 0 && !is_new) {
    return;
  }
  const double begin_s = std::max(now_s, last.is_glide ? last.end_s : last.begin_s);
  const double from_m = last.placeAt(begin_s);
  if (last.is_glide || begin_s < last.overS()) {  // else it stands there
    strokes.push_back(lineTo(hand, from_m, begin_s - now_s));
  }
  const double way_s = std::clamp(std::abs(target_m - from_m) / speed, kLagS, HandMove::kMaxGlideS);
  last = {begin_s, begin_s + way_s, from_m, target_m, false};
  strokes.push_back(lineTo(hand, target_m, last.end_s - now_s));
}

void HandWays::stop(const Hand& hand, double now_s, Strokes& strokes) {
  const auto found = ways_.find(hand);
  if (found == ways_.end() || now_s >= found->second.overS()) {
    return;
  }
  Way& last = found->second;
  const double from_m = last.placeAt(now_s);
  const double to_m = last.placeAt(now_s + 0.5 * kLagS);
  strokes.push_back(lineTo(hand, from_m, 0.0));
  strokes.push_back(lineTo(hand, to_m, kLagS));
  last = {now_s, now_s + kLagS, from_m, to_m, false};
}

void HandWays::letGo(const Hand& hand, Strokes& strokes) {
  if (ways_.erase(hand) > 0) {
    Stroke stroke = lineTo(hand, 0.0, 0.0);
    stroke.lets_go = true;
    strokes.push_back(stroke);
  }
}

}  // namespace ergotic::tgr
