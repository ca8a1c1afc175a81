// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "ergotic/physics/state/coefficients.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/aligned.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/energy_stable_form.hpp"

namespace ergotic::physics {

using scene::EnergyStableLaw;

/// Per-slot coefficients of d <- d - (lose d + pull x) + inverse_mass f + drift; x <- x + d. What
/// is lost is stored, not what is left: close to 1 a float would round it to a few digits. Masses
/// without a medium lose and pull nothing and use neither.
template <class Real>
struct MassCoefficients {
  AlignedVector<Real> inverse_mass;
  AlignedVector<Real> drift;  ///< constant force, gravity and the cell's rest, per step
  AlignedVector<Real> lose;
  AlignedVector<Real> pull;
  AlignedVector<Real> loss;  ///< lose / inverse_mass; 0 where no force moves a module
};

/// Coefficients of the links of a block (blocks.hpp).
template <class Real>
struct BlockCoefficients {
  AlignedVector<Real> k;  ///< [diagonals][guard + elements], chains: [rows, or 1 per lane][kLanes]
  AlignedVector<Real> z;  ///< empty if `ratio` says it all
  AlignedVector<Real> bias;     ///< [elements] force at rest, N; empty: none
  std::vector<Real> rest;       ///< added to elongations, as k; sparse: [links]; empty: 0
  std::vector<Real> uniform_k;  ///< [diagonals]
  std::vector<Real> uniform_z;
  Real ratio = Real(0);  ///< Z / K where that is one number
};

/// The tables of a run, one after the other.
template <class Real>
struct TableCoefficients {
  std::vector<Real> x;
  std::vector<Real> cubic;  ///< [points][4]
  std::vector<int> first;   ///< [links]
  std::vector<int> count;

  void add(const scene::Table& table);
};

/// Coefficients of the links of a run; empty where a block has them.
template <class Real>
struct RunCoefficients {
  std::vector<Real> fields;  ///< [fields of the law][links]
  std::vector<Real> rests;   ///< [dimensions][links] rest of a less rest of b
  TableCoefficients<Real> table;
  TableCoefficients<Real> viscous_table;
};

/// The position that a point of a grid is to take, and the energy that moving it may bring. `speed`
/// and `allowance` are per step of its section; energies in units of the scene.
struct PlaceCoefficients {
  struct Way {
    double at = 0.0;
    double scale = 0.0;
    double minimum = 0.0;
    double maximum = 1.0;
    int glide = 1;  ///< frames between two changes of what is asked for
  };
  std::array<Way, 2> ways;  ///< along, across
  double speed = 0.0;
  double allowance = 0.0;   ///< energy that moving it may bring
  double credit = 0.0;      ///< the most that it may owe and go on
  double stiffness = 0.0;   ///< stiffness of the explicit links that end there, at their steepest
  double resistance = 0.0;  ///< Z/h of these links
};

template <class Real>
class CoefficientsOf final : public Coefficients {
 public:
  /// Converts every number of `scene` to steps. \pre layout was made from scene and rates
  CoefficientsOf(const scene::Scene& scene, const Rates& rates, const Layout& layout);

  /// Converts again what follows an audio input, from the present samples in `scene`.
  /// Realtime: yes
  void follow(const scene::Scene& scene,
              const Rates& rates,
              const Layout& layout,
              const Follower& follower) noexcept;

  MassCoefficients<Real> masses;
  std::vector<RunCoefficients<Real>> runs;      ///< [Layout::runs]
  std::vector<BlockCoefficients<Real>> blocks;  ///< [Layout::blocks]
  std::vector<std::vector<EnergyStableLaw<Real>>>
      energy_stable;                      ///< [energyStableGroupsOf(layout)][links]
  std::vector<Real> pickup_gains;         ///< [Layout::pickups]
  std::vector<Real> feed_gains;           ///< [Layout::feeds]
  std::vector<PlaceCoefficients> places;  ///< [Layout::places]

 private:
  void fillMasses(const scene::Scene& scene, const Rates& rates, const Layout& layout);
  void setSlot(const scene::Scene& scene, const StepUnits& units, const Layout& layout, int slot);
  void setLink(
      const scene::Scene& scene, const StepUnits& units, const LinkRun& run, std::size_t r, int l);
  void fillBlocks(const scene::Scene& scene, const Rates& rates, const Layout& layout);
  void fillBlock(const scene::Scene& scene,
                 const StepUnits& units,
                 const Block& block,
                 const LinkRun& run);
  void fillEnergyStable(const scene::Scene& scene, const Rates& rates, const Layout& layout);
  void fillPlaces(const scene::Scene& scene, const Rates& rates, const Layout& layout);
  void fillRun(const scene::Scene& scene, const Rates& rates, const Layout& layout, std::size_t r);
};

extern template class CoefficientsOf<float>;
extern template class CoefficientsOf<double>;

}  // namespace ergotic::physics
