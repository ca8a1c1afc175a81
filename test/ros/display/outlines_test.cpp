// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/outlines.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "ros/display/markers.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

scene::Scene barAsModes() {
  return scene::readYaml(
      "ergotic: 1\n"
      "sections:\n"
      "  a: {rate: audio}\n"
      "mats:\n"
      "  first: {type: mass, section: a, mass: 1 g}\n"
      "generators:\n"
      "  - {type: bar, name: bar, section: a, as: modes, masses: 49, mass: 200 g, pitch: A4, "
      "partials: 3,\n"
      "     from: [0, 0], to: [0, 0.4], places: {middle: 0.5}}\n"
      "outputs:\n"
      "  sound: {quantity: velocity, at: bar.middle, channel: 1}\n",
      "bar.yaml");
}

TEST(OutlinesTest, MoveAsTheBodyDoesWhereItIsTouched) {
  const scene::Scene scene = barAsModes();
  ASSERT_EQ(scene.outlines.size(), 1U);
  const scene::Outline& outline = scene.outlines[0];
  EXPECT_EQ(outline.rest.size(), 25U);
  EXPECT_EQ(outline.lines.size(), 24U);
  EXPECT_EQ(outline.modes, 3);
  std::vector<float> displacements(static_cast<std::size_t>(scene.coordinates()), 0.0F);
  displacements.at(static_cast<std::size_t>(outline.first_mat)) = 0.001F;  // its first mode
  const scene::Tap::Share& share = scene.taps.at(0).shares.at(0);
  ASSERT_EQ(share.mat, outline.first_mat);
  const std::size_t before = displacements.size();
  Outlines(scene).move(displacements);
  ASSERT_EQ(displacements.size(), before + 25);
  EXPECT_NEAR(displacements[before + 12], 0.001 * share.weight, 1e-7) << "in the middle";
  EXPECT_NEAR(displacements[before], displacements[before + 24], 1e-6) << "a free bar";
  EXPECT_LT(displacements[before] * displacements[before + 12], -1e-7)
      << "its ends go the other way";
}

TEST(OutlinesTest, AreDrawnInPlaceOfTheModes) {
  const scene::Scene scene = barAsModes();
  const scene::Scene drawn = Outlines::addTo(scene);
  ASSERT_EQ(drawn.mats.size(), scene.mats.size() + 25);
  EXPECT_EQ(drawn.lias.size(), scene.lias.size() + 24);
  EXPECT_NEAR(drawn.mats.back().rest.z(), 0.4, 1e-12);
  std::vector<float> displacements(static_cast<std::size_t>(scene.coordinates()), 0.0F);
  Outlines(scene).move(displacements);
  Markers markers(drawn, 1.0);
  const auto& array = markers.draw(displacements, ::ros::Time(1.0));
  // The mass, the place in the middle and the outline; its modes are no places.
  EXPECT_EQ(array.markers.at(0).points.size(), 1U + 1U + 25U);
}

}  // namespace
}  // namespace ergotic::node
