// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scene/clipped_law.hpp"
#include "scene/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

/// One type of link as it is written, and the coefficients it takes.
struct LiaKind {
  const char* name;
  LiaType type;
  std::vector<std::string> required;
  std::vector<std::string> optional;
};

const std::vector<LiaKind>& liaKinds() {
  using List = std::vector<std::string>;
  const List rest = {"rest_length"};
  const List damped = {"damping", "rest_length"};
  const List clipped = {"stiffness", "nonlinearity", "stiffness_limit"};
  static const std::vector<LiaKind> kKinds = {
      {"spring", LiaType::kSpringDamper, {"stiffness"}, rest},
      {"damper", LiaType::kSpringDamper, {"damping"}, {}},
      {"spring_damper", LiaType::kSpringDamper, {"stiffness", "damping"}, rest},
      {"contact", LiaType::kContact, {"stiffness"}, {"damping", "threshold"}},
      {"quadratic", LiaType::kQuadratic, {"stiffness", "nonlinearity"}, damped},
      {"cubic", LiaType::kCubic, {"stiffness", "nonlinearity"}, damped},
      {"clipped_cubic", LiaType::kClippedCubic, clipped, damped},
      {"cubic_contact", LiaType::kCubicContact, clipped, {"damping", "threshold"}},
      {"pluck", LiaType::kPluck, {"stiffness", "width"}, damped},
      {"bow", LiaType::kBow, {"damping", "width"}, {}},
      {"smooth_bow", LiaType::kSmoothBow, {"damping", "width"}, {}},
  };
  return kKinds;
}

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// The module under a key or in a list: never a point between two modules.
int matOf(const SceneBuilder& builder, const std::string& name, Place place) {
  if (name.find('@') != std::string::npos) {
    builder.fail(place, quoted(name) + " is a point between two modules, allowed here: one module" +
                            ", as in " + quoted(name.substr(0, name.find('@')) + ".1"));
  }
  return builder.mat(name, place);
}

void readEnds(const SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const YAML::Node& ends = map.at("between");
  if (!ends.IsSequence() || ends.size() != 2) {
    map.fail("between",
             "'between' of " + map.what() + " is not a list of 2, allowed: [lower, upper]");
  }
  int indices[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const YAML::Node& end = ends[i];
    const Place place = placeOf(end, map.placeAt("between"));
    indices[i] = matOf(builder, wordOf(builder, end, "an end of " + map.what(), place), place);
  }
  lia.a = indices[0];
  lia.b = indices[1];
  if (lia.a == lia.b) {
    map.fail("between", map.what() + " joins module " + quoted(ends[0].Scalar()) + " to itself");
  }
}

/// Points of a force law, sorted by their first number.
void readTable(const SceneBuilder& builder, const YamlMap& map, Lia& lia) {
  const YAML::Node& points = map.at("table");
  const std::string what = "'table' of " + map.what();
  if (!points.IsSequence() || points.size() < 2 || points.size() > kMaxTablePoints) {
    map.fail("table", what + " is not a list of points, allowed: 2..." +
                          std::to_string(kMaxTablePoints) + " pairs");
  }
  double before = -kInfinity;
  for (const YAML::Node& point : points) {
    const Place place = placeOf(point, map.placeAt("table"));
    if (!point.IsSequence() || point.size() != 2) {
      builder.fail(place, "a point of " + what + " is not a pair of numbers");
    }
    const double at = numberOf(builder, point[0], "first number of a point of " + what, {}, place);
    if (at <= before) {
      builder.fail(place, outOfRange("first number of a point of " + what, at,
                                     {"", before, kInfinity, true}));
    }
    lia.table.points.emplace_back(
        at, numberOf(builder, point[1], "force of a point of " + what, kForceLimits, place));
    before = at;
  }
}

/// The tipping point of a clipped law is computed once.
void refuseParameters(const YamlMap& map, const Lia& lia) {
  for (const LiaField& field : liaFields(lia.type)) {
    const bool shapes = field.member == &Lia::stiffness || field.member == &Lia::nonlinearity ||
                        field.member == &Lia::stiffness_limit;
    if (shapes && (lia.*field.member).parameter >= 0) {
      map.fail(field.key, quoted(field.key) + " of " + map.what() +
                              " is a parameter, allowed in a clipped law: a number");
    }
  }
}

Lia readLia(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  std::vector<std::string> words;
  for (const LiaKind& each : liaKinds()) {
    words.emplace_back(each.name);
  }
  const LiaKind& kind = liaKinds()[map.choice("type", words)];
  const bool may_have_table = kind.type == LiaType::kPluck || kind.type == LiaType::kBow;
  const bool has_table = may_have_table && map.has("table");
  std::vector<std::string> keys = {"type", "between"};
  if (has_table) {
    keys.emplace_back("table");
  } else {
    keys.insert(keys.end(), kind.required.begin(), kind.required.end());
    keys.insert(keys.end(), kind.optional.begin(), kind.optional.end());
  }
  if (has_table && contains(kind.optional, "rest_length")) {
    keys.emplace_back("rest_length");
  }
  map.allow(keys);

  Lia lia;
  lia.name = name;
  lia.type = kind.type;
  lia.place = map.place();
  readEnds(builder, map, lia);
  lia.rest_length = map.number("rest_length", kMetreLimits, 0.0);
  if (has_table) {
    readTable(builder, map, lia);
    return lia;
  }
  for (const LiaField& field : liaFields(kind.type)) {
    const bool required = contains(kind.required, field.key);
    lia.*field.member =
        required ? map.value(field.key, field.limits) : map.value(field.key, field.limits, {});
  }
  if (kind.type == LiaType::kClippedCubic || kind.type == LiaType::kCubicContact) {
    refuseParameters(map, lia);
    completeClippedLaw(lia, ClippedLaw::kContinuous);
  }
  return lia;
}

/// `name`, or `string@fraction`.
Point readPoint(const SceneBuilder& builder, const YamlMap& map) {
  const std::string text = map.word("at");
  const Place place = map.placeAt("at");
  const std::size_t at_sign = text.find('@');
  if (at_sign == std::string::npos) {
    return {builder.mat(text, place), -1, 0.0};
  }
  const StringInfo& string =
      builder.scene()
          .strings[static_cast<std::size_t>(builder.string(text.substr(0, at_sign), place))];
  const double along = numberIn(builder, text.substr(at_sign + 1), "fraction of " + quoted(text),
                                kFractionLimits, place);
  const double index = along * (string.count - 1);
  const int whole = static_cast<int>(std::floor(index));
  const double fraction = index - whole;
  const int mat = string.first + whole;
  return fraction > 0.0 ? Point{mat, mat + 1, fraction} : Point{mat, -1, 0.0};
}

Quantity readQuantity(const YamlMap& map, const std::vector<std::string>& words) {
  constexpr Quantity kQuantities[] = {Quantity::kPosition, Quantity::kForce, Quantity::kVelocity};
  return kQuantities[map.choice("quantity", words)];
}

Input readInput(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"mat", "quantity", "channel", "gain"});
  Input input;
  input.name = name;
  input.place = map.place();
  input.mat = matOf(builder, map.word("mat"), map.placeAt("mat"));
  input.quantity = readQuantity(map, {"position", "force"});
  input.channel = map.integer("channel", kChannelLimits) - 1;
  input.gain = map.value("gain", kGainLimits, {1.0});
  const Mat& mat = builder.scene().mats[static_cast<std::size_t>(input.mat)];
  if (input.quantity == Quantity::kPosition && mat.type != MatType::kDriven) {
    map.fail("quantity", map.what() + " sets the position of module " + quoted(mat.name) +
                             ", allowed: modules of type driven");
  }
  return input;
}

Port readPort(const SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"mat", "slice", "offset", "position_scale", "force_scale"});
  Port port;
  port.name = name;
  port.place = map.place();
  port.mat = matOf(builder, map.word("mat"), map.placeAt("mat"));
  port.slice = map.integer("slice", kSliceLimits);
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

}  // namespace

void readLias(SceneBuilder& builder, const YamlMap& top) {
  std::size_t points = 0;
  forEachElement(builder, top, "lias", "link", [&](const std::string& name, const YamlMap& map) {
    Lia lia = readLia(builder, name, map);
    points += lia.table.points.size();
    if (points > kMaxSceneTablePoints) {
      builder.fail(map.place(), "the tables of the scene have more than " +
                                    std::to_string(kMaxSceneTablePoints) + " points");
    }
    builder.add(std::move(lia));
  });
}

void readPorts(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "ports", "port", [&](const std::string& name, const YamlMap& map) {
    builder.scene().ports.push_back(readPort(builder, name, map));
  });
}

void readInputs(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "inputs", "input", [&](const std::string& name, const YamlMap& map) {
    builder.scene().inputs.push_back(readInput(builder, name, map));
  });
}

void readOutputs(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "outputs", "output",
                 [&](const std::string& name, const YamlMap& map) {
                   map.allow({"at", "quantity", "channel", "gain"});
                   Output output;
                   output.name = name;
                   output.place = map.place();
                   output.point = readPoint(builder, map);
                   output.quantity = readQuantity(map, {"position", "force", "velocity"});
                   output.channel = map.integer("channel", kChannelLimits) - 1;
                   output.gain = map.value("gain", kGainLimits, {1.0});
                   builder.scene().outputs.push_back(std::move(output));
                 });
}

}  // namespace ergotic::scene
