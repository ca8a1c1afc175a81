// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "scene/generators.hpp"
#include "scene/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

/// One type of module and the keys it takes beside `type`, `section` and `at`.
struct MatKind {
  const char* name;
  MatType type;
  std::vector<std::string> keys;
};

const std::vector<MatKind>& matKinds() {
  static const std::vector<MatKind> kKinds = {
      {"mass", MatType::kMass, {"mass", "x", "v", "rest"}},
      {"ground", MatType::kGround, {"x"}},
      {"cell", MatType::kCell, {"mass", "stiffness", "damping", "x", "v"}},
      {"driven", MatType::kDriven, {"x", "rest"}},
      {"slice", MatType::kSlice, {"rest"}},
  };
  return kKinds;
}

/// The section that is named, or the only one.
int sectionOf(const SceneBuilder& builder, const YamlMap& map) {
  if (map.has("section")) {
    return builder.section(map.word("section"), map.placeAt("section"));
  }
  if (builder.scene().sections.size() == 1) {
    return 0;
  }
  std::string names;
  for (const Section& section : builder.scene().sections) {
    names += (names.empty() ? "" : ", ") + section.name;
  }
  builder.fail(map.place(), "missing key 'section' of " + map.what() + ", allowed: " + names);
}

Eigen::Vector2d planePoint(const YamlMap& map, const std::string& key) {
  const std::vector<double> yz = map.vector(key, 2, kMetreLimits);
  return {yz[0], yz[1]};
}

Mat readMat(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  std::vector<std::string> words;
  for (const MatKind& each : matKinds()) {
    words.emplace_back(each.name);
  }
  const MatKind& kind = matKinds()[map.choice("type", words)];
  std::vector<std::string> keys = {"type", "section", "at"};
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  map.allow(keys);

  Mat mat;
  mat.name = name;
  mat.type = kind.type;
  mat.section = sectionOf(builder, map);
  mat.place = map.place();
  if (kind.type == MatType::kMass || kind.type == MatType::kCell) {
    mat.mass = map.value("mass", kMassLimits);
  }
  mat.stiffness = map.value("stiffness", kStiffnessLimits, {});
  mat.damping = map.value("damping", kDampingLimits, {});
  mat.rest.x() = map.number("rest", kMetreLimits, 0.0);
  mat.position.x() = map.number("x", kMetreLimits, mat.rest.x());
  mat.velocity.x() = map.number("v", kVelocityLimits, 0.0);
  if (kind.type == MatType::kGround) {
    mat.rest.x() = mat.position.x();
  }
  const Eigen::Vector2d at = planePoint(map, "at");
  mat.rest.y() = at.x();
  mat.rest.z() = at.y();
  if (kind.type == MatType::kSlice &&
      !builder.scene().sections[static_cast<std::size_t>(mat.section)].gestural) {
    builder.fail(map.has("section") ? map.placeAt("section") : map.place(),
                 map.what() + " is a slice in a section that is not gestural, allowed: sections " +
                     "with rate: gestural");
  }
  return mat;
}

Value readStringStiffness(const SceneBuilder& builder, const YamlMap& map, const StringSpec& spec) {
  if (map.has("stiffness") == map.has("frequency")) {
    builder.fail(map.has("stiffness") ? map.keyPlaceAt("stiffness") : map.place(),
                 map.what() + " has " + (map.has("stiffness") ? "both" : "neither") +
                     " 'stiffness' and 'frequency', allowed: exactly one of them");
  }
  return map.has("stiffness")
             ? map.value("stiffness", kStiffnessLimits)
             : stringStiffness(spec.masses, spec.mass, map.number("frequency", kFrequencyLimits));
}

void readString(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "masses", "mass", "stiffness", "frequency", "damping",
             "loss", "from", "to", "pluck"});
  StringSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  spec.masses = map.integer("masses", {"", 1.0, kMaxMats - 2});
  spec.mass = map.value("mass", kMassLimits);
  spec.stiffness = readStringStiffness(builder, map, spec);
  spec.damping = map.value("damping", kDampingLimits, {});
  if (map.has("loss")) {
    spec.loss = map.value("loss", kDampingLimits);
  }
  map.at("to");
  spec.from = planePoint(map, "from");
  spec.to = planePoint(map, "to");
  if (map.has("pluck")) {
    const YamlMap pluck = map.map("pluck");
    pluck.allow({"at", "height"});
    spec.pluck = Eigen::Vector2d(pluck.number("at", kInnerFractionLimits),
                                 pluck.number("height", kMetreLimits));
  }
  addString(builder, spec);
}

void readChaplet(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"type", "name", "section", "from", "mass", "at"});
  ChapletSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = sectionOf(builder, map);
  const Section& section = builder.scene().sections[static_cast<std::size_t>(spec.section)];
  if (section.gestural || section.divisor != 1) {
    builder.fail(map.has("section") ? map.placeAt("section") : map.place(),
                 map.what() + " is in section " + quoted(section.name) +
                     ", allowed: sections with rate: audio");
  }
  spec.from = builder.mat(map.word("from"), map.placeAt("from"));
  spec.mass = map.value("mass", kMassLimits);
  const Mat& carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];
  spec.at =
      map.has("at") ? planePoint(map, "at") : Eigen::Vector2d(carrier.rest.y(), carrier.rest.z());
  addChaplet(builder, spec);
}

}  // namespace

void readMats(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "mats", "module", [&](const std::string& name, const YamlMap& map) {
    builder.add(readMat(builder, name, map));
  });
}

void readGenerators(SceneBuilder& builder, const YamlMap& top) {
  if (!top.has("generators")) {
    return;
  }
  const YAML::Node& list = top.at("generators");
  if (!list.IsSequence()) {
    top.fail("generators", "'generators' is not a list, allowed: a list of maps");
  }
  for (const YAML::Node& node : list) {
    const YamlMap map(builder, node, "generator", placeOf(node, top.placeAt("generators")));
    const std::size_t type = map.choice("type", {"string", "chaplet"});
    const std::string name = map.word("name");
    checkName(builder, name, map.placeAt("name"));
    (type == 0 ? readString : readChaplet)(builder, name, map);
  }
}

}  // namespace ergotic::scene
