// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/performer.hpp"
#include "support/alloc_count.hpp"

namespace ergotic::station {
namespace {

constexpr physics::Rates kRates{44100.0, 12};

/// Two plates at two rates, half as many modules and links in strings.
std::string scene(int strings, int side) {
  std::string text = "ergotic: 1\nsections: {a: {}, b: {rate: {divisor: 2}}}\ngenerators:\n";
  for (int i = 0; i < strings; ++i) {
    text += "  - {type: string, name: s" + std::to_string(i) +
            ", section: a, masses: 99, mass: 1e-4, frequency: " + std::to_string(50 + i % 50) +
            ", damping: 1e-4, to: [0.6, 0]}\n";
  }
  for (const char* section : {"a", "b"}) {
    text += std::string("  - {type: mesh, name: plate_") + section + ", section: " + section +
            ", rows: " + std::to_string(side) + ", columns: " + std::to_string(side) +
            ", spacing: 0.01, mass: 1e-3, stiffness: 1e5, neighbours: 8}\n";
  }
  return text + "outputs: {o: {at: s0@0.3, quantity: position, channel: 1}}\n";
}

std::size_t partsOf(const physics::Instrument& instrument) {
  return instrument.scene().mats.size() + instrument.scene().lias.size();
}

TEST(LoadTest, AModuleOrLinkTakesAtMostTwoHundredBytes) {
  if (!test::AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the heap is the sanitizer's";
  }
  const std::string text = scene(60, 32);
  const auto bytesOf = [](const std::string& what, std::size_t& parts) {
    const test::AllocationScope scope;
    const auto performer =
        makePerformer(scene::readYaml(what, "load.yaml"), kRates, physics::Precision::kFloat);
    parts = partsOf(*performer->instrument);
    return scope.bytes();
  };
  std::size_t few = 0;
  std::size_t many = 0;
  const std::int64_t fixed = bytesOf(scene(1, 3), few);
  const std::int64_t all = bytesOf(text, many);
  ASSERT_GE(many, 20000U);
  EXPECT_LE(static_cast<double>(all - fixed) / static_cast<double>(many - few), 200.0);
}

TEST(LoadTest, TwoHundredThousandModulesAndLinksLoad) {
  const auto performer = makePerformer(scene::readYaml(scene(500, 100), "load.yaml"), kRates,
                                       physics::Precision::kFloat);
  EXPECT_GE(partsOf(*performer->instrument), 190000U);
  EXPECT_EQ(performer->certificate.verdict, physics::Verdict::kPassive);
  for (int i = 0; i < 2; ++i) {
    performer->instrument->tick({performer->positions.data(), performer->forces.data(),
                                 performer->inputs.data(), performer->outputs.data()});
  }
  EXPECT_TRUE(performer->instrument->isFinite());
}

TEST(LoadTest, TheListenerHearsEveryStage) {
  std::vector<std::string> stages;
  PerformerPolicy policy;
  policy.on_stage = [&](const std::string& stage) { stages.push_back(stage); };
  makePerformer(scene::readYaml(scene(1, 3), "load.yaml"), kRates, physics::Precision::kFloat,
                policy);
  ASSERT_EQ(stages.size(), 3U);
  EXPECT_EQ(stages[0].substr(0, 9), "validate ");
  EXPECT_EQ(stages[1].substr(0, 8), "certify ");
  EXPECT_EQ(stages[2].substr(0, 8), "compile ");
}

TEST(LoadTest, ARefusalCarriesItsVerdict) {
  const char* const stiff =
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n"
      "  - {type: string, name: s, masses: 9, mass: 1, stiffness: 1e12, to: [1, 0]}\n";
  try {
    makePerformer(scene::readYaml(stiff, "stiff.yaml"), kRates, physics::Precision::kFloat);
    FAIL() << "was not refused";
  } catch (const RefusedScene& refusal) {
    EXPECT_EQ(refusal.verdict(), physics::Verdict::kUnstable);
  }
}

}  // namespace
}  // namespace ergotic::station
