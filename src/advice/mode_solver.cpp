// SPDX-License-Identifier: BSD-3-Clause
#include "advice/mode_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsSolver.h>

#include "algebra/decompositions.hpp"
#include "at.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Matrix>;

constexpr double kSoft = 1e-12;       // of the largest: below, eigenvalues are those of rounding
constexpr double kRigid = 1e-16;      // of the largest: below, a motion as a whole
constexpr int kMaxRigidVectors = 12;  // more are counted only
constexpr int kMaxRounds = 40;        // of iterations beside what was found
constexpr int kBeyond = 4;            // more than are wanted, so that there is a gap
constexpr int kMaxDenseAtAll = 4000;  // rows, where many of their modes are wanted
constexpr double kNothing = 1e-6;     // of 1/(lambda - shift): of what was taken out

/// (P - shift)^-1 beside vectors that are taken out: these have the eigenvalue 0.
class Inverse {
 public:
  using Scalar = double;
  Inverse(const Factor& factor, const Eigen::MatrixXd& without)
      : factor_(factor), without_(without) {}
  Eigen::Index rows() const { return factor_.rows(); }
  Eigen::Index cols() const { return factor_.cols(); }
  // NOLINTNEXTLINE(readability-identifier-naming): Spectra's name
  void perform_op(const double* from, double* to) const {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(from, rows());
    takeOut(x);
    Eigen::VectorXd y = factor_.solve(x);
    takeOut(y);
    Eigen::Map<Eigen::VectorXd>(to, rows()) = y;
  }

 private:
  void takeOut(Eigen::VectorXd& x) const {
    if (without_.cols() > 0) {
      x -= without_ * (without_.transpose() * x);
    }
  }
  const Factor& factor_;
  const Eigen::MatrixXd& without_;
};

struct Inertia {
  int below = 0;
  double doubt = 0.0;  // eigenvalues that are nearer may be on the other side
};

class ModeFinder {
 public:
  ModeFinder(const ModePart& part, const EigenWindow& window)
      : part_(part), window_(window), size_(static_cast<int>(part.rows.size())) {
    scale_ = part.pull.diagonal().cwiseAbs().maxCoeff();
    unit_.resize(size_, size_);
    unit_.setIdentity();
    found_.vectors.resize(size_, 0);
  }

  EigenPairs run() {
    if (!(scale_ > 0.0)) {
      return loose();
    }
    if (size_ <= kMaxDenseRows) {
      dense();
    } else {
      sparse();
    }
    polish();
    return std::move(found_);
  }

 private:
  bool fromBottom() const { return !(window_.from > 0.0); }
  /// True if motions as a whole, and what is as soft, are worked out.
  bool takesSoft() const { return fromBottom() && soft_ <= kMaxRigidVectors; }

  /// The eigenpairs of a part on which no load acts.
  EigenPairs loose() {
    const int count = std::min(size_, kMaxRigidVectors);
    found_.values = Eigen::VectorXd::Zero(fromBottom() ? count : 0);
    found_.vectors = Eigen::MatrixXd::Identity(size_, found_.values.size());
    found_.rigid = static_cast<int>(found_.values.size());
    found_.rigid_in_all = size_;
    return std::move(found_);
  }

  void dense() {
    const algebra::SymmetricModes modes = algebra::symmetricModes(Eigen::MatrixXd(part_.pull));
    if (!modes.converged) {
      throw Exception("the modes of " + std::to_string(size_) + " coordinates are not found");
    }
    const Eigen::VectorXd& all = modes.values;
    const double* const end = all.data() + size_;
    const auto countTo = [&](double value) {
      return static_cast<int>(std::upper_bound(all.data(), end, value) - all.data());
    };
    soft_ = countTo(kSoft * scale_);
    const auto below_from =
        static_cast<int>(std::lower_bound(all.data(), end, window_.from) - all.data());
    const int skipped = takesSoft() ? 0 : std::max(soft_, below_from);
    in_window_ = std::max(0, countTo(window_.to) - skipped);
    const int taken = std::min(size_ - skipped, window_.most + (takesSoft() ? soft_ : 0) + kBeyond);
    found_.values = all.segment(skipped, taken);
    found_.vectors = modes.vectors.middleCols(skipped, taken);
  }

  Matrix shifted(double shift) const { return part_.pull - shift * unit_; }

  Inertia inertiaAt(double shift) const {
    const Factor factor(shifted(shift));
    Inertia inertia{0, std::numeric_limits<double>::infinity()};
    if (factor.info() != Eigen::Success) {
      return inertia;
    }
    const Eigen::VectorXd& d = factor.vectorD();
    Eigen::VectorXd sums = d.cwiseAbs();
    const Matrix& lower = factor.matrixL().nestedExpression();
    for (int column = 0; column < size_; ++column) {
      for (Matrix::InnerIterator it(lower, column); it; ++it) {
        sums[it.row()] += it.value() * it.value() * std::abs(d[column]);
      }
      inertia.below += d[column] < 0.0 ? 1 : 0;
    }
    inertia.doubt = sums.allFinite()
                        ? 8.0 * std::numeric_limits<double>::epsilon() * sums.maxCoeff()
                        : std::numeric_limits<double>::infinity();
    return inertia;
  }

  /// How many lie below some place between two values, as certainly as can be.
  int countWithin(double low, double high) {
    Inertia best{0, std::numeric_limits<double>::infinity()};
    double room = 0.0;
    for (const double share : {0.5, 0.37, 0.61, 0.29, 0.73, 0.43, 0.57}) {
      const Inertia inertia = inertiaAt(low + share * (high - low));
      if (inertia.doubt < best.doubt) {
        best = inertia;
        room = std::min(share, 1.0 - share) * (high - low);
      }
      if (best.doubt < room) {
        return best.below;
      }
    }
    found_.is_certain = false;
    return best.below;
  }

  void sparse() {
    soft_ = countWithin(0.5 * kSoft * scale_, 2.0 * kSoft * scale_);
    int below = 0;
    double shift = -1e-7 * part_.pull.diagonal().sum() / size_;
    if (fromBottom() && !takesSoft()) {
      below = soft_;
      shift = aboveSoft();
    } else if (!fromBottom()) {
      shift = std::max(window_.from, kSoft * scale_);
      below = countWithin(shift * (1.0 - 1e-9), shift);
    }
    const double top = 1.01 * (part_.pull.cwiseAbs() * Eigen::VectorXd::Ones(size_)).maxCoeff();
    const int below_to =
        window_.to >= top ? size_ : countWithin(window_.to, window_.to * (1.0 + 1e-9));
    in_window_ = std::max(0, below_to - below);
    const int wanted = std::min(in_window_, window_.most + (takesSoft() ? soft_ : 0));
    if (wanted <= size_ / 4) {
      collect(shift, below, wanted);
    } else if (size_ <= kMaxDenseAtAll) {
      dense();
    } else {
      throw Exception(std::to_string(wanted) + " modes of " + std::to_string(size_) +
                      " coordinates are too many, allowed: a quarter of them");
    }
  }

  /// A shift above the soft modes, as high as no other mode lies below it.
  double aboveSoft() {
    double shift = 2.0 * kSoft * scale_;
    while (shift < scale_ && countWithin(2.0 * shift, 4.0 * shift) == soft_) {
      shift *= 2.0;
    }
    return shift;
  }

  /// The lowest above a shift below which some lie, until the count is complete.
  void collect(double shift, int below, int wanted) {
    const Factor factor(shifted(shift));
    if (factor.info() != Eigen::Success) {
      throw Exception("the modes of " + std::to_string(size_) + " coordinates are not found");
    }
    if (below == 0) {
      const int negative = inertiaAt(shift).below;
      for (int round = 0; round < kMaxRounds && found_.values.size() < negative; ++round) {
        iterate(factor, shift, negative - static_cast<int>(found_.values.size()), -1.0);
      }
    }
    for (int round = 0; round < kMaxRounds && wanted > 0; ++round) {
      const int have = static_cast<int>(found_.values.size());
      const int room = size_ - below - have;
      const int missing = isComplete(below, wanted);
      if (missing == 0) {
        return;
      }
      iterate(factor, shift, std::min(room, std::max(missing, 1)), 1.0);
    }
    if (wanted > 0) {
      throw Exception("only " + std::to_string(found_.values.size()) + " of " +
                      std::to_string(wanted) + " modes are found");
    }
  }

  /// \return how many are still to be looked for
  int isComplete(int below, int wanted) {
    const int have = static_cast<int>(found_.values.size());
    if (have < wanted) {
      return wanted - have + kBeyond;
    }
    if (have + below >= size_) {
      return 0;
    }
    // The first gap behind those that are wanted.
    for (int last = wanted - 1; last + 1 < have; ++last) {
      const double low = found_.values[last];
      const double high = found_.values[last + 1];
      if (high - low > 1e-7 * std::abs(high) + 1e-13 * scale_) {
        const int there = countWithin(low, high) - below;
        return std::max(0, there - (last + 1));
      }
    }
    return kBeyond;
  }

  /// Adds the nearest on one side of the shift.
  void iterate(const Factor& factor, double shift, int count, double side) {
    const Eigen::MatrixXd without = found_.vectors;
    Inverse inverse(factor, without);
    const int room = size_ - static_cast<int>(without.cols());
    count = std::min(count, room - 1);
    if (count < 1) {
      return;
    }
    Spectra::SymEigsSolver<Inverse> solver(inverse, count,
                                           std::min(size_, std::max(2 * count + 20, 40)));
    std::vector<double> start(at(size_));
    for (int i = 0; i < size_; ++i) {  // the same every time, and orthogonal to nothing
      start[at(i)] = std::sin(1.0 + 12.9898 * i + 78.233 * static_cast<double>(without.cols()));
    }
    solver.init(start.data());
    solver.compute(side > 0.0 ? Spectra::SortRule::LargestAlge : Spectra::SortRule::SmallestAlge,
                   300, 1e-11, Spectra::SortRule::LargestMagn);
    const Eigen::VectorXd values = solver.eigenvalues();
    const Eigen::MatrixXd vectors = solver.eigenvectors();
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (side * values[i] > kNothing / scale_) {
        add(shift + 1.0 / values[i], vectors.col(i));
      }
    }
    sort();
  }

  void add(double value, Eigen::VectorXd vector) {
    for (int twice = 0; twice < 2; ++twice) {
      vector -= found_.vectors * (found_.vectors.transpose() * vector);
    }
    const Eigen::Index count = found_.values.size();
    found_.values.conservativeResize(count + 1);
    found_.vectors.conservativeResize(size_, count + 1);
    found_.values[count] = value;
    found_.vectors.col(count) = vector.normalized();
  }

  /// Sorts the modes by eigenvalue, motions as a whole before all others.
  void sort() {
    const auto key = [this](Eigen::Index i) {
      const double value = found_.values[i];
      return isRigid(value) ? -std::numeric_limits<double>::infinity() : value;
    };
    std::vector<Eigen::Index> order(static_cast<std::size_t>(found_.values.size()));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](Eigen::Index a, Eigen::Index b) { return key(a) < key(b); });
    const Eigen::VectorXd values = found_.values;
    const Eigen::MatrixXd vectors = found_.vectors;
    for (std::size_t i = 0; i < order.size(); ++i) {
      found_.values[static_cast<Eigen::Index>(i)] = values[order[i]];
      found_.vectors.col(static_cast<Eigen::Index>(i)) = vectors.col(order[i]);
    }
  }

  bool isRigid(double value) const { return std::abs(value) < kRigid * scale_; }

  double elongation(const ModeLoad& load, Eigen::Index column) const {
    double e = 0.0;
    for (const Share& end : load.ends) {
      e += end.weight * found_.vectors(end.node, column);
    }
    return e;
  }

  /// Recomputes eigenvalues near 0, whose rounding errors are larger than they are: in coordinates
  /// of their own, and load by load, they are accurate.
  void polish() {
    turn(found_.values.size(), found_.vectors.transpose() * (part_.pull * found_.vectors));
    Eigen::Index soft = 0;
    while (soft < found_.values.size() && found_.values[soft] < 1e-8 * scale_) {
      ++soft;
    }
    Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(soft, soft);
    Eigen::VectorXd e(soft);
    for (const ModeLoad& load : part_.loads) {
      for (Eigen::Index i = 0; i < soft; ++i) {
        e[i] = elongation(load, i);
      }
      energy += load.pull * e * e.transpose();
    }
    turn(soft, energy);
    for (Eigen::Index i = 0; i < found_.values.size(); ++i) {
      double value = 0.0;
      for (const ModeLoad& load : part_.loads) {
        const double stretched = elongation(load, i);
        value += load.pull * stretched * stretched;
      }
      found_.values[i] = value;
    }
    sort();
    while (found_.rigid < found_.values.size() && isRigid(found_.values[found_.rigid])) {
      ++found_.rigid;
    }
    found_.rigid_in_all = takesSoft() ? found_.rigid : soft_;
    found_.counted = in_window_ - (takesSoft() ? found_.rigid : 0);
  }

  /// The first vectors become those of a matrix in their coordinates.
  void turn(Eigen::Index count, const Eigen::MatrixXd& matrix) {
    if (count > 0) {
      const algebra::SymmetricModes modes = algebra::symmetricModes(matrix);
      const Eigen::MatrixXd turned = found_.vectors.leftCols(count) * modes.vectors;
      found_.vectors.leftCols(count) = turned;
      found_.values.head(count) = modes.values;
    }
  }

  const ModePart& part_;
  EigenWindow window_;
  int size_;
  double scale_ = 0.0;
  Matrix unit_;
  int soft_ = 0;       // eigenvalues that rounding does not tell from 0, negative ones as well
  int in_window_ = 0;  // with those
  EigenPairs found_;
};

}  // namespace

EigenPairs eigenPairsIn(const ModePart& part, const EigenWindow& window) {
  return ModeFinder(part, window).run();
}

}  // namespace ergotic::physics
