// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "ergotic/station/performer.hpp"
#include "tools/lib/report.hpp"

namespace CLI {
class App;
}

namespace ergotic::tools {

/// Options of a virtual hand that probes a slice.
struct FeelChoice {
  std::string slice;           ///< `slice:N`; empty: no probing
  double travel = 0.02;        ///< m at the device, from the zero of the hand; < 0: the other way
  std::vector<double> speeds;  ///< m/s at the device, > 0; none: 0.01 and 0.5
  std::string csv;             ///< empty: not written
  std::string plot;            ///< empty: not drawn
};

void addOptions(CLI::App& app, FeelChoice& choice);

/// N of `slice:N`. \throws Exception if it is none
int sliceOf(const FeelChoice& choice);

/// State of the hand at one tick.
struct FeltTick {
  double position = 0.0;  ///< m at the device
  double speed = 0.0;     ///< m/s
  double force = 0.0;     ///< N on the hand, along its axis: a resisting force is against the speed
};

/// Motion there and back at one speed.
struct Stroke {
  double speed = 0.0;    ///< m/s
  std::size_t turn = 0;  ///< the first tick of the way back
  std::vector<FeltTick> ticks;
};

/// Characteristic values of a stroke.
struct StrokeFigures {
  double speed = 0.0;      ///< m/s
  double press_j = 0.0;    ///< work of the hand on the way there
  double release_j = 0.0;  ///< work that the hand gets back
  double peak_n = 0.0;     ///< largest force
  double stiffest = 0.0;   ///< N/m: steepest rise of the resisting force, up to its maximum
  /// Release force on the way there: the resisting force at which it drops by more than half, N; 0:
  /// it does not drop.
  double release_n = 0.0;
};

/// Plays a model from its start: it rests for a tenth of a second, then the slice is moved to
/// `travel` and back. What the hand meets in a tick is the answer to where it is in that tick,
/// without the delay of a device and without a safety chain.
/// \throws Exception if no port of the model moves with the slice
Stroke feel(station::Performer& performer, int slice, double travel, double speed);

StrokeFigures figuresOf(const Stroke& stroke);

/// `speed_m_per_s,way,position_m,velocity_m_per_s,force_n`, tick by tick.
void writeFeel(const std::vector<Stroke>& strokes, std::ostream& out);

/// Feels a slice as asked, writes the files, and reports; \see docs/tools.md
/// \throws Exception
Json feelReport(station::Performer& performer,
                const physics::DeviceTraits& device,
                const tgr::EndEffectors& end_effectors,
                const FeelChoice& choice);

}  // namespace ergotic::tools
