// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/linear_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include "algebra/decompositions.hpp"
#include "at.hpp"
#include "physics/network/load_matrix.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

constexpr int kBoundIterations = 50;  // of Collatz-Wielandt

}  // namespace

LinearNetwork::LinearNetwork(const Network& network, int section, int absent)
    : network_(network), node_of_mat_(network.nodes.size(), -1) {
  addModules(section, absent);
  addSprings(section, absent);
}

void LinearNetwork::addModules(int section, int absent) {
  const double unit = network_.scene.time_unit_s;
  for (int m = 0; m < static_cast<int>(network_.nodes.size()); ++m) {
    const Network::Node& module = network_.nodes[at(m)];
    if (!module.is_free || module.section != section || m == absent) {
      continue;
    }
    const int node = static_cast<int>(mass_.size());
    node_of_mat_[at(m)] = node;
    mass_.push_back(module.mass.now);
    damping_.push_back(module.damping.now / unit);
    if (network_.scene.mats[at(m)].type == MatType::kCell) {
      springs_.push_back({module.stiffness.now / (unit * unit), {{node, 1.0}}, true});
    }
  }
}

bool LinearNetwork::counts(const scene::Lia& lia, int section, int absent) const {
  const auto ends_here = [&](int mat) {
    const scene::Mat& end = network_.scene.mats[at(mat)];
    return end.section == section ? end.type != MatType::kSlice : end.type == MatType::kGround;
  };
  return !lia.filtered && lia.a != absent && lia.b != absent && ends_here(lia.a) &&
         ends_here(lia.b);
}

void LinearNetwork::addSprings(int section, int absent) {
  const double unit = network_.scene.time_unit_s;
  for (std::size_t l = 0; l < network_.links.size(); ++l) {
    const Network::Link& link = network_.links[l];
    const double stiffness = link.at_rest / (unit * unit);
    if (stiffness == 0.0 || !counts(network_.scene.lias[l], section, absent)) {
      continue;
    }
    Shares ends = endsAmong(network_, node_of_mat_, link);
    double weight = 0.0;
    for (const Share& share : ends) {
      weight += share.weight;
    }
    if (!ends.empty()) {
      // Weights of an end that moves as a whole add up to 1.
      springs_.push_back({stiffness, std::move(ends), std::abs(weight) > 1e-12});
    }
  }
}

double LinearNetwork::effectiveMass(const Shares& shares, double sign) const {
  double mobility = 0.0;
  for (const auto& [node, weight] : shares) {
    mobility += weight * sign > 0.0 ? weight * weight / mass_[at(node)] : 0.0;
  }
  return mobility > 0.0 ? 1.0 / mobility : std::numeric_limits<double>::infinity();
}

double LinearNetwork::massAt(int mat) const {
  return effectiveMass(sharesOf(mat), 1.0);
}

/// Modules of a tap may lie on bodies that do not know of each other.
double LinearNetwork::impedanceAt(int mat) const {
  const Shares shares = sharesOf(mat);
  if (!isTap(network_, mat)) {
    return impedanceOf(shares);
  }
  double mobility = 0.0;
  for (const auto& [node, weight] : shares) {
    const double impedance = impedanceOf({{node, 1.0}});
    if (impedance == 0.0) {
      return 0.0;
    }
    mobility += weight * weight / impedance;
  }
  return 1.0 / mobility;
}

double LinearNetwork::impedanceOf(const Shares& shares) const {
  double impedance = 0.0;
  double weights = 0.0;
  for (const auto& [node, weight] : shares) {
    impedance += weight * damping_[at(node)];
    weights += weight;
  }
  for (const Spring& spring : springs_) {
    const double lighter =
        std::min(effectiveMass(spring.ends, 1.0), effectiveMass(spring.ends, -1.0));
    const double wave = std::sqrt(std::max(spring.stiffness, 0.0) * lighter);
    for (const auto& [node, weight] : shares) {
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
  const auto reach = [&](const Shares& shares) {
    for (const auto& [node, weight] : shares) {
      if (part.row_of_node[at(node)] < 0) {
        part.row_of_node[at(node)] = static_cast<int>(nodes.size());
        nodes.push_back(node);
      }
    }
  };
  std::vector<bool> taken(springs_.size(), false);
  std::vector<const Spring*> springs;
  reach(sharesOf(mat));
  for (std::size_t next = 0; next < nodes.size(); ++next) {
    for (const std::size_t i : springs_of[at(nodes[next])]) {
      if (taken[i]) {
        continue;
      }
      taken[i] = true;
      springs.push_back(&springs_[i]);
      reach(springs_[i].ends);
      part.anchored = part.anchored || springs_[i].anchored;
    }
  }
  LoadMatrix stiffness(static_cast<int>(nodes.size()));
  for (const Spring* spring : springs) {
    Shares ends = spring->ends;
    for (Share& end : ends) {
      end.node = part.row_of_node[at(end.node)];
    }
    stiffness.addLoad(ends, [spring](const Share& a, const Share& b) {
      return spring->stiffness * a.weight * b.weight;
    });
  }
  part.stiffness = stiffness.sum();
  part.mass.resize(part.stiffness.rows());
  for (std::size_t row = 0; row < nodes.size(); ++row) {
    part.mass[static_cast<Eigen::Index>(row)] = mass_[at(nodes[row])];
  }
  return part;
}

double LinearNetwork::stiffnessAt(int mat) const {
  const Part part = partAround(mat);
  if (!part.anchored) {
    return 0.0;
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(part.mass.size());
  for (const auto& [node, weight] : sharesOf(mat)) {
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
  const int size = static_cast<int>(mass_.size());
  if (size == 0 || size > most) {
    return {};
  }
  LoadMatrix pencil(size);  // of unit masses
  for (const Spring& spring : springs_) {
    pencil.addLoad(spring.ends, [&](const Share& a, const Share& b) {
      return spring.stiffness * a.weight * b.weight /
             std::sqrt(mass_[at(a.node)] * mass_[at(b.node)]);
    });
  }
  const Eigen::VectorXd values = algebra::symmetricEigenvalues(Eigen::MatrixXd(pencil.sum()));
  return {values.data(), values.data() + size};
}

double LinearNetwork::highestModeAt(int mat) const {
  const Part part = partAround(mat);
  const Eigen::SparseMatrix<double> stiffness = part.stiffness.cwiseAbs();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(part.mass.size());
  double bound = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kBoundIterations; ++i) {
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
