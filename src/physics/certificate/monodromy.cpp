// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/monodromy.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Eigenvalues>

#include "physics/certificate/linear_stepper.hpp"

namespace ergotic::physics {
namespace {

constexpr double kNearOne = 1e-6;
constexpr double kRigid = 1e-7;

/// One module that forces move: what a unit of its position and of its force make of everything.
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

}  // namespace

Eigen::MatrixXd monodromy(const scene::Scene& scene, const Rates& rates) {
  LinearStepper stepper(linearPart(scene), rates);
  const int slots = stepper.slots();
  const std::vector<Column> columns = columnsOf(stepper);
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  // A force waits in the state to move its module together with the difference. Both act alike, so
  // they are one number, here a force, scaled to move as much as a unit of position: eigenvalues
  // of badly scaled matrices are inexact.
  const auto reduce = [&](const Eigen::VectorXd& state, Eigen::Index to, double scale) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const Column& row = columns[static_cast<std::size_t>(i)];
      const double force =
          state[2 * slots + row.slot] + row.force_per_difference * state[slots + row.slot];
      matrix(i, to) = scale * state[row.slot];
      matrix(n + i, to) = scale * force * row.reach;
    }
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    const Column& column = columns[static_cast<std::size_t>(j)];
    reduce(column.of_position, j, 1.0);
    reduce(column.of_force, n + j, 1.0 / column.reach);
  }
  return matrix;
}

double spectralRadius(const Eigen::MatrixXd& matrix) {
  double radius = 0.0;
  if (matrix.size() == 0) {
    return radius;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  for (const std::complex<double>& value : solver.eigenvalues()) {
    const double size = std::abs(value);
    const bool is_rigid = std::abs(value - 1.0) < kNearOne && size <= 1.0 + kRigid;
    radius = std::max(radius, is_rigid ? 1.0 : size);
  }
  return radius;
}

}  // namespace ergotic::physics
