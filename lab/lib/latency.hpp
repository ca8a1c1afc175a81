// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/station/tick_meter.hpp"
#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// What `latency` is asked for.
struct LatencyOptions {
  std::string scene;   ///< path; empty: a plate that 12 slices play, of `modules`
  int modules = 1000;  ///< masses and links of that plate, at least
  double rate_hz = 44100.0;
  int ratio = 4;  ///< audio frames per tick
  CompileChoice compile;
  double seconds = 10.0;
  int priority = 75;  ///< SCHED_FIFO; 0: an ordinary thread
  int cpu = -1;       ///< to run on, -1: any
  std::string json;   ///< path; empty: not written
};

void addOptions(CLI::App& app, LatencyOptions& options);

/// Plays in real time and prints the histograms of lateness and cost of the ticks.
/// \return kSuccess, or kFailure if the force was lost on the way: what was measured is no playing
/// \throws TextError, Exception
int latency(const LatencyOptions& options);

/// Quantiles in microseconds and as shares of the period; with `bins` also how many durations are
/// up to the end of each bin.
Json histogramReport(const station::TickHistogram& histogram, double period_us, bool bins);

}  // namespace ergotic::tools
