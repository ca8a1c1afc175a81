// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "support/test.hpp"
#include "tgr/end_effectors/fields.hpp"

namespace ergotic::test {

/// A scene of ports alone: a rig looks at nothing else.
class PortScene {
 public:
  scene::Port& port(const std::string& name, int slice = -1) {
    scene::Port port;
    port.name = name;
    port.slice = slice;
    port.place = {static_cast<int>(scene.ports.size()) + 10, 3};
    scene.file = "ports.yaml";
    scene.ports.push_back(port);
    return scene.ports.back();
  }

  scene::Scene scene;
};

inline tgr::EndEffectorConfig endEffector(tgr::EndEffectorType type,
                                          std::vector<int> slices,
                                          std::vector<std::string> ports) {
  tgr::EndEffectorConfig config;
  config.name = tgr::traitsOf(type).name;
  config.type = type;
  config.slices = std::move(slices);
  config.ports = std::move(ports);
  config.place = {4, 2};
  return config;
}

inline tgr::EndEffectors endEffectors(std::vector<tgr::EndEffectorConfig> list) {
  return {"hands.yaml", std::move(list)};
}

}  // namespace ergotic::test
