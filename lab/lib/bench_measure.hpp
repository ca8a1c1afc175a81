// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "lab/lib/bench_scenes.hpp"
#include "lab/lib/bench_work.hpp"

namespace ergotic::tools {

/// How to measure.
struct BenchSettings {
  physics::CompileOptions compile;
  int runs = 5;
  double seconds = 0.5;  ///< of all runs of one scene together
};

/// One scene at one size: what it is, and what it costs.
struct BenchResult {
  std::string scene;
  std::size_t modules = 0;
  std::size_t masses = 0;
  std::size_t links = 0;
  double make_s = 0.0;           ///< the scene, generated and settled
  double compile_s = 0.0;        ///< the instrument from it
  std::vector<double> ns;        ///< [runs] per audio frame, instrument
  std::vector<double> plain_ns;  ///< [runs] plain implementation; empty: it cannot play this
  BenchWork work;
  std::vector<std::string> chosen;  ///< what compile() says of itself
};

/// Makes the scene, then lets the instrument and the plain implementation play in turns of a few
/// milliseconds, so that what disturbs one disturbs the other. One thread is measured in CPU time,
/// several on the clock.
BenchResult measure(const BenchKind& kind, int modules, const BenchSettings& settings);

/// \pre not empty
double median(std::vector<double> values);

/// Median over the runs of plain / instrument. 0: not known
double ratioOf(const BenchResult& result);

}  // namespace ergotic::tools
