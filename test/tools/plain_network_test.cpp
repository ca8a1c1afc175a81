// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/plain_network.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "support/plain_difference.hpp"

namespace ergotic::tools {
namespace {

using physics::Precision;
using scene::Geometry;
using scene::LiaType;
using test::SceneBuilder;

const physics::Rates kRates{44100.0, 8};

double differenceFromInstrument(const scene::Scene& scene, int ticks) {
  return test::differenceFromPlain(scene, Precision::kDouble, kRates, ticks);
}

TEST(PlainNetworkTest, MovesAFallingMassByHand) {
  SceneBuilder builder;
  builder.scene.sections[0].gravity.x() = -9.81;
  builder.mass(0.1);
  const auto plain = makePlainNetwork(builder.scene, kRates, Precision::kDouble);
  plain->step(100);
  double moved = 0.0;
  plain->readDisplacements(&moved);
  EXPECT_NEAR(moved, -9.81 * 100 * 101 / (2 * 44100.0 * 44100.0), 1e-15);
}

TEST(PlainNetworkTest, MovesALossyStringAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.chain(40, 0.001, 2e5, 0.02);
  for (int i = 1; i <= 40; ++i) {
    builder.scene.mats[static_cast<std::size_t>(i)].mass = {0.001 + 1e-5 * i};
  }
  builder.scene.mats[7].push.edit().velocity.x() = 1.0;
  builder.scene.lias[3].rest_length = 1e-4;
  builder.scene.mats[20].push.edit().force.x() = 0.3;
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, MovesARandomGraphAsTheInstrumentDoes) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> pick(0, 49);
  std::uniform_real_distribution<double> number(0.5, 1.5);
  SceneBuilder builder;
  for (int i = 0; i < 50; ++i) {
    builder.mass(0.001 * number(random), 0.0, i == 0 ? 1.0 : 0.0);
  }
  for (int l = 0; l < 100; ++l) {
    const int a = pick(random);
    const int b = (a + 1 + pick(random) % 49) % 50;
    builder.spring(a, b, 3e4 * number(random), 0.01 * number(random));
  }
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, MovesAStretchedChainInSpaceAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.scene.sections[0].geometry = Geometry::kSpace;
  builder.scene.sections[1].geometry = Geometry::kSpace;
  builder.chain(10, 0.001, 1e5, 0.05);
  for (std::size_t i = 0; i < builder.scene.mats.size(); ++i) {
    scene::Mat& mat = builder.scene.mats[i];
    mat.rest.x() = 0.01 * static_cast<double>(i);
    mat.position = mat.rest;
  }
  for (scene::Lia& lia : builder.scene.lias) {
    lia.rest_length = 0.009;
  }
  builder.scene.mats[3].push.edit().velocity = {0.1, 1.0, 0.5};
  builder.link(LiaType::kContact, 2, 6, 1e4, 0.1);
  builder.scene.lias.back().law.edit().width = {0.0405};
  EXPECT_LT(differenceFromInstrument(builder.scene, 200), 1e-12);
}

TEST(PlainNetworkTest, HitsWithASlowHammerAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.chain(20, 0.001, 1e5, 0.02);
  const int hammer = builder.mass(0.01, -1e-3, 2.0, SceneBuilder::kGestural);
  const int hand = builder.ground(0.0, SceneBuilder::kGestural);
  builder.spring(hand, hammer, 50.0, 0.1);
  builder.link(LiaType::kContact, 8, hammer, 5e3, 0.2);
  std::swap(builder.scene.lias.back().a, builder.scene.lias.back().b);
  builder.spring(hammer, 12, 100.0, 0.05);
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, SaysWhatItCannotDo) {
  const auto complaint = [](const scene::Scene& scene) -> std::string {
    try {
      makePlainNetwork(scene, kRates, Precision::kFloat);
    } catch (const Exception& error) {
      return error.what();
    }
    return "none";
  };
  SceneBuilder cells;
  cells.cell(0.001, 10.0, 0.0);
  EXPECT_THAT(complaint(cells.scene), testing::HasSubstr("module like 'm0'"));
  SceneBuilder cubic;
  cubic.link(LiaType::kCubic, cubic.mass(0.1), cubic.ground(), 10.0);
  EXPECT_THAT(complaint(cubic.scene), testing::HasSubstr("link like 'l0'"));
  SceneBuilder mixed;
  mixed.mass(0.1);
  mixed.scene.sections[1].geometry = Geometry::kSpace;
  EXPECT_THAT(complaint(mixed.scene), testing::HasSubstr("'gestural'"));
}

}  // namespace
}  // namespace ergotic::tools
