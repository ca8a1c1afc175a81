// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/gesture_csv.hpp"

#include <algorithm>

#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kTargetColumns = "time_s,slice,target_m";
constexpr const char* kRows = "time_s,slice,target_m, or time_s,$parameter,value";
constexpr char kMark = '$';       // of parameters
constexpr double kBefore = -1.0;  // all times
constexpr Limits kTimeLimits{"s", 0.0, 1e6};
constexpr double kLastTick = 1e15;      // a double counts that far
constexpr double kShortestGapS = 1e-9;  // a hand moves at finite speed

}  // namespace

GestureReader::GestureReader(std::istream& in,
                             const std::string& file,
                             int slices,
                             const Limits& metres)
    : csv_(in, file, kRows),
      metres_(metres),
      slices_(slices),
      x_(1),
      last_s_(static_cast<std::size_t>(slices), kBefore) {
  has_row_ = csv_.next();
  if (has_row_ && csv_.isHeader()) {
    readHeader();
    has_row_ = false;
  }
}

void GestureReader::readHeader() {
  in_ticks_ = csv_.word(0) == "tick";
  if (in_ticks_) {
    readColumns();
    return;
  }
  const char* const words[] = {"time_s", "slice", "target_m"};
  for (std::size_t i = 0; i < std::max<std::size_t>(csv_.size(), 3); ++i) {
    if (i >= 3 || csv_.word(i) != words[i]) {
      csv_.fail(i, "column " + quoted(std::string(csv_.text(i))) +
                       " of the header, allowed: " + kTargetColumns + ", or tick,x0,x1,...");
    }
  }
}

/// Reads the columns of a header `tick,x0,x1,...`.
void GestureReader::readColumns() {
  for (std::size_t i = 1; i < std::max<std::size_t>(csv_.size(), 2); ++i) {
    const std::string expected = "x" + std::to_string(i - 1);
    if (i > static_cast<std::size_t>(slices_)) {
      csv_.fail(i, "columns of more than " + std::to_string(slices_) +
                       " slices, allowed: at most " + std::to_string(slices_));
    }
    if (csv_.word(i) != expected) {
      csv_.fail(i, "column " + quoted(std::string(csv_.text(i))) +
                       " of the header, allowed: " + expected);
    }
  }
  x_.resize(csv_.size() - 1);
  slices_ = static_cast<int>(x_.size());
  csv_.setColumns("a tick and " + std::to_string(slices_) + " positions in a line");
}

bool GestureReader::next() {
  if (!has_row_ && !csv_.next()) {
    return false;
  }
  has_row_ = false;
  in_ticks_ ? readPositions() : readTarget();
  return true;
}

void GestureReader::readPositions() {
  const double earliest = time_ + 1.0;
  time_ = csv_.whole(0, "tick", {"", earliest, kLastTick});
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = csv_.number(i + 1, "position", metres_);
  }
  csv_.expectEnd(x_.size() + 1);
}

void GestureReader::readTarget() {
  time_ = csv_.number(0, "time_s", kTimeLimits);
  if (!csv_.text(1).empty() && csv_.text(1).front() == kMark) {
    return readValue();
  }
  slice_ = static_cast<int>(csv_.whole(1, "slice", {"", 0.0, slices_ - 1.0}));
  x_[0] = csv_.number(2, "target_m", metres_);
  csv_.expectEnd(3);
  requireLater(last_s_[static_cast<std::size_t>(slice_)], "slice's");
}

void GestureReader::readValue() {
  slice_ = kNoSlice;
  parameter_ = csv_.text(1).substr(1);
  if (parameter_.empty()) {
    csv_.fail(1, std::string("the name of a parameter is missing, allowed: ") + kRows);
  }
  x_[0] = csv_.number(2, "value", Limits{});
  csv_.expectEnd(3);
  requireLater(last_value_s_.emplace(parameter_, kBefore).first->second, "parameter's");
}

void GestureReader::requireLater(double& last_s, const std::string& whose) const {
  if (last_s >= 0.0 && time_ - last_s < kShortestGapS) {
    csv_.fail(0, "time_s = " + numberText(time_) + " s is not after the " + whose +
                     " row before it, by 1e-9 s at least");
  }
  last_s = time_;
}

}  // namespace ergotic::scene
