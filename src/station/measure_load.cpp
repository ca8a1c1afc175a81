// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/measure_load.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <sstream>
#include <thread>

#include "ergotic/physics/certificate/precision.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::station {
namespace {

constexpr std::int64_t kMeasureNs = 100'000'000;
constexpr std::int64_t kBatchNs = 500'000;
constexpr int kMinBatches = 5;
constexpr int kPatienceMs = 100;

void tick(Performer& p) {
  p.instrument->tick({p.positions.data(), p.forces.data(), p.inputs.data(), p.outputs.data()});
}

/// \return false if the tick stalled, and does not come to its end
bool finish(Performer& p) {
  for (int i = 0; i < kPatienceMs && p.instrument->isUnderWay(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    tick(p);
  }
  return !p.instrument->isUnderWay();
}

/// Runs ticks from the initial state, in which no quiet module is asleep. \return ns per tick
double batch(Performer& p, int ticks) {
  p.restart();
  const std::int64_t begin = rt::threadCpuNs();
  for (int i = 0; i < ticks; ++i) {
    tick(p);
  }
  return static_cast<double>(rt::threadCpuNs() - begin) / ticks;
}

double tickNs(const physics::Instrument& instrument) {
  return 1e9 / instrument.rates().gesturalHz();
}

}  // namespace

double measureLoad(Performer& p) {
  const rt::FlushDenormals flush_denormals;
  const std::int64_t end_ns = rt::monotonicNs() + kMeasureNs;
  double least_ns = std::numeric_limits<double>::infinity();
  int ticks = 1;
  for (int i = 0; i < kMinBatches || rt::monotonicNs() < end_ns; ++i) {
    least_ns = std::min(least_ns, batch(p, ticks));
    if (!finish(p)) {
      return 0.0;
    }
    ticks = std::clamp(static_cast<int>(kBatchNs / std::max(least_ns, 1.0)), 1, 100);
  }
  p.restart();
  return least_ns / tickNs(*p.instrument);
}

std::string describeLoad(const physics::Instrument& instrument, double load, double max_load) {
  const physics::CompileOptions& options = instrument.options();
  std::ostringstream text;
  text.precision(3);
  text << instrument.scene().file << ": error: scene '" << instrument.scene().name
       << "' is too heavy for this machine: its ticks take at least "
       << 1e-6 * load * tickNs(instrument) << " ms of the " << 1e-6 * tickNs(instrument)
       << " ms between two of them, a load of " << load
       << ", allowed: up to max_load = " << max_load << ", " << load / max_load
       << " times less. What helps: fewer modules and links, lower rates of its sections (rate: "
          "auto)";
  if (options.precision == physics::Precision::kDouble &&
      physics::bodiesThatMoveFreely(instrument.scene()).empty()) {
    text << ", precision: float";
  }
  if (options.metered) {
    text << ", energies: false";
  }
  if (options.threads < static_cast<int>(std::thread::hardware_concurrency())) {
    text << ", threads: " << options.threads + 1 << " or more";
  }
  return text.str();
}

}  // namespace ergotic::station
