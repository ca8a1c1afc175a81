// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ergotic::panel {
namespace {

constexpr float kAmbient = 0.30F;
constexpr float kDiffuse = 0.70F;
constexpr float kShine = 0.25F;
constexpr float kAboveCamera = 0.6F;  // of the light, as share of its distance
constexpr float kStaleLight = 0.8F;

// Light on rviz's dark ground, in the order of ModuleLook.
const std::array<Tint, kModuleLooks> kTints = {{{0.0F, 0.0F, 0.0F},
                                                {0.66F, 0.70F, 0.78F},
                                                {0.58F, 0.38F, 0.22F},
                                                {0.34F, 0.43F, 0.56F},
                                                {0.70F, 0.74F, 0.80F},
                                                {0.42F, 0.42F, 0.45F},
                                                {0.30F, 0.72F, 1.00F},
                                                {0.78F, 0.60F, 0.92F}}};
const std::array<Tint, 6> kSectionTints = {{{1.0F, 0.72F, 0.20F},
                                            {0.35F, 0.78F, 1.0F},
                                            {0.55F, 0.95F, 0.45F},
                                            {1.0F, 0.45F, 0.45F},
                                            {0.80F, 0.60F, 1.0F},
                                            {0.95F, 0.95F, 0.60F}}};
const Tint kWarm(1.0F, 0.45F, 0.08F);
const Tint kHot(1.0F, 0.93F, 0.55F);
const Tint kCool(0.10F, 0.25F, 1.0F);
const Tint kCold(0.55F, 0.90F, 1.0F);

/// Colour of a glow: from nothing over orange to light yellow; below zero over blue to light blue.
Tint heat(float glow) {
  constexpr float kHalf = 0.5F;
  const Tint& weak = glow < 0.0F ? kCool : kWarm;
  const Tint& strong = glow < 0.0F ? kCold : kHot;
  const float size = std::abs(glow);
  return size < kHalf ? weak : Tint(weak + (size - kHalf) / kHalf * (strong - weak));
}

std::uint32_t toByte(float share) {
  return static_cast<std::uint32_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

}  // namespace

Tint tintOf(ModuleLook look) {
  return kTints[static_cast<std::size_t>(look)];
}

Tint tintOfSection(std::size_t section) {
  return kSectionTints[section % kSectionTints.size()];
}

ModelLight::ModelLight(const Eigen::Vector3f& eye,
                       const Eigen::Vector3f& middle,
                       const Eigen::Vector3f& up)
    : eye_(eye),
      to_light_(((eye - middle).normalized() + kAboveCamera * up.normalized()).normalized()) {}

float ModelLight::on(const Eigen::Vector3f& normal, const Eigen::Vector3f& place) const {
  const float length = normal.norm();
  if (!(length > 0.0F)) {
    return kAmbient + kDiffuse;
  }
  const bool is_back = normal.dot(eye_ - place) < 0.0F;
  const float facing = (is_back ? -1.0F : 1.0F) * normal.dot(to_light_) / length;
  const float lit = std::max(facing, 0.0F);
  const float square = lit * lit;
  const float fourth = square * square;
  return kAmbient + kDiffuse * lit + kShine * fourth * fourth;
}

std::uint32_t colourOf(const Tint& tint, float light, float glow, bool is_stale) {
  Tint colour = light * tint;
  if (is_stale) {
    colour.setConstant(kStaleLight * colour.mean());
  } else {
    // What glows keeps some of its shades, or its form would be lost.
    const float shaded = 0.6F + 0.4F * std::min(light, 1.0F);
    const float dark = 1.0F - std::abs(glow);
    const float share = 1.0F - dark * dark;
    colour += share * (shaded * heat(glow) - colour);
  }
  return toByte(colour.x()) | toByte(colour.y()) << 8 | toByte(colour.z()) << 16 | 0xFF000000U;
}

}  // namespace ergotic::panel
