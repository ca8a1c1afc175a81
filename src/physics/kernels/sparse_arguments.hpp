// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/kernels/sparse_kernels.hpp"
#include "physics/layout/blocks/sparse_program.hpp"

namespace ergotic::physics::kernels {

/// Kernel arguments that a program gives; coefficients and node arrays are still to be set.
template <class Real>
SparseArguments<Real> sparseArguments(const SparseProgram& program) {
  SparseArguments<Real> to{};
  to.first_window = program.first_window.data();
  to.first_pick = program.first_pick.data();
  to.window = program.window.data();
  to.lane = program.lane.data();
  to.pick = program.pick.data();
  to.present = program.present.data();
  return to;
}

}  // namespace ergotic::physics::kernels
