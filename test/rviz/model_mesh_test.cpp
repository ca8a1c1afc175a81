// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_mesh.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "rviz/model_solids.hpp"
#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

struct Drawn {
  explicit Drawn(const ModelStructure& structure, bool has_links = true)
      : shape(shapeOf(structure)),
        motion(structure, shape),
        mesh(structure, shape, motion, 1.0, has_links) {}

  std::vector<MeshVertex> vertices(const MeshView& view = {{1.0F, 0.0F, 0.0F}, false, false}) {
    constexpr std::uint32_t kMark = 0x12345678U;
    std::vector<MeshVertex> out(mesh.vertices() + 1, {0.0F, 0.0F, 0.0F, kMark});
    mesh.fill(motion, view, out.data());
    EXPECT_EQ(out.back().colour, kMark) << "more than it has";
    for (std::size_t i = 0; i < mesh.vertices(); ++i) {
      EXPECT_EQ(out[i].colour >> 24, 0xFFU) << "vertex " << i << " is not written";
    }
    out.pop_back();
    return out;
  }

  ModelShape shape;
  ModelMotion motion;
  ModelMesh mesh;
};

Eigen::Vector3f placeOf(const MeshVertex& vertex) {
  return {vertex.x, vertex.y, vertex.z};
}

std::uint32_t brightness(std::uint32_t colour) {
  return (colour & 0xFF) + (colour >> 8 & 0xFF) + (colour >> 16 & 0xFF);
}

void expectInside(const ModelMesh& mesh) {
  for (const ModuleIndices* indices : {&mesh.triangles(), &mesh.lines(), &mesh.points()}) {
    EXPECT_TRUE(std::all_of(indices->begin(), indices->end(),
                            [&](std::uint32_t i) { return i < mesh.vertices(); }));
  }
}

/// Six times the volume inside of triangles, whichever way round they are.
double volumeOf(const std::vector<Eigen::Vector3f>& corners, const ModuleIndices& triangles) {
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& corner : corners) {
    middle += corner / static_cast<float>(corners.size());
  }
  double sum = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Eigen::Vector3f a = corners[triangles[t]] - middle;
    const Eigen::Vector3f b = corners[triangles[t + 1]] - middle;
    const Eigen::Vector3f c = corners[triangles[t + 2]] - middle;
    sum += static_cast<double>(std::abs(a.cross(b).dot(c)));
  }
  return sum;
}

TEST(ModelMeshTest, AStringIsATubeOfSixSides) {
  StructureMaker maker;
  maker.string(30, 0.0F);
  Drawn drawn(maker.structure);
  EXPECT_EQ(drawn.mesh.vertices(), 30U * 6U);
  EXPECT_EQ(drawn.mesh.triangles().size(), 29U * 6U * 6U);
  EXPECT_TRUE(drawn.mesh.lines().empty());
  expectInside(drawn.mesh);
  const std::vector<MeshVertex> vertices = drawn.vertices();
  const float radius = placeOf(vertices[0]).norm();
  EXPECT_GT(radius, 1e-4F);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f off =
        placeOf(vertices[i]) - Eigen::Vector3f(0.0F, 0.01F * static_cast<float>(i / 6), 0.0F);
    EXPECT_NEAR(off.norm(), radius, 1e-6F);
    EXPECT_NEAR(off.y(), 0.0F, 1e-6F);
  }
}

TEST(ModelMeshTest, ManyModulesAreLinesAndPoints) {
  StructureMaker maker;
  maker.string(ModelMesh::kMaxTubeModules + 1, 0.0F);
  for (std::size_t i = 0; i <= kMaxBodies; ++i) {
    maker.module(ModelStructure::MASS, 0.0F, 0.0F, 0.1F + 0.01F * static_cast<float>(i));
  }
  Drawn drawn(maker.structure);
  EXPECT_TRUE(drawn.mesh.triangles().empty());
  EXPECT_EQ(drawn.mesh.lines().size(), 2 * ModelMesh::kMaxTubeModules);
  EXPECT_EQ(drawn.mesh.points().size(), kMaxBodies + 1);
  EXPECT_EQ(drawn.mesh.vertices(), maker.structure.module_names.size()) << "each has but one";
  expectInside(drawn.mesh);
  drawn.vertices();
}

TEST(ModelMeshTest, ASurfaceHasARimAndIsLitBySlopeFromBothSides) {
  StructureMaker maker;
  maker.net(5, 6, 0.01F, 0.01F);
  Drawn drawn(maker.structure);
  EXPECT_EQ(drawn.mesh.triangles().size(), 3U * 2U * 4U * 5U);
  EXPECT_EQ(drawn.mesh.lines().size(), 2U * 2U * (4U + 5U));
  expectInside(drawn.mesh);
  const auto above = drawn.vertices({{1.0F, 0.0F, 0.0F}, false, false});
  const auto below = drawn.vertices({{-1.0F, 0.0F, 0.0F}, false, false});
  const auto aside = drawn.vertices({{0.1F, 1.0F, 0.0F}, false, false});
  EXPECT_GT(brightness(above[0].colour), brightness(aside[0].colour));
  EXPECT_GT(brightness(below[0].colour), 60U) << "its back is not dark";

  ModelState state;
  state.header.stamp = ros::Time(1.0);
  for (int i = 0; i < 30; ++i) {  // a ramp along y
    state.displacement.push_back(0.01F * static_cast<float>(i % 6));
  }
  drawn.motion.show(state);
  EXPECT_LT(brightness(drawn.vertices()[0].colour), brightness(above[0].colour));
}

TEST(ModelMeshTest, ABarIsAClosedBox) {
  StructureMaker maker;
  maker.row(10, 0.0F, "bar.outline.");
  Drawn drawn(maker.structure);
  expectInside(drawn.mesh);
  std::vector<Eigen::Vector3f> corners;
  for (const MeshVertex& vertex : drawn.vertices()) {
    corners.push_back(placeOf(vertex));
  }
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& corner : corners) {
    box.extend(corner);
  }
  const Eigen::Vector3f size = box.sizes();
  EXPECT_NEAR(size.y(), 0.09F, 1e-5F);
  EXPECT_GT(size.z(), 3.0F * size.x()) << "flat, and thin along x";
  EXPECT_NEAR(volumeOf(corners, drawn.mesh.triangles()), 6.0 * static_cast<double>(box.volume()),
              1e-3 * static_cast<double>(box.volume()));
}

TEST(ModelMeshTest, BallsAndBoxesAreClosedAndPointOutwards) {
  for (const Solid* solid : {&key(), &hammer(), &finger(), &plectrum(), &bow()}) {
    EXPECT_EQ(solid->corners.size(), solid->normals.size());
    EXPECT_TRUE(std::all_of(solid->triangles.begin(), solid->triangles.end(),
                            [&](std::uint32_t corner) { return corner < solid->corners.size(); }));
    EXPECT_TRUE(std::all_of(solid->corners.begin(), solid->corners.end(), [&](const auto& corner) {
      return corner.z() < 1.0F;
    })) << "what it touches lies there";
  }
  for (const Solid* solid : {&ball(), &box()}) {
    EXPECT_EQ(solid->corners.size(), solid->normals.size());
    for (std::size_t i = 0; i < solid->corners.size(); ++i) {
      EXPECT_GT(solid->corners[i].dot(solid->normals[i]), 0.5F);
      EXPECT_NEAR(solid->normals[i].norm(), 1.0F, 1e-5F);
    }
  }
  EXPECT_EQ(ball().triangles.size(), 3U * 80U);
  EXPECT_NEAR(volumeOf(ball().corners, ball().triangles) / 6.0, 4.0 / 3.0 * M_PI, 0.7);
  EXPECT_NEAR(volumeOf(box().corners, box().triangles) / 6.0, 1.5 * 1.5 * 1.5, 1e-3);
}

TEST(ModelMeshTest, AHammerEndsWhereItTouchesAndIsHeldFromThePlayersSide) {
  for (const float x : {-0.02F, 0.02F}) {
    StructureMaker maker;
    maker.string(30, 0.0F);
    const std::uint32_t hammer = maker.module(ModelStructure::MASS, x, 0.1F, 0.0F);
    maker.link(hammer, 10);
    maker.structure.law_names = {"spring-damper", "felt"};
    maker.structure.link_types.back() = 1;
    Drawn drawn(maker.structure, false);
    const std::vector<MeshVertex> vertices = drawn.vertices();
    Eigen::AlignedBox3f box;
    for (std::size_t i = 30U * 6U; i < vertices.size(); ++i) {
      box.extend(placeOf(vertices[i]));
    }
    const float nearest = x < 0.0F ? box.max().x() : box.min().x();
    EXPECT_NEAR(nearest, x, 1e-4F) << "its head reaches to the place of its module";
    EXPECT_LT(box.min().z(), -4.0F * box.max().z()) << "its shaft";
    expectInside(drawn.mesh);
  }
}

TEST(ModelMeshTest, LinksAreDrawnIfTheyAreWanted) {
  StructureMaker maker;
  maker.link(maker.module(ModelStructure::MASS, 0.0F, 0.0F, 0.0F),
             maker.module(ModelStructure::GROUND, 0.0F, 0.1F, 0.0F));
  EXPECT_EQ(Drawn(maker.structure, true).mesh.lines().size(), 2U);
  EXPECT_TRUE(Drawn(maker.structure, false).mesh.lines().empty());
}

TEST(ModelLightTest, WhatGlowsIsWarmerAndWhatIsStaleIsGrey) {
  const Tint tint = tintOf(ModuleLook::kSurface);
  const auto red = [](std::uint32_t colour) { return colour & 0xFF; };
  const auto blue = [](std::uint32_t colour) { return colour >> 16 & 0xFF; };
  std::uint32_t before = colourOf(tint, 1.0F, 0.0F, false);
  EXPECT_LT(red(before), blue(before));
  for (const float glow : {0.2F, 0.4F, 0.7F, 1.0F}) {
    const std::uint32_t now = colourOf(tint, 1.0F, glow, false);
    EXPECT_GE(red(now), red(before));
    EXPECT_GT(red(now), blue(now));
    before = now;
  }
  before = colourOf(tint, 1.0F, 0.0F, false);
  for (const float glow : {-0.3F, -0.6F, -1.0F}) {
    const std::uint32_t now = colourOf(tint, 1.0F, glow, false);
    EXPECT_GT(blue(now), red(now)) << "what is slack is cold";
    EXPECT_GE(blue(now), blue(before));
    before = now;
  }
  const std::uint32_t grey = colourOf(tint, 1.0F, 1.0F, true);
  EXPECT_EQ(red(grey), blue(grey));
  EXPECT_LT(red(grey), 140U);
  EXPECT_EQ(colourOf({1.0F, 0.0F, 0.5F}, 1.0F, 0.0F, false), 0xFF8000FFU) << "bytes in order";
}

TEST(ModelMeshTest, NothingIsDrawnOfAnEmptyModel) {
  StructureMaker maker;
  Drawn drawn(maker.structure);
  EXPECT_EQ(drawn.mesh.vertices(), 0U);
  drawn.vertices();
}

}  // namespace
}  // namespace ergotic::panel
