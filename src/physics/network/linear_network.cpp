// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/linear_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

#include "ergotic/scene/grid.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

constexpr int kIterations = 50;  // of Collatz-Wielandt

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

bool isAlwaysOn(LiaType type) {
  return type == LiaType::kSpringDamper || type == LiaType::kQuadratic || type == LiaType::kCubic ||
         type == LiaType::kClippedCubic;
}

}  // namespace

LinearNetwork::LinearNetwork(const scene::Scene& scene, int section, int absent)
    : scene_(scene), node_of_mat_(scene.mats.size(), -1), connection_(scene.mats.size(), -1) {
  for (std::size_t i = 0; i < scene.connections.size(); ++i) {
    connection_[at(scene.connections[i].mat)] = static_cast<int>(i);
  }
  addModules(section, absent);
  addSprings(section, absent);
}

void LinearNetwork::addModules(int section, int absent) {
  const double unit = scene_.time_unit_s;
  for (std::size_t i = 0; i < scene_.mats.size(); ++i) {
    const scene::Mat& mat = scene_.mats[i];
    const bool free = mat.type == MatType::kMass || mat.type == MatType::kCell;
    if (!free || mat.section != section || static_cast<int>(i) == absent) {
      continue;
    }
    const int node = static_cast<int>(mass_.size());
    node_of_mat_[i] = node;
    mass_.push_back(scene_.valueOf(mat.mass));
    damping_.push_back(scene_.valueOf(scene_.sectionOf(mat).medium) / unit);
    if (mat.type == MatType::kCell) {
      damping_.back() += scene_.valueOf(mat.damping) / unit;
      springs_.push_back({scene_.valueOf(mat.stiffness) / (unit * unit), {{node, 1.0}}, true});
    }
  }
}

bool LinearNetwork::counts(const scene::Lia& lia, int section, int absent) const {
  if (!isAlwaysOn(lia.type) || lia.filtered || lia.a == absent || lia.b == absent) {
    return false;
  }
  const auto ends_here = [&](int mat) {
    const scene::Mat& end = scene_.mats[at(mat)];
    return end.section == section ? end.type != MatType::kSlice : end.type == MatType::kGround;
  };
  return ends_here(lia.a) && ends_here(lia.b);
}

void LinearNetwork::addSprings(int section, int absent) {
  const double unit = scene_.time_unit_s;
  for (const scene::Lia& lia : scene_.lias) {
    const double stiffness = scene_.valueOf(lia.stiffness) / (unit * unit);
    if (stiffness == 0.0 || !counts(lia, section, absent)) {
      continue;
    }
    Spring spring{stiffness, shareOf(lia.a), false};
    double weight = 0.0;
    for (const auto& [node, share] : spring.ends) {
      weight += share;
    }
    for (const auto& [node, share] : shareOf(lia.b)) {
      spring.ends.emplace_back(node, -share);
      weight -= share;
    }
    // Weights of an end that moves as a whole add up to 1.
    spring.anchored = std::abs(weight) > 1e-12;
    if (!spring.ends.empty()) {
      springs_.push_back(std::move(spring));
    }
  }
}

LinearNetwork::Share LinearNetwork::shareOf(int mat) const {
  Share share;
  const auto add = [&](int module, double weight) {
    if (node_of_mat_[at(module)] >= 0 && weight > 0.0) {
      share.emplace_back(node_of_mat_[at(module)], weight);
    }
  };
  if (connection_[at(mat)] < 0) {
    add(mat, 1.0);
    return share;
  }
  const scene::Connection& connection = scene_.connections[at(connection_[at(mat)])];
  const scene::GridPlace place =
      scene::placeOn(scene_.grids[at(connection.grid)], scene_.valueOf(connection.along),
                     scene_.valueOf(connection.across));
  for (std::size_t i = 0; i < at(place.count); ++i) {
    add(place.mats[i], place.weights[i]);
  }
  return share;
}

double LinearNetwork::effectiveMass(const Share& share, double sign) const {
  double mobility = 0.0;
  for (const auto& [node, weight] : share) {
    mobility += weight * sign > 0.0 ? weight * weight / mass_[at(node)] : 0.0;
  }
  return mobility > 0.0 ? 1.0 / mobility : std::numeric_limits<double>::infinity();
}

double LinearNetwork::massAt(int mat) const {
  return effectiveMass(shareOf(mat), 1.0);
}

double LinearNetwork::impedanceAt(int mat) const {
  const Share share = shareOf(mat);
  double impedance = 0.0;
  double weights = 0.0;
  for (const auto& [node, weight] : share) {
    impedance += weight * damping_[at(node)];
    weights += weight;
  }
  for (const Spring& spring : springs_) {
    const double lighter =
        std::min(effectiveMass(spring.ends, 1.0), effectiveMass(spring.ends, -1.0));
    const double wave = std::sqrt(std::max(spring.stiffness, 0.0) * lighter);
    for (const auto& [node, weight] : share) {
      for (const auto& [end, part] : spring.ends) {
        impedance += end == node ? weight * std::abs(part) * wave : 0.0;
      }
    }
  }
  return impedance / weights;
}

LinearNetwork::Part LinearNetwork::partAround(int mat) const {
  Part part;
  part.row_of_node.assign(mass_.size(), -1);
  std::vector<std::vector<std::size_t>> springs_of(mass_.size());
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    for (const auto& [node, weight] : springs_[i].ends) {
      springs_of[at(node)].push_back(i);
    }
  }
  std::vector<int> nodes;
  const auto reach = [&](const Share& share) {
    for (const auto& [node, weight] : share) {
      if (part.row_of_node[at(node)] < 0) {
        part.row_of_node[at(node)] = static_cast<int>(nodes.size());
        nodes.push_back(node);
      }
    }
  };
  std::vector<bool> taken(springs_.size(), false);
  std::vector<Eigen::Triplet<double>> entries;
  reach(shareOf(mat));
  for (std::size_t next = 0; next < nodes.size(); ++next) {
    for (const std::size_t i : springs_of[at(nodes[next])]) {
      if (taken[i]) {
        continue;
      }
      taken[i] = true;
      const Spring& spring = springs_[i];
      reach(spring.ends);
      part.anchored = part.anchored || spring.anchored;
      for (const auto& [row, down] : spring.ends) {
        for (const auto& [column, across] : spring.ends) {
          entries.emplace_back(part.row_of_node[at(row)], part.row_of_node[at(column)],
                               spring.stiffness * down * across);
        }
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(nodes.size());
  part.stiffness.resize(size, size);
  part.stiffness.setFromTriplets(entries.begin(), entries.end());
  part.mass.resize(size);
  for (Eigen::Index row = 0; row < size; ++row) {
    part.mass[row] = mass_[at(nodes[static_cast<std::size_t>(row)])];
  }
  return part;
}

double LinearNetwork::stiffnessAt(int mat) const {
  const Part part = partAround(mat);
  if (!part.anchored) {
    return 0.0;
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(part.mass.size());
  for (const auto& [node, weight] : shareOf(mat)) {
    force[part.row_of_node[at(node)]] += weight;
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(part.stiffness);
  if (solver.info() != Eigen::Success) {
    return 0.0;
  }
  const double give = force.dot(solver.solve(force));
  return give > 0.0 ? 1.0 / give : 0.0;
}

std::vector<double> LinearNetwork::modes(int most) const {
  const auto size = static_cast<Eigen::Index>(mass_.size());
  if (size == 0 || size > most) {
    return {};
  }
  Eigen::MatrixXd pencil = Eigen::MatrixXd::Zero(size, size);  // of unit masses
  for (const Spring& spring : springs_) {
    for (const auto& [row, down] : spring.ends) {
      for (const auto& [column, across] : spring.ends) {
        pencil(row, column) +=
            spring.stiffness * down * across / std::sqrt(mass_[at(row)] * mass_[at(column)]);
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(pencil, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  return {values.data(), values.data() + size};
}

double LinearNetwork::highestModeAt(int mat) const {
  const Part part = partAround(mat);
  const Eigen::SparseMatrix<double> stiffness = part.stiffness.cwiseAbs();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(part.mass.size());
  double bound = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd next = (stiffness * x).cwiseQuotient(part.mass);
    if (next.maxCoeff() == 0.0) {
      return 0.0;
    }
    bound = std::min(bound, next.cwiseQuotient(x).maxCoeff());
    x = next / next.maxCoeff();
  }
  return bound;
}

}  // namespace ergotic::physics
