// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_bodies.hpp"

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

namespace ergotic::panel {
namespace {

constexpr float kBodyRadius = 0.008F;  // of the size of the model
constexpr float kMinSizeM = 0.01F;

/// As share of kBodyRadius.
float radiusOf(ModuleLook look) {
  switch (look) {
    case ModuleLook::kHand:
      return 1.3F;
    case ModuleLook::kPoint:
      return 0.5F;
    default:
      return 1.0F;
  }
}

const Solid& solidOf(ModuleLook look, HandForm form) {
  switch (form) {
    case HandForm::kKey:
      return key();
    case HandForm::kHammer:
      return hammer();
    case HandForm::kFinger:
      return finger();
    case HandForm::kPlectrum:
      return plectrum();
    case HandForm::kBow:
      return bow();
    default:
      return look == ModuleLook::kGround ? box() : ball();
  }
}

/// What holds it comes from the player, who sits at the lower end of z.
Eigen::Matrix3f turnOf(const HandBody& hand) {
  Eigen::Matrix3f turn;
  turn.col(0) = hand.towards;
  turn.col(2) = hand.towards.cross(hand.along);
  turn.col(2) *= turn(2, 2) < 0.0F ? -1.0F : 1.0F;
  turn.col(1) = turn.col(2).cross(turn.col(0));
  return turn;
}

}  // namespace

std::vector<DrawnBody> bodiesOf(const ModelStructure& structure,
                                const ModelShape& shape,
                                float size_m) {
  std::vector<DrawnBody> bodies;
  if (shape.bodies.size() > kMaxBodies) {
    return bodies;
  }
  const std::vector<HandBody> hands = handsOf(structure, shape);
  for (std::size_t b = 0; b < hands.size(); ++b) {
    const std::uint32_t module = shape.bodies[b];
    const ModuleLook look = shape.looks[module];
    bodies.push_back({module, &solidOf(look, hands[b].form),
                      radiusOf(look) * kBodyRadius * std::max(size_m, kMinSizeM)});
    if (hands[b].form != HandForm::kNone) {
      bodies.back().turn = turnOf(hands[b]);
    }
  }
  return bodies;
}

std::array<Eigen::Vector3f, 2> axisOf(const DrawnBody& body) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& corner : body.solid->corners) {
    box.extend(corner);
  }
  int longest = 0;
  box.sizes().maxCoeff(&longest);
  std::array<Eigen::Vector3f, 2> ends{box.center(), box.center()};
  ends[0][longest] = box.min()[longest];
  ends[1][longest] = box.max()[longest];
  for (Eigen::Vector3f& end : ends) {
    end = body.radius * (body.turn * end);
  }
  return ends;
}

}  // namespace ergotic::panel
