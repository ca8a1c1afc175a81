// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/skin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "at.hpp"
#include "scene/generate/generated.hpp"
#include "scene/generate/sheet.hpp"

namespace ergotic::scene {
namespace {

struct Step {
  int row;
  int column;
};
constexpr Step kSteps[] = {{0, 1}, {1, 0}, {1, 1}, {1, -1}};
constexpr double kShortestAtRim = 0.5;  // of a link; shorter ones would be stiffer than all others
constexpr double kDiagonal = 0.25;      // of the stiffness along rows and columns

class Membrane {
 public:
  Membrane(SceneBuilder& builder, const MembraneSpec& spec) : builder_(builder), spec_(spec) {}

  void add() {
    Tuning body = beginBody(builder_, spec_.name, spec_.place);
    first_ = body.first_mat;
    addMats();
    addLinks();
    addHardLinks(body.first_lia);
    finishBody(builder_, std::move(body), spec_.wish);
  }

 private:
  double middleRow() const { return 0.5 * (spec_.rows - 1); }
  double middleColumn() const { return 0.5 * (spec_.columns - 1); }
  double radius() const { return middleColumn(); }

  /// Distance from the middle, in cells.
  double distance(int row, int column) const {
    return std::hypot(row - middleRow(), column - middleColumn());
  }
  bool isInside(int row, int column) const {
    return row > 0 && column > 0 && row < spec_.rows - 1 && column < spec_.columns - 1 &&
           (!spec_.is_round || distance(row, column) < radius() - 1e-9);
  }

  void addMats() {
    int inside = 0;
    for (int row = 0; row < spec_.rows; ++row) {
      for (int column = 0; column < spec_.columns; ++column) {
        inside += isInside(row, column) ? 1 : 0;
      }
    }
    const Sheet sheet{spec_.name,    spec_.section, spec_.rows, spec_.columns,
                      spec_.spacing, spec_.at,      spec_.place};
    addSheet(builder_, sheet, spec_.wish, [&](int row, int column) {
      const double r = distance(row, column) / radius();
      return isInside(row, column) ? spec_.mass / inside * spec_.load.at(r, radius()) : 0.0;
    });
  }

  /// The part of a step from inside to outside that is inside.
  double partInside(int row, int column, const Step& step) const {
    if (!spec_.is_round) {
      return 1.0;
    }
    // |p + t d| = R, with p inside: the positive root.
    const Eigen::Vector2d p(row - middleRow(), column - middleColumn());
    const Eigen::Vector2d d(step.row, step.column);
    const double half = p.dot(d) / d.squaredNorm();
    const double left = (radius() * radius() - p.squaredNorm()) / d.squaredNorm();
    return std::clamp(-half + std::sqrt(half * half + left), kShortestAtRim, 1.0);
  }

  void addLinks() {
    const Name stem = linkStem(spec_.name);
    for (int row = 0; row < spec_.rows; ++row) {
      for (int column = 0; column < spec_.columns; ++column) {
        for (const Step& step : kSteps) {
          addLink(stem, row, column, step);
        }
      }
    }
  }

  void addLink(const Name& stem, int row, int column, const Step& step) {
    const int to_row = row + step.row;
    const int to_column = column + step.column;
    const bool is_diagonal = step.row != 0 && step.column != 0;
    if (to_row >= spec_.rows || to_column < 0 || to_column >= spec_.columns ||
        (is_diagonal && !spec_.has_diagonals)) {
      return;
    }
    const bool from_inside = isInside(row, column);
    const bool to_inside = isInside(to_row, to_column);
    if (!from_inside && !to_inside) {
      return;
    }
    double part = 1.0;
    if (from_inside != to_inside) {
      part = from_inside ? partInside(row, column, step)
                         : partInside(to_row, to_column, {-step.row, -step.column});
    }
    Lia lia = generatedLink(stem, next_++, first_ + row * spec_.columns + column,
                            first_ + to_row * spec_.columns + to_column, spec_.place);
    lia.stiffness.factor = (is_diagonal ? kDiagonal : 1.0) / part * spec_.mass;
    lia.damping.factor = spec_.wish.t60.size() > 1 ? lia.stiffness.factor : 0.0;
    lengths_.push_back(part * std::hypot(step.row, step.column) * spec_.spacing);
    builder_.add(std::move(lia));
  }

  /// Each spring K of the length l as a wire that its tension has drawn out by that strain:
  /// Q = K/(2 strain l^2). By the mean over its area, K times sum K/(2 strain sum K l^2).
  void addHardLinks(int first) {
    HardLinks links(builder_, spec_.name, spec_.hardening, spec_.place);
    if (spec_.hardening == Hardening::kNone) {
      return;
    }
    double stiffness = 0.0;
    for (int l = 0; l < next_; ++l) {
      stiffness += builder_.scene().lias[at(first + l)].stiffness.factor;
    }
    // In each cell two springs along it and, of a length of sqrt 2, two across.
    const double cells = spec_.is_round
                             ? M_PI * radius() * radius()
                             : static_cast<double>((spec_.rows - 1) * (spec_.columns - 1));
    const double per_cell = 2.0 * (1.0 + (spec_.has_diagonals ? 2.0 * kDiagonal : 0.0));
    const double stretched = cells * per_cell * spec_.mass * spec_.spacing * spec_.spacing;
    for (int l = 0; l < next_; ++l) {
      const Lia& spring = builder_.scene().lias[at(first + l)];
      const double per_area = spec_.hardening == Hardening::kGlobal
                                  ? stiffness / stretched
                                  : 1.0 / (lengths_[at(l)] * lengths_[at(l)]);
      links.add(spring.a, spring.b, 0.5 / spec_.strain * per_area * spring.stiffness.factor);
    }
  }

  SceneBuilder& builder_;
  const MembraneSpec& spec_;
  int first_ = 0;
  int next_ = 0;                 // number of the next link
  std::vector<double> lengths_;  // of the links, m
};

}  // namespace

double SkinLoad::at(double r, double cells) const {
  const double share = radius ? std::clamp((*radius - r) * cells + 0.5, 0.0, 1.0)
                              : std::pow(std::max(0.0, 1.0 - r * r), power);
  return 1.0 + (ratio - 1.0) * share;
}

void addMembrane(SceneBuilder& builder, const MembraneSpec& spec) {
  Membrane(builder, spec).add();
}

}  // namespace ergotic::scene
