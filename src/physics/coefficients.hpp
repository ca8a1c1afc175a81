// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "ergotic/physics/instrument.hpp"
#include "layout.hpp"
#include "step_units.hpp"

namespace ergotic::physics {

/// Per-slot coefficients of d <- keep d - pull x + inverse_mass f + drift; x <- x + d.
/// Masses have keep = 1 and pull = 0 and use neither.
template <class Real>
struct MassCoefficients {
  std::vector<Real> inverse_mass;
  std::vector<Real> drift;  ///< constant force, gravity and the cell's rest, per step
  std::vector<Real> keep;
  std::vector<Real> pull;
};

template <class Real>
struct RunCoefficients {
  std::vector<Real> fields;  ///< [fields of the law][links]
  std::vector<Real> table_x;
  std::vector<Real> table_y;
  std::vector<int> table_first;  ///< [links] of tabulated laws
  std::vector<int> table_count;
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
  std::vector<RunCoefficients<Real>> runs;  ///< [Layout::runs]
  std::vector<Real> tap_gains;              ///< [Layout::taps]
  std::vector<Real> feed_gains;             ///< [Layout::feeds]

 private:
  void fillMasses(const scene::Scene& scene, const Rates& rates, const Layout& layout);
  void setSlot(const scene::Scene& scene, const StepUnits& units, const Layout& layout, int slot);
  void setLink(
      const scene::Scene& scene, const StepUnits& units, const LinkRun& run, std::size_t r, int l);
  void fillRun(const scene::Scene& scene, const Rates& rates, const Layout& layout, std::size_t r);
};

extern template class CoefficientsOf<float>;
extern template class CoefficientsOf<double>;

}  // namespace ergotic::physics
