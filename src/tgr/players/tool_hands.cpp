// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/players/tool_hands.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::tgr {
namespace {

template <class Value>
[[noreturn]] void refuseWish(const std::string& field,
                             const Value& value,
                             const std::string& allowed) {
  std::ostringstream text;
  text << field << " is " << value << ", allowed: " << allowed;
  throw Exception(text.str());
}

HandMove moveOf(int slice, double target_m, bool lets_go) {
  if (slice < 0 || slice >= kMaxSlices) {
    refuseWish("slice", slice, "0..." + std::to_string(kMaxSlices - 1));
  }
  if (!(std::abs(target_m) <= kMaxTargetM)) {
    refuseWish("target", target_m, "-0.1...0.1 m");
  }
  HandMove move;
  move.slice = slice;
  move.target_m = target_m;
  move.lets_go = lets_go;
  return move;
}

}  // namespace

ToolHands::ToolHands(const EndEffectors& end_effectors) {
  for (const EndEffectorConfig& config : end_effectors.list) {
    Tool tool;
    tool.config = config;
    tool.kinematics = makeKinematics(config, end_effectors.file);
    tool.slices.assign(static_cast<std::size_t>(tool.kinematics->slices()), 0.0);
    tool.coordinates.assign(static_cast<std::size_t>(tool.kinematics->coordinates()), 0.0);
    tools_.push_back(std::move(tool));
  }
}

bool ToolHands::has(const std::string& end_effector) const {
  return std::any_of(tools_.begin(), tools_.end(),
                     [&](const Tool& tool) { return tool.config.name == end_effector; });
}

std::vector<HandMove> ToolHands::moves(const Wish& wish) {
  if (!wish.end_effector.empty()) {
    return moveTool(toolNamed(wish.end_effector), wish);
  }
  std::vector<HandMove> moves;
  for (std::size_t i = 0; i < wish.indices.size(); ++i) {
    const auto slice = std::min<std::uint32_t>(wish.indices[i], kMaxSlices);
    moves.push_back(
        moveOf(static_cast<int>(slice), wish.lets_go ? 0.0 : wish.targets_m[i], wish.lets_go));
  }
  return moves;
}

std::vector<HandMove> ToolHands::moves(const Stroke& stroke) {
  std::vector<HandMove> wanted = moves(Wish{stroke.end_effector,
                                            {static_cast<std::uint32_t>(stroke.index)},
                                            {stroke.target_m},
                                            stroke.lets_go});
  for (HandMove& move : wanted) {
    move.grip = HandGrip::kKey;
    move.glide_s = stroke.glide_s;
    move.delay_s = stroke.after_s;
  }
  return wanted;
}

ToolHands::Tool& ToolHands::toolNamed(const std::string& name) {
  std::string names;
  for (Tool& tool : tools_) {
    if (tool.config.name == name) {
      return tool;
    }
    names += (names.empty() ? "" : ", ") + tool.config.name;
  }
  constexpr std::size_t kMaxOfName = 64;
  refuseWish("end_effector", "'" + name.substr(0, kMaxOfName) + "'",
             names.empty() ? "none, as none is there" : names);
}

/// A linkage is held or let go of as a whole.
std::vector<HandMove> ToolHands::moveTool(Tool& tool, const Wish& wish) {
  std::vector<double> coordinates = tool.coordinates;
  for (std::size_t i = 0; i < wish.indices.size(); ++i) {
    const std::uint32_t index = wish.indices[i];
    if (index >= coordinates.size()) {
      refuseWish("coordinate of " + tool.config.name, index,
                 "0..." + std::to_string(coordinates.size() - 1));
    }
    if (!wish.lets_go) {
      coordinates[index] = wish.targets_m[i];
      if (!(std::abs(coordinates[index]) <= 1.0)) {
        refuseWish("target", coordinates[index], "-1...1 m");
      }
    }
  }
  if (!wish.lets_go) {
    tool.coordinates = std::move(coordinates);
    bringTo(*tool.kinematics, tool.coordinates.data(), kMaxTargetM, tool.slices.data());
  }
  std::vector<HandMove> moves;
  for (std::size_t i = 0; i < tool.slices.size(); ++i) {
    moves.push_back(moveOf(tool.config.slices[i], tool.slices[i], wish.lets_go));
  }
  return moves;
}

}  // namespace ergotic::tgr
