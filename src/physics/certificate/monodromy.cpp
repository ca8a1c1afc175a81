// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/monodromy.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "algebra/decompositions.hpp"
#include "at.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "physics/network/network.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

constexpr double kNearOne = 1e-6;
constexpr double kFixed = 1e-12;  // of the largest pivot

/// Response of the whole state, over one period, to a unit of one module's position or force.
struct Column {
  int slot = 0;
  Eigen::VectorXd of_position;
  Eigen::VectorXd of_force;
  /// A unit difference does as much as this force: keep M / h^2, with which differences enter.
  double force_per_difference = 0.0;
  double reach = 0.0;  ///< how far a unit of force moves everything
};

std::vector<Column> columnsOf(LinearStepper& stepper) {
  const int slots = stepper.slots();
  std::vector<Column> columns;
  const auto from = [&](int index) {
    return stepper.step(Eigen::VectorXd::Unit(3 * slots, index));
  };
  for (int slot = 0; slot < slots; ++slot) {
    Column column;
    column.slot = slot;
    column.of_force = from(2 * slots + slot);
    const double square = column.of_force.squaredNorm();
    if (square == 0.0) {
      continue;  // no force moves it
    }
    column.of_position = from(slot);
    column.force_per_difference = from(slots + slot).dot(column.of_force) / square;
    column.reach = column.of_force.head(slots).norm();
    columns.push_back(std::move(column));
  }
  return columns;
}

/// How far a unit of force makes a module move in its step.
double moveOfForce(const scene::Scene& scene, const Rates& rates, int module) {
  const scene::Mat& mat = scene.mats[at(module)];
  const StepUnits units(scene, rates, divisorOf(scene.sectionOf(mat), rates));
  return units.inverseMass(scene.valueOf(mat.mass));
}

/// NaN if they cannot be worked out.
double largestEigenvalue(const Eigen::MatrixXd& matrix, bool* is_near_one) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!matrix.allFinite()) {
    return kNone;
  }
  const std::optional<Eigen::VectorXcd> values = algebra::generalEigenvalues(matrix);
  if (!values || !values->allFinite()) {
    return kNone;
  }
  double radius = 0.0;
  for (const std::complex<double>& value : *values) {
    if (std::abs(value) > radius) {
      radius = std::abs(value);
      *is_near_one = std::abs(value - 1.0) < kNearOne;
    }
  }
  return radius;
}

/// The matrix on what is left when the states that it keeps as they are are taken out. A body that
/// nothing holds has such a state, where it is, and a double eigenvalue of 1, which would come out
/// as 1 + sqrt(rounding).
Eigen::MatrixXd withoutFixedStates(const Eigen::MatrixXd& matrix) {
  const Eigen::Index size = matrix.rows();
  const algebra::Kernel fixed =
      algebra::kernelOf(matrix - Eigen::MatrixXd::Identity(size, size), kFixed);
  if (fixed.rank == size) {
    return matrix;
  }
  const Eigen::MatrixXd others = algebra::orthogonalComplement(fixed.basis);
  return others.transpose() * matrix * others;
}

/// [modules][modules] of all springs, at the present values of the parameters.
Eigen::MatrixXd stiffnessOf(const scene::Scene& linear, const std::vector<int>& modules) {
  const Network network(linear);
  std::vector<int> row_of(linear.mats.size(), -1);
  const auto n = static_cast<Eigen::Index>(modules.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int module = modules[static_cast<std::size_t>(i)];
    row_of[at(module)] = static_cast<int>(i);
    stiffness(i, i) = network.nodes[at(module)].stiffness.now;
  }
  for (std::size_t l = 0; l < linear.lias.size(); ++l) {
    const Shares ends = endsAmong(network, row_of, network.links[l]);
    for (const Share& a : ends) {
      for (const Share& b : ends) {
        stiffness(a.node, b.node) += a.weight * b.weight * linear.valueOf(linear.lias[l].stiffness);
      }
    }
  }
  return stiffness;
}

}  // namespace

Period periodOf(const scene::Scene& scene, const Rates& rates) {
  const scene::Scene linear = linearPart(scene);
  LinearStepper stepper(linear, rates);
  const int slots = stepper.slots();
  const std::vector<Column> columns = columnsOf(stepper);
  const auto n = static_cast<Eigen::Index>(columns.size());
  Period period{Eigen::MatrixXd(2 * n, 2 * n), {}, Eigen::VectorXd(n), {}, Eigen::VectorXd(n)};
  // A force waits in the state to move its module together with the difference. Both act alike, so
  // they are one number, here a force, scaled to move as much as a unit of position: eigenvalues
  // of badly scaled matrices are inexact.
  const auto reduce = [&](const Eigen::VectorXd& state, Eigen::Index to, double scale) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const Column& row = columns[static_cast<std::size_t>(i)];
      const double force =
          state[2 * slots + row.slot] + row.force_per_difference * state[slots + row.slot];
      period.matrix(i, to) = scale * state[row.slot];
      period.matrix(n + i, to) = scale * force * row.reach;
    }
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    const Column& column = columns[static_cast<std::size_t>(j)];
    reduce(column.of_position, j, 1.0);
    reduce(column.of_force, n + j, 1.0 / column.reach);
    const int module = stepper.moduleOf(column.slot);
    period.modules.push_back(module);
    const double moved = moveOfForce(scene, rates, module);  // h^2/M
    period.units[j] = moved / column.reach;
    period.inertia[j] = period.units[j] * period.units[j] / moved;
  }
  period.stiffness = stiffnessOf(linear, period.modules);
  return period;
}

double spectralRadius(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) {
    return 0.0;
  }
  bool is_near_one = false;
  const double radius = largestEigenvalue(matrix, &is_near_one);
  if (radius <= 1.0 || !is_near_one) {
    return radius;
  }
  const Eigen::MatrixXd others = withoutFixedStates(matrix);
  if (others.rows() == 0) {
    return 1.0;
  }
  const double rest = largestEigenvalue(others, &is_near_one);
  return rest < 1.0 ? 1.0 : rest;
}

}  // namespace ergotic::physics
