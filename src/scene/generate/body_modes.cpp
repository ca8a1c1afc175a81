// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/body_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/SparseCore>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SparseSymShiftSolve.h>
#include <Spectra/SymEigsShiftSolver.h>
#include <Spectra/SymEigsSolver.h>

#include "algebra/decompositions.hpp"
#include "at.hpp"

namespace ergotic::scene {
namespace {

constexpr int kMaxDense = 120;

/// The moving masses of a body.
class Masses {
 public:
  Masses(const Scene& scene, const Tuning& body) : first_(body.first_mat), index_(at(body.mats)) {
    for (int i = 0; i < body.mats; ++i) {
      const Mat& mat = scene.mats[at(first_ + i)];
      const bool moves = mat.type == MatType::kMass || mat.type == MatType::kCell;
      index_[at(i)] = moves ? static_cast<int>(roots_.size()) : -1;
      if (moves) {
        roots_.push_back(std::sqrt(mat.mass.factor));
      }
    }
  }
  int count() const { return static_cast<int>(roots_.size()); }
  /// -1: a ground
  int indexOf(int mat) const { return index_[at(mat - first_)]; }
  double root(int index) const { return roots_[at(index)]; }

  /// M^-1/2 K M^-1/2 of springs and bends together.
  Eigen::SparseMatrix<double> stiffness(const Scene& scene, const Tuning& body) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int l = body.first_lia; l < body.first_lia + body.lias; ++l) {
      const Lia& lia = scene.lias[at(l)];
      const std::array<int, 2> ends{indexOf(lia.a), indexOf(lia.b)};
      for (const int row : ends) {
        for (const int column : ends) {
          if (row >= 0 && column >= 0) {
            const double sign = row == column ? 1.0 : -1.0;
            entries.emplace_back(row, column,
                                 sign * lia.stiffness.factor / (root(row) * root(column)));
          }
        }
      }
    }
    Eigen::SparseMatrix<double> matrix(count(), count());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

 private:
  int first_;
  std::vector<int> index_;
  std::vector<double> roots_;
};

/// Eigenvectors, unit ones.
struct Vectors {
  Eigen::MatrixXd lowest;  // a column each, by eigenvalue
  Eigen::VectorXd top;
};

Vectors denseVectors(const Eigen::SparseMatrix<double>& matrix, int count) {
  const Eigen::MatrixXd vectors = algebra::symmetricModes(Eigen::MatrixXd(matrix)).vectors;
  return {vectors.leftCols(count), vectors.rightCols(1)};
}

Vectors sparseVectors(const Eigen::SparseMatrix<double>& matrix, int count) {
  const auto size = static_cast<int>(matrix.rows());
  // Where it may move as a whole nothing but the shift keeps the matrix from being singular.
  const double shift = -1e-7 * matrix.diagonal().sum() / size;
  Spectra::SparseSymShiftSolve<double> inverse(matrix);
  Spectra::SymEigsShiftSolver<Spectra::SparseSymShiftSolve<double>> low(
      inverse, count, std::min(size, 2 * count + 20), shift);
  low.init();
  low.compute(Spectra::SortRule::LargestMagn, 1000, 1e-13, Spectra::SortRule::SmallestAlge);
  Spectra::SparseSymMatProd<double> product(matrix);
  Spectra::SymEigsSolver<Spectra::SparseSymMatProd<double>> high(product, 1, std::min(size, 40));
  high.init();
  high.compute(Spectra::SortRule::LargestAlge, 1000, 1e-6);
  return {low.eigenvectors(), high.eigenvectors()};
}

/// Energy of a mode in the springs, dampers and bends of a body.
Tuning::Mode energyOf(const Scene& scene, const Tuning& body, const Eigen::VectorXd& shape) {
  const auto x = [&](int mat) { return shape(mat - body.first_mat); };
  Tuning::Mode mode;
  for (int l = body.first_lia; l < body.first_lia + body.lias; ++l) {
    const Lia& lia = scene.lias[at(l)];
    const double e = x(lia.a) - x(lia.b);
    mode.springs += lia.bend < 0 ? lia.stiffness.factor * e * e : 0.0;
    mode.dampers += lia.damping.factor * e * e;
  }
  for (int b = body.first_bend; b < body.first_bend + body.bends; ++b) {
    const Bend& bend = scene.bends[at(b)];
    const double e = std::accumulate(
        bend.ends.begin(), bend.ends.end(), 0.0,
        [&](double sum, const Bend::End& end) { return sum + end.weight * x(end.mat); });
    mode.bends += bend.stiffness.factor * e * e;
  }
  return mode;
}

/// Displacements of the modules of a body, of unit modal mass.
Eigen::VectorXd shapeOf(const Masses& masses, const Tuning& body, const Eigen::VectorXd& vector) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(body.mats);
  for (int i = 0; i < body.mats; ++i) {
    if (const int index = masses.indexOf(body.first_mat + i); index >= 0) {
      shape(i) = vector(index) / masses.root(index);
    }
  }
  return shape;
}

}  // namespace

BodyModes lowestModes(const Scene& scene, const Tuning& body, int count) {
  const Masses masses(scene, body);
  const Eigen::SparseMatrix<double> matrix = masses.stiffness(scene, body);
  const int wanted = std::min(body.rigid + count, masses.count());
  const Vectors vectors =
      masses.count() <= kMaxDense ? denseVectors(matrix, wanted) : sparseVectors(matrix, wanted);
  BodyModes result;
  const Eigen::Index found = std::max<Eigen::Index>(0, vectors.lowest.cols() - body.rigid);
  result.shapes.resize(body.mats, found);
  for (Eigen::Index j = 0; j < found; ++j) {
    result.shapes.col(j) = shapeOf(masses, body, vectors.lowest.col(j + body.rigid));
    result.modes.push_back(energyOf(scene, body, result.shapes.col(j)));
  }
  if (vectors.top.size() > 0) {
    result.top = energyOf(scene, body, shapeOf(masses, body, vectors.top));
  }
  return result;
}

}  // namespace ergotic::scene
