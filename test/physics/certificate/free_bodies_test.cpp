// SPDX-License-Identifier: BSD-3-Clause
// Bodies that nothing holds: what single precision makes of the forces that their links take at
// rest.
#include <functional>
#include <string>
#include <vector>

#include "physics/certificate/certified_scene.hpp"

namespace ergotic::physics {
namespace {

/// Modules of one mass in a row, and links between neighbours.
std::string row(int count,
                const char* geometry,
                const std::function<std::string(int)>& module,
                const std::vector<std::string>& links) {
  std::string text = "ergotic: 1\ngestural_rate: 1000\nsections: {a: {geometry: ";
  text += std::string(geometry) + "}}\nmats:\n";
  for (int m = 0; m < count; ++m) {
    text += "  m" + std::to_string(m) + ": {type: mass, " + module(m) + "}\n";
  }
  text += "lias:\n";
  for (const std::string& link : links) {
    text += "  " + link + "\n";
  }
  return text + "outputs: {o: {at: m0, quantity: velocity, channel: 1}}\n";
}

std::string bend(int first, double stiffness) {
  const auto name = [first](int m) { return "m" + std::to_string(first + m); };
  return "b" + std::to_string(first) + ": {type: bend, between: [" + name(0) + ", " + name(1) +
         ", " + name(2) + "], weights: [1, -2, 1], stiffness: " + std::to_string(stiffness) + "}";
}

/// A straight bar takes no force, wherever it lies: what its springs rest at, each rounded by
/// itself, pulled it out to 182 m within a minute.
TEST(RoundingTest, ABarThatNothingHoldsInAPlaneStaysWhereItIs) {
  const Certified bar(row(
      4, "plane", [](int m) { return "mass: 0.001, at: [" + std::to_string(0.01 * m) + ", 0.37]"; },
      {bend(0, 380411.501), bend(1, 378815.438)}));
  EXPECT_TRUE(bar.isCertified());
  EXPECT_EQ(bar.fastestOf(10.0, Precision::kFloat), 0.0);
  EXPECT_EQ(bar.fastestOf(10.0, Precision::kDouble), 0.0);
}

/// Forces that springs take at rest must add up to nothing: rounded by module they pushed a chain,
/// always the same way, to 1 m/s in 20 s, the faster the further it went. Noise is left.
TEST(RoundingTest, AChainThatNothingHoldsIsNotPushedByItsRestLengths) {
  const double stiffness[] = {214831.317, 838884.423, 765668.933, 320467.856, 530827.7,  490619.123,
                              667491.538, 787503.177, 179383.078, 122049.205, 828672.449};
  for (const double damping : {0.0, 0.05}) {
    std::vector<std::string> springs;
    for (int s = 0; s < 11; ++s) {
      springs.push_back("s" + std::to_string(s) + ": {type: spring_damper, between: [m" +
                        std::to_string(s + 1) + ", m" + std::to_string(s) +
                        "], rest_length: 0.01, stiffness: " + std::to_string(stiffness[s]) +
                        ", damping: " + std::to_string(damping) + "}");
    }
    const Certified chain(row(
        12, "scalar", [](int m) { return "mass: 0.001, x: " + std::to_string(0.01 * m); },
        springs));
    EXPECT_TRUE(chain.isCertified());
    EXPECT_LT(chain.fastestOf(20.0, Precision::kFloat), 0.3);
  }
}

/// Bends of unlike stiffness side by side have sums of more digits than single precision has.
TEST(RoundingTest, ABarOfUnlikePartsThatNothingHoldsTurnsEvenly) {
  std::vector<std::string> bends;
  for (int b = 0; b < 10; ++b) {
    bends.push_back(bend(b, b % 2 == 0 ? 388923103.8 : 48015.1940628));
  }
  const Certified bar(row(
      12, "scalar", [](int m) { return "mass: 1, v: " + std::to_string((m - 5.5) / 12000.0); },
      bends));
  EXPECT_TRUE(bar.isCertified());
  EXPECT_LT(bar.fastestOf(10.0, Precision::kFloat), 1e-3);  // 4.6e-4 at the start
}

}  // namespace
}  // namespace ergotic::physics
