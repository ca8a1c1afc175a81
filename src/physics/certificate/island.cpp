// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/island.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "at.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

constexpr double kFlatnessRounding = 1e-12;  // of a cosine

bool switches(const scene::Lia& lia) {
  return scene::lawOf(lia.type).switches;
}

bool isOfBend(const scene::Lia& lia) {
  return lia.bend >= 0;
}

/// Single precision plays bends with few digits: these decide whether modes meet.
scene::Scene withBendsInFloat(scene::Scene scene, const Rates& rates) {
  for (scene::Lia& lia : scene.lias) {
    if (!isOfBend(lia)) {
      continue;
    }
    const StepUnits units(scene, rates, divisorOf(scene.sectionOf(scene.mats[at(lia.a)]), rates));
    const auto rounding = [&](double number) {
      return number == 0.0
                 ? 1.0
                 : static_cast<double>(scene::inPrecision<float>(scene, lia, number)) / number;
    };
    const double of_stiffness = rounding(scene.valueOf(lia.stiffness));
    const double of_damping = rounding(units.damping(scene.valueOf(lia.damping)));
    lia.stiffness.factor *= of_stiffness;
    lia.damping.factor *= of_damping;
  }
  return scene;
}

void setParameters(scene::Scene& scene, double scene::Parameter::*end) {
  for (scene::Parameter& parameter : scene.parameters) {
    parameter.value = parameter.*end;
  }
}

using Sections = std::vector<const scene::Section*>;

bool areAlike(const Sections& flats) {
  return std::all_of(flats.begin(), flats.end(), [&](const scene::Section* section) {
    return section->pose.linear().isApprox(flats.front()->pose.linear(), kFlatnessRounding);
  });
}

bool haveOneAxis(const Sections& scalars) {
  return std::all_of(scalars.begin(), scalars.end(), [&](const scene::Section* section) {
    const double cosine = scalars.front()->pose.linear().col(0).dot(section->pose.linear().col(0));
    return std::abs(cosine) >= 1.0 - kFlatnessRounding;
  });
}

/// True if the axis of the scalar sections lies in every line and plane.
bool liesIn(const Sections& flats, const Sections& scalars) {
  return scalars.empty() ||
         std::all_of(flats.begin(), flats.end(), [&](const scene::Section* section) {
           const Eigen::Vector3d axis = scalars.front()->pose.linear().col(0);
           double seen = 0.0;
           for (int k = 0; k < dimensionsOf(section->geometry); ++k) {
             const double cosine = section->pose.linear().col(k).dot(axis);
             seen += cosine * cosine;
           }
           return seen >= 1.0 - kFlatnessRounding;
         });
}

}  // namespace

Island::Island(const RatedNetwork& networks, int island) : networks_(networks), island_(island) {
  for (int m = 0; m < static_cast<int>(networks.scene().mats.size()); ++m) {
    masses_ += isMember(m) ? 1 : 0;
  }
}

bool Island::isMember(int mat) const {
  return networks_.network().nodes[at(mat)].is_free && networks_.islandOf(mat) == island_;
}

bool Island::isMember(const scene::Lia& lia) const {
  return networks_.isExplicit(lia) && networks_.islandOf(lia) == island_;
}

scene::Scene Island::isolated(bool closed) const {
  scene::Scene scene = networks_.scene();
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    if (networks_.network().nodes[at(m)].is_free && !isMember(m)) {
      scene.mats[at(m)].type = MatType::kGround;
    }
  }
  scene.lias.clear();
  for (int l = 0; l < static_cast<int>(networks_.scene().lias.size()); ++l) {
    const scene::Lia& lia = networks_.scene().lias[at(l)];
    if (!isMember(lia)) {
      continue;
    }
    scene.lias.push_back(lia);
    if (closed && switches(lia)) {
      scene.lias.back().type = LiaType::kSpringDamper;
      scene.lias.back().stiffness = {networks_.slopes(l).stiffness.highest};
      scene.lias.back().damping = {networks_.slopes(l).damping.highest};
    }
  }
  return scene;
}

std::vector<scene::Scene> Island::cases() const {
  std::vector<scene::Scene> result{isolated(false)};
  if (std::any_of(result[0].lias.begin(), result[0].lias.end(), switches)) {
    result.push_back(isolated(true));
  }
  if (std::any_of(result[0].lias.begin(), result[0].lias.end(), isOfBend)) {
    result.push_back(withBendsInFloat(result[0], networks_.rates()));
  }
  if (followsParameters()) {
    const std::vector<scene::Scene> present = result;
    for (double scene::Parameter::*end : {&scene::Parameter::minimum, &scene::Parameter::maximum}) {
      for (scene::Scene scene : present) {
        setParameters(scene, end);
        result.push_back(std::move(scene));
      }
    }
  }
  return result;
}

bool Island::follows(const scene::Value& v) const {
  const Range span = rangeOf(networks_.scene(), v);
  return span.lowest != span.highest;
}

bool Island::followsParameters() const {
  const scene::Scene& scene = networks_.scene();
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    const scene::Mat& mat = scene.mats[at(m)];
    if (isMember(m) && (follows(mat.mass) || follows(mat.stiffness) || follows(mat.damping) ||
                        follows(scene.sectionOf(mat).medium))) {
      return true;
    }
  }
  return std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return isMember(lia) && (follows(lia.stiffness) || follows(lia.damping) ||
                             follows(lia.law->nonlinearity) || follows(lia.law->stiffness_limit) ||
                             follows(lia.law->limit_damping) || follows(lia.law->exponent));
  });
}

/// True if all coordinates move as one does by itself, or in one rate beside it. Links between
/// different geometries act along the axes of the smaller one; what they leave is another network.
/// So do links between lines, and planes, that are turned against one another.
bool Island::isOneLine() const {
  std::set<scene::Geometry> geometries;
  std::set<int> divisors;  // of Euclidean sections
  std::vector<const scene::Section*> scalars;
  std::vector<const scene::Section*> flats;  // lines and planes
  for (int m = 0; m < static_cast<int>(networks_.scene().mats.size()); ++m) {
    if (!isMember(m)) {
      continue;
    }
    const scene::Section& section = networks_.scene().sectionOf(networks_.scene().mats[at(m)]);
    geometries.insert(section.geometry);
    if (section.geometry == scene::Geometry::kScalar) {
      scalars.push_back(&section);
      continue;
    }
    divisors.insert(networks_.divisorOfMat(m));
    if (section.geometry != scene::Geometry::kSpace) {
      flats.push_back(&section);
    }
  }
  return areAlike(flats) &&
         (geometries.size() <= 1 ||
          (divisors.size() == 1 && haveOneAxis(scalars) && liesIn(flats, scalars)));
}

std::string Island::doubt() const {
  if (!isOneLine()) {
    return "its sections have different geometries and act along different axes, or at several "
           "rates: what moves across is not what was worked out";
  }
  const scene::Scene& scene = networks_.scene();
  for (const scene::Lia& lia : scene.lias) {
    if (!isMember(lia)) {
      continue;
    }
    if (networks_.isMoving(lia)) {
      return "the ends of link '" + lia.name + "' move: that is so where they are at the start";
    }
    for (const int end : {lia.a, lia.b}) {
      const scene::Section& section = scene.sectionOf(scene.mats[at(end)]);
      if (leavesModesOut(networks_.network(), scene.mats[at(end)].section)) {
        return "they were worked out with all modes of section '" + section.name +
               "', of which some are left out. Use modes: all";
      }
      if (section.geometry != scene::Geometry::kScalar && lia.rest_length != 0.0) {
        return "link '" + lia.name + "' turns and has a length at rest: no matrix describes it";
      }
    }
  }
  if (followsParameters()) {
    return "that is so at the present values of its parameters and at both ends of their ranges, "
           "not proven between";
  }
  return {};
}

}  // namespace ergotic::physics
