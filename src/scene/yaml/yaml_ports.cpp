// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "constants.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

Port readPort(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(portKeys());
  Port port;
  port.name = name;
  port.place = map.place();
  port.mat = builder.mat(map.word("mat"), map.placeAt("mat"));
  port.axis = readAxis(builder, map, port.mat);
  if (map.has("slice")) {
    port.slice = map.integer("slice", kSliceLimits);
  }
  port.offset = map.number("offset", kOffsetLimits, 0.0);
  port.position_scale = map.number("position_scale", kPositionScaleLimits, 1.0);
  port.force_scale = map.number("force_scale", kForceScaleLimits, 1.0);
  const Mat& mat = builder.scene().mats[static_cast<std::size_t>(port.mat)];
  if (mat.type != MatType::kSlice) {
    map.fail("mat",
             map.what() + " is on module " + quoted(mat.name) + ", allowed: modules of type slice");
  }
  return port;
}

/// The mass that is attached to the slice of a port, and that everything else is attached to.
struct NoiseFilter {
  double mass = 0.0;  // kg
  double stiffness = 0.0;
  double damping = 0.0;
  int section = 0;
};

/// Reads a filter that is stable by itself at the wanted gestural rate: (wh)^2 + 4 z wh < 4.
NoiseFilter readFilter(const SceneBuilder& builder, const YamlMap& map, const Mat& slice) {
  map.allow(filterKeys());
  NoiseFilter filter;
  filter.section = map.has("section") ? sectionOf(builder, map) : slice.section;
  const Section& from = builder.scene().sectionOf(slice);
  const Section& to = builder.scene().sections[static_cast<std::size_t>(filter.section)];
  const bool is_scalar = from.geometry == Geometry::kScalar;
  if (to.geometry != from.geometry || !(is_scalar || to.pose.matrix() == from.pose.matrix())) {
    map.fail("section", map.what() + " is in a section of another geometry or pose than that of " +
                            quoted(slice.name) + ", allowed: the same");
  }
  filter.mass = map.number("mass", kMassLimits);
  const double ratio = map.number("damping_ratio", kDampingRatioLimits, 0.7);
  const double highest_hz =
      builder.scene().gestural_rate_hz * (std::sqrt(ratio * ratio + 1.0) - ratio) / kPi;
  const double omega = 2.0 * kPi * map.number("frequency", {"Hz", 0.0, highest_hz, true});
  filter.stiffness = filter.mass * omega * omega;
  filter.damping = 2.0 * ratio * filter.mass * omega;
  return filter;
}

/// The damper of a filter in a Euclidean section: friction that is proportional to the speed acts
/// along every axis, a damper along the line of its link alone.
Lia damperOf(const NoiseFilter& filter) {
  constexpr double kFastest = 1000.0;  // m/s
  Lia damper;
  damper.type = LiaType::kBowTable;
  const double force = filter.damping * kFastest;
  damper.law.edit().table.points = {{-kFastest, -force}, {kFastest, force}};
  return damper;
}

void attach(SceneBuilder& builder,
            const Port& port,
            const NoiseFilter& filter,
            const std::string& name) {
  Scene& scene = builder.scene();
  const Mat slice = scene.mats[static_cast<std::size_t>(port.mat)];
  Mat mass = slice;
  mass.name = name;
  mass.type = MatType::kMass;
  mass.mass = {filter.mass};
  mass.section = filter.section;
  mass.place = port.place;
  const int m = builder.add(std::move(mass));
  for (Lia& lia : scene.lias) {
    lia.a = lia.a == port.mat ? m : lia.a;
    lia.b = lia.b == port.mat ? m : lia.b;
  }
  Lia spring;
  spring.stiffness = {filter.stiffness};
  std::vector<Lia> lias;
  if (dimensionsOf(scene.sectionOf(slice).geometry) == 1) {
    spring.damping = {filter.damping};
  } else if (filter.damping > 0.0) {
    lias.push_back(damperOf(filter));
    lias.back().name = name + ".damper";
  }
  spring.name = name;
  lias.push_back(std::move(spring));
  for (Lia& lia : lias) {
    lia.a = m;
    lia.b = port.mat;
    lia.place = port.place;
    builder.add(std::move(lia));
  }
  for (Port& other : scene.ports) {
    other.filter = other.mat == port.mat ? m : other.filter;
  }
}

}  // namespace

int readAxis(const SceneBuilder& builder, const YamlMap& map, int mat) {
  if (!map.has("axis")) {
    return 0;
  }
  std::vector<std::string> axes = {"x", "y", "z"};
  const Scene& scene = builder.scene();
  const Section& section = scene.sectionOf(scene.mats[static_cast<std::size_t>(mat)]);
  axes.resize(static_cast<std::size_t>(dimensionsOf(section.geometry)));
  return static_cast<int>(map.choice("axis", axes));
}

void readPorts(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "ports", "port", [&](const std::string& name, const YamlMap& map) {
    builder.scene().ports.push_back(readPort(builder, name, map));
  });
}

void readPortFilters(SceneBuilder& builder, const YamlMap& top) {
  std::size_t next = 0;
  forEachElement(builder, top, "ports", "port", [&](const std::string& name, const YamlMap& map) {
    const Port port = builder.scene().ports[next++];
    if (!map.has("filter")) {
      return;
    }
    if (port.filter >= 0) {
      builder.fail(map.keyPlaceAt("filter"), map.what() +
                                                 " has a filter and so has another port "
                                                 "of its module, allowed: one for each module");
    }
    const Mat& slice = builder.scene().mats[static_cast<std::size_t>(port.mat)];
    attach(builder, port, readFilter(builder, map.map("filter"), slice), name + ".filter");
  });
}

}  // namespace ergotic::scene
