// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "physics/network/network.hpp"

namespace ergotic::physics {

/// Largest entry on the diagonal of K^-1; infinite if K is not positive definite.
/// Cost: that of the sparse LDL^T of K, then of the entries of K^-1 where L has some (Erisman and
/// Tinney 1975, Communications of the ACM 18(3)).
double largestCompliance(const Eigen::SparseMatrix<double>& stiffness);

/// No module of a sleeping section is further away from rest than this, m: with the energy E of the
/// section, |x_i| <= sqrt(2 E (K^-1)_ii). Infinite if a module is free to go.
double sleepingDistance(const Network& network, int section);

/// Adds notes on the motion that sleep may hide, for every section that may sleep.
void noteSleep(const scene::Scene& scene, std::vector<std::string>& notes);

}  // namespace ergotic::physics
