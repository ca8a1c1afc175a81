// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/sleep_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include "at.hpp"
#include "physics/network/section_stiffness.hpp"
#include "physics/note.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kSmallestPivot = 1e-13;  // of the largest: below, it is rounding

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

/// Energy of a spring whose ends are at `a` and `b`.
double springEnergy(const scene::Scene& scene,
                    const scene::Lia& lia,
                    double stiffness,
                    const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b) {
  const Geometry geometry = scene.sectionOf(scene.mats[at(lia.a)]).geometry;
  const Eigen::Vector3d line = a - b;
  const double reach = geometry == Geometry::kScalar ? line.x() : movingPart(line, geometry).norm();
  const double e = reach - lia.rest_length;
  return 0.5 * stiffness * e * e;
}

/// Elongation of a cell's spring at the start: from x = 0, or in Euclidean sections from its rest.
Eigen::Vector3d stretchOf(const scene::Scene& scene, const scene::Mat& cell) {
  const Geometry geometry = scene.sectionOf(cell).geometry;
  return geometry == Geometry::kScalar ? Eigen::Vector3d(cell.position.x(), 0.0, 0.0)
                                       : movingPart(cell.position - cell.rest, geometry);
}

/// Energy of a section at the start, in motion and in its own springs, beyond that at rest.
double startEnergy(const Network& network, int section) {
  const scene::Scene& scene = network.scene;
  const auto isInside = [&](int m) { return scene.mats[at(m)].section == section; };
  const Geometry geometry = scene.sections[at(section)].geometry;
  double energy = 0.0;
  for (int m = 0; m < static_cast<int>(network.nodes.size()); ++m) {
    const Network::Node& node = network.nodes[at(m)];
    if (node.is_free && isInside(m)) {
      const scene::Mat& mat = scene.mats[at(m)];
      energy += 0.5 * node.mass.now * movingPart(mat.push->velocity, geometry).squaredNorm();
      energy += 0.5 * node.stiffness.now * stretchOf(scene, mat).squaredNorm();
    }
  }
  for (std::size_t l = 0; l < network.links.size(); ++l) {
    const scene::Lia& lia = scene.lias[l];
    if (isInside(lia.a) && isInside(lia.b)) {
      const scene::Mat& a = scene.mats[at(lia.a)];
      const scene::Mat& b = scene.mats[at(lia.b)];
      const double k = network.links[l].at_least;
      energy += springEnergy(scene, lia, k, a.position, b.position) -
                springEnergy(scene, lia, k, a.rest, b.rest);
    }
  }
  return energy;
}

bool isHeard(const scene::Scene& scene, int section) {
  return std::any_of(scene.outputs.begin(), scene.outputs.end(), [&](const scene::Output& output) {
    return scene.mats[at(output.point.mat)].section == section;
  });
}

std::string noteOnSleep(const Network& network, int index) {
  const scene::Scene& scene = network.scene;
  const scene::Section& section = scene.sections[at(index)];
  std::string text = noteAt(scene, section.place) + "section '" + section.name + "' sleeps below " +
                     shortly(section.sleep_energy / (scene.time_unit_s * scene.time_unit_s)) +
                     " J: ";
  const double distance = sleepingDistance(network, index);
  if (!std::isfinite(distance)) {
    return text +
           "how far its modules then are from rest has no bound, because springs of its "
           "own do not hold all of them";
  }
  text += "its modules are then at most " + shortly(distance) + " m from rest";
  const double start = startEnergy(network, index);
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

double sleepingDistance(const Network& network, int section) {
  const double energy = network.scene.sections[at(section)].sleep_energy;
  return std::sqrt(2.0 * energy * largestCompliance(stiffnessOf(network, section)));
}

void noteSleep(const scene::Scene& scene, std::vector<std::string>& notes) {
  const auto maySleep = [](const scene::Section& section) { return section.sleep_energy > 0.0; };
  if (std::none_of(scene.sections.begin(), scene.sections.end(), maySleep)) {
    return;
  }
  const Network network(scene);
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    if (maySleep(scene.sections[s])) {
      notes.push_back(noteOnSleep(network, static_cast<int>(s)));
    }
  }
}

}  // namespace ergotic::physics
