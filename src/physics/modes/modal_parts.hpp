// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "physics/network/network.hpp"

namespace ergotic::physics {

/// Free modules that constant springs join, with damping that modes share: they stand in for these.
struct LinearPart {
  std::vector<int> mats;  ///< indices in Scene::mats, ascending
  std::vector<int> lias;  ///< springs that become part of the modes
};

/// Why something in a section does not become part of its modes.
struct Offence {
  scene::Place place;
  std::string what;
};

struct LinearParts {
  std::vector<LinearPart> parts;
  std::vector<int> part_of;          ///< [mats] -1: none
  std::vector<int> row_of;           ///< [mats] place in LinearPart::mats, for those of a part
  std::vector<unsigned char> is_in;  ///< [lias] 1: part of the modes
  std::optional<Offence> offence;    ///< the first of those that stay outside and need not
  int offences = 0;                  ///< how many there are
};

/// Finds all modules and links of a scalar section that modes can replace. Realtime: no.
/// Cost: O(modules)
LinearParts linearPartsOf(const Network& network, const Rates& rates, int section);

/// A part in coordinates in which all masses are equal: a step without forces is
/// d <- d - loss d - pull x. Rows as in LinearPart::mats.
struct PartMatrices {
  Eigen::SparseMatrix<double> pull;  ///< h^2 M^-1/2 K M^-1/2
  Eigen::SparseMatrix<double> loss;  ///< h M^-1/2 Z M^-1/2
};
/// \param row_of  LinearParts::row_of
PartMatrices matricesOf(const Network& network,
                        const Rates& rates,
                        const std::vector<int>& row_of,
                        const LinearPart& part);

/// A symmetric matrix as entries of its lower triangle, sorted by column, then row.
struct ModalMatrix {
  struct Entry {
    int row = 0;
    int column = 0;
    double value = 0.0;
  };
  int size = 0;
  std::vector<Entry> entries;
};
/// The mixture of both whose eigenvectors are the modes: those that `pull` alone leaves open in a
/// plane of modes of one frequency, `loss` decides.
ModalMatrix mixtureOf(const PartMatrices& matrices);

/// Forces and motion at the start, in the order of LinearPart::mats.
struct PartStart {
  Eigen::VectorXd mass;         ///< kg
  Eigen::VectorXd x;            ///< m, from rest
  Eigen::VectorXd velocity;     ///< m/time_unit
  Eigen::VectorXd constant;     ///< sum of all forces where x = 0 and nothing moves
  Eigen::VectorXd first_force;  ///< of modules, in the first step only
  Eigen::VectorXd of_springs;   ///< forces of the links of the part at the start
};
PartStart startOf(const Network& network,
                  const Rates& rates,
                  const std::vector<int>& row_of,
                  const LinearPart& part);

}  // namespace ergotic::physics
