// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/load_matrix.hpp"
#include "physics/network/network_analysis.hpp"

namespace ergotic::physics {
namespace {

constexpr double kPrecision = 2e-7;  // of a step; lambda goes with its square
constexpr double kPivotMargin = 1e-9;
constexpr double kHeld = 1e-6;   // of the norm, what counts as held
constexpr int kIterations = 20;  // of Collatz-Wielandt
constexpr int kRounds = 100;
constexpr int kInverseIterations = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Matrix = Eigen::SparseMatrix<double>;

Eigen::VectorXd scaleOf(const NetworkBound& network) {
  Eigen::VectorXd scale(network.nodes());
  for (int i = 0; i < network.nodes(); ++i) {
    scale[i] = 1.0 / std::sqrt(network.mass(i));
  }
  return scale;
}

/// Lower triangle of sum k u u^T for unit masses, with a place for every pair of nodes of a link
/// and for the diagonal.
template <class CoefficientOf>
Matrix assemble(const NetworkBound& network,
                const Eigen::VectorXd& scale,
                CoefficientOf coefficient) {
  LoadMatrix matrix(network.nodes());
  for (int i = 0; i < network.nodes(); ++i) {
    matrix.add(i, i, 0.0);
  }
  for (const NetworkBound::Link& link : network.links()) {
    const double k = coefficient(link);
    for (const Share& a : link.ends) {
      for (const Share& b : link.ends) {
        if (a.node >= b.node) {
          const double u = a.weight * scale[a.node];
          matrix.add(a.node, b.node, k * u * (b.weight * scale[b.node]));
        }
      }
    }
  }
  return matrix.sum();
}

bool isFinite(const Matrix& matrix) {
  return std::all_of(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
                     [](double v) { return std::isfinite(v); });
}

double quadratic(const Matrix& lower, const Eigen::VectorXd& x) {
  return x.dot(lower.selfadjointView<Eigen::Lower>() * x);
}

double normOf(const Matrix& lower) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(lower.rows());
  for (int column = 0; column < lower.outerSize(); ++column) {
    for (Matrix::InnerIterator it(lower, column); it; ++it) {
      rows[it.row()] += std::abs(it.value());
      rows[column] += it.row() == column ? 0.0 : std::abs(it.value());
    }
  }
  return rows.size() == 0 ? 0.0 : rows.maxCoeff();
}

bool allPivotsPositive(const Eigen::SimplicialLDLT<Matrix>& solver) {
  return solver.info() == Eigen::Success && (solver.vectorD().array() > 0.0).all();
}

/// \param nodes  of the network, one for each row
Factor factorOf(const Eigen::SimplicialLDLT<Matrix>& solver,
                const NetworkBound& network,
                const std::vector<int>& nodes) {
  Factor factor;
  const Eigen::VectorXd pivots = solver.vectorD();
  factor.pivots.assign(pivots.begin(), pivots.end());
  factor.modules.resize(factor.pivots.size());
  for (int row = 0; row < static_cast<int>(nodes.size()); ++row) {
    factor.modules[at(solver.permutationP().indices()[row])] = network.ownerOf(nodes[at(row)]);
  }
  const Matrix& below = solver.matrixL().nestedExpression();
  for (int column = 0; column < below.outerSize(); ++column) {
    for (Matrix::InnerIterator it(below, column); it; ++it) {
      factor.below.push_back({static_cast<int>(it.row()), column, it.value()});
    }
  }
  return factor;
}

std::vector<int> allNodes(const NetworkBound& network) {
  std::vector<int> nodes(at(network.nodes()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

/// What shows that the eigenvalues of some rows are above a margin. \param margin  of their norm
std::optional<Factor> factorAbove(const NetworkBound& network,
                                  const Matrix& lower,
                                  const std::vector<int>& nodes,
                                  double margin) {
  if (!isFinite(lower)) {
    return std::nullopt;
  }
  const double norm = normOf(lower);
  if (norm == 0.0) {
    return std::nullopt;
  }
  Matrix shifted = lower;
  for (int i = 0; i < shifted.rows(); ++i) {
    shifted.coeffRef(i, i) -= margin * norm;
  }
  const Eigen::SimplicialLDLT<Matrix> solver(shifted);
  return allPivotsPositive(solver) ? std::optional<Factor>(factorOf(solver, network, nodes))
                                   : std::nullopt;
}

/// Nodes of all that hangs together with something negative.
template <class CoefficientOf>
std::vector<int> besideNegative(const NetworkBound& network, CoefficientOf coefficient) {
  DisjointSets bodies(at(network.nodes()));
  for (const NetworkBound::Link& link : network.links()) {
    for (const Share& end : link.ends) {
      if (coefficient(link) != 0.0) {
        bodies.join(end.node, link.ends.front().node);
      }
    }
  }
  std::set<int> negative;
  for (const NetworkBound::Link& link : network.links()) {
    if (coefficient(link) < 0.0 && !link.ends.empty()) {
      negative.insert(bodies.setOf(link.ends.front().node));
    }
  }
  std::vector<int> nodes = allNodes(network);
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                             [&](int n) { return negative.count(bodies.setOf(n)) == 0; }),
              nodes.end());
  return nodes;
}

/// What is negative lets all that hangs together with it grow unless the whole is definite: how
/// slowly is a matter of the norm, but however little is missing it grows.
template <class CoefficientOf>
std::optional<Factor> definiteBesideNegative(const NetworkBound& network,
                                             CoefficientOf coefficient) {
  const std::vector<int> nodes = besideNegative(network, coefficient);
  Matrix select(network.nodes(), static_cast<int>(nodes.size()));
  for (int row = 0; row < select.cols(); ++row) {
    select.insert(nodes[at(row)], row) = 1.0;
  }
  const Matrix lower = assemble(network, scaleOf(network), coefficient);
  const Matrix whole = lower.selfadjointView<Eigen::Lower>();
  const Matrix part = Matrix(select.transpose() * whole * select).triangularView<Eigen::Lower>();
  return factorAbove(network, part, nodes, kPivotMargin);
}

/// A direction that no mode is orthogonal to; the same at every run.
Eigen::VectorXd anyDirection(int count) {
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::VectorXd direction(count);
  for (double& each : direction) {
    each = number(random);
  }
  return direction;
}

}  // namespace

NetworkSpectrum::NetworkSpectrum(const NetworkBound& network)
    : network_(network), scale_(scaleOf(network)), mode_(anyDirection(network.nodes())) {
  pencil_.limit = NetworkBound::kLimit * (1.0 - kPivotMargin);
  pencil_.stiffness = assemble(
      network, scale_, [](const NetworkBound::Link& link) { return link.stiffness.highest; });
  pencil_.damping = assemble(network, scale_,
                             [](const NetworkBound::Link& link) { return link.damping.highest; });
  for (const NetworkBound::MovingLink& link : network.movingLinks()) {
    pencil_.moving_stiffness.push_back(link.stiffness);
    pencil_.moving_damping.push_back(link.damping);
  }
  const NetworkBound everywhere = network.withMovingEverywhere();
  bound_ = std::min(everywhere.linkBound(), everywhere.collatzWielandtBound(kIterations));
  finite_ = physics::isFinite(pencil_.stiffness) && physics::isFinite(pencil_.damping) &&
            std::isfinite(bound_);
  if (finite_) {
    solver_.analyzePattern(pencil_.stiffness);
  }
}

Factor NetworkSpectrum::factorAtLimit() {
  Pencil pencil = pencil_;
  pencil.limit = NetworkAnalysis::kProven;
  return isDefinite(pencil, network_.step()) ? factorOf(solver_, network_, allNodes(network_))
                                             : Factor{};
}

std::optional<Factor> NetworkSpectrum::semidefiniteStiffness(const NetworkBound& network) {
  return definiteBesideNegative(
      network, [](const NetworkBound::Link& link) { return link.stiffness.lowest; });
}

std::optional<Factor> NetworkSpectrum::semidefiniteDamping(const NetworkBound& network) {
  return definiteBesideNegative(network,
                                [](const NetworkBound::Link& link) { return link.damping.lowest; });
}

std::optional<Factor> NetworkSpectrum::definiteDamping(const NetworkBound& network) {
  const Matrix softest = assemble(network, scaleOf(network), [](const NetworkBound::Link& link) {
    return link.damping.lowest;
  });
  return factorAbove(network, softest, allNodes(network), kPivotMargin);
}

double NetworkSpectrum::softness(const NetworkBound& network, const Shares& u) {
  const Eigen::VectorXd scale = scaleOf(network);
  Matrix lower = assemble(network, scale, [](const auto& link) { return link.stiffness.lowest; });
  const double norm = normOf(lower);
  if (u.empty() || !(norm > 0.0) || !physics::isFinite(lower)) {
    return kInfinity;
  }
  for (int i = 0; i < lower.rows(); ++i) {
    lower.coeffRef(i, i) += kPivotMargin * norm;
  }
  const Eigen::SimplicialLDLT<Matrix> solver(lower);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(network.nodes());
  for (const Share& share : u) {
    force[share.node] += share.weight * scale[share.node];
  }
  const double give = allPivotsPositive(solver) ? force.dot(solver.solve(force)) : kInfinity;
  return give * norm * kHeld < force.squaredNorm() ? give : kInfinity;
}

bool NetworkSpectrum::isDefinite(const Pencil& pencil, double t) {
  Matrix matrix = pencil.stiffness;
  const double* z = pencil.damping.valuePtr();
  double* values = matrix.valuePtr();
  for (Eigen::Index i = 0; i < matrix.nonZeros(); ++i) {
    values[i] = -t * (t * values[i] + 2.0 * z[i]);
  }
  for (int i = 0; i < matrix.rows(); ++i) {
    values[matrix.outerIndexPtr()[i]] += pencil.limit;  // the first of its column
  }
  solver_.factorize(matrix);
  return allPivotsPositive(solver_);
}

/// max over the places of u^T P^-1 u.
double NetworkSpectrum::placeCompliance(const NetworkBound::MovingLink& link) const {
  double largest = 0.0;
  Eigen::VectorXd u(network_.nodes());
  for (const Shares& place : link.places) {
    u.setZero();
    for (const Share& share : place) {
      u[share.node] += share.weight * scale_[share.node];
    }
    largest = std::max(largest, u.dot(solver_.solve(u)));
  }
  return largest;
}

/// P - sum a u u^T is definite if P is and sum a u^T P^-1 u < 1; with one link: only if, too.
bool NetworkSpectrum::holds(const Pencil& pencil, double t) {
  if (!isDefinite(pencil, t)) {
    return false;
  }
  double taken = 0.0;
  for (std::size_t l = 0; l < network_.movingLinks().size(); ++l) {
    const double load = t * (t * pencil.moving_stiffness[l] + 2.0 * pencil.moving_damping[l]);
    taken += load > 0.0 ? load * placeCompliance(network_.movingLinks()[l]) : 0.0;
  }
  return taken < 1.0;
}

double NetworkSpectrum::reach(const Pencil& pencil) const {
  const double norm = mode_.squaredNorm();
  const double k = quadratic(pencil.stiffness, mode_) / norm;
  const double z = quadratic(pencil.damping, mode_) / norm;
  const double root = z * z + pencil.limit * k;
  const double below = z + std::sqrt(std::max(root, 0.0));
  return root >= 0.0 && below > 0.0 ? pencil.limit / below : kInfinity;
}

/// From below by factorisation, from above by Rayleigh quotients; inverse iteration turns the mode
/// towards the one that is first to fail.
double NetworkSpectrum::longestAtRest(const Pencil& pencil, double proven) {
  double refuted = kInfinity;
  double part = 0.1;  // of what is undecided, from above
  bool is_factorised = false;
  for (int round = 0; round < kRounds; ++round) {
    if (!is_factorised && !isDefinite(pencil, proven)) {
      return 0.0;
    }
    for (int i = 0; i < kInverseIterations; ++i) {
      mode_ = solver_.solve(mode_).normalized();
      refuted = std::min(refuted, reach(pencil));
    }
    if (refuted - proven <= kPrecision * refuted) {
      break;
    }
    const double t = std::isfinite(refuted) ? refuted - part * (refuted - proven) : 2.0 * proven;
    is_factorised = isDefinite(pencil, t);
    (is_factorised ? proven : refuted) = t;
    part = is_factorised ? 0.1 : 0.5;
  }
  return proven;
}

double NetworkSpectrum::longest(const Pencil& pencil, double proven) {
  double highest = longestAtRest(pencil, proven);
  if (network_.movingLinks().empty() || holds(pencil, highest)) {
    return highest;
  }
  double lowest = std::min(proven, highest);
  while (highest - lowest > kPrecision * highest) {
    const double middle = 0.5 * (lowest + highest);
    (holds(pencil, middle) ? lowest : highest) = middle;
  }
  return lowest;
}

double NetworkSpectrum::lambda() {
  const double h = network_.step();
  Pencil here = pencil_;
  here.stiffness = h * h * pencil_.stiffness + 2.0 * h * pencil_.damping;
  here.damping = 0.0 * pencil_.damping;
  here.limit = 1.0;
  for (std::size_t l = 0; l < here.moving_stiffness.size(); ++l) {
    here.moving_stiffness[l] =
        h * h * pencil_.moving_stiffness[l] + 2.0 * h * pencil_.moving_damping[l];
    here.moving_damping[l] = 0.0;
  }
  if (!(bound_ > 0.0)) {
    return 0.0;
  }
  const double proven = (1.0 - kPivotMargin) / std::sqrt(bound_);
  const double t = longest(here, proven);
  lambda_ = std::min(bound_, 1.0 / (t * t));
  if (lambda_ >= pencil_.limit) {
    const bool is_below = holds(here, 1.0 / std::sqrt(pencil_.limit));
    lambda_ = is_below ? pencil_.limit : std::max(lambda_, NetworkBound::kLimit);
  }
  findWorst();
  return lambda_;
}

void NetworkSpectrum::findWorst() {
  const double h = network_.step();
  double largest = 0.0;
  for (const NetworkBound::Link& link : network_.links()) {
    double strain = 0.0;
    for (const Share& share : link.ends) {
      strain += share.weight * scale_[share.node] * mode_[share.node];
    }
    const double energy =
        (h * h * link.stiffness.highest + 2.0 * h * link.damping.highest) * strain * strain;
    if (energy > largest) {
      largest = energy;
      worst_link_ = link.label;
      const auto most =
          std::max_element(link.ends.begin(), link.ends.end(), [&](const Share& a, const Share& b) {
            return std::abs(mode_[a.node]) < std::abs(mode_[b.node]);
          });
      worst_owner_ = network_.ownerOf(most->node);
    }
  }
}

double NetworkSpectrum::longestStep() {
  if (!(bound_ > 0.0)) {
    return kInfinity;
  }
  // lambda grows at least as h and at most as h^2.
  const double h = network_.step();
  const double stretch = pencil_.limit / lambda_;
  const double proven = h * std::min(stretch, std::sqrt(stretch)) * (1.0 - kPivotMargin);
  return longest(pencil_, std::max(proven, network_.withMovingEverywhere().stableStep() *
                                               (1.0 - kPivotMargin)));
}

}  // namespace ergotic::physics
