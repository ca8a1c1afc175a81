// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_plan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/note.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;

constexpr double kRounding = 1e-10;  // of the largest eigenvalue

bool moves(const Scene& scene, const scene::Connection& place) {
  const auto changes = [](const scene::Connection::Way& way) {
    return way.guide >= 0 || way.at.parameter >= 0 || way.at.audio >= 0;
  };
  const bool has_rows = scene.grids[at(place.grid)].rows > 1;
  return changes(place.along) || (has_rows && changes(place.across));
}

class Planner {
 public:
  Planner(const Network& network, const Rates& rates, ModalPlan& plan)
      : network_(network),
        scene_(network.scene),
        section_(scene_.sections[at(plan.section)]),
        rates_(rates),
        plan_(plan),
        touch_of_(scene_.mats.size(), -1) {}

  /// \return what is in the way, if anything is
  std::optional<Offence> findParts() {
    plan_.linear = linearPartsOf(network_, rates_, plan_.section);
    std::size_t springs = 0;
    for (const LinearPart& part : plan_.linear.parts) {
      springs += part.lias.size();
    }
    if (at(plan_.linear.offences) >= springs) {
      return plan_.linear.offence.value_or(
          Offence{section_.place, "no springs join free modules in it"});
    }
    for (const LinearPart& part : plan_.linear.parts) {
      if (part.mats.size() > at(kMaxModalModules)) {
        return Offence{section_.place, "springs join " + std::to_string(part.mats.size()) +
                                           " modules, allowed: at most " +
                                           std::to_string(kMaxModalModules) + " for modes"};
      }
    }
    if (std::optional<Offence> offence = findTouches()) {
      return offence;
    }
    if (plan_.touches.size() > at(kMaxModalTouches)) {
      const std::string count = std::to_string(plan_.touches.size()) +
                                " of its modules are touched by what is not part of the modes, "
                                "allowed: at most " +
                                std::to_string(kMaxModalTouches);
      const std::optional<Offence>& offence = plan_.linear.offence;
      return offence ? Offence{offence->place, offence->what + "; " + count}
                     : Offence{section_.place, count};
    }
    return std::nullopt;
  }

  std::vector<int> touchesOfParts() const {
    std::vector<int> counts(plan_.linear.parts.size(), 0);
    for (const ModalTouch& touch : plan_.touches) {
      if (touch.part >= 0) {
        ++counts[at(touch.part)];
      }
    }
    return counts;
  }

  std::optional<Offence> findModes() {
    for (std::size_t p = 0; p < plan_.linear.parts.size(); ++p) {
      const LinearPart& part = plan_.linear.parts[p];
      ModalPart to;
      const PartMatrices matrices = matricesOf(network_, rates_, plan_.linear.row_of, part);
      to.modes = modesOf(mixtureOf(matrices));
      const Eigen::MatrixXd& vectors = to.modes->vectors;
      to.pull = vectors.cwiseProduct(matrices.pull * vectors).colwise().sum();
      to.loss = vectors.cwiseProduct(matrices.loss * vectors).colwise().sum();
      if (to.pull.minCoeff() < -kRounding * to.pull.maxCoeff()) {
        return Offence{section_.place,
                       "springs of negative stiffness push its modules apart: no modes"};
      }
      to.pull = to.pull.cwiseMax(0.0);
      describe(static_cast<int>(p), to);
      plan_.parts.push_back(std::move(to));
    }
    return std::nullopt;
  }

 private:
  std::optional<Offence> findTouches() {
    for (std::size_t l = 0; l < scene_.lias.size(); ++l) {
      if (plan_.linear.is_in[l] == 0) {
        touch(scene_.lias[l].a);
        touch(scene_.lias[l].b);
      }
    }
    for (const scene::Input& input : scene_.inputs) {
      touch(input.mat);
    }
    for (const scene::Output& output : scene_.outputs) {
      touch(output.point.mat);
      if (output.point.next >= 0) {
        touch(output.point.next);
      }
    }
    for (const scene::Connection& place : scene_.connections) {
      for (const scene::Connection::Way& way : {place.along, place.across}) {
        if (way.guide >= 0) {
          touch(way.guide);
        }
      }
    }
    for (int c = 0; c < static_cast<int>(scene_.connections.size()); ++c) {
      if (isOnParts(scene_.connections[at(c)])) {
        plan_.connections.push_back(c);
        if (std::optional<Offence> offence = addGridPoint(scene_.connections[at(c)])) {
          return offence;
        }
      }
    }
    for (int t = 0; t < static_cast<int>(scene_.taps.size()); ++t) {
      const scene::Tap& tap = scene_.taps[at(t)];
      if (std::any_of(tap.shares.begin(), tap.shares.end(),
                      [this](const auto& share) { return isOfPart(share.mat); })) {
        plan_.taps.push_back(t);
        if (std::optional<Offence> offence = addPoint(tap)) {
          return offence;
        }
      }
    }
    return std::nullopt;
  }

  void touch(int mat) {
    const int part = plan_.linear.part_of[at(mat)];
    if (part >= 0 && touch_of_[at(mat)] < 0) {
      add({mat, part, {{mat, 1.0}}, 0.0});
    }
  }

  void add(ModalTouch touch) {
    touch_of_[at(touch.mat)] = static_cast<int>(plan_.touches.size());
    plan_.touches.push_back(std::move(touch));
  }

  bool isOfPart(int mat) const { return plan_.linear.part_of[at(mat)] >= 0; }

  bool isOnParts(const scene::Connection& place) const {
    const scene::Grid& grid = scene_.grids[at(place.grid)];
    const auto first = plan_.linear.part_of.begin() + grid.first;
    return std::any_of(first, first + grid.columns * grid.rows, [](int part) { return part >= 0; });
  }

  std::optional<Offence> addGridPoint(const scene::Connection& place) {
    if (moves(scene_, place)) {
      return Offence{place.place, "point '" + scene_.mats[at(place.mat)].name +
                                      "' can move, allowed on modes: points that stay"};
    }
    const scene::GridPlace around = scene::placeOf(scene_, place);
    scene::Tap tap{place.mat, {}, place.place, -scene_.mats[at(place.mat)].rest.x()};
    for (std::size_t i = 0; i < at(around.count); ++i) {
      tap.shares.push_back({around.mats[i], around.weights[i]});
      tap.offset += around.weights[i] * scene_.mats[at(around.mats[i])].rest.x();
    }
    return addPoint(tap);
  }

  std::optional<Offence> addPoint(const scene::Tap& tap) {
    ModalTouch touch{tap.mat, -1, {}, tap.offset};
    for (const scene::Tap::Share& share : tap.shares) {
      if (share.weight == 0.0) {
        continue;
      }
      const int part = plan_.linear.part_of[at(share.mat)];
      const bool is_shared = part >= 0 && (touch.part < 0 || touch.part == part);
      const bool is_ground = scene_.mats[at(share.mat)].type == scene::MatType::kGround;
      if (!is_shared && !(is_ground && !isForceHeard(share.mat))) {
        return Offence{tap.place,
                       "point '" + scene_.mats[at(tap.mat)].name +
                           "' lies between modules that do not share their modes, or on one "
                           "whose force is an output"};
      }
      touch.part = is_shared ? part : touch.part;
      touch.shares.push_back(share);
    }
    add(std::move(touch));
    return std::nullopt;
  }

  bool isForceHeard(int mat) const {
    return std::any_of(
        scene_.outputs.begin(), scene_.outputs.end(), [mat](const scene::Output& output) {
          return output.quantity == scene::Quantity::kForce && output.point.mat == mat;
        });
  }

  void describe(int p, ModalPart& to) const {
    const LinearPart& part = plan_.linear.parts[at(p)];
    const Eigen::MatrixXd& vectors = to.modes->vectors;
    const PartStart start = startOf(network_, rates_, plan_.linear.row_of, part);
    const double step = StepUnits(scene_, rates_, divisorOf(section_, rates_)).step;
    const Eigen::VectorXd root = start.mass.cwiseSqrt();
    const auto project = [&](const Eigen::VectorXd& v) { return vectors.transpose() * v; };
    to.x = project(start.x.cwiseProduct(root));
    to.d = step * project(start.velocity.cwiseProduct(root));
    to.constant = project(start.constant.cwiseQuotient(root));
    to.first_force = project((start.first_force - start.of_springs).cwiseQuotient(root));
    std::vector<const ModalTouch*> touches;
    for (const ModalTouch& touch : plan_.touches) {
      if (touch.part == p) {
        touches.push_back(&touch);
      }
    }
    to.weights.setZero(static_cast<Eigen::Index>(touches.size()), vectors.cols());
    for (std::size_t t = 0; t < touches.size(); ++t) {
      for (const scene::Tap::Share& share : touches[t]->shares) {
        if (isOfPart(share.mat)) {
          const Eigen::Index i = plan_.linear.row_of[at(share.mat)];
          to.weights.row(static_cast<Eigen::Index>(t)) += share.weight / root[i] * vectors.row(i);
        }
      }
    }
  }

  const Network& network_;
  const Scene& scene_;
  const scene::Section& section_;
  Rates rates_;
  ModalPlan& plan_;
  std::vector<int> touch_of_;  // [mats] index in plan_.touches, -1: none
};

std::string costText(const ModalCost& cost) {
  return std::to_string(cost.products) + " products per step, as a network " +
         std::to_string(cost.modules) + " modules";
}

std::string errorText(const ModalPlan& plan, int kept, int all) {
  if (kept == all) {
    return "all of them, so exact";
  }
  std::string text = std::to_string(all - kept) + " are left out: where forces are given, ";
  if (!plan.touches.empty()) {
    text += "touched places give " + shortly(100.0 * plan.error.static_share) +
            " % less at most when pushed for long, and are off by at most " +
            shortly(plan.error.per_impulse) +
            " m at any time after impulses of 1 N s in all, and by at most " +
            shortly(plan.error.at_start) + " m by their motion at the start";
  }
  return text;
}

std::string stayText(const LinearParts& linear) {
  return linear.offence ? "; some stay modules: " + linear.offence->what : "";
}

}  // namespace

bool planModes(const Network& network,
               const Rates& rates,
               int index,
               ModalPlan& plan,
               std::vector<std::string>& notes) {
  const Scene& scene = network.scene;
  const scene::Section& section = scene.sections[at(index)];
  const bool is_free_to_choose = section.modes == scene::kAutomaticModes;
  const std::string who = "section '" + section.name + "' ";
  const auto refuse = [&](const Offence& offence) {
    if (!is_free_to_choose) {
      throw TextError(scene.file, offence.place.line, offence.place.column,
                      who + "cannot be played by its modes: " + offence.what);
    }
    notes.push_back(noteAt(scene, section.place) + who + "stays a network: " + offence.what);
    return false;
  };
  plan = ModalPlan{};
  plan.section = index;
  Planner planner(network, rates, plan);
  if (const std::optional<Offence> offence = planner.findParts()) {
    return refuse(*offence);
  }
  ModalCost cost = costOf(plan.linear.parts, planner.touchesOfParts());
  if (is_free_to_choose && cost.products >= cost.modules) {
    notes.push_back(noteAt(scene, section.place) + who + "stays a network: by " +
                    std::to_string(cost.modes) + " modes, touched at " +
                    std::to_string(plan.touches.size()) + " places, " + costText(cost));
    return false;
  }
  if (const std::optional<Offence> offence = planner.findModes()) {
    return refuse(*offence);
  }
  const double step = StepUnits(scene, rates, divisorOf(section, rates)).step;
  const int kept = is_free_to_choose ? cost.modes : std::min(section.modes, cost.modes);
  plan.error = keepModes(plan.parts, kept, step);
  cost.products = cost.products / cost.modes * kept;
  notes.push_back(noteAt(scene, section.place) + who + "is played by " + std::to_string(kept) +
                  " modes, touched at " + std::to_string(plan.touches.size()) +
                  " places: " + costText(cost) + "; " + errorText(plan, kept, cost.modes) +
                  stayText(plan.linear));
  return true;
}

}  // namespace ergotic::physics
