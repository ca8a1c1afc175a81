// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_choice.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "algebra/decompositions.hpp"
#include "at.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

/// Largest |x| after a start at x = 1 with d = 0, at most.
double peakFromRest(double pull, double loss) {
  const double trace = 2.0 - loss - pull;
  const double product = 1.0 - loss;
  const double discriminant = trace * trace - 4.0 * product;
  if (discriminant < 0.0) {
    // r^n (cos n w + (cos w - r) / sin w sin n w)
    const double r = std::sqrt(product);
    const double cosine = trace / (2.0 * r);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return r <= 1.0 ? std::hypot(1.0, (cosine - r) / sine) : kInfinity;
  }
  return (1.0 + std::abs(product)) * peakAfterKick(pull, loss);
}

/// Largest |q| of a mode that nothing touches.
double ownMotion(const ModalPart& part, Eigen::Index k, double step) {
  const double pull = part.pull[k];
  const double loss = part.loss[k];
  const double constant = part.constant[k] * step * step;
  const bool moves = part.x[k] != 0.0 || part.d[k] != 0.0 || constant != 0.0;
  if (!moves) {
    return 0.0;
  }
  if (!(pull > 0.0)) {
    return kInfinity;
  }
  const double rest = constant / pull;
  const double before = part.x[k] - rest;
  const double d = (1.0 - loss) * part.d[k] - pull * before + part.first_force[k] * step * step;
  return std::abs(rest) + std::abs(before + d) * peakFromRest(pull, loss) +
         std::abs((1.0 - loss) * d) * peakAfterKick(pull, loss);
}

struct Ranked {
  std::size_t part = 0;
  int mode = 0;
  double by_impulse = 0.0;  // what leaving it out adds to the bounds, at most
  double at_start = 0.0;
  double score = 0.0;
};

/// Every mode of all parts, those that matter most first.
std::vector<Ranked> rank(const std::vector<ModalPart>& parts, double step) {
  std::vector<Ranked> all;
  Ranked sum;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (Eigen::Index k = 0; k < parts[p].pull.size(); ++k) {
      Ranked mode{p, static_cast<int>(k), 0.0, 0.0, 0.0};
      const double weight =
          parts[p].weights.rows() == 0 ? 0.0 : parts[p].weights.col(k).cwiseAbs().maxCoeff();
      if (weight > 0.0) {
        mode.by_impulse =
            weight * weight * step * peakAfterKick(parts[p].pull[k], parts[p].loss[k]);
        mode.at_start = weight * ownMotion(parts[p], k, step);
      }
      sum.by_impulse += std::isfinite(mode.by_impulse) ? mode.by_impulse : 0.0;
      sum.at_start += std::isfinite(mode.at_start) ? mode.at_start : 0.0;
      all.push_back(mode);
    }
  }
  for (Ranked& mode : all) {
    mode.score = (mode.by_impulse > 0.0 ? mode.by_impulse / sum.by_impulse : 0.0) +
                 (mode.at_start > 0.0 ? mode.at_start / sum.at_start : 0.0);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
  return all;
}

/// A weight of 0 counts for nothing, however far its mode goes.
double weighed(double weight, double size) {
  return weight == 0.0 ? 0.0 : weight * size;
}

double giveOf(const ModalPart& part, Eigen::Index point, Eigen::Index k) {
  const double weight = part.weights(point, k);
  return weighed(weight * weight, 1.0 / part.pull[k]);
}

ModalError errorOf(const ModalPart& part, const std::vector<int>& dropped, double step) {
  const Eigen::Index points = part.weights.rows();
  ModalError error;
  Eigen::MatrixXd per_impulse = Eigen::MatrixXd::Zero(points, points);
  Eigen::VectorXd at_start = Eigen::VectorXd::Zero(points);
  Eigen::VectorXd missing = Eigen::VectorXd::Zero(points);
  for (const int k : dropped) {
    const double own = ownMotion(part, k, step);
    const double kick = step * peakAfterKick(part.pull[k], part.loss[k]);
    for (Eigen::Index i = 0; i < points; ++i) {
      at_start[i] += weighed(std::abs(part.weights(i, k)), own);
      missing[i] += giveOf(part, i, k);
      for (Eigen::Index j = 0; j < points; ++j) {
        per_impulse(i, j) += weighed(std::abs(part.weights(i, k) * part.weights(j, k)), kick);
      }
    }
  }
  for (Eigen::Index i = 0; i < points; ++i) {
    double whole = 0.0;
    for (Eigen::Index k = 0; k < part.pull.size(); ++k) {
      whole += giveOf(part, i, k);
    }
    const bool has_give = std::isfinite(whole) && whole > 0.0;
    error.static_share = std::max(error.static_share, has_give ? missing[i] / whole : 0.0);
    error.at_start = std::max(error.at_start, at_start[i]);
    error.per_impulse = std::max(error.per_impulse, per_impulse.row(i).maxCoeff());
  }
  return error;
}

}  // namespace

std::shared_ptr<const Modes> modesOf(const ModalMatrix& matrix) {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(matrix.size, matrix.size);
  for (const ModalMatrix::Entry& entry : matrix.entries) {
    lower(entry.row, entry.column) = entry.value;
  }
  const algebra::SymmetricModes found = algebra::symmetricModes(lower);
  if (!found.converged) {
    throw Exception("the modes of " + std::to_string(matrix.size) + " modules do not converge");
  }
  auto modes = std::make_shared<Modes>();
  modes->values = found.values;
  modes->vectors = found.vectors;
  return modes;
}

ModalCost costOf(const std::vector<LinearPart>& parts, const std::vector<int>& points) {
  ModalCost cost;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto modes = static_cast<int>(parts[p].mats.size());
    cost.modules += modes + static_cast<int>(parts[p].lias.size());
    cost.modes += modes;
    cost.products += modes * (1 + points[p]);
  }
  return cost;
}

double peakAfterKick(double pull, double loss) {
  const double trace = 2.0 - loss - pull;
  const double product = 1.0 - loss;
  const std::complex<double> root = std::sqrt(std::complex<double>(trace * trace / 4.0 - product));
  const std::complex<double> one = trace / 2.0 + root;
  const std::complex<double> other = trace / 2.0 - root;
  const double larger = std::max(std::abs(one), std::abs(other));
  const double smaller = std::min(std::abs(one), std::abs(other));
  if (larger > 1.0 + 1e-12) {
    return kInfinity;
  }
  // x[n] = (z1^n - z2^n) / (z1 - z2) = sum of z1^(n-1-k) z2^k
  const double apart = 2.0 / std::abs(one - other);
  return smaller < 1.0 ? std::min(apart, 1.0 / (1.0 - smaller)) : apart;
}

ModalError keepModes(std::vector<ModalPart>& parts, int most, double step) {
  const std::vector<Ranked> ranked = rank(parts, step);
  const std::size_t kept = std::min(ranked.size(), at(most));
  std::vector<std::vector<int>> dropped(parts.size());
  for (std::size_t r = 0; r < ranked.size(); ++r) {
    (r < kept ? parts[ranked[r].part].kept : dropped[ranked[r].part]).push_back(ranked[r].mode);
  }
  ModalError error;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::sort(parts[p].kept.begin(), parts[p].kept.end());
    const ModalError of_part = errorOf(parts[p], dropped[p], step);
    error.static_share = std::max(error.static_share, of_part.static_share);
    error.per_impulse = std::max(error.per_impulse, of_part.per_impulse);
    error.at_start = std::max(error.at_start, of_part.at_start);
  }
  return error;
}

}  // namespace ergotic::physics
