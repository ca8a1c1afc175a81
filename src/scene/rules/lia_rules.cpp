// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "scene/laws/friction.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/relaxing.hpp"
#include "scene/names.hpp"
#include "scene/pressers.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

const Section& sectionAt(const Scene& scene, int mat) {
  return scene.sectionOf(scene.mats[static_cast<std::size_t>(mat)]);
}

/// Reason why `scheme: energy_stable` is refused, or nullptr.
const char* explicitOnly(const Scene& scene, const Lia& lia) {
  const Geometry a = sectionAt(scene, lia.a).geometry;
  const Geometry b = sectionAt(scene, lia.b).geometry;
  const bool is_straight = a == Geometry::kScalar || b == Geometry::kScalar ||
                           (dimensionsOf(a) == 1 && dimensionsOf(b) == 1);
  const bool is_linear = lia.type == LiaType::kSpringDamper && lia.rest_length == 0.0;
  return is_linear && is_straight ? "a linear spring or damper" : lawOf(lia.type).explicitOnly(lia);
}

}  // namespace

bool canBeEnergyStable(const Scene& scene, const Lia& lia) {
  return explicitOnly(scene, lia) == nullptr;
}

Limits restLengthLimits(const Scene& scene, const Lia& lia) {
  const bool scalar = sectionAt(scene, lia.a).geometry == Geometry::kScalar ||
                      sectionAt(scene, lia.b).geometry == Geometry::kScalar;
  return {"m", scalar ? -kInfinity : 0.0};
}

Limits releaseLimits(const Scene& scene, const Lia& lia) {
  double engage = lia.law->width.factor;
  if (lia.law->width.parameter >= 0) {
    const Parameter& p = scene.parameters[static_cast<std::size_t>(lia.law->width.parameter)];
    engage *= engage > 0.0 ? p.maximum : p.minimum;
  }
  return {"m", engage};
}

std::string schemeFault(const Scene& scene, const Lia& lia) {
  if (lia.scheme == Scheme::kExplicit && sticks(lia.type)) {
    return "link " + quoted(lia.name) +
           " cannot be explicit, it sticks, allowed: auto, energy_stable";
  }
  const char* kind = explicitOnly(scene, lia);
  if (lia.scheme != Scheme::kEnergyStable || kind == nullptr) {
    return "";
  }
  return "link " + quoted(lia.name) + " cannot be energy-stable, it is " + kind +
         ", allowed: auto, explicit";
}

std::string filterFault(const Scene& scene, const Lia& lia) {
  if (!lia.filtered) {
    return "";
  }
  if (sectionAt(scene, lia.a).gestural == sectionAt(scene, lia.b).gestural) {
    return "link " + quoted(lia.name) +
           " cannot be filtered, allowed: links between a gestural section and a faster one";
  }
  return "";
}

std::string relaxationFault(const Scene& scene, const Lia& lia) {
  const std::vector<Relaxation>& all = lia.law->relaxations;
  const std::string of = " of link " + quoted(lia.name);
  const bool relaxes = lawOf(lia.type).kind == Law::Kind::kRelaxing;
  if (all.size() > (relaxes ? kMaxRelaxations : 0) || all.empty() == relaxes) {
    return "branches" + of + " are " + std::to_string(all.size()) +
           ", allowed: 1...3 of a relaxing link";
  }
  for (const Relaxation& each : all) {
    const Range k = rangeOf(scene, each.stiffness);
    for (const double end : {k.lowest, k.highest}) {
      if (!kStiffnessLimits.hold(end)) {
        return outOfRange("stiffness of a branch" + of, end, kStiffnessLimits);
      }
    }
    if (!kRelaxationTimeLimits.hold(each.time * scene.time_unit_s)) {
      return outOfRange("time of a branch" + of, each.time * scene.time_unit_s,
                        kRelaxationTimeLimits);
    }
  }
  return {};
}

/// A slice stands still within a tick and leaps between two: what sticks to it would, too.
std::string frictionFault(const Scene& scene, const Lia& lia) {
  if (lawOf(lia.type).tables != Law::Tables::kCoefficient) {
    return "";
  }
  const auto isSlice = [&](int mat) {
    return scene.mats[static_cast<std::size_t>(mat)].type == MatType::kSlice;
  };
  if (isSlice(lia.a) || isSlice(lia.b)) {
    return "link " + quoted(lia.name) +
           " is friction on a slice, which moves in leaps, allowed: a mass that is attached to it "
           "(of a "
           "chaplet, or of the filter of its port)";
  }
  if (!lia.law->table.empty()) {
    const std::string fault = coefficientFault(lia.law->table);
    return fault.empty() ? "" : "the table of link " + quoted(lia.name) + " " + fault;
  }
  for (const LiaLaw::Fall& fall : lia.law->falls) {
    if (!kFrictionLimits.hold(fall.share) || !kFallWidthLimits.hold(fall.width)) {
      return "a part of link " + quoted(lia.name) + " is out of range, allowed: [" +
             kFrictionLimits.text() + ", " + kFallWidthLimits.text() + "]";
    }
  }
  return kFrictionLimits.hold(lia.law->steady)
             ? ""
             : outOfRange("steady of link " + quoted(lia.name), lia.law->steady, kFrictionLimits);
}

std::string liaFault(const Scene& scene, const Lia& lia) {
  for (const auto& faultOf : {schemeFault, filterFault, relaxationFault, frictionFault}) {
    if (std::string fault = faultOf(scene, lia); !fault.empty()) {
      return fault;
    }
  }
  return {};
}

std::optional<Fault> unpressed(const Scene& scene) {
  const std::vector<int> pressers = pressersOf(scene);
  for (std::size_t l = 0; l < pressers.size(); ++l) {
    const Name& name = scene.lias[l].law->pressed_by;
    const int by = pressers[l];
    const bool presses =
        by >= 0 && lawOf(scene.lias[static_cast<std::size_t>(by)].type).kind == Law::Kind::kGap;
    if (!name.empty() && !presses) {
      return Fault{scene.lias[l].place, "link " + quoted(scene.lias[l].name) + " is pressed by " +
                                            quoted(name) + ", allowed: a contact"};
    }
  }
  return std::nullopt;
}

}  // namespace ergotic::scene
