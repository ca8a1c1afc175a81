// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/sleep_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include "physics/laws/slopes.hpp"
#include "physics/note.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::LiaType;
using scene::MatType;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kSmallestPivot = 1e-13;  // of the largest: below, it is rounding

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Entries of K^-1 where L has some, from the last column to the first.
class SelectedInverse {
 public:
  SelectedInverse(const Sparse& lower, const Eigen::VectorXd& pivots)
      : lower_(lower),
        diagonal_(pivots.size()),
        entries_(static_cast<std::size_t>(lower.nonZeros())) {
    for (int j = static_cast<int>(pivots.size()) - 1; j >= 0; --j) {
      fillColumn(j, pivots[j]);
    }
  }
  const Eigen::VectorXd& diagonal() const { return diagonal_; }

 private:
  int begin(int column) const { return lower_.outerIndexPtr()[column]; }
  int end(int column) const { return lower_.outerIndexPtr()[column + 1]; }
  int row(int entry) const { return lower_.innerIndexPtr()[entry]; }

  double entry(int a, int b) const {
    if (a == b) {
      return diagonal_[a];
    }
    const int* const rows = lower_.innerIndexPtr();
    const int column = std::min(a, b);
    const int* const found =
        std::lower_bound(rows + begin(column), rows + end(column), std::max(a, b));
    return entries_[at(static_cast<int>(found - rows))];
  }

  void fillColumn(int j, double pivot) {
    diagonal_[j] = 1.0 / pivot;
    for (int p = end(j) - 1; p >= begin(j); --p) {
      double sum = 0.0;
      for (int q = begin(j); q < end(j); ++q) {
        sum -= lower_.valuePtr()[q] * entry(row(p), row(q));
      }
      entries_[at(p)] = sum;
      diagonal_[j] -= lower_.valuePtr()[p] * sum;
    }
  }

  const Sparse& lower_;
  Eigen::VectorXd diagonal_;
  std::vector<double> entries_;
};

/// The coordinates that move, the others 0.
Eigen::Vector3d moving(const Eigen::Vector3d& v, int dimensions) {
  return {v.x(), dimensions > 1 ? v.y() : 0.0, dimensions > 2 ? v.z() : 0.0};
}

/// Of the spring that a link is at least; 0 if it may let go.
double springOf(const scene::Scene& scene, const scene::Lia& lia) {
  const double k = rangeOf(scene, lia.stiffness).lowest;
  switch (lia.type) {
    case LiaType::kSpringDamper:
      return k;
    case LiaType::kQuadratic:
    case LiaType::kCubic:
      return rangeOf(scene, lia.law->nonlinearity).lowest < 0.0 ? 0.0 : k;
    case LiaType::kClippedCubic:
      return std::min(k, rangeOf(scene, lia.law->stiffness_limit).lowest);
    default:
      return 0.0;
  }
}

/// Rows of K: the coordinates of the free modules of a section.
class Assembly {
 public:
  Assembly(const scene::Scene& scene, int section)
      : scene_(scene),
        section_(section),
        geometry_(scene.sections[at(section)].geometry),
        dimensions_(scene::dimensionsOf(geometry_)),
        row_(scene.mats.size(), -1) {
    for (std::size_t m = 0; m < scene.mats.size(); ++m) {
      const scene::Mat& mat = scene.mats[m];
      if (mat.section == section && (mat.type == MatType::kMass || mat.type == MatType::kCell)) {
        row_[m] = rows_;
        rows_ += dimensions_;
      }
    }
  }

  Sparse run() {
    for (std::size_t m = 0; m < scene_.mats.size(); ++m) {
      const scene::Mat& mat = scene_.mats[m];
      if (row_[m] >= 0 && mat.type == MatType::kCell) {
        addBlock(row_[m], row_[m],
                 rangeOf(scene_, mat.stiffness).lowest * Eigen::Matrix3d::Identity());
      }
    }
    for (const scene::Lia& lia : scene_.lias) {
      const double k = springOf(scene_, lia);
      if (k != 0.0 && isInside(lia.a) && isInside(lia.b)) {
        addSpring(lia, k);
      }
    }
    Sparse stiffness(rows_, rows_);
    stiffness.setFromTriplets(triplets_.begin(), triplets_.end());
    return stiffness;
  }

 private:
  /// Ground ends hold as well; points are not counted on, and neither is what is moved from
  /// outside.
  bool isInside(int m) const {
    return row_[at(m)] >= 0 ||
           (scene_.mats[at(m)].section == section_ && scene_.mats[at(m)].type == MatType::kGround);
  }

  /// What a spring of stiffness 1 does between its two ends.
  Eigen::Matrix3d tangent(const scene::Lia& lia) const {
    if (geometry_ == Geometry::kScalar || geometry_ == Geometry::kLine) {
      return Eigen::Matrix3d::Identity();
    }
    const Eigen::Vector3d line =
        moving(scene_.mats[at(lia.a)].rest - scene_.mats[at(lia.b)].rest, dimensions_);
    const double length = line.norm();
    if (!(length > 0.0)) {
      return lia.rest_length == 0.0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                    : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
    }
    const double across = 1.0 - lia.rest_length / length;
    const Eigen::Vector3d n = line / length;
    return across * Eigen::Matrix3d::Identity() + (1.0 - across) * n * n.transpose();
  }

  void addSpring(const scene::Lia& lia, double k) {
    const Eigen::Matrix3d block = k * tangent(lia);
    for (const int to : {lia.a, lia.b}) {
      for (const int from : {lia.a, lia.b}) {
        if (row_[at(to)] >= 0 && row_[at(from)] >= 0) {
          addBlock(row_[at(to)], row_[at(from)], to == from ? block : -block);
        }
      }
    }
  }

  void addBlock(int row, int column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < dimensions_; ++i) {
      for (int j = 0; j < dimensions_; ++j) {
        triplets_.emplace_back(row + i, column + j, block(i, j));
      }
    }
  }

  const scene::Scene& scene_;
  int section_;
  Geometry geometry_;
  int dimensions_;
  int rows_ = 0;
  std::vector<int> row_;
  std::vector<Eigen::Triplet<double>> triplets_;
};

/// Energy of a spring whose ends are at `a` and `b`.
double springEnergy(const scene::Scene& scene,
                    const scene::Lia& lia,
                    const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b) {
  const scene::Section& section = scene.sectionOf(scene.mats[at(lia.a)]);
  const int dimensions = scene::dimensionsOf(section.geometry);
  const Eigen::Vector3d line = a - b;
  const double reach =
      section.geometry == Geometry::kScalar ? line.x() : moving(line, dimensions).norm();
  const double e = reach - lia.rest_length;
  return 0.5 * springOf(scene, lia) * e * e;
}

/// Of the spring of a cell at the start: to x = 0, or in Euclidean sections to its rest.
Eigen::Vector3d stretchOf(const scene::Scene& scene, const scene::Mat& cell) {
  const Geometry geometry = scene.sectionOf(cell).geometry;
  return geometry == Geometry::kScalar
             ? Eigen::Vector3d(cell.position.x(), 0.0, 0.0)
             : moving(cell.position - cell.rest, scene::dimensionsOf(geometry));
}

/// What a section has at the start more than at rest, in the springs of its own and in motion.
double startEnergy(const scene::Scene& scene, int section) {
  const auto isInside = [&](int m) { return scene.mats[at(m)].section == section; };
  const int dimensions = scene::dimensionsOf(scene.sections[at(section)].geometry);
  double energy = 0.0;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.section == section && (mat.type == MatType::kMass || mat.type == MatType::kCell)) {
      energy +=
          0.5 * scene.valueOf(mat.mass) * moving(mat.push->velocity, dimensions).squaredNorm();
    }
    if (mat.section == section && mat.type == MatType::kCell) {
      energy += 0.5 * scene.valueOf(mat.stiffness) * stretchOf(scene, mat).squaredNorm();
    }
  }
  for (const scene::Lia& lia : scene.lias) {
    if (isInside(lia.a) && isInside(lia.b)) {
      const scene::Mat& a = scene.mats[at(lia.a)];
      const scene::Mat& b = scene.mats[at(lia.b)];
      energy += springEnergy(scene, lia, a.position, b.position) -
                springEnergy(scene, lia, a.rest, b.rest);
    }
  }
  return energy;
}

bool isHeard(const scene::Scene& scene, int section) {
  return std::any_of(scene.outputs.begin(), scene.outputs.end(), [&](const scene::Output& output) {
    return scene.mats[at(output.point.mat)].section == section;
  });
}

std::string noteOn(const scene::Scene& scene, int index) {
  const scene::Section& section = scene.sections[at(index)];
  std::string text = noteAt(scene, section.place) + "section '" + section.name + "' sleeps below " +
                     shortly(section.sleep_energy / (scene.time_unit_s * scene.time_unit_s)) +
                     " J: ";
  const double distance = sleepingDistance(scene, index);
  if (!std::isfinite(distance)) {
    return text +
           "how far its modules then are from rest has no bound, because springs of its "
           "own do not hold all of them";
  }
  text += "its modules are then at most " + shortly(distance) + " m from rest";
  const double start = startEnergy(scene, index);
  if (start > 0.0 && isHeard(scene, index)) {
    const double share = section.sleep_energy / start;
    text += "; that is " + shortly(share) + " of its energy at the start (" +
            shortly(10.0 * std::log10(share)) + " dB)";
  }
  return text;
}

}  // namespace

double largestCompliance(const Sparse& stiffness) {
  if (stiffness.rows() == 0) {
    return 0.0;
  }
  const Eigen::SimplicialLDLT<Sparse> factors(stiffness);
  if (factors.info() != Eigen::Success) {
    return std::numeric_limits<double>::infinity();
  }
  const Eigen::VectorXd pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kSmallestPivot * pivots.maxCoeff())) {
    return std::numeric_limits<double>::infinity();
  }
  const Sparse& lower = factors.matrixL().nestedExpression();
  return SelectedInverse(lower, pivots).diagonal().maxCoeff();
}

Sparse stiffnessOf(const scene::Scene& scene, int section) {
  return Assembly(scene, section).run();
}

double sleepingDistance(const scene::Scene& scene, int section) {
  const double energy = scene.sections[at(section)].sleep_energy;
  return std::sqrt(2.0 * energy * largestCompliance(stiffnessOf(scene, section)));
}

void noteSleep(const scene::Scene& scene, std::vector<std::string>& notes) {
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    if (scene.sections[s].sleep_energy > 0.0) {
      notes.push_back(noteOn(scene, static_cast<int>(s)));
    }
  }
}

}  // namespace ergotic::physics
