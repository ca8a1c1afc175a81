// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/gesture_csv.hpp"

#include <algorithm>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "files/read_file.hpp"
#include "scene/names.hpp"

namespace ergotic::tgr {
namespace {

class CsvSource final : public GestureSource {
 public:
  explicit CsvSource(const std::string& path) {
    std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
    scene::GestureReader rows(in, path, kMaxSlices, scene::kMetreLimits);
    if (!rows.isInTicks()) {
      rows.failAtLine("no line tick,x0,... above the rows, allowed: positions of every tick");
    }
    slices_ = static_cast<std::size_t>(rows.slices());
    read(rows);
  }

  int slices() const noexcept override { return static_cast<int>(slices_); }

  bool next(double* positions) noexcept override {
    if (cursor_ == positions_.size()) {
      return false;
    }
    std::copy_n(positions_.data() + cursor_, slices_, positions);
    cursor_ += slices_;
    return true;
  }

 private:
  void read(scene::GestureReader& rows) {
    while (rows.next()) {
      if (!positions_.empty() && rows.time() != next_tick_) {
        rows.fail("tick = " + scene::numberText(rows.time()) +
                  ", allowed: " + scene::numberText(next_tick_) + ", each tick has a row");
      }
      next_tick_ = rows.time() + 1.0;
      positions_.insert(positions_.end(), rows.positions().begin(), rows.positions().end());
    }
  }

  std::size_t slices_ = 0;
  double next_tick_ = 0.0;
  std::vector<double> positions_;  // [ticks][slices]
  std::size_t cursor_ = 0;
};

}  // namespace

std::unique_ptr<GestureSource> readPositionsCsv(const std::string& path) {
  return std::make_unique<CsvSource>(path);
}

GestureKind gestureKindOf(const std::string& path) {
  std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
  const scene::GestureReader rows(in, path, kMaxSlices, scene::kMetreLimits);
  return rows.isInTicks() ? GestureKind::kPositions : GestureKind::kTargets;
}

std::vector<GestureValue> readGestureValues(const std::string& path) {
  std::vector<GestureValue> values;
  if (path.empty()) {
    return values;
  }
  std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
  scene::GestureReader rows(in, path, kMaxSlices, scene::kMetreLimits);
  while (!rows.isInTicks() && rows.next()) {
    if (rows.isParameter()) {
      values.push_back(
          {rows.time(), rows.parameter(), rows.value(), path, rows.place(1), rows.place(2)});
    }
  }
  std::stable_sort(values.begin(), values.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return values;
}

std::size_t parameterOf(const GestureValue& value,
                        const std::vector<scene::Parameter>& parameters) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(),
                   [&value](const auto& parameter) { return parameter.name == value.parameter; });
  if (found == parameters.end()) {
    std::vector<std::string> known;
    for (const scene::Parameter& parameter : parameters) {
      known.push_back(parameter.name);
    }
    throw TextError(
        value.file, value.name_at.line, value.name_at.column,
        "the scene has no parameter " + scene::quoted(value.parameter) +
            (known.empty() ? ", and no other" : scene::suggestion(value.parameter, known)));
  }
  const scene::Limits range{found->unit.c_str(), found->minimum, found->maximum};
  if (!range.hold(value.value)) {
    throw TextError(value.file, value.value_at.line, value.value_at.column,
                    scene::outOfRange(value.parameter, value.value, range));
  }
  return static_cast<std::size_t>(found - parameters.begin());
}

}  // namespace ergotic::tgr
