// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/gesture_csv.hpp"

#include <algorithm>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "files/read_file.hpp"

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

}  // namespace ergotic::tgr
