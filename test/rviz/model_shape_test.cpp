// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_shape.hpp"

#include <algorithm>
#include <cstdlib>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

double areaOf(const ModelStructure& structure, const ModuleIndices& triangles) {
  double area = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Eigen::Vector3f a = restOf(structure, triangles[t]);
    const Eigen::Vector3f b = restOf(structure, triangles[t + 1]);
    const Eigen::Vector3f c = restOf(structure, triangles[t + 2]);
    area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
  }
  return area;
}

TEST(ModelShapeTest, AStringIsARowFromEndToEnd) {
  StructureMaker maker;
  const std::uint32_t first = maker.string(30, 0.0F);
  for (std::uint32_t i = 0; i + 2 < 30; ++i) {
    maker.link(first + i, first + i + 2);  // it is stiff
  }
  const ModelShape shape = shapeOf(maker.structure);
  ASSERT_EQ(shape.strings.size(), 1U);
  EXPECT_EQ(shape.strings[0].size(), 30U);
  EXPECT_TRUE(std::is_sorted(shape.strings[0].begin(), shape.strings[0].end()));
  EXPECT_TRUE(shape.links.empty());
  EXPECT_TRUE(shape.bodies.empty());
}

TEST(ModelShapeTest, SquareMeshesCoverAPlateOnceWhateverElseIsLinked) {
  for (const float height : {0.01F, 0.016F, 0.03F}) {
    for (const int links : {0, 1, 2}) {  // none but the net, diagonals, and bends beside them
      StructureMaker maker;
      constexpr std::uint32_t kRows = 7;
      constexpr std::uint32_t kColumns = 9;
      maker.net(kRows, kColumns, 0.01F, height);
      for (std::uint32_t i = 0; i < kRows * kColumns && links > 0; ++i) {
        const std::uint32_t row = i / kColumns;
        const std::uint32_t column = i % kColumns;
        if (row + 1 < kRows && column + 1 < kColumns) {
          maker.link(i, i + kColumns + 1);
          maker.link(i + 1, i + kColumns);
        }
        if (links > 1 && row + 2 < kRows) {
          maker.link(i, i + 2 * kColumns);
        }
        if (links > 1 && column + 2 < kColumns) {
          maker.link(i, i + 2);
        }
      }
      const ModelShape shape = shapeOf(maker.structure);
      EXPECT_EQ(shape.triangles.size(), 3 * 2 * (kRows - 1) * (kColumns - 1)) << height << links;
      EXPECT_NEAR(areaOf(maker.structure, shape.triangles),
                  0.08 * static_cast<double>(height) * (kRows - 1), 1e-7);
      EXPECT_TRUE(shape.links.empty());
    }
  }
}

TEST(ModelShapeTest, ASkinReachesItsRimWhoseGroundsHaveNoLinks) {
  StructureMaker maker;
  constexpr std::uint32_t kSide = 6;
  maker.net(kSide, kSide, 0.01F, 0.01F);
  ModelStructure& skin = maker.structure;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const bool is_rim = i % kSide % (kSide - 1) == 0 || i / kSide % (kSide - 1) == 0;
    skin.module_types[i] = is_rim ? ModelStructure::GROUND : ModelStructure::MASS;
  }
  ModuleIndices links;
  for (std::size_t i = 0; i < skin.links.size(); i += 2) {
    if (skin.module_types[skin.links[i]] != ModelStructure::GROUND ||
        skin.module_types[skin.links[i + 1]] != ModelStructure::GROUND) {
      links.insert(links.end(), {skin.links[i], skin.links[i + 1]});
    }
  }
  skin.links = links;
  // Of the 25 meshes the four at the corners have three modules, and are triangles.
  EXPECT_NEAR(areaOf(skin, shapeOf(skin).triangles), 23e-4, 1e-7);
}

TEST(ModelShapeTest, AnOutlineIsASurfaceWithRoundedStairsAndItsModesAreHidden) {
  StructureMaker maker;
  for (int j = 0; j < 5; ++j) {
    maker.module(ModelStructure::CELL, 0.0F, 0.01F * static_cast<float>(j), 0.0F,
                 "drum." + std::to_string(j));
  }
  constexpr int kSide = 11;
  std::vector<int> numbers(kSide * kSide, -1);
  for (int i = 0; i < kSide * kSide; ++i) {
    const int y = i % kSide - kSide / 2;
    const int z = i / kSide - kSide / 2;
    if (y * y + z * z <= 26) {
      numbers[static_cast<std::size_t>(i)] = static_cast<int>(
          maker.module(ModelStructure::POINT, 0.0F, 0.01F * static_cast<float>(y),
                       0.01F * static_cast<float>(z), "drum.outline." + std::to_string(i)));
      for (const int other : {i % kSide > 0 ? i - 1 : -1, i - kSide}) {
        if (other >= 0 && numbers[static_cast<std::size_t>(other)] >= 0) {
          maker.link(static_cast<std::uint32_t>(numbers[static_cast<std::size_t>(other)]),
                     static_cast<std::uint32_t>(numbers[static_cast<std::size_t>(i)]));
        }
      }
    }
  }
  const ModelShape shape = shapeOf(maker.structure);
  // Within an eighth of the disc, and more than the squares alone, of which 60 fit in.
  EXPECT_NEAR(areaOf(maker.structure, shape.triangles), M_PI * 26e-4, 0.13 * M_PI * 26e-4);
  EXPECT_GT(areaOf(maker.structure, shape.triangles), 60e-4);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(shape.looks[i], ModuleLook::kHidden);
  }
  EXPECT_TRUE(shape.bodies.empty());
}

TEST(ModelShapeTest, RowsThatAreNoStringsAreBarsIfTheyResistBending) {
  StructureMaker maker;
  maker.row(12, 0.0F, "bar.outline.");
  const std::uint32_t stiff = maker.row(12, 0.1F);
  for (std::uint32_t i = 0; i + 2 < 12; ++i) {
    maker.link(stiff + i, stiff + i + 2);
  }
  maker.row(12, 0.2F);
  const std::uint32_t spanned = maker.row(12, 0.3F);
  for (std::uint32_t i = 0; i + 2 < 12; ++i) {
    maker.link(spanned + i, spanned + i + 2);
  }
  maker.structure.module_types[spanned] = ModelStructure::GROUND;
  maker.structure.module_types[spanned + 11] = ModelStructure::GROUND;
  const ModelShape shape = shapeOf(maker.structure);
  EXPECT_EQ(shape.bars.size(), 2U);
  EXPECT_EQ(shape.strings.size(), 2U) << "one is stiff";
}

TEST(ModelShapeTest, WhatTouchesAStringIsNoPartOfIt) {
  for (const bool is_felt : {false, true}) {
    StructureMaker maker;
    const std::uint32_t row = maker.row(12, 0.0F);
    maker.link(maker.module(ModelStructure::MASS, -0.05F, 0.2F, 0.0F), row + 3);
    maker.structure.law_names = {"spring-damper", "felt"};
    maker.structure.link_types.back() = is_felt ? 1 : 0;
    const ModelShape shape = shapeOf(maker.structure);
    ASSERT_EQ(shape.strings.size(), 1U);
    EXPECT_EQ(shape.strings[0].size(), is_felt ? 12U : 8U) << "held by a spring it is a branch";
    EXPECT_EQ(shape.bodies.size(), is_felt ? 1U : 5U);
  }
}

TEST(ModelShapeTest, WhatStandsByItselfIsABodyAndItsLinksAreSeen) {
  StructureMaker maker;
  const std::uint32_t first = maker.string(10, 0.0F);
  maker.section(1);
  const std::uint32_t hand = maker.module(ModelStructure::SLICE, 0.0F, 0.05F, 0.1F);
  const std::uint32_t hammer = maker.module(ModelStructure::MASS, 0.0F, 0.05F, 0.05F);
  const std::uint32_t ground = maker.module(ModelStructure::GROUND, 0.0F, 0.1F, 0.1F);
  const std::uint32_t finger = maker.module(ModelStructure::POINT, 0.0F, 0.1F, 0.0F);
  maker.link(hand, hammer);
  maker.link(hammer, first + 5);
  const ModelShape shape = shapeOf(maker.structure);
  EXPECT_EQ(shape.bodies, (ModuleIndices{hand, hammer, ground, finger}));
  EXPECT_EQ(shape.links, (ModuleIndices{hand, hammer, hammer, first + 5}));
  EXPECT_EQ(shape.looks[hand], ModuleLook::kHand);
  EXPECT_EQ(shape.looks[hammer], ModuleLook::kMass);
  EXPECT_EQ(shape.looks[ground], ModuleLook::kGround);
  EXPECT_EQ(shape.looks[finger], ModuleLook::kPoint);
}

TEST(ModelShapeTest, StructuresWhoseListsDoNotFitAreRefused) {
  StructureMaker maker;
  maker.string(5, 0.0F);
  EXPECT_TRUE(isConsistent(maker.structure));
  const auto broken = [&](const auto& breaks) {
    ModelStructure structure = maker.structure;
    breaks(structure);
    return !isConsistent(structure);
  };
  EXPECT_TRUE(broken([](auto& s) { s.links.push_back(0); }));
  EXPECT_TRUE(broken([](auto& s) { s.links[0] = 5; }));
  EXPECT_TRUE(broken([](auto& s) { s.rest_positions.pop_back(); }));
  EXPECT_TRUE(broken([](auto& s) { s.module_sections[2] = 1; }));
  EXPECT_TRUE(broken([](auto& s) { s.section_dimensions[0] = 4; }));
  EXPECT_TRUE(broken([](auto& s) { s.section_dimensions[0] = 0; }));
  EXPECT_TRUE(broken([](auto& s) { s.string_count[0] = 6; }));
  EXPECT_TRUE(broken([](auto& s) { s.string_first[0] = 0xFFFFFFFFU; }));
  EXPECT_TRUE(broken([](auto& s) { s.module_types.pop_back(); }));
}

}  // namespace
}  // namespace ergotic::panel
