// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "ergotic/rt/isa.hpp"

namespace ergotic::physics {

/// kAuto chooses the precision that the scene needs (withPrecision, certificate/precision.hpp).
enum class Precision { kFloat, kDouble, kAuto };

/// "float", "double", "auto".
const char* nameOf(Precision precision);
/// \throws Exception if there is no such precision, listing those there are
Precision precisionNamed(const std::string& name);

/// How a scene is turned into an instrument. Only the precision changes what it plays.
struct CompileOptions {
  Precision precision = Precision::kFloat;  ///< kAuto: not chosen yet, compile() refuses it
  rt::Isa isa = rt::bestIsa();              ///< of the kernels; every level gives the same bits
  int threads = 1;  ///< 1...kMaxThreads that share a tick; any number gives the same bits
  /// Longest wait in a tick for a thread that has begun its share; beyond it the tick stalls
  /// (Instrument::stalledTicks). Where a hand waits: kOneTick (liveOptions).
  std::int64_t wait_limit_ns = 1'000'000'000;
  /// Keeps the energy accounts; else readEnergies knows only what positions tell (energy.hpp), the
  /// state is smaller, and the instrument plays the same bits in less time.
  bool metered = true;

  CompileOptions() = default;
  CompileOptions(Precision p) : precision(p) {}  // NOLINT(google-explicit-constructor)
};

constexpr int kMaxThreads = 8;
constexpr std::int64_t kOneTick = -1;  ///< one tick of the instrument's own rates

/// Options as a station plays, where a hand waits: no tick waits longer for a thread than a tick.
/// The precision is what the scene needs.
inline CompileOptions liveOptions() {
  CompileOptions options(Precision::kAuto);
  options.wait_limit_ns = kOneTick;
  return options;
}

}  // namespace ergotic::physics
