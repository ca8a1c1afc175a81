// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/generate/cut_string.hpp"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/grid.hpp"
#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {
namespace {

/// A string between other things, touched at a module, at a place and by a hand.
Scene played(const std::string& more = "", const std::string& medium = "0") {
  return readYaml(
      "ergotic: 1\n"
      "parameters: {weight: {value: 1e-4, range: [5e-5, 2e-4]}}\n"
      "sections: {s: {medium: " +
          medium +
          "}, h: {rate: gestural}}\n"
          "mats:\n"
          "  key: {type: slice, section: h}\n"
          "  before: {type: mass, section: s, mass: 0.1}\n"
          "generators:\n"
          "  - {type: string, name: a, section: s, masses: 39, mass: $weight, frequency: 110,\n"
          "     damping: 1e-3, loss: 1e-5, to: [0.65, 0], pluck: {at: 0.25, height: 0.002}}\n"
          "  - {type: string, name: b, section: s, masses: 5, mass: 1e-3, frequency: 220,\n"
          "     to: [0.65, 0]}\n"
          "lias:\n"
          "  hold: {type: spring, between: [before, b.2], stiffness: 100}\n"
          "  touch: {type: contact, between: [key, a.8], stiffness: 10}\n"
          "  nut: {type: spring, between: [a.0, a.1], stiffness: 10}\n"
          "ports: {k: {mat: key, slice: 0}}\n"
          "inputs: {i: {mat: a.20, quantity: force, channel: 1}}\n"
          "outputs:\n"
          "  o: {at: a@0.3, quantity: velocity, channel: 1}\n"
          "  last: {at: a.40, quantity: position, channel: 2}\n"
          "  other: {at: b.3, quantity: position, channel: 3}\n" +
          more,
      "cut.yaml");
}

const Mat& matAt(const Scene& scene, int index) {
  return scene.mats[static_cast<std::size_t>(index)];
}
const Lia& liaNamed(const Scene& scene, const std::string& name) {
  return *std::find_if(scene.lias.begin(), scene.lias.end(),
                       [&](const Lia& lia) { return lia.name == name; });
}

/// Where along string `a` a module or point is.
double alongOf(const Scene& scene, int mat) {
  for (const Connection& connection : scene.connections) {
    if (connection.mat == mat) {
      return connection.along.factor;
    }
  }
  const StringInfo& a = scene.strings[0];
  return (mat - a.first) / (a.count - 1.0);
}

TEST(CutStringTest, KeepsMassPitchLossAndShapeOfTheWhole) {
  const Scene before = played();
  for (const int masses : {9, 20, 79, 160}) {
    const Scene after = cutString(before, 0, {masses, false});
    ASSERT_NO_THROW(validate(after));
    const StringInfo& a = after.strings[0];
    EXPECT_EQ(a.count, masses + 2);
    EXPECT_NEAR(idealPitchHz(after, a), 110.0, 1e-9);
    EXPECT_NEAR(after.valueOf(a.mass) * (masses + 1), 1e-4 * 40, 1e-15);
    EXPECT_NEAR(after.valueOf(a.loss) * (masses + 1), 1e-5 * 40, 1e-16);
    EXPECT_NEAR(after.valueOf(a.damping) / (masses + 1), 1e-3 / 40, 1e-16);
    EXPECT_EQ(a.mass.parameter, 0);
    EXPECT_EQ(a.stiffness.parameter, 0);
    const Grid& grid = after.grids[0];
    const GridPlace peak = placeOn(grid, 0.25, 0.0);
    double height = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      height += peak.weights[i] * matAt(after, peak.mats[i]).position.x();
    }
    EXPECT_NEAR(height, 0.002, 0.002 * 2.0 / masses) << masses;
  }
}

TEST(CutStringTest, LeavesEverythingElseWhereItWas) {
  const Scene before = played();
  for (const StringCut cut : {StringCut{9, false}, StringCut{24, true}, StringCut{160, false}}) {
    const Scene after = cutString(before, 0, cut);
    ASSERT_NO_THROW(validate(after));
    EXPECT_NEAR(alongOf(after, liaNamed(after, "touch").b), 8.0 / 40.0, 1e-12);
    EXPECT_NEAR(alongOf(after, after.inputs[0].mat), 20.0 / 40.0, 1e-12);
    EXPECT_EQ(matAt(after, liaNamed(after, "nut").a).name, "a.0");
    EXPECT_EQ(matAt(after, liaNamed(after, "hold").a).name, "before");
    EXPECT_EQ(matAt(after, liaNamed(after, "hold").b).name, "b.2");
    const Point& heard = after.outputs[0].point;
    EXPECT_NEAR(alongOf(after, heard.mat) + heard.fraction / (cut.masses + 1), 0.3, 1e-12);
    EXPECT_EQ(matAt(after, after.outputs[1].point.mat).name, "a." + std::to_string(cut.masses + 1));
    EXPECT_EQ(matAt(after, after.outputs[2].point.mat).name, "b.3");
    EXPECT_EQ(matAt(after, after.ports[0].mat).name, "key");
    EXPECT_EQ(matAt(after, after.strings[1].first).name, "b.0");
    EXPECT_EQ(after.lias[static_cast<std::size_t>(after.strings[1].first_lia)].name, "b.link.0");
  }
}

TEST(CutStringTest, ThereAndBackAgainIsTheSameString) {
  const Scene before = played();
  const Scene after = cutString(cutString(before, 0, {24, true}), 0, {39, false});
  const StringInfo& a = after.strings[0];
  EXPECT_EQ(a.corrected_hz, 0.0);
  for (const Value StringInfo::*value :
       {&StringInfo::mass, &StringInfo::stiffness, &StringInfo::damping, &StringInfo::loss}) {
    const double was = (before.strings[0].*value).factor;
    EXPECT_NEAR((a.*value).factor, was, 1e-12 * was);
  }
  EXPECT_NEAR(stringPitchHz(after, a, 44100.0), stringPitchHz(before, before.strings[0], 44100.0),
              1e-9);
}

TEST(CutStringTest, CoarseOneHasTheLinksThatTheStationFits) {
  const Scene after = cutString(played(), 0, {24, true});
  const StringInfo& a = after.strings[0];
  EXPECT_NEAR(a.corrected_hz, 110.0, 1e-9);
  for (int i = 0; i < coarseLinks(24); ++i) {
    const Lia& lia = after.lias[static_cast<std::size_t>(a.first_lia + i)];
    EXPECT_EQ(lia.name, "a.link." + std::to_string(i));
    EXPECT_EQ(lia.a, a.first + coarseLink(24, i).a);
    EXPECT_EQ(lia.b, a.first + coarseLink(24, i).b);
  }
}

TEST(CutStringTest, SaysWhatIsAgainstIt) {
  using testing::HasSubstr;
  EXPECT_EQ(reasonAgainstCutting(played(), 0), "");
  EXPECT_THAT(reasonAgainstCutting(played("", "0.01"), 0), HasSubstr("medium of section 's'"));
  const std::string force = "  f: {at: a.7, quantity: force, channel: 4}\n";
  EXPECT_THAT(reasonAgainstCutting(played(force), 0), HasSubstr("output 'f'"));
  EXPECT_EQ(reasonAgainstCutting(played(force), 1), "");
}

}  // namespace
}  // namespace ergotic::scene
