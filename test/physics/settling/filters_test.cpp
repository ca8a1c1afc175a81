// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/chaplet.hpp"
#include "physics/settling/chaplet_load.hpp"
#include "physics/settling/steps.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

const double kNyquist = kPi * kRate / 14;  // wN, rad/s

/// A string whose middle a slice touches through a filter.
struct FilteredString : SceneBuilder {
  static constexpr int kMasses = 999;  // so long that its impedance counts, not its stiffness
  static constexpr int kTouched = 500;
  static constexpr double kKg = 1e-4;
  static constexpr double kStiffness = 9e4;  // Z = 2 sqrt(K M) = 6 kg/s
  FilteredString() {
    touch = link(LiaType::kContact, hand, string + kTouched, 1e4);
    scene.lias[at(touch)].filtered = true;
  }
  int string = chain(kMasses, kKg, kStiffness);
  int hand = slice(0);
  int touch = -1;
};

std::vector<std::string> insert(scene::Scene& scene, const Rates& rates = kRates) {
  std::vector<std::string> notes;
  insertFilters(scene, rates, notes);
  return notes;
}

std::string refusalOf(scene::Scene scene, const Rates& rates = kRates) {
  return complaintOf<TextError>([&] { insert(scene, rates); });
}

TEST(LinearNetworkTest, InsideOfAStringIsTwiceItsWaveImpedance) {
  SceneBuilder b;
  const int string = b.chain(99, 1e-4, 9e4);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  EXPECT_NEAR(network.impedanceAt(string + 50), 2.0 * std::sqrt(9e4 * 1e-4), 1e-12);
  EXPECT_NEAR(network.impedanceAt(string + 1), 2.0 * std::sqrt(9e4 * 1e-4), 1e-12);
  EXPECT_FALSE(network.moves(string));
}

TEST(LinearNetworkTest, EndOfAFreeChainIsItsWaveImpedance) {
  SceneBuilder b;
  const int end = b.mass(1e-4);
  const int next = b.mass(1e-4);
  b.spring(end, next, 9e4);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  EXPECT_NEAR(network.impedanceAt(end), std::sqrt(9e4 * 1e-4), 1e-12);
}

TEST(LinearNetworkTest, StringGivesWayAsTheSpringsOnBothSides) {
  SceneBuilder b;
  const int string = b.chain(99, 1e-4, 9e4, 1e-3);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  for (const int i : {1, 25, 50, 99}) {
    EXPECT_NEAR(network.stiffnessAt(string + i), 9e4 / i + 9e4 / (100 - i), 1e-6) << i;
  }
}

TEST(LinearNetworkTest, PointBetweenTwoMassesIsWeighted) {
  SceneBuilder b;
  const int string = b.chain(3, 1e-4, 1000.0);
  const int point = b.point(b.grid(string, 5), 0.375);  // midway between masses 1 and 2
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  // K^-1 of three masses between grounds is min(i, j) (4 - max(i, j)) / (4 K).
  const double give = 0.25 * (3.0 + 2.0 * 2.0 + 4.0) / (4.0 * 1000.0);
  EXPECT_NEAR(network.stiffnessAt(point), 1.0 / give, 1e-9);
  EXPECT_NEAR(network.massAt(point), 2e-4, 1e-15);
  EXPECT_NEAR(network.impedanceAt(point), 2.0 * std::sqrt(1000.0 * 1e-4), 1e-12);
}

TEST(LinearNetworkTest, FloatingPartHasNoStiffnessWhateverElseIsTiedDown) {
  SceneBuilder b;
  const int a = b.mass(1e-3);
  const int c = b.mass(1e-3);
  b.spring(a, c, 500.0);
  b.chain(5, 1e-3, 100.0);
  b.link(LiaType::kContact, a, b.ground(), 1e5);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  EXPECT_EQ(network.stiffnessAt(a), 0.0);
}

TEST(LinearNetworkTest, CellCountsItsSpringAndItsDamper) {
  SceneBuilder b;
  b.scene.sections[0].medium = scene::Value{0.25};
  const int cell = b.cell(0.01, 400.0, 0.5);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  EXPECT_DOUBLE_EQ(network.stiffnessAt(cell), 400.0);
  EXPECT_DOUBLE_EQ(network.impedanceAt(cell), std::sqrt(400.0 * 0.01) + 0.5 + 0.25);
}

TEST(LinearNetworkTest, LoneMassLoadsAsAMass) {
  SceneBuilder b;
  const int mass = b.mass(0.002);
  const ChapletLoad load =
      loadAt(LinearNetwork(Network(b.scene), SceneBuilder::kAudio), mass, kNyquist);
  EXPECT_EQ(load.stiffness, 0.0);
  EXPECT_DOUBLE_EQ(load.damping, 0.002 * kNyquist);
}

TEST(LinearNetworkTest, HighestModeIsBoundedTightly) {
  SceneBuilder b;
  const int string = b.chain(9, 1e-3, 100.0);
  const double exact = 4.0 * 100.0 / 1e-3 * std::pow(std::sin(9.0 * kPi / 20.0), 2);
  const Network whole(b.scene);
  const LinearNetwork network(whole, SceneBuilder::kAudio);
  EXPECT_GE(network.highestModeAt(string + 3), exact * (1.0 - 1e-12));
  EXPECT_LE(network.highestModeAt(string + 3), exact * 1.01);
  const int lone = b.mass(1.0);
  EXPECT_EQ(LinearNetwork(Network(b.scene), SceneBuilder::kAudio).highestModeAt(lone), 0.0);
}

TEST(FiltersTest, ChapletStandsBetweenTheHandAndTheLink) {
  FilteredString b;
  b.scene.mats[at(b.hand)].rest.x() = -0.01;
  b.scene.mats[at(b.hand)].position.x() = -0.02;
  const std::size_t mats = b.scene.mats.size();
  const std::size_t lias = b.scene.lias.size();
  insert(b.scene);
  ASSERT_EQ(b.scene.mats.size(), mats + 2);
  ASSERT_EQ(b.scene.lias.size(), lias + 2);
  const std::string name = b.scene.lias[at(b.touch)].name + ".filter";
  for (const std::size_t i : {0U, 1U}) {
    const scene::Mat& mat = b.scene.mats[mats + i];
    EXPECT_EQ(mat.name, name + "." + std::to_string(i));
    EXPECT_EQ(mat.section, SceneBuilder::kAudio);
    EXPECT_EQ(mat.rest.x(), -0.01);
    EXPECT_EQ(mat.position.x(), -0.02);
    const scene::Lia& lia = b.scene.lias[lias + i];
    EXPECT_EQ(lia.name, name + ".link." + std::to_string(i));
    EXPECT_EQ(lia.a, i == 0 ? b.hand : static_cast<int>(mats));
    EXPECT_EQ(lia.b, static_cast<int>(mats + i));
  }
  const scene::Lia& touch = b.scene.lias[at(b.touch)];
  EXPECT_EQ(touch.a, static_cast<int>(mats) + 1);
  EXPECT_EQ(touch.b, b.string + FilteredString::kTouched);
  EXPECT_FALSE(touch.filtered);
  EXPECT_NO_THROW(scene::validate(b.scene));
}

TEST(FiltersTest, ChapletOnAPointStartsWhereThatIs) {
  FilteredString b;
  const int slow = b.mass(2.0, 1.0, 8.0, SceneBuilder::kGestural);
  b.mass(2.0, 3.0, 4.0, SceneBuilder::kGestural);
  b.scene.lias[at(b.touch)].a = b.point(b.grid(slow, 2), 0.25);
  insert(b.scene);
  const scene::Mat& last = b.scene.mats[at(b.scene.lias[at(b.touch)].a)];
  EXPECT_DOUBLE_EQ(last.position.x(), 1.5);
  EXPECT_DOUBLE_EQ(last.push->velocity.x(), 7.0);
}

TEST(FiltersTest, IsAsHeavyAsTheImpedanceAsksFor) {
  FilteredString b;
  insert(b.scene);
  const auto found = findChaplets(b.scene, kRates);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, b.scene.lias[at(b.touch)].name + ".filter");
  EXPECT_NEAR(found[0].chaplet.mass(), 20.0 * 6.0 / kNyquist, 1e-12);
  EXPECT_NEAR(found[0].load.damping, 6.0, 1e-9);
  EXPECT_NEAR(found[0].load.stiffness, 9e4 / 500.0 + 9e4 / 500.0, 1e-6);
}

TEST(FiltersTest, IsAsHeavyAsTheStiffnessAsksForAndSoftensByLessThanADecibel) {
  SceneBuilder b;
  const int cell = b.cell(1e-7, 900.0, 0.0);
  b.scene.lias[at(b.spring(b.slice(0), cell, 100.0))].filtered = true;
  insert(b.scene);
  const auto found = findChaplets(b.scene, kRates);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].chaplet.mass(), 900.0 / (0.00074 * kNyquist * kNyquist), 1e-12);
  EXPECT_GT(decibels(found[0].chaplet.gain(1e-3, {900.0, 0.0})), -0.83);
}

TEST(FiltersTest, TakesTheRatioOfTheTwoSectionsThatAreJoined) {
  FilteredString b;
  b.scene.sections[0].divisor = 2;
  insert(b.scene, {kRate, 16});
  const auto found = findChaplets(b.scene, {kRate, 16});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].chaplet.ratio(), 8);
  EXPECT_NEAR(found[0].chaplet.nyquistHz(), kRate / 32.0, 1e-9);
  EXPECT_NEAR(found[0].chaplet.mass(), 20.0 * 6.0 * 16.0 / (kPi * kRate), 1e-12);
}

TEST(FiltersTest, EveryFilteredLinkIsPlannedForTheSceneAsItIsWritten) {
  FilteredString b;
  const int second =
      b.link(LiaType::kSpringDamper, b.slice(1), b.string + FilteredString::kTouched, 500.0);
  b.scene.lias[at(second)].filtered = true;
  EXPECT_EQ(insert(b.scene).size(), 2U);
  const std::size_t mats = b.scene.mats.size();
  EXPECT_DOUBLE_EQ(b.scene.mats[mats - 2].mass.factor, b.scene.mats[mats - 4].mass.factor);
}

TEST(FiltersTest, KeepsClearOfGravityAndMediumInASectionOfItsOwn) {
  for (const bool falls : {true, false}) {
    FilteredString b;
    if (falls) {
      b.scene.sections[0].gravity.x() = -9.81;
    } else {
      b.scene.sections[0].medium = scene::Value{1e-5};
    }
    b.scene.sections[0].divisor = 2;
    b.scene.sections[1].pose.translation().y() = 0.5;
    insert(b.scene);
    ASSERT_EQ(b.scene.sections.size(), 3U);
    const scene::Section& own = b.scene.sections.back();
    EXPECT_TRUE(own.gravity.isZero());
    EXPECT_EQ(own.medium.factor, 0.0);
    EXPECT_EQ(own.divisor, 2);
    EXPECT_EQ(own.pose.translation().y(), 0.5);
    EXPECT_EQ(b.scene.mats.back().section, 2);
    EXPECT_NO_THROW(scene::validate(b.scene));
  }
}

TEST(FiltersTest, MovesAlongTheAxisOfTheHandBeforeAStringInSpace) {
  FilteredString b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  insert(b.scene);
  ASSERT_EQ(b.scene.sections.size(), 3U);
  EXPECT_EQ(b.scene.sections.back().geometry, scene::Geometry::kScalar);
}

TEST(FiltersTest, SlowMassWithSpringsGetsTheSmallDashpot) {
  FilteredString b;
  const int slow = b.mass(2.0, 0.0, 0.0, SceneBuilder::kGestural);
  b.scene.lias[at(b.touch)].a = slow;
  const double stiffness = 0.3 * 2.0 * std::pow(kRate / 14, 2);
  b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), stiffness);
  const auto notes = insert(b.scene);
  const scene::Lia& dashpot = b.scene.lias.back();
  const double damping = b.scene.lias[b.scene.lias.size() - 3].damping.factor;
  const double angle = std::acos(1.0 - 0.3 / 2.0);  // w T of an explicit oscillator
  EXPECT_EQ(dashpot.a, slow);
  EXPECT_EQ(b.scene.mats[at(dashpot.b)].type, scene::MatType::kGround);
  EXPECT_EQ(b.scene.mats[at(dashpot.b)].section, SceneBuilder::kGestural);
  EXPECT_NEAR(dashpot.damping.factor, damping * angle * angle / 4.0, 1e-12);
  EXPECT_THAT(notes.at(0), HasSubstr("gets a dashpot of"));
  EXPECT_NO_THROW(scene::validate(b.scene));
}

/// The string above touched by a free slow mass.
FilteredString touchedByMass(double kg) {
  FilteredString b;
  b.scene.lias[at(b.touch)].a = b.mass(kg, 0.0, 0.0, SceneBuilder::kGestural);
  return b;
}

std::string noteOn(FilteredString b) {
  return insert(b.scene).at(0);
}

TEST(FiltersTest, NotesWhatItFoundAndMade) {
  FilteredString b;
  const std::string note = noteOn(b);
  EXPECT_THAT(note, HasSubstr("built.yaml:1100:1: note: link 'l1000' is filtered by a chaplet (a "
                              "mechanical low-pass) of "
                              "0.0121 kg, tuned to 1.58e+03 Hz"));
  EXPECT_THAT(note, HasSubstr(": 6 N s/m and 360 N/m"));
  EXPECT_THAT(note, HasSubstr("without load: 0.0126 kg"));
  EXPECT_THAT(note, HasSubstr("-0.254, -2.01"));
}

TEST(FiltersTest, NotesAMassThatItPullsAndNoOther) {
  const double chaplet = 20.0 * 6.0 / kNyquist;
  EXPECT_THAT(noteOn(touchedByMass(49.0 * chaplet)), HasSubstr("more than 1/50"));
  EXPECT_THAT(noteOn(touchedByMass(51.0 * chaplet)), Not(HasSubstr("more than 1/50")));
}

TEST(FiltersTest, RefusesToBeHeavierThanATenthOfTheSlowMass) {
  const double chaplet = 20.0 * 6.0 / kNyquist;
  EXPECT_THAT(
      refusalOf(touchedByMass(9.9 * chaplet).scene),
      HasSubstr("built.yaml:1100:1: error: link 'l1000' asks for a filter, which would weigh "
                "0.0121 kg, but the slower end 'm1002' has 0.12 kg"));
  EXPECT_EQ(refusalOf(touchedByMass(10.1 * chaplet).scene), "");
}

TEST(FiltersTest, RefusesRatesThatAreTooClose) {
  FilteredString b;
  EXPECT_THAT(
      refusalOf(b.scene, {kRate, 3}),
      HasSubstr("built.yaml:1100:1: error: link 'l1000' asks for a filter, but its ends are "
                "stepped every 3 and every 1 audio frames, ratio 3, allowed: whole ratios "
                "R >= 4"));
  EXPECT_EQ(refusalOf(b.scene, {kRate, 4}), "");
  b.scene.sections[0].divisor = 4;
  EXPECT_THAT(refusalOf(b.scene, {kRate, 18}), HasSubstr("ratio 4.5, allowed: whole ratios"));
}

TEST(FiltersTest, RefusesWhatDoesNotMove) {
  FilteredString b;
  b.scene.lias[at(b.touch)].b = b.string;
  EXPECT_THAT(refusalOf(b.scene), HasSubstr("'m0' is not moved by forces"));
}

TEST(FiltersTest, RefusesASlowerEndInThePlane) {
  FilteredString b;
  b.scene.sections[1].geometry = scene::Geometry::kPlane;
  EXPECT_THAT(refusalOf(b.scene), HasSubstr("moves in more than one coordinate"));
}

}  // namespace
}  // namespace ergotic::physics
