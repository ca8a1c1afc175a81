// SPDX-License-Identifier: BSD-3-Clause
#include "support/bars.hpp"

#include <sstream>

namespace ergotic::test {
namespace {

constexpr double kMass = 1e-3;
constexpr double kRate = 44100.0;

std::string numberText(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

std::string moduleAt(int row, int column) {
  return "m" + std::to_string(row) + "_" + std::to_string(column);
}

}  // namespace

void Bars::mat(const std::string& name, bool is_free) {
  mats_ += "  " + name + ": {type: " + (is_free ? "mass, mass: 1e-3" : "ground");
  if (is_free) {
    mats_ += masses_ < displacements.size() ? ", x: " + numberText(displacements[masses_]) : "";
    ++masses_;
  }
  mats_ += "}\n";
}

void Bars::bend(const std::vector<std::string>& ends, const std::string& weights, double share) {
  std::string between;
  for (const std::string& end : ends) {
    between += (between.empty() ? "" : ", ") + end;
  }
  lias_ += "  b" + std::to_string(bends_++) + ": {type: bend, between: [" + between +
           "], weights: [" + weights +
           "], stiffness: " + numberText(share * kappa_ * kMass * kRate * kRate) + keys_ + "}\n";
}

std::string Bars::text() const {
  return "ergotic: 1\nparameters: {p: {value: 1, range: [0.5, 2]}}\nsections: {s: " + section +
         "}\nmats:\n" + mats_ + "lias:\n" + lias_;
}

std::string Bars::bar(int count, Edge left, Edge right) {
  const int first = left == Edge::kFree ? 1 : left == Edge::kHinged ? 0 : -1;
  const int last = count + (right == Edge::kFree ? 0 : right == Edge::kHinged ? 1 : 2);
  const auto name = [&](int i) {
    return i < 1 ? "g" + std::to_string(-i) : (i > count ? "h" : "m") + std::to_string(i);
  };
  for (int i = first; i <= last; ++i) {
    mat(name(i), i >= 1 && i <= count);
  }
  for (int i = first + 1; i < last; ++i) {
    bend({name(i - 1), name(i), name(i + 1)}, "1, -2, 1", 1.0);
  }
  return text();
}

std::string Bars::supportedPlate(int side) {
  for (int row = 0; row <= side + 1; ++row) {
    for (int column = 0; column <= side + 1; ++column) {
      mat(moduleAt(row, column), row >= 1 && row <= side && column >= 1 && column <= side);
    }
  }
  for (int row = 1; row <= side; ++row) {
    for (int column = 1; column <= side; ++column) {
      bend({moduleAt(row, column - 1), moduleAt(row - 1, column), moduleAt(row, column),
            moduleAt(row + 1, column), moduleAt(row, column + 1)},
           "1, 1, -4, 1, 1", 1.0);
    }
  }
  return text();
}

std::string Bars::freePlate(int side, double poisson) {
  const auto isEdge = [&](int i) { return i == 0 || i == side - 1; };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      mat(moduleAt(row, column), true);
    }
  }
  const auto share = [&](bool at_edge) {
    return at_edge ? 1.0 - poisson * poisson : 1.0 - poisson;
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 1; j + 1 < side; ++j) {
      bend({moduleAt(i, j - 1), moduleAt(i, j), moduleAt(i, j + 1)}, "1, -2, 1", share(isEdge(i)));
      bend({moduleAt(j - 1, i), moduleAt(j, i), moduleAt(j + 1, i)}, "1, -2, 1", share(isEdge(i)));
      if (!isEdge(i) && poisson > 0.0) {
        bend({moduleAt(i, j - 1), moduleAt(i - 1, j), moduleAt(i, j), moduleAt(i + 1, j),
              moduleAt(i, j + 1)},
             "1, 1, -4, 1, 1", poisson);
      }
    }
  }
  for (int row = 0; row + 1 < side; ++row) {
    for (int column = 0; column + 1 < side; ++column) {
      const double area = (row == 0 || row == side - 2 ? 1.5 : 1.0) *
                          (column == 0 || column == side - 2 ? 1.5 : 1.0);
      bend({moduleAt(row, column), moduleAt(row, column + 1), moduleAt(row + 1, column),
            moduleAt(row + 1, column + 1)},
           "1, -1, -1, 1", 2.0 * (1.0 - poisson) * area);
    }
  }
  return text();
}

}  // namespace ergotic::test
