// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "ergotic/scene/grid.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

/// A module; a place on a string, between two of its modules; or a point on a mesh.
Point readPoint(SceneBuilder& builder, const YamlMap& map) {
  const std::string text = map.word("at");
  const Place place = map.placeAt("at");
  if (text.find('@') != std::string::npos) {
    const NamedPlace at = namedPlace(builder, text, place);
    const Grid& grid = builder.scene().grids[static_cast<std::size_t>(at.grid)];
    if (grid.rows == 1 && moduleOn(grid, at) < 0) {
      const GridPlace around = placeOn(grid, at.along, 0.0);
      return {around.mats[0], around.mats[1], around.weights[1]};
    }
  }
  return {pointAt(builder, text, place), -1, 0.0};
}

Quantity readQuantity(const YamlMap& map, const std::vector<std::string>& words) {
  constexpr Quantity kQuantities[] = {Quantity::kPosition, Quantity::kForce, Quantity::kVelocity};
  return kQuantities[map.choice("quantity", words)];
}

Input readInput(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow({"mat", "quantity", "channel", "axis", "gain"});
  Input input;
  input.name = name;
  input.place = map.place();
  input.mat = pointAt(builder, map.word("mat"), map.placeAt("mat"));
  input.quantity = readQuantity(map, {"position", "force"});
  input.channel = map.integer("channel", kChannelLimits) - 1;
  input.axis = readAxis(builder, map, input.mat);
  input.gain = map.value("gain", kGainLimits, {1.0});
  const Mat& mat = builder.scene().mats[static_cast<std::size_t>(input.mat)];
  if (input.quantity == Quantity::kPosition && mat.type != MatType::kDriven) {
    map.fail("quantity", map.what() + " sets the position of module " + quoted(mat.name) +
                             ", allowed: modules of type driven");
  }
  return input;
}

}  // namespace

void readInputs(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "inputs", "input", [&](const std::string& name, const YamlMap& map) {
    builder.scene().inputs.push_back(readInput(builder, name, map));
  });
}

void readOutputs(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(builder, top, "outputs", "output",
                 [&](const std::string& name, const YamlMap& map) {
                   map.allow({"at", "quantity", "channel", "axis", "gain"});
                   Output output;
                   output.name = name;
                   output.place = map.place();
                   output.point = readPoint(builder, map);
                   output.quantity = readQuantity(map, {"position", "force", "velocity"});
                   output.channel = map.integer("channel", kChannelLimits) - 1;
                   output.axis = readAxis(builder, map, output.point.mat);
                   output.gain = map.value("gain", kGainLimits, {1.0});
                   builder.scene().outputs.push_back(std::move(output));
                 });
}

}  // namespace ergotic::scene
