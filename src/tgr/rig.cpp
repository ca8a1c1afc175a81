// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/rig.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/driver.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::tgr {
namespace {

std::uint64_t bitOf(int slice) {
  return std::uint64_t{1} << static_cast<unsigned>(slice);
}

/// A port that one slice moves by itself.
struct Direct {
  int slice;
  int port;
};

/// A port that an agent moves.
struct Led {
  int port;
  scene::Agent agent;
};

/// An end-effector where it was last within its workspace.
struct Tool {
  std::unique_ptr<Kinematics> kinematics;
  double position_scale = 1.0;
  double force_scale = 1.0;
  std::uint64_t bits = 0;  ///< bit mask of its slices
  bool is_within = false;
  std::array<int, Kinematics::kMaxSlicesOfOne> slices{};
  std::array<int, Kinematics::kMaxCoordinates> ports{};  ///< -1: none
  std::array<double, Kinematics::kMaxCoordinates> x{};
  std::array<double, Kinematics::kMaxCoordinates * Kinematics::kMaxSlicesOfOne> jacobian{};

  void move(const double* device) noexcept {
    std::array<double, Kinematics::kMaxSlicesOfOne> q{};
    for (int i = 0; i < kinematics->slices(); ++i) {
      q[at(i)] = device[slices[at(i)]];
    }
    is_within = kinematics->forward(q.data(), x.data(), jacobian.data());
  }

  /// Adds J^T F. \param force  [ports] N, at the device's side of the ports' own scales
  void addForces(const double* force, double* device) const noexcept {
    if (!is_within) {
      return;
    }
    const int columns = kinematics->slices();
    for (int c = 0; c < kinematics->coordinates(); ++c) {
      if (ports[at(c)] < 0) {
        continue;
      }
      const double hand = force_scale * force[ports[at(c)]];
      for (int i = 0; i < columns; ++i) {
        device[slices[at(i)]] += jacobian[at(c * columns + i)] * hand;
      }
    }
  }
};

class SceneRig final : public Rig {
 public:
  SceneRig(std::vector<scene::Port> ports, int slices)
      : ports_(std::move(ports)), slices_(slices) {}

  void add(Tool tool) {
    slices_in_use_ |= tool.bits;
    tools_.push_back(std::move(tool));
  }
  void add(const Direct& direct) {
    slices_in_use_ |= bitOf(direct.slice);
    direct_.push_back(direct);
  }
  void add(Led led) { led_.push_back(std::move(led)); }

  ERGOTIC_REALTIME std::uint64_t toModel(const double* slices,
                                         double time_s,
                                         double* ports) noexcept override {
    std::array<double, kMaxPorts> hand{};
    for (const Direct& direct : direct_) {
      hand[at(direct.port)] = slices[direct.slice];
    }
    for (const Led& led : led_) {
      hand[at(led.port)] = led.agent.at(time_s);
    }
    std::uint64_t beyond = 0;
    for (Tool& tool : tools_) {
      tool.move(slices);
      beyond |= tool.is_within ? 0 : tool.bits;
      for (int c = 0; c < tool.kinematics->coordinates(); ++c) {
        if (tool.ports[at(c)] >= 0) {
          hand[at(tool.ports[at(c)])] = tool.x[at(c)] / tool.position_scale;
        }
      }
    }
    for (std::size_t p = 0; p < ports_.size(); ++p) {
      ports[p] = (hand[p] - ports_[p].offset) / ports_[p].position_scale;
    }
    return beyond;
  }

  ERGOTIC_REALTIME void toDevice(const double* ports, double* slices) const noexcept override {
    std::array<double, kMaxPorts> hand{};
    for (std::size_t p = 0; p < ports_.size(); ++p) {
      hand[p] = ports_[p].force_scale * ports[p];
    }
    std::fill_n(slices, slices_, 0.0);
    for (const Direct& direct : direct_) {
      slices[direct.slice] += hand[at(direct.port)];
    }
    for (const Tool& tool : tools_) {
      tool.addForces(hand.data(), slices);
    }
  }

  std::uint64_t slicesInUse() const noexcept override { return slices_in_use_; }

 private:
  std::vector<scene::Port> ports_;
  int slices_;
  std::vector<Direct> direct_;
  std::vector<Led> led_;
  std::vector<Tool> tools_;
  std::uint64_t slices_in_use_ = 0;
};

/// Assigns every port and every slice to at most one mover.
class RigMaker {
 public:
  RigMaker(const scene::Scene& scene, const EndEffectors& end_effectors, int slices)
      : scene_(scene),
        end_effectors_(end_effectors),
        slices_(slices),
        owner_of_port_(scene.ports.size()) {}

  std::unique_ptr<Rig> make() {
    if (scene_.ports.size() > at(kMaxPorts)) {
      fail(scene_.ports[at(kMaxPorts)], "is one of " + std::to_string(scene_.ports.size()) +
                                            ", allowed: at most " + std::to_string(kMaxPorts));
    }
    auto rig = std::make_unique<SceneRig>(scene_.ports, slices_);
    for (const EndEffectorConfig& config : end_effectors_.list) {
      checkName(config);
      rig->add(toolOf(config));
    }
    for (std::size_t p = 0; p < scene_.ports.size(); ++p) {
      const scene::Port& port = scene_.ports[p];
      const int index = static_cast<int>(p);
      if (owner_of_port_[p] != nullptr) {
        continue;
      }
      if (port.agent >= 0) {
        rig->add(Led{index, scene_.agents.at(at(port.agent))});
      } else if (port.slice >= slices_) {
        fail(port, "needs slice " + std::to_string(port.slice) + ", the device has 0..." +
                       std::to_string(slices_ - 1));
      } else if (port.slice >= 0 && owner_of_slice_[at(port.slice)] == nullptr) {
        rig->add(Direct{port.slice, index});
      }
    }
    return rig;
  }

 private:
  [[noreturn]] void fail(const scene::Port& port, const std::string& what) const {
    throw TextError(scene_.file, port.place.line, port.place.column,
                    "port " + scene::quoted(port.name) + " " + what);
  }
  [[noreturn]] void fail(const EndEffectorConfig& config, const std::string& what) const {
    throw TextError(end_effectors_.file, config.place.line, config.place.column,
                    "end-effector " + scene::quoted(config.name) + ": " + what);
  }

  /// Names are also those of frames, beside those of the device.
  void checkName(const EndEffectorConfig& config) {
    if (config.name.empty() || config.name == "model" || config.name.rfind("tgr_", 0) == 0) {
      fail(config, "not a name for one, allowed: all but '', 'model' and 'tgr_...'");
    }
    if (!names_.insert(config.name).second) {
      fail(config, "the name comes twice");
    }
  }

  void checkScale(const EndEffectorConfig& config,
                  const char* what,
                  double value,
                  const scene::Limits& limits) const {
    if (!limits.hold(value)) {
      fail(config, scene::outOfRange(what, value, limits));
    }
  }

  Tool toolOf(const EndEffectorConfig& config) {
    Tool tool;
    checkScale(config, "position_scale", config.position_scale, scene::kPositionScaleLimits);
    checkScale(config, "force_scale", config.force_scale, scene::kForceScaleLimits);
    tool.kinematics = makeKinematics(config, end_effectors_.file);
    tool.position_scale = config.position_scale;
    tool.force_scale = config.force_scale;
    const int coordinates = tool.kinematics->coordinates();
    if (static_cast<int>(config.ports.size()) != coordinates) {
      fail(config, std::to_string(config.ports.size()) + " ports, allowed: " +
                       std::to_string(coordinates) + ", one for each coordinate");
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < config.slices.size(); ++i) {
      take(config, config.slices[i]);
      tool.slices[i] = config.slices[i];
      bits |= bitOf(config.slices[i]);
    }
    tool.ports.fill(-1);
    for (std::size_t c = 0; c < config.ports.size(); ++c) {
      if (!config.ports[c].empty()) {
        tool.ports[c] = take(config, config.ports[c]);
        tool.bits = bits;  // one that moves nothing is not in use
      }
    }
    return tool;
  }

  void take(const EndEffectorConfig& config, int slice) {
    if (slice < 0 || slice >= slices_) {
      fail(config, "slice " + std::to_string(slice) + " does not exist, the device has 0..." +
                       std::to_string(slices_ - 1));
    }
    const EndEffectorConfig*& owner = owner_of_slice_[at(slice)];
    if (owner != nullptr) {
      fail(config, "slice " + std::to_string(slice) + " is taken by end-effector " +
                       scene::quoted(owner->name));
    }
    owner = &config;
  }

  int take(const EndEffectorConfig& config, const std::string& name) {
    const auto found = std::find_if(scene_.ports.begin(), scene_.ports.end(),
                                    [&name](const scene::Port& port) { return port.name == name; });
    if (found == scene_.ports.end()) {
      std::vector<std::string> known;
      for (const scene::Port& port : scene_.ports) {
        known.push_back(port.name);
      }
      fail(config, "the scene has no port " + scene::quoted(name) + scene::suggestion(name, known));
    }
    if (found->agent >= 0) {
      fail(config, "port " + scene::quoted(name) + " is moved by agent " +
                       scene::quoted(scene_.agents.at(at(found->agent)).name));
    }
    const auto index = found - scene_.ports.begin();
    const EndEffectorConfig*& owner = owner_of_port_[static_cast<std::size_t>(index)];
    if (owner != nullptr) {
      fail(config, "port " + scene::quoted(name) + " is taken by end-effector " +
                       scene::quoted(owner->name));
    }
    owner = &config;
    return static_cast<int>(index);
  }

  const scene::Scene& scene_;
  const EndEffectors& end_effectors_;
  int slices_;
  std::set<std::string> names_;
  std::vector<const EndEffectorConfig*> owner_of_port_;
  std::array<const EndEffectorConfig*, kMaxSlices> owner_of_slice_{};
};

}  // namespace

std::unique_ptr<Rig> makeRig(const scene::Scene& scene,
                             const EndEffectors& end_effectors,
                             int slices) {
  return RigMaker(scene, end_effectors, slices).make();
}

}  // namespace ergotic::tgr
