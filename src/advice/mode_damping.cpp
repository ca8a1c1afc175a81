// SPDX-License-Identifier: BSD-3-Clause
#include "advice/mode_damping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "algebra/damped_pole.hpp"
#include "algebra/decompositions.hpp"
#include "at.hpp"

namespace ergotic::physics {
namespace {

using Complex = std::complex<double>;

constexpr double kShared = 1e-9;    // of a shape that losses make of a mode: they share it
constexpr double kExact = 1e-11;    // relative, of a pole
constexpr double kOneMode = 0.99;   // of two shapes
constexpr int kMaxProjected = 200;  // modes among which the problem is solved
constexpr int kMaxRefinements = 6;

class Damping {
 public:
  Damping(const ModePart& part, const EigenPairs& pairs, int count)
      : part_(part),
        loss_(part.loss),
        both_(part.loss + part.pull),
        scale_(pairs.values.size() > 0 ? both_.diagonal().maxCoeff() : 0.0),
        count_(count),
        kappa_(pairs.values.tail(pairs.values.size() - pairs.rigid)),
        vectors_(pairs.vectors.rightCols(pairs.values.size() - pairs.rigid)) {
    shareTurns();
  }

  std::vector<DampedMode> run() {
    const Eigen::MatrixXd lost = loss_ * vectors_;
    for (int i = 0; i < count_; ++i) {
      const double zeta = vectors_.col(i).dot(lost.col(i));
      DampedMode mode;
      mode.w = poleOf(kappa_[i], zeta);
      mode.shape = vectors_.col(i).cast<Complex>();
      // What losses make of a mode that is another one.
      const double strange = (lost.col(i) - zeta * vectors_.col(i)).norm();
      mode.error = strange / std::abs(2.0 * mode.w + kappa_[i] + zeta);
      modes_.push_back(std::move(mode));
    }
    if (std::any_of(modes_.begin(), modes_.end(),
                    [](const DampedMode& mode) { return mode.error > kShared; })) {
      project(lost);
      refine();
    }
    for (DampedMode& mode : modes_) {
      mode.error = isExact(mode) ? 0.0 : mode.error;
    }
    return std::move(modes_);
  }

 private:
  /// Turns modes of one frequency to those that the losses decouple.
  void shareTurns() {
    for (Eigen::Index first = 0; first < kappa_.size();) {
      Eigen::Index next = first + 1;
      while (next < kappa_.size() && kappa_[next] - kappa_[first] <= 1e-10 * kappa_[next]) {
        ++next;
      }
      if (next > first + 1) {
        const Eigen::MatrixXd same = vectors_.middleCols(first, next - first);
        vectors_.middleCols(first, next - first) =
            same * algebra::symmetricModes(same.transpose() * (loss_ * same)).vectors;
      }
      first = next;
    }
  }

  /// How far w may be off, to first order, relative.
  double errorOf(const DampedMode& mode) const {
    const Complex w = mode.w;
    const Eigen::VectorXcd of_both = both_ * mode.shape;
    const Eigen::VectorXcd of_pull = part_.pull * mode.shape;
    const Eigen::VectorXcd rest = w * w * mode.shape + w * of_both + of_pull;
    const Complex slope = 2.0 * w * square(mode.shape) + product(mode.shape, of_both);
    return rest.norm() * mode.shape.norm() / (std::abs(slope) * std::abs(w));
  }

  /// True if the remaining error is rounding.
  bool isExact(const DampedMode& mode) const {
    const double rounding =
        16.0 * std::numeric_limits<double>::epsilon() * scale_ / std::norm(mode.w);
    return mode.error <= std::max(kExact, rounding);
  }

  static Complex product(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    return (a.transpose() * b)(0, 0);
  }
  static Complex square(const Eigen::VectorXcd& a) { return product(a, a); }

  /// The problem among all modes that are known. Those of motions as a whole are not among them.
  void project(const Eigen::MatrixXd& lost) {
    const Eigen::Index size = std::min<Eigen::Index>(kappa_.size(), kMaxProjected);
    const Eigen::VectorXd root = kappa_.head(size).cwiseMax(0.0).cwiseSqrt();
    if (size < count_ || kappa_.head(size).minCoeff() < 0.0) {
      return;
    }
    const Eigen::MatrixXd basis = vectors_.leftCols(size);
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(2 * size, 2 * size);
    step.topRightCorner(size, size) = root.asDiagonal();
    step.bottomLeftCorner(size, size) = -Eigen::MatrixXd(root.asDiagonal());
    step.bottomRightCorner(size, size) = -(basis.transpose() * lost.leftCols(size));
    step.bottomRightCorner(size, size).diagonal() -= kappa_.head(size);
    const algebra::GeneralModes modes = algebra::generalModes(step);
    if (!modes.converged) {
      return;
    }
    const Eigen::VectorXcd& values = modes.values;
    std::vector<Eigen::Index> order;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (values[i].imag() >= 0.0) {
        order.push_back(i);
      }
    }
    // What swings first, then the slower of two that creep.
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
      const bool swings_a = values[a].imag() > 0.0;
      const bool swings_b = values[b].imag() > 0.0;
      return swings_a != swings_b ? swings_a : std::abs(values[a]) < std::abs(values[b]);
    });
    std::vector<unsigned char> is_given(static_cast<std::size_t>(size), 0);
    const Eigen::MatrixXcd& eigenvectors = modes.vectors;
    for (const Eigen::Index i : order) {
      const Eigen::VectorXcd shares = eigenvectors.col(i).tail(size);
      Eigen::Index best = -1;
      for (Eigen::Index j = 0; j < size; ++j) {
        const bool is_free = is_given[static_cast<std::size_t>(j)] == 0;
        best = is_free && (best < 0 || std::abs(shares[j]) > std::abs(shares[best])) ? j : best;
      }
      if (best < 0) {
        break;
      }
      is_given[static_cast<std::size_t>(best)] = 1;
      if (best < count_) {
        DampedMode& mode = modes_[static_cast<std::size_t>(best)];
        mode.w = values[i];
        mode.shape = basis * shares;
        algebra::normalize(mode.shape);
        mode.error = errorOf(mode);
      }
    }
  }

  void refine() {
    for (int i = 0; i < count_; ++i) {
      DampedMode& mode = modes_[at(i)];
      const DampedMode first = mode;
      for (int k = 0; k < kMaxRefinements && !isExact(mode); ++k) {
        DampedMode next = refined(mode);
        if (!(next.error < mode.error)) {
          break;
        }
        mode = std::move(next);
      }
      if (isThereTwice(i)) {
        mode = first;
      }
    }
  }

  bool isThereTwice(int i) const {
    for (int j = 0; j < count_; ++j) {
      const DampedMode& a = modes_[at(i)];
      const DampedMode& b = modes_[at(j)];
      if (j != i && std::abs(a.w - b.w) <= 1e-9 * std::abs(a.w) &&
          std::abs(product(a.shape, b.shape)) > kOneMode) {
        return true;
      }
    }
    return false;
  }

  DampedMode refined(const DampedMode& mode) {
    DampedMode next = mode;
    next.error = std::numeric_limits<double>::infinity();
    const auto pole = algebra::refinedPole(both_, part_.pull, {mode.w, mode.shape});
    if (pole) {
      next.w = pole->w;
      next.shape = pole->shape;
      next.error = errorOf(next);
    }
    return next;
  }

  const ModePart& part_;
  const Eigen::SparseMatrix<double>& loss_;
  Eigen::SparseMatrix<double> both_;
  double scale_;
  int count_;
  Eigen::VectorXd kappa_;
  Eigen::MatrixXd vectors_;
  std::vector<DampedMode> modes_;
};

}  // namespace

std::complex<double> poleOf(double kappa, double zeta) {
  const double sum = kappa + zeta;
  const double square = sum * sum - 4.0 * kappa;
  if (square < 0.0) {
    return {-0.5 * sum, 0.5 * std::sqrt(-square)};
  }
  const double root = std::sqrt(square);
  // kappa over the larger one, without cancellation; of two it is the slower that is heard, unless
  // the other leaves the circle.
  const double fast = sum > 0.0 ? -0.5 * (sum + root) : -0.5 * (sum - root);
  const double slow = fast == 0.0 ? 0.0 : kappa / fast;
  return std::abs(1.0 + fast) > std::abs(1.0 + slow) ? fast : slow;
}

std::vector<DampedMode> dampedModesOf(const ModePart& part, const EigenPairs& pairs, int count) {
  return Damping(part, pairs, count).run();
}

}  // namespace ergotic::physics
