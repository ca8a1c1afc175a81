// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/handles.hpp"

#include <algorithm>
#include <string>

#include "ergotic/tgr/rig.hpp"

namespace ergotic::node {
namespace {

constexpr std::size_t kAxes = 3;

/// Mover of a port: a coordinate of an end-effector, or a slice (no name); -1: none.
struct Mover {
  std::string end_effector;
  int index = -1;
  double position_scale = 1.0;
};

Mover moverOf(const scene::Port& port, bool is_taken, const tgr::EndEffectors& end_effectors) {
  for (const tgr::EndEffectorConfig& config : end_effectors.list) {
    const auto found = std::find(config.ports.begin(), config.ports.end(), port.name);
    if (found != config.ports.end()) {
      return {config.name, static_cast<int>(found - config.ports.begin()), config.position_scale};
    }
  }
  return {"", is_taken ? -1 : port.slice, 1.0};
}

/// Index of the module's entry, which is made if there is none.
std::size_t entryOf(const scene::Port& port,
                    const Mover& mover,
                    const scene::Scene& scene,
                    Handles& handles) {
  const auto module = static_cast<std::uint32_t>(port.mat);
  const auto known = std::find(handles.modules.begin(), handles.modules.end(), module);
  if (known != handles.modules.end()) {
    return static_cast<std::size_t>(known - handles.modules.begin());
  }
  handles.names.push_back(scene.mats[module].name);
  handles.modules.push_back(module);
  handles.end_effectors.push_back(mover.end_effector);
  handles.indices.insert(handles.indices.end(), kAxes, -1);
  handles.scales.insert(handles.scales.end(), kAxes, 1.0);
  handles.offsets.insert(handles.offsets.end(), kAxes, 0.0);
  return handles.modules.size() - 1;
}

}  // namespace

Handles handlesOf(const scene::Scene& scene, const tgr::EndEffectors& end_effectors) {
  Handles handles;
  const std::vector<int> taken = tgr::takenPorts(scene, end_effectors);
  for (std::size_t i = 0; i < scene.ports.size(); ++i) {
    const scene::Port& port = scene.ports[i];
    const bool is_taken = std::find(taken.begin(), taken.end(), static_cast<int>(i)) != taken.end();
    const Mover mover = moverOf(port, is_taken, end_effectors);
    if (mover.index < 0) {
      continue;
    }
    const std::size_t entry = entryOf(port, mover, scene, handles);
    if (handles.end_effectors[entry] != mover.end_effector) {
      continue;  // two end-effectors share a module: the first has it
    }
    const std::size_t slot = entry * kAxes + static_cast<std::size_t>(port.axis);
    handles.indices[slot] = mover.index;
    handles.scales[slot] = mover.position_scale * port.position_scale;
    handles.offsets[slot] = mover.position_scale * port.offset;
  }
  return handles;
}

}  // namespace ergotic::node
