// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Largest entry on the diagonal of K^-1; infinite if K is not positive definite.
/// Cost: that of the sparse LDL^T of K, then of the entries of K^-1 where L has some (Erisman and
/// Tinney 1975, Communications of the ACM 18(3)).
double largestCompliance(const Eigen::SparseMatrix<double>& stiffness);

/// Stiffness of a section's own springs around the places where its modules rest, one row for each
/// coordinate of each free module; links to points and to other sections are left out, switching
/// ones too. K in kg/time_unit^2, at the softest end of its range.
Eigen::SparseMatrix<double> stiffnessOf(const scene::Scene& scene, int section);

/// No module of a sleeping section is further away from rest than this, m: with the energy E of the
/// section, |x_i| <= sqrt(2 E (K^-1)_ii). Infinite if a module is free to go.
double sleepingDistance(const scene::Scene& scene, int section);

/// What sleeping may hide, for every section that may sleep.
void noteSleep(const scene::Scene& scene, std::vector<std::string>& notes);

}  // namespace ergotic::physics
