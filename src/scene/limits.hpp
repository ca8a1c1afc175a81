// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "constants.hpp"
#include "ergotic/scene/scene.hpp"

/// Ranges of every number of a scene, said once for the readers and for `validate`.
namespace ergotic::scene {

/// Single precision holds a hundred million times as much: room for steps and products.
constexpr double kLargestNumber = 1e30;
constexpr double kSmallestNumber = 1e-30;

struct Limits {
  const char* unit = "";  ///< unit in scenes in SI units
  double minimum = -kInfinity;
  double maximum = kInfinity;
  bool above = false;  ///< the minimum itself is not allowed

  /// True if within, not beyond kLargestNumber and, of what has a unit and must not be 0, not below
  /// kSmallestNumber.
  bool hold(double value) const;
  /// Text for messages, as in `> 0 kg`, `0...1`, `a finite number of m`; without unit if
  /// `with_unit` is false.
  std::string text(bool with_unit = true) const;
};

constexpr Limits kMassLimits{"kg", 0.0, kInfinity, true};
constexpr Limits kStiffnessLimits{"N/m", 0.0};
constexpr Limits kDampingLimits{"N s/m", 0.0};
constexpr Limits kForceLimits{"N"};
constexpr Limits kMetreLimits{"m"};
constexpr Limits kVelocityLimits{"m/s"};
constexpr Limits kAngleLimits{"rad"};
constexpr Limits kGravityLimits{"m/s^2"};
constexpr Limits kSleepLimits{"J", 0.0, kInfinity, true};
constexpr Limits kGainLimits{""};
constexpr Limits kRadiationLimits{"Hz", 1.0, 20000.0};
constexpr Limits kGesturalRateLimits{"Hz", 500.0, 48000.0};
constexpr Limits kDivisorLimits{"audio frames", 1.0, 4096.0};
constexpr Limits kModesLimits{"", 1.0, 1e6};
constexpr Limits kFractionLimits{"", 0.0, 1.0};
constexpr Limits kGuideScaleLimits{"1/m"};
constexpr Limits kPointSpeedLimits{"1/s", 0.0, kInfinity, true};
constexpr Limits kPointPowerLimits{"W", 0.0, kInfinity, true};
constexpr Limits kWeightLimits{"", -1e6, 1e6};  ///< weight of a tap
constexpr Limits kSpacingLimits{"m", 0.0, kInfinity, true};
constexpr Limits kHardeningLimits{"", 0.0, 1e6};  ///< hardening of a stretch
constexpr Limits kInnerFractionLimits{"", 0.001, 0.999};
constexpr Limits kFrequencyLimits{"Hz", 0.0, 24000.0, true};
constexpr Limits kExponentLimits{"", 1.0, 5.0};
constexpr Limits kSliceLimits{"", 0.0, 63.0};
constexpr Limits kChannelLimits{"", 1.0, 64.0};  ///< as written; one less in a Scene
constexpr Limits kOffsetLimits{"m", -1.0, 1.0};
constexpr Limits kPositionScaleLimits{"", 1e-6, 1e6};
constexpr Limits kForceScaleLimits{"", 0.0, 1e6};

constexpr Limits kDampingRatioLimits{"", 0.0, 2.0};

constexpr int kMaxMats = 2'000'000;
constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20U;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kMaxTablePoints = 4096;            ///< points of one force law
constexpr std::size_t kMaxSceneTablePoints = 1U << 20U;  ///< points of all force laws together

/// `mass = -1 kg is out of range, allowed: > 0 kg`
std::string outOfRange(const std::string& what,
                       double value,
                       const Limits& limits,
                       bool with_unit = true);

/// The shortest of the usual forms of a number.
std::string numberText(double value);

}  // namespace ergotic::scene
