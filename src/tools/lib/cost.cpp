// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/cost.hpp"

#include <algorithm>
#include <ctime>
#include <vector>

#include "ergotic/rt/thread.hpp"

namespace ergotic::tools {
namespace {

constexpr int kTimedRuns = 20;
constexpr double kRunNs = 5e6;

double cpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// CPU time of one tick over `ticks` ticks, ns.
double timeTicks(physics::Instrument& instrument, const physics::TickIo& io, int ticks) {
  const double begin = cpuNs();
  for (int i = 0; i < ticks; ++i) {
    instrument.tick(io);
  }
  return (cpuNs() - begin) / ticks;
}

}  // namespace

Cost measureCost(physics::Instrument& instrument) {
  const rt::FlushDenormals as_when_played;
  const auto frames = static_cast<std::size_t>(instrument.rates().ratio);
  const std::vector<double> positions(static_cast<std::size_t>(instrument.ports()));
  std::vector<double> forces(positions.size());
  const std::vector<double> inputs(frames * static_cast<std::size_t>(instrument.inputChannels()));
  std::vector<double> outputs(frames * static_cast<std::size_t>(instrument.outputChannels()));
  const physics::TickIo io{positions.data(), forces.data(), inputs.data(), outputs.data()};
  std::vector<unsigned char> state(instrument.stateSize());
  instrument.saveState(state.data());

  Cost cost;
  cost.tick_ns = timeTicks(instrument, io, 10);  // warms up
  for (int run = 0; run < kTimedRuns; ++run) {
    const int ticks = static_cast<int>(std::clamp(kRunNs / cost.tick_ns, 1.0, 1e6));
    cost.tick_ns = std::min(cost.tick_ns, timeTicks(instrument, io, ticks));
  }
  instrument.loadState(state.data());
  cost.frame_ns = cost.tick_ns / static_cast<double>(frames);
  cost.real_time_factor = 1e9 / (cost.frame_ns * instrument.rates().audio_hz);
  return cost;
}

}  // namespace ergotic::tools
