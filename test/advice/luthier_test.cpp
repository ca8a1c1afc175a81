// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/luthier.hpp"

#include "advice/mode_scenes.hpp"

namespace ergotic::physics {
namespace {

using testing::SizeIs;

/// A string that is held beside its end, too: by what is on it, `post`.
std::string held(const std::string& law) {
  return "ergotic: 1\nsections: {a: {rate: audio}}\n"
         "mats: {wall: {type: ground, section: a}}\n"
         "generators:\n"
         "  - {type: string, name: s, section: a, masses: 60, mass: 1e-5, frequency: 220, damping: "
         "1e-3, to: [1, 0]}\n"
         "lias:\n"
         "  post: {type: spring_damper, between: [wall, s.5], " +
         law + "}\n";
}

const HeardBody& only(const HeardBodies& heard) {
  EXPECT_THAT(heard.bodies, SizeIs(1));
  EXPECT_THAT(heard.missing, IsEmpty());
  return heard.bodies.front();
}

TEST(LuthierTest, ABodyAloneIsInTuneAndNothingPullsIt) {
  const auto bodies = listenTo(read(held("stiffness: 0, damping: 0")), kRates);
  EXPECT_EQ(only(bodies).name, "s");
  EXPECT_EQ(only(bodies).asked_hz, 220.0);
  EXPECT_NEAR(only(bodies).cents, 0.0, 1e-3);
  EXPECT_THAT(only(bodies).influences, IsEmpty());
}

TEST(LuthierTest, WhatALinkPullsIsWhatIsHeardWithoutIt) {
  const auto bodies = listenTo(read(held("stiffness: 50, damping: 0")), kRates);
  ASSERT_THAT(only(bodies).influences, SizeIs(1));
  const Influence& post = only(bodies).influences.front();
  EXPECT_EQ(post.link, "post");
  EXPECT_GT(only(bodies).cents, 3.0);
  EXPECT_NEAR(post.cents, only(bodies).cents, 0.05 * only(bodies).cents);  // first order
}

TEST(LuthierTest, WhatALinkTakesIsWhatTheSoundLivesLongerWithoutIt) {
  const auto alone = listenTo(read(held("stiffness: 0, damping: 0")), kRates);
  const auto bodies = listenTo(read(held("stiffness: 0, damping: 1e-3")), kRates);
  ASSERT_THAT(only(bodies).influences, SizeIs(1));
  const double shorter = only(bodies).t60_s / only(alone).t60_s;
  EXPECT_LT(shorter, 0.8);
  EXPECT_NEAR(only(bodies).influences.front().of_loss, 1.0 - shorter, 0.01);
}

/// One mass between two springs of its own that tune it to 220 Hz, and `post` of $k.
scene::Scene oneMass() {
  return read(
      "ergotic: 1\nparameters: {k: {value: 10, range: [0, 400]}, volume: {value: 1, range: [0, "
      "2]}}\n"
      "sections: {a: {rate: audio}}\n"
      "mats: {wall: {type: ground, section: a}}\n"
      "generators:\n"
      "  - {type: string, name: s, section: a, masses: 1, mass: 1e-4, frequency: 220, to: [1, 0]}\n"
      "lias:\n"
      "  post: {type: spring, between: [wall, s.1], stiffness: $k}\n"
      "outputs: {o: {at: s.1, quantity: velocity, channel: 1, gain: $volume}}\n");
}

/// h^2 w^2 of a frequency.
double lambdaOf(double hz) {
  const double half = std::sin(kPi * hz / kRate);
  return 4.0 * half * half;
}

TEST(LuthierTest, AParameterIsMovedAsFarAsTheClosedFormSays) {
  const double wished_hz = 260.0;
  const auto moves = movesFor({Wish::Kind::kPitch, "s", wished_hz}, oneMass(), kRates);
  ASSERT_THAT(moves, SizeIs(1)) << "the volume does not move it";
  EXPECT_EQ(moves.front().parameter, "k");
  ASSERT_TRUE(moves.front().to);
  const double wanted = 1e-4 * kRate * kRate * (lambdaOf(wished_hz) - lambdaOf(220.0));
  EXPECT_NEAR(*moves.front().to, wanted, 1e-4 * wanted);
  EXPECT_NEAR(moves.front().lowest, 220.0, 1e-3);
}

TEST(LuthierTest, WhatNoValueReachesIsSaid) {
  const auto moves = movesFor({Wish::Kind::kPitch, "s", 200.0}, oneMass(), kRates);
  ASSERT_THAT(moves, SizeIs(1));
  EXPECT_FALSE(moves.front().to);
  EXPECT_GT(moves.front().lowest, 200.0);
  EXPECT_LT(moves.front().lowest, moves.front().highest);
}

TEST(LuthierTest, AMarginIsReachedByTheSpringThatTakesIt) {
  scene::Scene scene = oneMass();
  scene.parameters.front().maximum = 1e-4 * kRate * kRate * 3.0;
  const auto moves = movesFor({Wish::Kind::kMargin, "", 0.5}, scene, kRates);
  ASSERT_THAT(moves, SizeIs(1));
  ASSERT_TRUE(moves.front().to);
  const double wanted = 1e-4 * kRate * kRate * (2.0 - lambdaOf(220.0));  // margin 1 - lambda/4
  EXPECT_NEAR(*moves.front().to, wanted, 1e-4 * wanted);
}

TEST(LuthierTest, ABodyThatIsFarOffIsMissing) {
  const HeardBodies heard = listenTo(read(held("stiffness: 1e5, damping: 0")), kRates);
  EXPECT_THAT(heard.bodies, IsEmpty());
  ASSERT_THAT(heard.missing, SizeIs(1));
  EXPECT_EQ(heard.missing.front().body, "s");
}

/// T60 = 2 ln(1000) M/Z of a loss to the ground, which is none at one end of its range.
TEST(LuthierTest, ALongerDecayIsReachedFromNone) {
  const scene::Scene scene = read(
      "ergotic: 1\nparameters: {z: {value: 9e-6, range: [0, 9e-5]}}\nsections: {a: {rate: audio}}\n"
      "generators:\n"
      "  - {type: string, name: s, section: a, masses: 20, mass: 1e-5, frequency: 220, "
      "damping: 0, loss: $z, to: [1, 0]}\n");
  const double wanted = 1e-6;
  const auto moves =
      movesFor({Wish::Kind::kDecay, "s", 2.0 * std::log(1000.0) * 1e-5 / wanted}, scene, kRates);
  ASSERT_THAT(moves, SizeIs(1));
  ASSERT_TRUE(moves.front().to);
  EXPECT_NEAR(*moves.front().to, wanted, 1e-4 * wanted);
}

TEST(LuthierTest, ABodyThatIsNotThereIsRefused) {
  EXPECT_THAT(complaintOf([] {
                movesFor({Wish::Kind::kDecay, "drum", 1.0}, oneMass(), kRates);
              }),
              HasSubstr("no body 'drum' asks for a pitch"));
}

}  // namespace
}  // namespace ergotic::physics
