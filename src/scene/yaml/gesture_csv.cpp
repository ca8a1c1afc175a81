// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/gesture_csv.hpp"

#include <algorithm>
#include <cmath>

#include "scene/rules/mover_rules.hpp"
#include "scene/text/csv_line.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kTargetLine = "time_s,slice,target_m";

class GestureReader {
 public:
  explicit GestureReader(int slice) : slice_(slice) {}

  void read(CsvLine& csv) {
    if (is_first_) {
      is_first_ = false;
      if (readHeader(csv)) {
        return;
      }
    }
    if (gesture_.points.size() == kMaxSceneTablePoints) {
      csv.fail("too many points, allowed: " + std::to_string(kMaxSceneTablePoints));
    }
    gesture_.in_ticks ? readPositions(csv) : readTarget(csv);
  }

  GestureOfSlice& gesture() { return gesture_; }

 private:
  /// \return false if the line is none
  bool readHeader(CsvLine& csv) {
    CsvLine line = csv;
    const std::string kind = line.word();
    if (kind != "tick" && kind != "time_s") {
      return false;
    }
    gesture_.in_ticks = kind == "tick";
    for (line.skipSeparator(); !line.empty(); line.skipSeparator()) {
      const std::string word = line.word();
      if (gesture_.in_ticks && word != "x" + std::to_string(slices_)) {
        line.fail("column " + quoted(word) + ", allowed: x" + std::to_string(slices_));
      }
      ++slices_;
    }
    if (gesture_.in_ticks && slice_ >= slices_) {
      csv.fail("no column of slice " + std::to_string(slice_) + ", there are " +
               std::to_string(slices_) + " slices");
    }
    return true;
  }

  /// `tick,x0,x1,...`
  void readPositions(CsvLine& csv) {
    const std::string columns = "a tick and " + std::to_string(slices_) + " positions in a line";
    const double tick = csv.number("tick", next_, columns);
    if (tick != std::floor(tick)) {
      csv.fail("tick = " + numberText(tick) + ", allowed: whole numbers");
    }
    first_tick_ = gesture_.points.empty() ? tick : first_tick_;
    for (int i = 0; i < slices_; ++i) {
      csv.skipSeparator();
      const double x = csv.number("position", kTargetLimits, columns);
      if (i == slice_) {
        gesture_.points.emplace_back(tick - first_tick_, x);
      }
    }
    csv.expectEnd("more than " + columns + ", allowed: as many as in the header");
    next_ = {"", tick, kInfinity, true};
  }

  /// `time_s,slice,target_m`
  void readTarget(CsvLine& csv) {
    const CsvLine begin = csv;
    const double time = csv.number("time", {"s", 0.0}, kTargetLine);
    csv.skipSeparator();
    const double slice = csv.number("slice", kSliceLimits, kTargetLine);
    csv.skipSeparator();
    const double target = csv.number("target", kTargetLimits, kTargetLine);
    csv.expectEnd(std::string("more than three numbers in a line, allowed: ") + kTargetLine);
    if (slice != slice_) {
      return;
    }
    if (!next_.hold(time)) {
      begin.fail(outOfRange("time", time, next_));
    }
    gesture_.points.emplace_back(time, target);
    next_ = {"s", time, kInfinity, true};
  }

  int slice_;
  int slices_ = 0;
  bool is_first_ = true;
  double first_tick_ = 0.0;
  Limits next_{"", 0.0};  // of ticks, or of times of the slice
  GestureOfSlice gesture_;
};

}  // namespace

GestureOfSlice readGestureCsv(const std::string& text, const std::string& file, int slice) {
  GestureReader reader(slice);
  const int lines = forEachCsvLine(text, file, [&reader](CsvLine& csv) { reader.read(csv); });
  if (reader.gesture().points.empty()) {
    throw TextError(file, std::max(lines, 1), 1,
                    "the gesture has nothing of slice " + std::to_string(slice));
  }
  return std::move(reader.gesture());
}

}  // namespace ergotic::scene
