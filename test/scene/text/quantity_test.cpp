// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/quantity.hpp"

#include <cmath>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

double valueOf(const std::string& text, const std::string& unit) {
  const auto quantity = parseQuantity(text, unit);
  const auto* const value = std::get_if<double>(&quantity);
  return value == nullptr ? std::nan("") : *value;
}
std::string reasonOf(const std::string& text, const std::string& unit) {
  const auto quantity = parseQuantity(text, unit);
  const auto* const none = std::get_if<NoQuantity>(&quantity);
  return none == nullptr ? "" : none->reason;
}

TEST(QuantityTest, IsExactlyTheNumberThatSaysTheSameWithoutAUnit) {
  EXPECT_EQ(valueOf("12 mm", "m"), 0.012);
  EXPECT_EQ(valueOf("0.1mm", "m"), 0.0001);
  EXPECT_EQ(valueOf("-7.3 \xC2\xB5m", "m"), -7.3e-6);
  EXPECT_EQ(valueOf("2.5 kN/m", "N/m"), 2500.0);
  EXPECT_EQ(valueOf("3 N/mm", "N/m"), 3000.0);
  EXPECT_EQ(valueOf("20 g", "kg"), 0.02);
  EXPECT_EQ(valueOf("1.3e2 mg", "kg"), 1.3e-4);
  EXPECT_EQ(valueOf("300 ms", "s"), 0.3);
  EXPECT_EQ(valueOf("4 mN s/m", "N s/m"), 0.004);
  EXPECT_EQ(valueOf("4 g/s", "N s/m"), 0.004);
  EXPECT_EQ(valueOf("980 cm/s^2", "m/s^2"), 9.8);
  EXPECT_EQ(valueOf("2 kHz", "Hz"), 2000.0);
  EXPECT_EQ(valueOf("5 1/s", "Hz"), 5.0);
  EXPECT_EQ(valueOf("180 deg", "rad"), 180.0 * (3.14159265358979323846 / 180.0));
  EXPECT_EQ(valueOf("+3", "kg"), 3.0);
}

TEST(QuantityTest, NotesAreFrequenciesAndRatiosHaveNoUnit) {
  EXPECT_EQ(valueOf("A4", "Hz"), 440.0);
  EXPECT_NEAR(valueOf("C4", "Hz"), 261.625565, 1e-6);
  EXPECT_EQ(valueOf("C#3", "Hz"), valueOf("Db3", "Hz"));
  EXPECT_NEAR(valueOf("A0", "Hz"), 27.5, 1e-12);
  EXPECT_NEAR(valueOf("C8", "Hz"), 4186.009, 1e-3);
  EXPECT_EQ(valueOf("B3", "Hz"), valueOf("Cb4", "Hz"));
  EXPECT_EQ(valueOf("20 %", ""), 0.2);
  EXPECT_NEAR(valueOf("-6 dB", ""), 0.501187, 1e-6);
  EXPECT_NEAR(valueOf("1200 cents", ""), 2.0, 1e-15);
}

TEST(QuantityTest, WhatIsNoneIsToldWhy) {
  for (const char* text :
       {"", " ", "x", "kg", "mm", "1e999", "1e999 N", "--3 N", "1e300 Gm", "H4"}) {
    EXPECT_EQ(reasonOf(text, "m"), " is not a finite number") << text;
  }
  for (const char* text : {"3 furlongs", "3 m m^", "3 m^-1", "3 m^9", "3 /s", "3 N//m", "3 $m"}) {
    EXPECT_THAT(reasonOf(text, "m"), HasSubstr("which is not known")) << text;
  }
  for (const char* text : {"3 kg", "3 m^2", "3 m/s", "20 %", "5 cents", "3 1"}) {
    EXPECT_EQ(reasonOf(text, "m"), " is of another kind") << text;
  }
  EXPECT_EQ(reasonOf("3 m", ""), " is of another kind");
  EXPECT_EQ(reasonOf("3 s", "audio frames"), " is of another kind");
  EXPECT_THAT(reasonOf("A4", "m"), HasSubstr("is a note"));
}

TEST(QuantityTest, ParametersSayWhatTheyAre) {
  const std::string head = "ergotic: 1\nsections: {a: {}}\nparameters: {k: {value: 2 kN/m, ";
  const std::string mats = "\nmats: {m: {type: mass, mass: 20 g}, g: {type: ground}}\n";
  const auto read = [&](const std::string& range, const std::string& lia) {
    return readYaml(head + range + "}}" + mats + "lias: {l: {between: [m, g], " + lia + "}}\n",
                    "k.yaml");
  };
  const Scene scene = read("range: [1 kN/m, 9000], unit: N/m", "type: spring, stiffness: $k");
  EXPECT_EQ(scene.parameters[0].value, 2000.0);
  EXPECT_EQ(scene.parameters[0].minimum, 1000.0);
  EXPECT_EQ(scene.parameters[0].unit, "N/m");
  EXPECT_EQ(scene.mats[0].mass.factor, 0.02);
  EXPECT_THAT(
      complaintOf<TextError>(
          [&] { read("range: [1, 9000], unit: N/m", "type: damper, damping: $k"); }),
      HasSubstr("k.yaml:5:52: error: 'damping' of link 'l' follows parameter 'k', which is in "
                "N/m, allowed: any finite number of N s/m"));
  EXPECT_NO_THROW(read("range: [1, 9000], unit: N/m", "type: damper, damping: 1e-3*$k"));
  EXPECT_THAT(
      complaintOf<TextError>([&] { read("range: [1, 9000]", "type: spring, stiffness: $k"); }),
      HasSubstr("'2 kN/m' is of another kind"));
  for (const char* unit : {"kN/m", "dB", "furlong"}) {
    EXPECT_THAT(complaintOf<TextError>([&] {
                  read("range: [1, 9000], unit: " + std::string(unit),
                       "type: spring, stiffness: $k");
                }),
                HasSubstr("allowed: SI units without prefix"));
  }
}

}  // namespace
}  // namespace ergotic::scene
