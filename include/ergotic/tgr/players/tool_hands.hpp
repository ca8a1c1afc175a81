// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/players/hand_ways.hpp"

namespace ergotic::tgr {

/// Understands where hands shall go: coordinates of end-effectors become slices. Thread: one
class ToolHands {
 public:
  /// Request for a motion of hands.
  struct Wish {
    std::string end_effector;            ///< empty: `indices` are slices
    std::vector<std::uint32_t> indices;  ///< slices, or coordinates of the end-effector
    std::vector<double> targets_m;  ///< target positions, [indices]; no effect if the hands let go
    bool lets_go = false;
  };

  /// There are no end-effectors.
  ToolHands() = default;
  /// \throws TextError if one of them cannot be put together
  explicit ToolHands(const EndEffectors& end_effectors);

  /// Whether there is an end-effector of that name.
  bool has(const std::string& end_effector) const;

  /// \pre there is a target for each index, unless they let go
  /// \return for each slice its target, and nothing about when and how
  /// \throws Exception naming field, value and allowed range; nothing has changed then
  std::vector<HandMove> moves(const Wish& wish);

  /// \return what the hand does for a note, after it has arrived. \throws Exception as above
  std::vector<HandMove> moves(const Stroke& stroke);

 private:
  struct Tool {
    EndEffectorConfig config;
    std::unique_ptr<Kinematics> kinematics;
    std::vector<double> slices;       // [slices] m, as wanted last
    std::vector<double> coordinates;  // [coordinates] m, as wanted last
  };
  Tool& toolNamed(const std::string& name);
  static std::vector<HandMove> moveTool(Tool& tool, const Wish& wish);

  std::vector<Tool> tools_;
};

}  // namespace ergotic::tgr
