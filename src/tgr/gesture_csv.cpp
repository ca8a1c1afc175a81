// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "files/read_file.hpp"
#include "tgr/csv.hpp"

namespace ergotic::tgr {
namespace {

class CsvSource final : public GestureSource {
 public:
  explicit CsvSource(const std::string& path) {
    std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
    CsvReader csv(in, path);
    if (!csv.nextRow()) {
      throw TextError(path, 1, 1, "no header line, expected tick,x0,...");
    }
    readHeader(csv);
    while (csv.nextRow()) {
      readRow(csv);
    }
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
  void readHeader(const CsvReader& csv) {
    constexpr std::size_t kMaxColumns = kMaxSlices + 1;
    if (csv.text(0) != "tick") {
      csv.fail(0, "header '" + std::string(csv.text(0)) + "', expected 'tick'");
    }
    csv.requireSize(std::clamp<std::size_t>(csv.size(), 2, kMaxColumns));
    for (std::size_t i = 1; i < csv.size(); ++i) {
      const std::string expected = "x" + std::to_string(i - 1);
      if (csv.text(i) != expected) {
        csv.fail(i, "header '" + std::string(csv.text(i)) + "', expected '" + expected + "'");
      }
    }
    slices_ = csv.size() - 1;
  }

  void readRow(const CsvReader& csv) {
    csv.requireSize(slices_ + 1);
    const bool first = positions_.empty();
    constexpr std::int64_t kLastFirstTick = 1'000'000'000'000'000;
    const std::int64_t tick =
        csv.integer(0, "tick", first ? 0 : next_tick_, first ? kLastFirstTick : next_tick_);
    next_tick_ = tick + 1;
    for (std::size_t i = 1; i <= slices_; ++i) {
      constexpr double kMax = std::numeric_limits<double>::max();
      positions_.push_back(csv.number(i, "position", -kMax, kMax));
    }
  }

  std::size_t slices_ = 0;
  std::int64_t next_tick_ = 0;
  std::vector<double> positions_;  // [ticks][slices]
  std::size_t cursor_ = 0;
};

}  // namespace

std::unique_ptr<GestureSource> readPositionsCsv(const std::string& path) {
  return std::make_unique<CsvSource>(path);
}

GestureKind gestureKindOf(const std::string& path) {
  std::ifstream in = files::openFile(path, files::kMaxRecordingBytes);
  CsvReader csv(in, path);
  return csv.nextRow() && csv.text(0) == "tick" ? GestureKind::kPositions : GestureKind::kTargets;
}

}  // namespace ergotic::tgr
