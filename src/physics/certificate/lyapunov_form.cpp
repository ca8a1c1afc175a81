// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/lyapunov_form.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Cholesky>

#include "algebra/decompositions.hpp"
#include "constants.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kUnchanged = 1e-12;       // of the largest pivot: what a period leaves as it is
constexpr double kFading = 0.99;           // per period
constexpr double kMeeting = 30.0;          // of |G| |G^-1|: 1/how near modes are to meeting
constexpr double kBreathing = 10.0;        // the same of roots of the energy that is kept
constexpr double kLending = 1000.0;        // and of that which steps near their limit lend
constexpr double kFadingBreathes = 100.0;  // of what fades, all at once: a bound from far
constexpr double kMaxOff = 5e-10;          // of what G s becomes
constexpr int kPeriodDoublings = 40;
constexpr double kAlike = 1e-6;     // of places of bodies
constexpr double kStaying = 1e-10;  // of a body, whatever rounds
constexpr double kNear = 0.1;       // of eigenvalues that rounding might bring together
constexpr double kSlow = 1e-8;      // per period, of growth that is none

/// Rows that a period makes B times themselves.
struct Form {
  MatrixXd rows;
  MatrixXd turn;
};

/// The subspace that a period leaves unchanged, and the first module of each body in it.
struct Staying {
  MatrixXd beside;  // at right angles to it
  std::vector<Index> bodies;
};

/// The first modules of as many bodies as there is that stays, which nothing holds: the modules of
/// each moved alike, all at rest; more if it is not so. A mode that comes back to where it was
/// within a period stays, too.
std::vector<Index> bodiesOf(const MatrixXd& stays) {
  const Index modules = stays.rows() / 2;
  std::vector<Index> bodies;
  for (Index m = 0; m < modules; ++m) {
    const auto isHere = [&](Index known) {
      return (stays.row(known) - stays.row(m)).norm() < kAlike;
    };
    if (stays.row(m).norm() >= kAlike && std::none_of(bodies.begin(), bodies.end(), isHere)) {
      bodies.push_back(m);
    }
  }
  return bodies;
}

/// Splits the unchanged subspace off. nullopt if it holds more than bodies at rest, or if rounding
/// changes it.
std::optional<Staying> besideWhatStays(const MatrixXd& matrix,
                                       const std::vector<MatrixXd>& rounded) {
  const MatrixXd unit = MatrixXd::Identity(matrix.rows(), matrix.cols());
  const algebra::Kernel unchanged = algebra::kernelOf(matrix - unit, kUnchanged);
  if (unchanged.rank == matrix.rows()) {
    return Staying{unit, {}};
  }
  const MatrixXd& stays = unchanged.basis;
  const bool stay = std::all_of(rounded.begin(), rounded.end(), [&](const MatrixXd& other) {
    return (other * stays - stays).norm() <= kStaying * stays.norm();
  });
  Staying staying{algebra::orthogonalComplement(stays), bodiesOf(stays)};
  const bool are_bodies = stays.bottomRows(matrix.rows() / 2).norm() < kAlike &&
                          static_cast<Index>(staying.bodies.size()) == stays.cols();
  return stay && are_bodies ? std::optional<Staying>(std::move(staying)) : std::nullopt;
}

/// Real and imaginary parts of the eigenvectors of what hardly fades, as columns, and what becomes
/// of their transpose.
Form lastingOf(const algebra::GeneralModes& modes) {
  const Index size = modes.values.size();
  Form form{MatrixXd(size, size), MatrixXd::Zero(size, size)};
  Index count = 0;
  for (Index i = 0; i < size; ++i) {
    const std::complex<double> value = modes.values[i];
    if (!(std::abs(value) > kFading) || value.imag() < 0.0) {
      continue;
    }
    const Eigen::VectorXcd vector = modes.vectors.col(i).normalized();
    form.rows.col(count) = vector.real();
    form.turn(count, count) = value.real();
    if (value.imag() > 0.0) {
      form.rows.col(count + 1) = vector.imag();
      form.turn(count + 1, count + 1) = value.real();
      form.turn(count, count + 1) = -value.imag();
      form.turn(count + 1, count) = value.imag();
    }
    count += value.imag() > 0.0 ? 2 : 1;
  }
  return {form.rows.leftCols(count), form.turn.topLeftCorner(count, count)};
}

/// P = sum over k of (B^k)' B^k, so that P - B' P B = I.
MatrixXd lyapunov(MatrixXd power) {
  MatrixXd sum = MatrixXd::Identity(power.rows(), power.cols());
  for (int k = 0; k < kPeriodDoublings && power.squaredNorm() > 0.0; ++k) {
    sum += power.transpose() * sum * power;
    power = power * power;
  }
  return sum;
}

Form fadingOf(const MatrixXd& matrix, const MatrixXd& lasting) {
  const MatrixXd others = algebra::orthogonalComplement(lasting);
  if (others.cols() == 0) {
    return {};
  }
  const MatrixXd turn = others.transpose() * matrix * others;
  const MatrixXd root = lyapunov(turn).llt().matrixU();
  const MatrixXd back =
      root.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(root.rows(), root.cols()));
  return {root * others.transpose(), root * turn * back};
}

Form joined(const Form& a, const Form& b, Index columns) {
  const Index rows = a.rows.rows() + b.rows.rows();
  Form both{MatrixXd(rows, columns), MatrixXd::Zero(rows, rows)};
  both.rows.topRows(a.rows.rows()) = a.rows;
  both.rows.bottomRows(b.rows.rows()) = b.rows;
  both.turn.topLeftCorner(a.turn.rows(), a.turn.cols()) = a.turn;
  both.turn.bottomRightCorner(b.turn.rows(), b.turn.cols()) = b.turn;
  return both;
}

/// How far the form is from becoming B times itself.
double errorOf(const Form& form, const MatrixXd& matrix) {
  const MatrixXd becomes =
      algebra::solve(form.rows.transpose(), (form.rows * matrix).transpose()).transpose();
  return (becomes - form.turn).norm();
}

/// How large a motion may become that begins small: of G without the places of one module of each
/// body, the largest of |G| |G^-1|.
double conditionOf(const MatrixXd& form, const std::vector<Index>& bodies) {
  MatrixXd seen(form.rows(), form.rows());
  Index to = 0;
  for (Index column = 0; column < form.cols(); ++column) {
    if (std::count(bodies.begin(), bodies.end(), column) == 0) {
      seen.col(to++) = form.col(column);
    }
  }
  const MatrixXd back = algebra::inverse(seen);
  return (seen.cwiseAbs() * back.cwiseAbs()).diagonal().maxCoeff();
}

/// Rows that a period mixes with one another alone, from `first` on: one past the last of them.
Index endOfBlock(const MatrixXd& turn, Index first) {
  Index end = first + 1;
  for (Index row = first; row < end; ++row) {
    for (Index other = turn.rows(); other-- > end;) {
      if (turn(row, other) != 0.0 || turn(other, row) != 0.0) {
        end = other + 1;
      }
    }
  }
  return end;
}

double normOf(const MatrixXd& matrix) {
  const MatrixXd square = matrix.rows() < matrix.cols() ? MatrixXd(matrix * matrix.transpose())
                                                        : MatrixXd(matrix.transpose() * matrix);
  return std::sqrt(algebra::symmetricEigenvalues(square).maxCoeff());
}

/// |G E^-1/2| |E^1/2 G^-1| of the rows of G and columns of G^-1 that a period mixes, at most: how
/// many times the root of the energy E that a motion begins with may become that of a part of it
/// that goes by itself. Infinity where E is not positive.
/// \param seen     G without a place of each body
/// \param lasting  rows that hardly fade, the first ones
double conditionIn(const MatrixXd& energy,
                   const MatrixXd& seen,
                   const MatrixXd& turn,
                   Index lasting) {
  const Eigen::LLT<MatrixXd> root(energy);
  if (root.info() != Eigen::Success) {
    return kInfinity;
  }
  const MatrixXd upper = root.matrixU();
  const MatrixXd back = upper * algebra::inverse(seen);
  const MatrixXd rows =
      upper.transpose().triangularView<Eigen::Lower>().solve(seen.transpose()).transpose();
  double most = 0.0;
  for (Index first = 0, end = 0; first < turn.rows(); first = end) {
    end = endOfBlock(turn, first);
    const double fading = first >= lasting ? kFadingBreathes / kBreathing : 1.0;
    const double much =
        normOf(rows.middleRows(first, end - first)) * normOf(back.middleCols(first, end - first));
    if (!std::isfinite(much)) {
      return kInfinity;
    }
    most = std::max(most, much / fading);
  }
  return most;
}

/// How far motions may breathe, over what is allowed: in the energy of the displacements x and of
/// what modules are about to move by, u, as the scheme keeps it at one rate, x'Kx + x'Ku +
/// u'Mu/h^2, where that is positive (between rates it need not be), and in x'Kx + u'Mu/h^2. What
/// coordinates are measured in does not matter, nor that light modules go far.
double breathingOf(const MatrixXd& form,
                   const MatrixXd& turn,
                   Index lasting,
                   const std::vector<Index>& bodies,
                   const Period& period) {
  const Index modules = period.units.size();
  std::vector<Index> kept;
  for (Index column = 0; column < modules; ++column) {
    if (std::count(bodies.begin(), bodies.end(), column) == 0) {
      kept.push_back(column);
    }
  }
  const auto places = static_cast<Index>(kept.size());
  const Index size = places + modules;
  MatrixXd plain = MatrixXd::Zero(size, size);
  MatrixXd seen(form.rows(), size);
  MatrixXd cross(places, modules);
  for (Index i = 0; i < places; ++i) {
    const Index from = kept[static_cast<std::size_t>(i)];
    seen.col(i) = form.col(from);
    for (Index j = 0; j < places; ++j) {
      plain(i, j) = period.stiffness(from, kept[static_cast<std::size_t>(j)]);
    }
    cross.row(i) = 0.5 * period.stiffness.row(from).cwiseProduct(period.units.transpose());
  }
  plain.bottomRightCorner(modules, modules).diagonal() = period.inertia;
  seen.rightCols(modules) = form.rightCols(modules);
  MatrixXd as_kept = plain;
  as_kept.topRightCorner(places, modules) = cross;
  as_kept.bottomLeftCorner(modules, places) = cross.transpose();

  const double in_plain = conditionIn(plain, seen, turn, lasting);
  const double in_kept = conditionIn(as_kept, seen, turn, lasting);
  return std::isinf(in_kept) ? in_plain / kBreathing
                             : std::max(in_kept / kBreathing, in_plain / kLending);
}

/// Perturbation of the modes of a period by rounding: in their eigenvectors, one matrix per case.
class RoundedModes {
 public:
  RoundedModes(const algebra::GeneralModes& modes, const std::vector<MatrixXd>& roundings) {
    const Eigen::MatrixXcd& right = modes.vectors;
    const Eigen::MatrixXcd left = algebra::inverse(right);
    const std::vector<Index> judged = judgedOf(modes.values);
    values_ = modes.values(judged);
    const Eigen::MatrixXcd columns = right(Eigen::all, judged);
    const Eigen::MatrixXcd rows = left(judged, Eigen::all);
    for (const MatrixXd& rounding : roundings) {
      shifts_.push_back(rows * (rounding * columns));
    }
  }

  /// True if a mode, or two modes that feed each other, may grow under rounding.
  bool mayGrow() const {
    for (Index i = 0; i < values_.size(); ++i) {
      if (lasts(values_[i]) && !(std::log(std::abs(values_[i])) + changeOf(i) <= kSlow)) {
        return true;
      }
      for (Index j = 0; j < i; ++j) {
        if ((lasts(values_[i]) || lasts(values_[j])) && areNear(values_[i], values_[j]) &&
            !(growthOf(i, j) <= kSlow)) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  static bool lasts(std::complex<double> value) { return std::abs(value) > kFading; }
  static bool areNear(std::complex<double> a, std::complex<double> b) {
    return std::abs(a - b) <= kNear;
  }

  /// Modes that hardly decay, and those whose eigenvalues rounding may bring close to them.
  static std::vector<Index> judgedOf(const Eigen::VectorXcd& values) {
    std::vector<Index> judged;
    for (Index i = 0; i < values.size(); ++i) {
      bool is_judged = false;
      for (Index j = 0; j < values.size() && !is_judged; ++j) {
        is_judged = lasts(values[j]) && areNear(values[i], values[j]);
      }
      if (is_judged) {
        judged.push_back(i);
      }
    }
    return judged;
  }

  /// Largest change of the growth of mode i by rounding. Exact where rounding only rotates it.
  double changeOf(Index i) const {
    return largest([&](const Eigen::MatrixXcd& shift) {
      return std::abs(std::log(std::abs(1.0 + shift(i, i) / values_[i])));
    });
  }

  /// Largest growth of two modes while rounding goes from -1 to 1, to first order: that of the
  /// eigenvalues of [[x, 0], [0, y]] + t [[a, b], [c, d]], as near as any case brings them.
  double growthOf(Index i, Index j) const {
    const std::complex<double> x = values_[i];
    const std::complex<double> y = values_[j];
    // Of logarithms: real parts grow, imaginary ones turn.
    const std::complex<double> apart = 0.5 * std::log(x / y);
    const double nearer = largest([&](const Eigen::MatrixXcd& shift) {
      return 0.5 * std::abs(shift(i, i) / x - shift(j, j) / y);
    });
    const double left = std::max(0.0, std::abs(apart) - nearer);
    const std::complex<double> nearest = left > 0.0 ? apart * (left / std::abs(apart)) : 0.0;
    const double together = largest([&](const Eigen::MatrixXcd& shift) {
      const std::complex<double> joint = shift(i, j) * shift(j, i) / (x * y);
      return std::max(std::sqrt(nearest * nearest + joint).real(),
                      std::sqrt(apart * apart + joint).real());
    });
    return 0.5 * std::log(std::abs(x * y)) + together;
  }

  template <class Function>
  double largest(const Function& function) const {
    double most = 0.0;
    for (const Eigen::MatrixXcd& shift : shifts_) {
      const double value = function(shift);
      most = value <= most ? most : value;  // what is not a number stays
    }
    return most;
  }

  Eigen::VectorXcd values_;
  std::vector<Eigen::MatrixXcd> shifts_;
};

}  // namespace

std::optional<LyapunovForm> lyapunovFormOf(const Period& period,
                                           const std::vector<MatrixXd>& rounded) {
  const std::optional<Staying> staying = besideWhatStays(period.matrix, rounded);
  if (!staying) {
    return std::nullopt;
  }
  const MatrixXd& kept = staying->beside;
  const MatrixXd matrix = kept.transpose() * period.matrix * kept;
  const algebra::GeneralModes modes = algebra::generalModes(matrix);
  const algebra::GeneralModes transposed = algebra::generalModes(matrix.transpose());
  if (!modes.converged || !transposed.converged) {
    return std::nullopt;
  }
  Form lasting = lastingOf(transposed);
  lasting.rows.transposeInPlace();
  const Form form = joined(lasting, fadingOf(matrix, lastingOf(modes).rows), matrix.cols());
  if (form.rows.rows() != form.rows.cols() || !(errorOf(form, matrix) <= kMaxOff)) {
    return std::nullopt;
  }
  std::vector<MatrixXd> roundings;
  for (const MatrixXd& other : rounded) {
    roundings.push_back(kept.transpose() * (other - period.matrix) * kept);
  }
  LyapunovForm found{form.rows * kept.transpose(), form.turn};
  if (!(conditionOf(found.form, staying->bodies) < kMeeting) ||
      !(breathingOf(found.form, found.turn, lasting.rows.rows(), staying->bodies, period) < 1.0) ||
      RoundedModes(modes, roundings).mayGrow()) {
    return std::nullopt;
  }
  const Index modules = period.units.size();
  found.form.rightCols(modules) *= period.units.cwiseInverse().asDiagonal();
  return found;
}

}  // namespace ergotic::physics
