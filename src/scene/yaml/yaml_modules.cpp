// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "scene/generate/points.hpp"
#include "scene/rules/rules.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

/// One type of module and the keys it takes beside `type` and `section`.
struct MatKind {
  const char* name;
  MatType type;
  std::vector<std::string> keys;
  std::vector<std::string> scalar_keys;  ///< keys in scalar sections only
};

const std::vector<MatKind>& matKinds() {
  static const std::vector<MatKind> kKinds = {
      {"mass", MatType::kMass, {"at", "mass", "x", "v"}, {"rest"}},
      {"ground", MatType::kGround, {"at"}, {"x"}},
      {"cell", MatType::kCell, {"at", "mass", "stiffness", "damping", "matched", "x", "v"}, {}},
      {"driven", MatType::kDriven, {"at", "x"}, {"rest"}},
      {"slice", MatType::kSlice, {"at", "coupling"}, {"rest"}},
      {"point", MatType::kPoint, {"at", "along", "guide", "range", "speed", "power"}, {}},
      {"tap", MatType::kPoint, {"of", "weights"}, {}},
  };
  return kKinds;
}

const MatKind& moduleKind(const YamlMap& map) {
  static const auto kWords = [] {
    std::vector<std::string> words;
    for (const MatKind& each : matKinds()) {
      words.emplace_back(each.name);
    }
    return words;
  }();
  return matKinds()[map.choice("type", kWords)];
}

KeyNames moduleKeys(const MatKind& kind) {
  KeyNames keys = {"type", "section"};
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  keys.insert(keys.end(), kind.scalar_keys.begin(), kind.scalar_keys.end());
  return keys;
}

/// Rest, position and velocity.
void readPlaces(const SceneBuilder& builder, const YamlMap& map, const MatKind& kind, Mat& mat) {
  const Section& section = builder.scene().sectionOf(mat);
  mat.rest = readRest(section, map, "at");
  if (section.geometry == Geometry::kScalar) {
    mat.rest.x() = map.number("rest", kMetreLimits, 0.0);
  } else {
    refuseIn(builder, section, map, kind.scalar_keys, "'at'");
  }
  const int moving = dimensionsOf(section.geometry);
  Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();
  at_rest.head(moving) = mat.rest.head(moving);
  mat.position = readMoving(section, map, "x", kMetreLimits, at_rest);
  if (map.has("v")) {
    mat.push.edit().velocity =
        readMoving(section, map, "v", kVelocityLimits, Eigen::Vector3d::Zero());
  }
  if (kind.type == MatType::kGround) {
    mat.rest.head(moving) = mat.position.head(moving);
  }
}

Mat readMat(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  const MatKind& kind = moduleKind(map);
  map.allow(moduleKeys(kind));
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
  if (map.has("coupling")) {
    const std::vector<std::string> words = {"hold", "smooth", "chaplet", "auto"};
    mat.coupling = static_cast<Coupling>(map.choice("coupling", words));
  }
  mat.matched = map.flag("matched", kind.type == MatType::kCell);
  readPlaces(builder, map, kind, mat);
  const Section& section = builder.scene().sectionOf(mat);
  if (kind.type == MatType::kSlice && !section.gestural && !section.automatic_rate) {
    builder.fail(map.has("section") ? map.placeAt("section") : map.place(),
                 map.what() + " is a slice in a section that is not gestural, allowed: sections " +
                     "with rate: gestural or auto");
  }
  return mat;
}

/// `of: key` or `of: [a, b]`.
std::vector<Tap::Share> readModules(const SceneBuilder& builder, const YamlMap& map) {
  const Node& of = map.at("of");
  if (of.isList() && of.size() == 0) {
    map.fail("of", "'of' of " + map.what() + " is empty, allowed: one module at least");
  }
  std::vector<Tap::Share> shares;
  for (std::size_t i = 0; i < (of.isList() ? of.size() : 1); ++i) {
    const Node& node = of.isList() ? of[i] : of;
    const Place place = placeOf(node, map.placeAt("of"));
    const int mat = builder.mat(wordOf(builder, node, "a module of " + map.what(), place), place);
    shares.push_back({mat, 1.0});
    const Mat& first = builder.scene().mats[static_cast<std::size_t>(shares.front().mat)];
    const std::string reason = reasonAgainstTap(builder.scene(), first.section, mat);
    if (!reason.empty()) {
      builder.fail(place, map.what() + " " + reason);
    }
  }
  return shares;
}

/// Without weights it is the mean of its modules.
void readTap(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  Tap tap;
  tap.place = map.place();
  tap.shares = readModules(builder, map);
  const std::size_t count = tap.shares.size();
  const std::vector<double> weights =
      map.has("weights") ? map.numbers("weights", count, count, kWeightLimits)
                         : std::vector<double>(count, 1.0 / static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    tap.shares[i].weight = weights[i];
  }
  addTap(builder, name, std::move(tap));
}

void refuseSection(const SceneBuilder& builder, const YamlMap& map) {
  if (map.has("section")) {
    builder.fail(map.keyPlaceAt("section"),
                 "'section' of " + map.what() + ", allowed: none, it is that of what it lies on");
  }
}

}  // namespace

KeysOfTypes keysOfMats() {
  KeysOfTypes all;
  for (const MatKind& kind : matKinds()) {
    all.emplace_back(kind.name, moduleKeys(kind));
  }
  return all;
}

void readMats(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "mats", "module", [&](const std::string& name, const YamlMap& map) {
    if (moduleKind(map).type != MatType::kPoint) {
      builder.add(readMat(builder, name, map));
    }
  });
}

void readPoints(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "mats", "module", [&](const std::string& name, const YamlMap& map) {
    const MatKind& kind = moduleKind(map);
    if (kind.type == MatType::kPoint) {
      map.allow(moduleKeys(kind));
      refuseSection(builder, map);
      (map.word("type") == "tap" ? readTap : readPoint)(builder, name, map);
    }
  });
}

}  // namespace ergotic::scene
