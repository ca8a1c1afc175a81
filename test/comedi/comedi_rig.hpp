// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "comedi/standin/standin.hpp"
#include "tgr/drivers/comedi/comedi_factory.hpp"

namespace ergotic::test {

using Volts = std::array<double, tgr::kMaxSlices>;

constexpr unsigned kMidCount = 32768;  // the count nearest to 0 V
constexpr double kVoltsPerCount = 20.0 / kComediMost;
constexpr double kNewtonsPerVolt = 20.0;
constexpr double kMetresPerVolt = 0.004;

/// Slices that move by force alone, with no force and rest at exactly `kMidCount`.
inline ComediStandinBoard plainBoard() {
  ComediStandinBoard board;
  board.channels = 4;
  board.no_force_volts = comediVolts(kMidCount);
  board.rest_volts = comediVolts(kMidCount);
  board.slice.dry_friction = 0.0;
  board.slice.quantum = 0.0;
  board.slice.noise_rms = 0.0;
  board.slice.bandwidth = std::numeric_limits<double>::infinity();
  return board;
}

/// Three slices, at channels in another order than they have.
inline std::string threeSlices(const std::string& more = "") {
  char safe[32];
  std::snprintf(safe, sizeof safe, "%.17g", comediVolts(kMidCount));
  return std::string("{ai_channels: [2, 0, 1], ao_channels: [2, 0, 1], safe_volts: ") + safe +
         (more.empty() ? "" : ", " + more) + "}";
}

/// A new stand-in board and a driver for it, not yet open.
class ComediRig {
 public:
  explicit ComediRig(const ComediStandinBoard& board = plainBoard(),
                     const std::string& settings = threeSlices()) {
    comediStandinReset(&board);
    driver_ = tgr::ComediFactory().make(YAML::Load(settings), "here.yaml");
  }

  tgr::Driver& driver() { return *driver_; }
  std::unique_ptr<tgr::Driver> release() { return std::move(driver_); }

  /// The same volts to all.
  std::uint32_t exchange(double volts) {
    Volts outputs;
    outputs.fill(volts);
    return driver_->exchange(outputs.data(), inputs.data());
  }

  static ComediCounters counters() {
    ComediCounters counted;
    comediStandinCounters(&counted);
    return counted;
  }
  static void inject(ComediFault kind, double amount = 0.0, std::int64_t lists = 1) {
    const ComediFaultOrder order{kind, 0, 0, lists, amount};
    comediStandinInject(&order);
  }

  Volts inputs{};

 private:
  std::unique_ptr<tgr::Driver> driver_;
};

}  // namespace ergotic::test
