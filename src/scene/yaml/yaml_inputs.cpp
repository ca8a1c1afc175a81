// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

Input readInput(SceneBuilder& builder, const std::string& name, const YamlMap& map) {
  map.allow(inputKeys());
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

}  // namespace ergotic::scene
