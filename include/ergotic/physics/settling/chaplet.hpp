// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/generate/chaplet.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Load of a chaplet at its last mass, a spring and a dashpot to the ground; none: free.
struct ChapletLoad {
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m
};

/// A low-pass chain between an end that moves at a slower rate and a structure: its response under
/// the explicit scheme, in closed form.
///
/// Realtime: no. Thread: any. Cost of each figure: O(stages).
/// Source: docs/physics/multirate.md, "Chaplets: mechanical low-passes".
class Chaplet {
 public:
  /// \param stages  SI: N/m, N s/m, kg; from the slower end on; at least one
  /// \param step_s  h, s, of the chaplet
  /// \param ratio   R, its steps in one of the slower end
  Chaplet(std::vector<scene::ChapletStage> stages, double step_s, int ratio);

  const std::vector<scene::ChapletStage>& stages() const { return stages_; }
  int ratio() const { return ratio_; }
  double mass() const;             ///< sum of all masses, kg
  double seriesStiffness() const;  ///< stiffness of all springs in series, N/m
  double nyquistHz() const;        ///< fN, half the slower rate, Hz: what is above it is an image

  /// Position of the last mass over that of the slower end if that moved in every step.
  double gain(double frequency_hz, const ChapletLoad& load) const;
  /// Factor of the zero-order hold: that gain times this holds if the slower end is held between
  /// its steps.
  double holdGain(double frequency_hz) const;

  /// Mass that the slower end feels when it moves the chaplet, kg.
  double apparentMass(double frequency_hz, const ChapletLoad& load) const;
  /// Dashpot that the slower end feels when it moves the chaplet, N s/m.
  double apparentDamping(double frequency_hz, const ChapletLoad& load) const;

 private:
  struct Port {
    std::complex<double> position;  // of the slower end, where the last mass has 1
    std::complex<double> force;     // on the first spring
  };
  Port portAt(double frequency_hz, const ChapletLoad& load) const;

  std::vector<scene::ChapletStage> stages_;
  double step_s_;
  int ratio_;
};

/// A chaplet of one of the tables of the scene room.
/// \param mass     of all, kg
/// \param step_s   h, s
template <class Table>
Chaplet tunedChaplet(const Table& table, double mass, double step_s, int ratio) {
  const double nyquist = 3.14159265358979323846 / (ratio * step_s);  // wN, rad/s
  std::vector<scene::ChapletStage> stages;
  for (const scene::ChapletStage& stage : table) {
    stages.push_back({stage.stiffness * mass * nyquist * nyquist, stage.damping * mass * nyquist,
                      stage.mass * mass});
  }
  return {std::move(stages), step_s, ratio};
}

/// 20 log10.
double decibels(double gain);

/// A chaplet in a scene, with the load that the structure at its last mass is taken for.
struct FoundChaplet {
  std::string name;  ///< of its masses, without the number
  int first =
      0;  ///< index in Scene::mats of its first mass, which is attached to the slower module
  Chaplet chaplet;
  ChapletLoad load;
};

/// Every C2 of a settled scene, whoever put it there: two masses of its proportions, the first one
/// attached to a module of a slower section.
std::vector<FoundChaplet> findChaplets(const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
