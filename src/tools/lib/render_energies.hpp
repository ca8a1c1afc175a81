// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include "ergotic/physics/engine/instrument.hpp"

namespace ergotic::tools {

/// Prints where the energy of an instrument is and went, section by section, J, and the residual
/// of the balance.
void printEnergies(const physics::Instrument& instrument, std::ostream& out);

}  // namespace ergotic::tools
