// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/target_gesture.hpp"

#include <algorithm>

#include "ergotic/rt/realtime.hpp"
#include "files/read_file.hpp"
#include "scene/text/gesture_csv.hpp"

namespace ergotic::tgr {

TargetGesture::TargetGesture(std::istream& in, const std::string& name, int slices)
    : TargetGesture(slices) {
  scene::GestureReader rows(in, name, slices, {"m", -kMaxTargetM, kMaxTargetM});
  is_in_ticks_ = rows.isInTicks();
  double first_tick = -1.0;
  while (rows.next()) {
    if (rows.isParameter()) {
      continue;
    }
    if (!is_in_ticks_) {
      knots_[static_cast<std::size_t>(rows.slice())].push_back({rows.time(), rows.target()});
      continue;
    }
    first_tick = first_tick < 0.0 ? rows.time() : first_tick;
    for (std::size_t i = 0; i < rows.positions().size(); ++i) {
      knots_[i].push_back({rows.time() - first_tick, rows.positions()[i]});
    }
  }
}

void TargetGesture::setTickRate(double tick_rate_hz) noexcept {
  per_second_ = is_in_ticks_ ? tick_rate_hz : 1.0;
}

TargetGesture::Range TargetGesture::rangeOf(int slice) const {
  Range range;
  for (const Knot& knot : knots_[static_cast<std::size_t>(slice)]) {
    range.lowest_m = range.is_empty ? knot.target_m : std::min(range.lowest_m, knot.target_m);
    range.highest_m = range.is_empty ? knot.target_m : std::max(range.highest_m, knot.target_m);
    range.last_s = knot.t / per_second_;
    range.is_empty = false;
  }
  return range;
}

ERGOTIC_REALTIME HandTarget TargetGesture::at(int slice, double t_s) const noexcept {
  const std::vector<Knot>& knots = knots_[static_cast<std::size_t>(slice)];
  if (knots.empty()) {
    return {};
  }
  const double now = t_s * per_second_;
  const auto next = std::upper_bound(knots.begin(), knots.end(), now,
                                     [](double t, const Knot& knot) { return t < knot.t; });
  if (next == knots.begin()) {
    return {knots.front().target_m, 0.0};
  }
  const Knot& last = *(next - 1);
  if (next == knots.end()) {
    return {last.target_m, 0.0};
  }
  const double slope = (next->target_m - last.target_m) / (next->t - last.t);
  return {last.target_m + (now - last.t) * slope, slope * per_second_};
}

TargetGesture readTargetGesture(const std::string& path, int slices) {
  if (path.empty()) {
    return TargetGesture(slices);
  }
  std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
  return {in, path, slices};
}

}  // namespace ergotic::tgr
