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

using scene::MatType;
using scene::Scene;

constexpr std::size_t kPictureModes = 24;

/// Rewrites a scene by the plans of its sections.
class Rewriter {
 public:
  Rewriter(const Scene& from, const Rates& rates, const std::vector<ModalPlan>& plans)
      : from_(from), rates_(rates), plans_(plans) {}

  ModalScene run() {
    to_.scene = from_;
    to_.scene.mats.clear();
    to_.scene.lias.clear();
    to_.scene.strings.clear();
    to_.scene.taps.clear();
    copyMats();
    copyLias();
    for (const ModalPlan& plan : plans_) {
      addModes(plan);
      to_.scene.sections[at(plan.section)].modes = scene::kNoModes;
    }
    std::sort(to_.as_written.pictures.begin(), to_.as_written.pictures.end(),
              [](const ModalPicture& a, const ModalPicture& b) { return a.mat < b.mat; });
    renumber();
    copyPlaces();
    return std::move(to_);
  }

 private:
  int newIndex(int mat) const { return to_.as_written.mats[at(mat)]; }

  void copyMats() {
    std::vector<unsigned char> is_touched(from_.mats.size(), 0);
    std::vector<unsigned char> is_replaced(from_.mats.size(), 0);
    for (const ModalPlan& plan : plans_) {
      for (const LinearPart& part : plan.linear.parts) {
        for (const int m : part.mats) {
          is_replaced[at(m)] = 1;
        }
      }
      for (const ModalTouch& touch : plan.touches) {
        is_touched[at(touch.mat)] = 1;
      }
    }
    to_.as_written.mats.assign(from_.mats.size(), -1);
    for (std::size_t m = 0; m < from_.mats.size(); ++m) {
      if (is_touched[m] != 0 || is_replaced[m] == 0) {
        to_.as_written.mats[m] = static_cast<int>(to_.scene.mats.size());
        to_.scene.mats.push_back(from_.mats[m]);
        if (is_touched[m] != 0) {
          to_.scene.mats.back().type = MatType::kPoint;
        }
      }
    }
  }

  void copyLias() {
    for (std::size_t l = 0; l < from_.lias.size(); ++l) {
      const bool is_in = std::any_of(plans_.begin(), plans_.end(), [l](const ModalPlan& plan) {
        return plan.linear.is_in[l] != 0;
      });
      if (!is_in) {
        scene::Lia lia = from_.lias[l];
        lia.a = newIndex(lia.a);
        lia.b = newIndex(lia.b);
        to_.scene.lias.push_back(std::move(lia));
        to_.as_written.lias.push_back(static_cast<int>(l));
      }
    }
  }

  void addModes(const ModalPlan& plan) {
    std::vector<int> first_of;
    for (const ModalPart& part : plan.parts) {
      first_of.push_back(static_cast<int>(to_.scene.mats.size()));
      for (const int k : part.kept) {
        addMode(plan.section, part, k);
      }
    }
    std::vector<Eigen::Index> next(plan.parts.size(), 0);
    for (const ModalTouch& touch : plan.touches) {
      scene::Tap tap{newIndex(touch.mat), {}, from_.mats[at(touch.mat)].place, touch.offset};
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
          tap.shares.push_back({newIndex(share.mat), share.weight});
        }
      }
      to_.scene.taps.push_back(std::move(tap));
    }
    for (std::size_t p = 0; p < plan.parts.size(); ++p) {
      addPictures(plan.linear.parts[p], plan.parts[p], first_of[p]);
    }
  }

  /// A cell whose coefficients in a step are those of the mode, whatever its section adds.
  void addMode(int section, const ModalPart& part, int k) {
    const scene::Section& in = from_.sections[at(section)];
    const double step = StepUnits(from_, rates_, divisorOf(in, rates_)).step;
    scene::Mat cell;
    cell.name = in.name + ".mode";
    cell.type = MatType::kCell;
    cell.section = section;
    cell.mass.factor = 1.0;
    cell.stiffness.factor = part.pull[k] / (step * step);
    cell.damping.factor = part.loss[k] / step - from_.valueOf(in.medium);
    cell.position.x() = part.x[k];
    scene::setVelocity(cell, part.d[k] / step * Eigen::Vector3d::UnitX());
    const double force = part.constant[k] - in.gravity.x();
    if (force != 0.0) {
      cell.push.edit().force.x() = force;
    }
    cell.place = in.place;
    to_.first_forces.emplace_back(static_cast<int>(to_.scene.mats.size()), part.first_force[k]);
    to_.scene.mats.push_back(std::move(cell));
  }

  void addPictures(const LinearPart& linear, const ModalPart& part, int first) {
    const std::size_t count = std::min(kPictureModes, part.kept.size());
    for (std::size_t i = 0; i < linear.mats.size(); ++i) {
      const int m = linear.mats[i];
      if (newIndex(m) >= 0) {
        continue;
      }
      const double root = std::sqrt(from_.valueOf(from_.mats[at(m)].mass));
      ModalPicture picture{m, first, {}};
      for (std::size_t k = 0; k < count; ++k) {
        picture.weights.push_back(static_cast<float>(
            part.modes->vectors(static_cast<Eigen::Index>(i), part.kept[k]) / root));
      }
      to_.as_written.pictures.push_back(std::move(picture));
    }
  }

  void renumber() {
    for (scene::Port& port : to_.scene.ports) {
      port.mat = newIndex(port.mat);
      port.filter = port.filter < 0 ? -1 : newIndex(port.filter);
    }
    for (scene::Input& input : to_.scene.inputs) {
      input.mat = newIndex(input.mat);
    }
    for (scene::Output& output : to_.scene.outputs) {
      output.point.mat = newIndex(output.point.mat);
      output.point.next = output.point.next < 0 ? -1 : newIndex(output.point.next);
    }
  }

  /// Grids whose modules are all still there, and the points on them.
  void copyPlaces() {
    to_.scene.grids.clear();
    to_.scene.connections.clear();
    std::vector<int> grid_of(from_.grids.size(), -1);
    for (int c = 0; c < static_cast<int>(from_.connections.size()); ++c) {
      if (isTouched(&ModalPlan::connections, c)) {
        continue;
      }
      scene::Connection place = from_.connections[at(c)];
      int& grid = grid_of[at(place.grid)];
      if (grid < 0) {
        grid = static_cast<int>(to_.scene.grids.size());
        to_.scene.grids.push_back(from_.grids[at(place.grid)]);
        to_.scene.grids.back().first = newIndex(to_.scene.grids.back().first);
      }
      place.grid = grid;
      place.mat = newIndex(place.mat);
      place.guide = place.guide < 0 ? -1 : newIndex(place.guide);
      to_.scene.connections.push_back(std::move(place));
    }
    for (int t = 0; t < static_cast<int>(from_.taps.size()); ++t) {
      if (!isTouched(&ModalPlan::taps, t)) {
        scene::Tap tap = from_.taps[at(t)];
        tap.mat = newIndex(tap.mat);
        for (scene::Tap::Share& share : tap.shares) {
          share.mat = newIndex(share.mat);
        }
        to_.scene.taps.push_back(std::move(tap));
      }
    }
  }

  bool isTouched(std::vector<int> ModalPlan::*among, int point) const {
    return std::any_of(plans_.begin(), plans_.end(), [&](const ModalPlan& plan) {
      return std::count((plan.*among).begin(), (plan.*among).end(), point) > 0;
    });
  }

  const Scene& from_;
  Rates rates_;
  const std::vector<ModalPlan>& plans_;
  ModalScene to_;
};

}  // namespace

std::optional<ModalScene> withModes(const Scene& scene,
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
