// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/cell_bound.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "at.hpp"
#include "constants.hpp"

namespace ergotic::physics {
namespace {
constexpr double kCellRounding = 1e-12;

class CellBound {
 public:
  explicit CellBound(const NetworkBound& network)
      : network_(network),
        cells_of_(at(network.nodes())),
        sum_(at(network.nodes()), 0.0),
        matrices_(network.cells().size(), Eigen::Matrix4d::Zero()) {
    for (int c = 0; c < static_cast<int>(network.cells().size()); ++c) {
      for (const int node : network.cells()[at(c)]) {
        if (node >= 0) {
          cells_of_[at(node)].push_back(c);
        }
      }
    }
  }

  double run() {
    for (const NetworkBound::Link& link : network_.links()) {
      share(link);
    }
    double bound = 0.0;
    for (std::size_t c = 0; c < matrices_.size(); ++c) {
      bound = std::max(bound, highest(c));
    }
    for (const NetworkBound::Link* link : alone_) {
      double total = 0.0;
      for (const Share& end : link->ends) {
        total += std::abs(end.weight) * sum_[at(end.node)] / network_.mass(end.node);
      }
      bound = std::max(bound, total);
      is_finite_ = is_finite_ && std::isfinite(total);
    }
    return is_finite_ ? bound * (1.0 + kCellRounding) : kInfinity;
  }

 private:
  /// Cells that hold all nodes of a link.
  void findCells(const NetworkBound::Link& link) {
    found_.clear();
    for (const int cell : cells_of_[at(link.ends.front().node)]) {
      const auto& nodes = network_.cells()[at(cell)];
      const auto holds = [&](const Share& end) {
        return std::find(nodes.begin(), nodes.end(), end.node) != nodes.end();
      };
      if (std::all_of(link.ends.begin(), link.ends.end(), holds)) {
        found_.push_back(cell);
      }
    }
  }

  /// How a link is divided among the cells that hold its ends. Any division gives a bound; it is
  /// tight if a link to a fixed point goes to cells by how many of their corners are fixed.
  double weightOf(int cell, const NetworkBound::Link& link) const {
    const auto& nodes = network_.cells()[at(cell)];
    return link.ends.size() == 1 ? static_cast<double>(std::count(nodes.begin(), nodes.end(), -1))
                                 : 1.0;
  }

  void share(const NetworkBound::Link& link) {
    const double load = network_.load(link);
    if (!(load > 0.0)) {
      return;
    }
    findCells(link);
    if (found_.empty()) {
      alone_.push_back(&link);
      for (const Share& end : link.ends) {
        sum_[at(end.node)] += load * std::abs(end.weight);
      }
      return;
    }
    double weights = 0.0;
    for (const int cell : found_) {
      weights += weightOf(cell, link);
    }
    for (const int cell : found_) {
      const auto& nodes = network_.cells()[at(cell)];
      const double part = load * (weights > 0.0 ? weightOf(cell, link) / weights
                                                : 1.0 / static_cast<double>(found_.size()));
      Eigen::Vector4d u = Eigen::Vector4d::Zero();
      for (const Share& end : link.ends) {
        u[std::find(nodes.begin(), nodes.end(), end.node) - nodes.begin()] = end.weight;
      }
      matrices_[at(cell)] += part * u * u.transpose();
    }
    for (const Share& end : link.ends) {
      sum_[at(end.node)] += load * end.weight * end.weight;
    }
  }

  /// The largest eigenvalue of a cell whose masses are their shares of the network's.
  double highest(std::size_t c) {
    Eigen::Vector4d scale = Eigen::Vector4d::Zero();
    for (int i = 0; i < 4; ++i) {
      const int node = network_.cells()[c][at(i)];
      const double own = matrices_[c](i, i);
      if (node >= 0 && own > 0.0) {
        scale[i] = std::sqrt(sum_[at(node)] / (own * network_.mass(node)));
      }
    }
    const Eigen::Matrix4d scaled = scale.asDiagonal() * matrices_[c] * scale.asDiagonal();
    if (scaled == last_) {
      return last_highest_;  // cells of one kind follow one another
    }
    if (!scaled.allFinite()) {
      is_finite_ = false;
      return kInfinity;
    }
    last_ = scaled;
    last_highest_ = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(scaled, Eigen::EigenvaluesOnly)
                        .eigenvalues()
                        .maxCoeff();
    return last_highest_;
  }

  const NetworkBound& network_;
  std::vector<std::vector<int>> cells_of_;  // [nodes]
  std::vector<double> sum_;                 // [nodes] loads of all its cells
  std::vector<Eigen::Matrix4d> matrices_;   // [cells]
  std::vector<const NetworkBound::Link*> alone_;
  std::vector<int> found_;
  Eigen::Matrix4d last_ = Eigen::Matrix4d::Zero();
  double last_highest_ = 0.0;
  bool is_finite_ = true;
};

}  // namespace

double cellBound(const NetworkBound& network) {
  return CellBound(network).run();
}

double rayleighQuotient(const NetworkBound& network, int iterations) {
  const std::size_t count = at(network.nodes());
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<double> x(count);
  for (double& each : x) {
    each = number(random);
  }
  double quotient = 0.0;
  for (int k = 0; k < iterations; ++k) {
    std::vector<double> y(count, 0.0);  // A x
    for (const NetworkBound::Link& link : network.links()) {
      double strain = 0.0;
      for (const Share& end : link.ends) {
        strain += end.weight * x[at(end.node)];
      }
      strain *= network.load(link);
      for (const Share& end : link.ends) {
        y[at(end.node)] += end.weight * strain;
      }
    }
    double energy = 0.0;
    double inertia = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double mass = network.mass(static_cast<int>(i));
      energy += x[i] * y[i];
      inertia += mass * x[i] * x[i];
      y[i] /= mass;
      largest = std::max(largest, std::abs(y[i]));
    }
    if (!(inertia > 0.0) || !std::isfinite(energy / inertia) || !(largest > 0.0)) {
      return quotient;
    }
    quotient = std::max(quotient, energy / inertia);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = y[i] / largest;
    }
  }
  return quotient;
}

}  // namespace ergotic::physics
