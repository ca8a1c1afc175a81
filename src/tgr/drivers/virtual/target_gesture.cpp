// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/target_gesture.hpp"

#include <algorithm>
#include <array>

#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"
#include "files/read_file.hpp"
#include "tgr/csv.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kMaxTimeS = 1e6;
constexpr double kShortestS = 1e-9;  // between rows of a slice: a hand moves at finite speed

bool isHeader(const CsvReader& csv) {
  if (csv.text(0) != "time_s") {
    return false;
  }
  csv.requireSize(3);
  if (csv.text(1) != "slice" || csv.text(2) != "target_m") {
    csv.fail(1, "header, expected time_s,slice,target_m");
  }
  return true;
}

}  // namespace

TargetGesture::TargetGesture(std::istream& in, const std::string& name, int slices)
    : TargetGesture(slices) {
  CsvReader csv(in, name);
  for (bool first = true; csv.nextRow(); first = false) {
    if (first && isHeader(csv)) {
      continue;
    }
    csv.requireSize(3);
    const double t_s = csv.number(0, "time_s", 0.0, kMaxTimeS);
    const auto slice = static_cast<std::size_t>(csv.integer(1, "slice", 0, slices - 1));
    const double target_m = csv.number(2, "target_m", -kMaxTargetM, kMaxTargetM);
    std::vector<Knot>& knots = knots_[slice];
    if (!knots.empty() && t_s - knots.back().t < kShortestS) {
      csv.fail(0, "time_s '" + std::string(csv.text(0)) +
                      "' is not after the slice's row before it, by 1e-9 s at least");
    }
    knots.push_back({t_s, target_m});
  }
}

TargetGesture::TargetGesture(GestureSource& positions, const std::string& name, int slices)
    : TargetGesture(slices) {
  if (positions.slices() > slices) {
    throw Exception(name + ": positions of " + std::to_string(positions.slices()) +
                    " slices, allowed: at most " + std::to_string(slices));
  }
  is_in_ticks_ = true;
  std::array<double, kMaxSlices> x{};
  for (double tick = 0.0; positions.next(x.data()); tick += 1.0) {
    for (int i = 0; i < positions.slices(); ++i) {
      const auto slot = static_cast<std::size_t>(i);
      requireWithin(name + ": position of slice " + std::to_string(i), x[slot], -kMaxTargetM,
                    kMaxTargetM, "m");
      knots_[slot].push_back({tick, x[slot]});
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
  if (gestureKindOf(path) == GestureKind::kPositions) {
    return {*readPositionsCsv(path), path, slices};
  }
  std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
  return {in, path, slices};
}

}  // namespace ergotic::tgr
