// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/ranges.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A mass on a spring: lambda = h^2 K/M.
std::vector<JudgedRange> judged(const char* parameters, const char* spring = "stiffness: $k") {
  return judgeRanges(
      scene::readYaml("ergotic: 1\nparameters: {" + std::string(parameters) +
                          "}\nsections: {s: {}}\n"
                          "mats: {m: {type: mass, mass: $m}, g: {type: ground}}\n"
                          "lias: {l: {type: spring_damper, between: [m, g], damping: 1, " +
                          spring + "}}\n",
                      "ranges.yaml"),
      kRates);
}

TEST(RangesTest, EndAtTheLimitOfTheStep) {
  const auto ranges = judged("k: {value: 1e6, range: [1e5, 2e6]}, m: {value: 1, range: [0.5, 2]}");
  ASSERT_EQ(ranges.size(), 2U);
  // h^2 K/M + 2 h Z/M < 4, the other parameter at its worst
  const double most = (4.0 * 0.5 - 2.0 / 44100.0) * 44100.0 * 44100.0;
  EXPECT_EQ(ranges[0].name, "k");
  EXPECT_EQ(ranges[0].decides, JudgedRange::End::kMaximum);
  EXPECT_TRUE(ranges[0].holds);
  EXPECT_NEAR(ranges[0].highest, most, 2e-3 * most);
  EXPECT_LE(ranges[0].highest, most);
  EXPECT_NEAR(ranges[0].lowest, 0.0, 1e4);
  const double least = 2e6 / (4.0 * 44100.0 * 44100.0) + 2.0 / (4.0 * 44100.0);
  EXPECT_EQ(ranges[1].decides, JudgedRange::End::kMinimum);
  EXPECT_NEAR(ranges[1].lowest, least, 2e-3);
  EXPECT_GE(ranges[1].lowest, least);
  EXPECT_TRUE(std::isinf(ranges[1].highest));
}

TEST(RangesTest, WhatIsUnprovenIsToldWhereItWouldHold) {
  const double limit = 4.0 * 44100.0 * 44100.0;
  const auto ranges = judged("k: {value: 1e6, range: [1e5, 1e12]}, m: {value: 1, range: [1, 1]}");
  EXPECT_EQ(ranges[0].decides, JudgedRange::End::kMaximum);
  EXPECT_TRUE(ranges[0].holds);
  EXPECT_NEAR(ranges[0].highest, limit, 2e-3 * limit);
  EXPECT_FALSE(ranges[1].holds) << "whatever the mass, the stiffness is too high";
}

TEST(RangesTest, WhatNothingDependsOnHasNoEnd) {
  const auto ranges =
      judged("k: {value: 1, range: [0, 2]}, m: {value: 1, range: [1, 1]}", "stiffness: 100");
  EXPECT_EQ(ranges[0].decides, JudgedRange::End::kNone);
  EXPECT_TRUE(std::isinf(ranges[0].highest));
  EXPECT_TRUE(std::isinf(ranges[0].lowest));
}

}  // namespace
}  // namespace ergotic::physics
