// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "physics/modes/modal_plan.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::Mat;
using scene::MatType;
using scene::Scene;

constexpr std::size_t kPictureModes = 24;

/// Rewrites a scene by the plans of its sections.
class Rewriter {
 public:
  Rewriter(const Scene& from, const Rates& rates, const std::vector<ModalPlan>& plans)
      : from_(from), rates_(rates), plans_(plans), to_(from) {}

  Scene run() {
    to_.strings.clear();
    to_.bends.clear();
    to_.lias.clear();
    for (std::size_t l = 0; l < from_.lias.size(); ++l) {
      if (!isAmong([l](const ModalPlan& plan) { return plan.linear.is_in[l] != 0; })) {
        to_.lias.push_back(from_.lias[l]);
        to_.lias.back().bend = -1;  // what is left of one are springs
      }
    }
    to_.connections = without(from_.connections, &ModalPlan::connections);
    to_.taps = without(from_.taps, &ModalPlan::taps);
    for (const ModalPlan& plan : plans_) {
      addModes(plan);
      to_.sections[at(plan.section)].modes = scene::kNoModes;
    }
    return std::move(to_);
  }

 private:
  template <class Test>
  bool isAmong(const Test& test) const {
    return std::any_of(plans_.begin(), plans_.end(), test);
  }

  template <class Point>
  std::vector<Point> without(const std::vector<Point>& points,
                             std::vector<int> ModalPlan::*touched) const {
    std::vector<Point> left;
    for (int p = 0; p < static_cast<int>(points.size()); ++p) {
      if (!isAmong([&](const ModalPlan& plan) {
            return std::count((plan.*touched).begin(), (plan.*touched).end(), p) > 0;
          })) {
        left.push_back(points[at(p)]);
      }
    }
    return left;
  }

  void addModes(const ModalPlan& plan) {
    std::vector<int> first_of;
    for (const ModalPart& part : plan.parts) {
      first_of.push_back(static_cast<int>(to_.mats.size()));
      for (const int k : part.kept) {
        to_.mats.push_back(cellOf(plan.section, part, k));
      }
    }
    std::vector<unsigned char> is_touched(from_.mats.size(), 0);
    std::vector<Eigen::Index> next(plan.parts.size(), 0);
    for (const ModalTouch& touch : plan.touches) {
      is_touched[at(touch.mat)] = 1;
      scene::Tap& tap = addTap(touch.mat, touch.offset);
      if (touch.part >= 0) {
        const ModalPart& part = plan.parts[at(touch.part)];
        const Eigen::Index row = next[at(touch.part)]++;
        int cell = first_of[at(touch.part)];
        for (const int k : part.kept) {
          tap.shares.push_back({cell++, part.weights(row, k)});
        }
      }
      for (const scene::Tap::Share& share : touch.shares) {
        if (plan.linear.part_of[at(share.mat)] < 0) {
          tap.shares.push_back(share);
        }
      }
    }
    for (std::size_t p = 0; p < plan.parts.size(); ++p) {
      addPictures(plan.linear.parts[p], plan.parts[p], first_of[p], is_touched);
    }
  }

  scene::Tap& addTap(int mat, double offset) {
    to_.mats[at(mat)].type = MatType::kPoint;
    to_.taps.push_back({mat, {}, from_.mats[at(mat)].place, offset});
    return to_.taps.back();
  }

  /// A cell whose coefficients in a step are those of the mode, whatever its section adds.
  Mat cellOf(int section, const ModalPart& part, int k) const {
    const scene::Section& in = from_.sections[at(section)];
    const double step = StepUnits(from_, rates_, divisorOf(in, rates_)).step;
    Mat cell;
    cell.name = in.name + ".mode";
    cell.type = MatType::kCell;
    cell.section = section;
    cell.mass.factor = 1.0;
    cell.stiffness.factor = part.pull[k] / (step * step);
    cell.damping.factor = part.loss[k] / step - from_.valueOf(in.medium);
    cell.position.x() = part.x[k];
    scene::setVelocity(cell, part.d[k] / step * Eigen::Vector3d::UnitX());
    const double force = part.constant[k] - in.gravity.x();
    if (force != 0.0 || part.first_force[k] != 0.0) {
      cell.push.edit().force.x() = force;
      cell.push.edit().first_force.x() = part.first_force[k];
    }
    cell.place = in.place;
    return cell;
  }

  /// Adds taps for modules to which nothing is attached: they are only displayed, as the sum of the
  /// lowest modes.
  void addPictures(const LinearPart& linear,
                   const ModalPart& part,
                   int first,
                   const std::vector<unsigned char>& is_touched) {
    const std::size_t count = std::min(kPictureModes, part.kept.size());
    for (std::size_t i = 0; i < linear.mats.size(); ++i) {
      const int m = linear.mats[i];
      if (is_touched[at(m)] != 0) {
        continue;
      }
      const double root = std::sqrt(from_.valueOf(from_.mats[at(m)].mass));
      scene::Tap& tap = addTap(m, 0.0);
      for (std::size_t k = 0; k < count; ++k) {
        const double weight = part.modes->vectors(static_cast<Eigen::Index>(i), part.kept[k]);
        tap.shares.push_back({first + static_cast<int>(k), weight / root});
      }
    }
  }

  const Scene& from_;
  Rates rates_;
  const std::vector<ModalPlan>& plans_;
  Scene to_;
};

}  // namespace

std::optional<Scene> withModes(const Scene& scene,
                               const Rates& rates,
                               std::vector<std::string>& notes) {
  const auto isModal = [](const scene::Section& section) {
    return section.modes != scene::kNoModes;
  };
  if (std::none_of(scene.sections.begin(), scene.sections.end(), isModal)) {
    return std::nullopt;
  }
  const Network network(scene);
  std::vector<ModalPlan> plans;
  for (int s = 0; s < static_cast<int>(scene.sections.size()); ++s) {
    ModalPlan plan;
    if (isModal(scene.sections[at(s)]) && planModes(network, rates, s, plan, notes)) {
      plans.push_back(std::move(plan));
    }
  }
  if (plans.empty()) {
    return std::nullopt;
  }
  return Rewriter(scene, rates, plans).run();
}

}  // namespace ergotic::physics
