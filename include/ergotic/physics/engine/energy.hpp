// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace ergotic::physics {

/// Energies of one section, J. Those that are "since the start" add up over time.
struct SectionEnergy {
  double kinetic = 0.0;
  double potential = 0.0;    ///< potential energy of its links, cells, gravity and constant forces
  double dissipated = 0.0;   ///< since the start
  double from_device = 0.0;  ///< work of the hands on its slices, since the start
  double from_inputs = 0.0;  ///< work of audio inputs and moving places, since the start
  double from_links = 0.0;   ///< work of links to other sections on its modules, since the start
};

/// Energies of the links between two sections, J.
struct CouplingEnergy {
  int section_a = 0;  ///< < section_b
  int section_b = 0;
  double stored = 0.0;
  double dissipated = 0.0;  ///< since the start
  /// Energy made by hold and mean, since the start: the work of the held end's jumps on the springs
  /// less that of the slower end against its mean force. Below 0 it was lost. 0 at one rate.
  double made = 0.0;
};

/// The balance: all that is stored, less what it was at the start, plus what was dissipated, less
/// what came in and what couplings made. Only rounding may remain. Of an instrument without energy
/// accounts of energy (CompileOptions::metered) only what positions tell is known: kinetic energy,
/// and the potential energy of gravity, constant forces, cells and the explicit spring-dampers
/// inside each section; all else, the residual too, is 0.
struct Energies {
  std::vector<SectionEnergy> sections;    ///< [Scene::sections]
  std::vector<CouplingEnergy> couplings;  ///< pairs of sections that links join
  double stored = 0.0;                    ///< energy in all sections and couplings
  double from_parameters = 0.0;           ///< work of parameter changes, since the start
  double residual = 0.0;
};

/// How often the force of an energy-stable link had to be cut to keep it from making energy.
struct TankReport {
  int lia = 0;               ///< index in Scene::lias
  std::int64_t active = 0;   ///< steps in which it pushed
  std::int64_t clipped = 0;  ///< of these, steps with less force than its law asks for
};

}  // namespace ergotic::physics
