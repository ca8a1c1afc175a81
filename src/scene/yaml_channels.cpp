// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>
#include <vector>

#include "scene/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

/// The module that a text names: never a point between two modules.
int matOf(const SceneBuilder& builder, const std::string& name, Place place) {
  if (name.find('@') != std::string::npos) {
    builder.fail(place, quoted(name) + " is a point between two modules, allowed here: one module" +
                            ", as in " + quoted(name.substr(0, name.find('@')) + ".1"));
  }
  return builder.mat(name, place);
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
