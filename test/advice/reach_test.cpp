// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/reach.hpp"

#include "advice/mode_scenes.hpp"

namespace ergotic::physics {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kExact = 1e-12;
constexpr double kStroke = 0.03;

scene::Scene sceneOf(const std::string& mats,
                     const std::string& lias,
                     const std::string& port = "",
                     const std::string& more = "") {
  return settle(read("ergotic: 1\nsections: {a: {rate: audio}, k: {rate: gestural}}\nmats:\n"
                     "  key: {type: slice, section: k, rest: -8 mm}\n" +
                     mats + "lias:\n" + lias + "ports: {hand: {mat: key, slice: 3" + port + "}}\n" +
                     more),
                kRates)
      .scene;
}

PortReach reachIn(const scene::Scene& scene) {
  std::vector<std::string> notes;
  std::vector<PortReach> found = reachOf(scene, portsOfSlices(scene), true, notes);
  EXPECT_EQ(found.size(), 1U);
  EXPECT_THAT(notes, IsEmpty());
  return found.at(0);
}

/// Of the only thing that is met.
Meeting meetingIn(const scene::Scene& scene) {
  const PortReach found = reachIn(scene);
  EXPECT_EQ(found.meetings.size(), 1U);
  return found.meetings.at(0);
}

constexpr char kWall[] = "  wall: {type: ground, section: a, x: 2 mm}\n";

TEST(ReachTest, OfAContactIsTheGapThroughScaleAndOffset) {
  const std::string touch = "  c: {type: contact, between: [key, wall], stiffness: 10";
  Meeting met = meetingIn(sceneOf(kWall, touch + "}\n"));
  EXPECT_NEAR(met.at_m, 0.010, kExact);
  EXPECT_EQ(met.thing, "wall");
  EXPECT_EQ(met.by, "key");
  EXPECT_STREQ(met.law, "contact");
  EXPECT_FALSE(met.touches || met.is_missed);
  // It acts from where the wall comes closer than the threshold.
  met = meetingIn(sceneOf(kWall, touch + ", threshold: 3 mm}\n"));
  EXPECT_NEAR(met.at_m, 0.007, kExact);
  // x_model = (x_hand - offset)/scale
  met = meetingIn(sceneOf(kWall, touch + "}\n", ", position_scale: 2.8, offset: 1 mm"));
  EXPECT_NEAR(met.at_m, 2.8 * 0.010 + 0.001, kExact);
  // Below: the other way.
  met = meetingIn(sceneOf("  wall: {type: ground, section: a, x: -20 mm}\n",
                          "  c: {type: felt, between: [wall, key], stiffness: 10, exponent: 2, "
                          "damping: 0, threshold: 1 mm}\n"));
  EXPECT_NEAR(met.at_m, -0.011, kExact);
  EXPECT_STREQ(met.law, "felt");
}

TEST(ReachTest, WhatLetsGoAgainSaysWhere) {
  Meeting met = meetingIn(
      sceneOf(kWall, "  p: {type: pluck, between: [key, wall], stiffness: 10, width: 4 mm}\n"));
  EXPECT_NEAR(met.at_m, 0.006, kExact);
  ASSERT_EQ(met.ends_m.size(), 1U);
  EXPECT_NEAR(met.ends_m[0], 0.014, kExact);
  met = meetingIn(sceneOf(
      kWall, "  p: {type: one_way_pluck, between: [key, wall], stiffness: 10, width: 4 mm}\n"));
  EXPECT_NEAR(met.at_m, 0.010, kExact);
  ASSERT_EQ(met.ends_m.size(), 1U);
  EXPECT_NEAR(met.ends_m[0], 0.014, kExact);
  // A damper that is lifted: it touches at rest, and no more from 2 mm on.
  met = meetingIn(sceneOf("  wall: {type: ground, section: a, x: -8 mm}\n",
                          "  c: {type: contact, between: [wall, key], stiffness: 0, damping: 1, "
                          "threshold: 2 mm}\n"));
  EXPECT_TRUE(met.touches);
  ASSERT_EQ(met.ends_m.size(), 1U);
  EXPECT_NEAR(met.ends_m[0], 0.002, kExact);
}

TEST(ReachTest, OfATableIsWhereItIsNoMoreZero) {
  const std::string between = "  t: {type: table, between: [key, wall], elastic: ";
  const PortReach found =
      reachIn(sceneOf(kWall, between + "[[-20 mm, -3], [-15 mm, 0], [-6 mm, 0], [0, 2]]}\n"));
  ASSERT_EQ(found.meetings.size(), 2U);  // e = -10 mm at rest
  EXPECT_NEAR(found.meetings[0].at_m, 0.004, kExact);
  EXPECT_NEAR(found.meetings[1].at_m, -0.005, kExact);
  EXPECT_THAT(found.meetings[0].ends_m, IsEmpty());  // its end holds
}

/// A head on a shaft, a lever on that head, and a mass that it hangs on.
constexpr char kHead[] =
    "  head: {type: mass, section: a, mass: 0.02, x: -8 mm}\n"
    "  wall: {type: ground, section: a, x: 2 mm}\n";
constexpr char kShaft[] =
    "  shaft: {type: spring_damper, between: [key, head], stiffness: 600, damping: 3}\n";

TEST(ReachTest, WhatHangsOnTheSliceAloneGoesWithIt) {
  const scene::Scene scene = sceneOf(
      kHead,
      std::string(kShaft) +
          "  c: {type: power_contact, between: [head, wall], stiffness: 1e5, exponent: 2}\n",
      ", position_scale: 0.5");
  const PortReach found = reachIn(scene);
  EXPECT_THAT(found.carries, ElementsAre("head"));
  ASSERT_EQ(found.meetings.size(), 1U);
  EXPECT_NEAR(found.meetings[0].at_m, 0.005, kExact);
  EXPECT_EQ(found.meetings[0].by, "head");
  EXPECT_THAT(found.holds, IsEmpty());
}

TEST(ReachTest, WeightSagsBeforeTheHandMoves) {
  const std::string gravity =
      "ergotic: 1\nsections: {a: {rate: audio, gravity: -9.81}, k: {rate: gestural}}\nmats:\n"
      "  key: {type: slice, section: k, rest: -8 mm}\n";
  const scene::Scene scene =
      settle(read(gravity + kHead + "lias:\n" + kShaft +
                  "  c: {type: contact, between: [head, wall], stiffness: 10}\n"
                  "ports: {hand: {mat: key, slice: 0}}\n"),
             kRates)
          .scene;
  EXPECT_NEAR(reachIn(scene).meetings.at(0).at_m, 0.010 + 0.02 * 9.81 / 600.0, kExact);
}

TEST(ReachTest, AHeadThatBeginsElsewhereComesToItsShaft) {
  const scene::Scene scene =
      sceneOf("  head: {type: mass, section: a, mass: 0.02}\n" + std::string(kWall),
              "  shaft: {type: spring_damper, between: [head, key], stiffness: 600, damping: 3, "
              "rest_length: 1 mm}\n"
              "  c: {type: contact, between: [head, wall], stiffness: 10}\n");
  EXPECT_NEAR(reachIn(scene).meetings.at(0).at_m, 0.009, kExact);
}

TEST(ReachTest, ALeverTakesItsTimesTheWay) {
  const scene::Scene scene = sceneOf(
      "  arm: {type: mass, section: a, mass: 0.02}\n"
      "  tip: {type: tap, of: arm, weights: 5}\n"
      "  wall: {type: ground, section: a, x: 20 mm}\n",
      "  shaft: {type: spring_damper, between: [key, arm], stiffness: 600, damping: 3}\n"
      "  c: {type: contact, between: [tip, wall], stiffness: 10}\n");
  EXPECT_NEAR(reachIn(scene).meetings.at(0).at_m, 0.008 + 0.020 / 5.0, kExact);
}

TEST(ReachTest, AFilterGoesWithItsSlice) {
  const Meeting met =
      meetingIn(sceneOf(kWall, "  c: {type: contact, between: [key, wall], stiffness: 10}\n",
                        ", filter: {mass: 1 g, frequency: 100, section: a}, position_scale: 0.25"));
  EXPECT_NEAR(met.at_m, 0.0025, kExact);
  EXPECT_EQ(met.by, "hand.filter");
}

/// key - 600 N/m - grip - 200 N/m - nail: the grip goes 3/4 of the way.
TEST(ReachTest, WhatIsHeldElsewhereTooFollowsAsFarAsSpringsSay) {
  const PortReach found = reachIn(
      sceneOf("  grip: {type: mass, section: a, mass: 0.02}\n  nail: {type: ground, section: a}\n" +
                  std::string(kWall),
              "  arm: {type: spring_damper, between: [key, grip], stiffness: 600, damping: 1}\n"
              "  tie: {type: spring_damper, between: [grip, nail], stiffness: 200, damping: 1}\n"
              "  c: {type: contact, between: [grip, wall], stiffness: 10}\n"));
  // The key rests 8 mm below, so the grip 6 mm below 0.
  EXPECT_NEAR(found.meetings.at(0).at_m, (0.002 + 0.006) / 0.75, kExact);
  ASSERT_EQ(found.holds.size(), 1U);
  EXPECT_EQ(found.holds[0].thing, "grip");
  EXPECT_NEAR(found.holds[0].stiffness, 600.0, 1e-9);
  EXPECT_NEAR(found.holds[0].follows, 0.75, kExact);
  EXPECT_THAT(found.carries, IsEmpty());
}

TEST(ReachTest, OfAPointIsThatOfTheStringAroundIt) {
  const scene::Scene scene = sceneOf(
      "  place: {type: point, along: s, at: 0.33}\n",
      "  c: {type: contact, between: [key, place], stiffness: 10}\n", "",
      "generators:\n"
      "  - {type: string, name: s, section: a, masses: 20, mass: 1e-4, frequency: 110, to: [1, 0], "
      "pluck: {at: 0.4, height: 1 mm}}\n");
  const Meeting met = meetingIn(scene);  // it is straight when it has come to rest
  EXPECT_NEAR(met.at_m, 0.008, kExact);
  EXPECT_EQ(met.thing, "place");
}

TEST(ReachTest, WhatIsPushedGoesOnAgainstItsSprings) {
  const std::string hammer =
      "  hammer: {type: mass, section: a, mass: 0.003, x: -3 mm, rest: -3 mm}\n"
      "  home: {type: ground, section: a, x: -3 mm}\n" +
      std::string(kWall);
  const std::string links =
      "  throw: {type: contact, between: [key, hammer], stiffness: 1000}\n"
      "  felt: {type: felt, between: [hammer, wall], stiffness: 1e8, exponent: 2, damping: 0}\n";
  Meeting met = reachIn(sceneOf(hammer, links)).meetings.at(0);
  EXPECT_NEAR(met.at_m, 0.005, kExact);
  ASSERT_EQ(met.then.size(), 1U);  // free: as far as it has to go
  EXPECT_EQ(met.then[0].thing, "wall");
  EXPECT_STREQ(met.then[0].law, "felt");
  EXPECT_NEAR(met.then[0].at_m, 0.010, kExact);
  met = reachIn(sceneOf(hammer, links + "  back: {type: spring, between: [hammer, home], "
                                        "stiffness: 50}\n"))
            .meetings.at(0);
  // 5 mm against 50 N/m press the contact by 0.25 mm.
  EXPECT_NEAR(met.then.at(0).at_m, 0.010 + 0.005 * 50.0 / 1000.0, kExact);
}

/// A finger of flesh on a string of one mass over a fret.
TEST(ReachTest, AStringIsPressedOntoItsFret) {
  const PortReach found = reachIn(
      sceneOf("  m: {type: mass, section: a, mass: 1e-3, x: -12 mm}\n"
              "  nut: {type: ground, section: a, x: -12 mm}\n"
              "  fret: {type: ground, section: a, x: -13 mm}\n"
              "  tip: {type: mass, section: a, mass: 0.01, x: -8 mm}\n",
              "  flesh: {type: spring_damper, between: [key, tip], stiffness: 700, damping: 1}\n"
              "  string: {type: spring, between: [m, nut], stiffness: 300}\n"
              "  stop: {type: contact, between: [fret, m], stiffness: 1e4}\n"
              "  press: {type: contact, between: [m, tip], stiffness: 8000}\n"));
  const Meeting& met = found.meetings.at(0);
  EXPECT_NEAR(met.at_m, -0.004, kExact);
  ASSERT_EQ(met.then.size(), 1U);
  EXPECT_EQ(met.then[0].thing, "fret");
  const double share = (1.0 / 300.0) / (1.0 / 300.0 + 1.0 / 700.0 + 1.0 / 8000.0);
  EXPECT_NEAR(met.then[0].at_m, -0.004 - 0.001 / share, kExact);
}

/// A ball that goes by a post at a distance of 6 mm, along x, in a plane that is turned.
TEST(ReachTest, InAPlaneIsWhereTheCirclesMeet) {
  const auto at = [](const std::string& threshold) {
    return meetingIn(
        settle(
            read(
                "ergotic: 1\nsections: {a: {rate: audio, geometry: plane, pose: {position: [0, 10 "
                "mm, 0]}},\n"
                "  k: {rate: gestural, geometry: plane, pose: {rotation: [0, 0, 90 deg]}}}\nmats:\n"
                "  key: {type: slice, section: k, at: [0, 0]}\n"
                "  post: {type: ground, section: a, at: [-6 mm, 20 mm]}\n"
                "lias: {c: {type: contact, between: [key, post], stiffness: 10, threshold: " +
                threshold +
                "}}\nports: {hand: {mat: key, axis: x, slice: 0, position_scale: 2}}\n"),
            kRates)
            .scene);
  };
  const Meeting met = at("10 mm");  // x of the hand is y of the model
  EXPECT_NEAR(met.at_m, 2.0 * (0.030 - 0.008), kExact);
  EXPECT_NEAR(met.ends_m.at(0), 2.0 * (0.030 + 0.008), kExact);
  const Meeting missed = at("5 mm");
  EXPECT_TRUE(missed.is_missed);
  EXPECT_NEAR(missed.missed_by_m, 0.001, kExact);
}

TEST(ReachTest, WhatHangsBetweenThingsInAPlaneIsHeldAndANoteSaysSo) {
  const auto reach = [](const std::string& tie, std::vector<std::string>& notes) {
    const scene::Scene scene =
        settle(read("ergotic: 1\nsections: {a: {rate: audio, geometry: plane}, k: {rate: gestural, "
                    "geometry: plane}}\nmats:\n"
                    "  key: {type: slice, section: k, at: [0, 0]}\n"
                    "  ball: {type: mass, section: a, mass: 0.02, at: [10 mm, 0]}\n"
                    "  nail: {type: ground, section: a, at: [0, 10 mm]}\n"
                    "  post: {type: ground, section: a, at: [25 mm, 3 mm]}\n"
                    "lias:\n"
                    "  arm: {type: spring, between: [key, ball], stiffness: 600}\n" +
                    tie +
                    "  c: {type: contact, between: [ball, post], stiffness: 10, threshold: 5 mm}\n"
                    "ports: {hand: {mat: key, axis: x, slice: 0}}\n"),
               kRates)
            .scene;
    return reachOf(scene, {0}, true, notes).at(0);
  };
  std::vector<std::string> notes;
  PortReach found = reach("", notes);
  EXPECT_NEAR(found.meetings.at(0).at_m, 0.015 - 0.004, kExact);
  EXPECT_THAT(notes, IsEmpty());
  found = reach("  tie: {type: spring, between: [ball, nail], stiffness: 600}\n", notes);
  EXPECT_THAT(found.meetings, IsEmpty());
  ASSERT_EQ(found.holds.size(), 1U);
  EXPECT_EQ(found.holds[0].follows, 0.0);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("1 body hangs on slices in a way that is not worked")));
}

TEST(ReachTest, AFrictionWaitsForWhatPresses) {
  const std::string mats =
      "  wrist: {type: slice, section: k, rest: -3 mm}\n  pad: {type: ground, section: k}\n"
      "  hair: {type: mass, section: a, mass: 3 g, x: -8 mm}\n" +
      std::string(kWall);
  const scene::Scene scene =
      settle(read("ergotic: 1\nsections: {a: {rate: audio}, k: {rate: gestural}}\nmats:\n"
                  "  key: {type: slice, section: k, rest: -8 mm}\n" +
                  mats +
                  "lias:\n  stick: {type: spring_damper, between: [key, hair], stiffness: 800, "
                  "damping: 2}\n"
                  "  weight: {type: contact, between: [wrist, pad], stiffness: 800}\n"
                  "  rub: {type: friction, between: [wall, hair], normal: weight, steady: 0.3}\n"
                  "ports: {draw: {mat: key, slice: 0}, press: {mat: wrist, slice: 1}}\n"),
             kRates)
          .scene;
  std::vector<std::string> notes;
  const std::vector<PortReach> found = reachOf(scene, {0, 1}, true, notes);
  ASSERT_EQ(found[0].meetings.size(), 1U);
  EXPECT_EQ(found[0].meetings[0].waits_for, "weight");
  EXPECT_FALSE(found[0].isIdle(kStroke));
  ASSERT_EQ(found[1].meetings.size(), 1U);
  EXPECT_NEAR(found[1].meetings[0].at_m, 0.003, kExact);
  ASSERT_EQ(found[1].meetings[0].presses.size(), 1U);
  EXPECT_EQ(found[1].meetings[0].presses[0].link, "rub");
}

TEST(ReachTest, AGuideSaysWhereItsPlaceEnds) {
  const PortReach found = reachIn(
      sceneOf("  place: {type: point, along: s, at: 0.3, range: [0.1, 0.8], guide: {mat: key, "
              "scale: 25}}\n",
              "  c: {type: damper, between: [place, s.0], damping: 0.1}\n", ", position_scale: 0.5",
              "generators:\n  - {type: string, name: s, section: a, masses: 20, mass: 1e-4, "
              "frequency: 110, "
              "to: [1, 0]}\n"));
  ASSERT_EQ(found.guides.size(), 1U);
  EXPECT_EQ(found.guides[0].along, "s");
  EXPECT_NEAR(found.guides[0].fraction, 0.3, kExact);
  EXPECT_NEAR(found.guides[0].per_m, 50.0, kExact);
  EXPECT_NEAR(found.guides[0].ends_m.at(0), -0.004, kExact);
  EXPECT_NEAR(found.guides[0].ends_m.at(1), 0.010, kExact);
  EXPECT_FALSE(found.isIdle(kStroke));
}

std::vector<std::string> warningsOf(const scene::Scene& scene) {
  return reachWarnings(scene, {reachIn(scene)}, kStroke);
}

TEST(ReachTest, SlicesThatMeetNothingAreWarnedOf) {
  const std::string wall = "  wall: {type: ground, section: a, x: 40 mm}\n";
  const std::string touch = "  c: {type: contact, between: [key, wall], stiffness: 10}\n";
  EXPECT_THAT(warningsOf(sceneOf(wall, touch)),
              ElementsAre(AllOf(HasSubstr(
                  "modes.yaml:8:9: warning: port 'hand' (slice 3) meets nothing within its "
                  "stroke of +-30 mm: the nearest, 'wall' (contact 'c'), is at "
                  "48 mm of the hand"))));
  EXPECT_THAT(warningsOf(sceneOf(wall, touch, ", position_scale: 0.5")), IsEmpty());
  EXPECT_THAT(warningsOf(sceneOf(std::string(kHead), kShaft)),
              ElementsAre(HasSubstr("can touch nothing: no link leads from 'key'")));
}

/// Plays a hand that goes step by step, each held for some ticks, until the wall feels a force.
/// \return where the hand is then, m
double playedUntilForce(const scene::Scene& scene, double way, double step, int ticks) {
  Player player(compile(scene, kRates, Precision::kDouble));
  player.positions.assign(scene.ports.size(), 0.0);
  const scene::Port& port = scene.ports[0];
  double hand = 0.0;
  for (int n = 0; std::abs(hand) < 2.0 * std::abs(way); ++n) {
    hand = std::copysign(n * step, way);
    player.positions[0] = (hand - port.offset) / port.position_scale;
    const std::size_t heard = player.heard[0].size();
    player.ticks(ticks);
    if (std::any_of(player.heard[0].begin() + static_cast<std::ptrdiff_t>(heard),
                    player.heard[0].end(), [](double f) { return std::abs(f) > 1e-9; })) {
      break;
    }
  }
  return hand;
}

TEST(ReachTest, WhenPlayedForceBeginsThere) {
  struct Case {
    std::string mats, lias, port;
    int ticks;  // in which what the hand moves comes to rest
  };
  const std::string touch = "  c: {type: contact, between: [key, wall], stiffness: 100}\n";
  const Case cases[] = {
      {kWall, touch, ", position_scale: 2.8, offset: 1 mm", 2},
      {kWall, touch, ", filter: {mass: 1 g, frequency: 300, damping_ratio: 1, section: a}", 60},
      {kWall, "  p: {type: pluck, between: [key, wall], stiffness: 100, width: 4.03 mm}\n", "", 2},
      {kWall,
       "  t: {type: table, between: [key, wall], elastic: [[-9 mm, 0], [-4.32 mm, 0], [0, 2]]}\n",
       "", 2},
      {kHead,
       "  shaft: {type: spring_damper, between: [key, head], stiffness: 600, damping: 7}\n"
       "  c: {type: contact, between: [head, wall], stiffness: 100}\n",
       ", position_scale: 0.3", 150},
      {std::string(kWall) +
           "  hammer: {type: mass, section: a, mass: 0.003, x: -3.03 mm, rest: -3 mm}\n"
           "  home: {type: ground, section: a, x: -3.03 mm}\n",
       "  throw: {type: contact, between: [key, hammer], stiffness: 1000}\n"
       "  back: {type: spring_damper, between: [hammer, home], stiffness: 50, damping: 1}\n"
       "  felt: {type: felt, between: [hammer, wall], stiffness: 1e4, exponent: 1, damping: 0}\n",
       "", 150},
  };
  constexpr double kStep = 0.97e-4;
  for (const Case& one : cases) {
    const scene::Scene scene = sceneOf(one.mats, one.lias, one.port,
                                       "outputs: {o: {at: wall, quantity: force, channel: 1}}\n");
    const Meeting met = reachIn(scene).meetings.at(0);
    const double at_m = met.then.empty() ? met.at_m : met.then[0].at_m;
    const double played_m = playedUntilForce(scene, at_m, kStep, one.ticks);
    EXPECT_NEAR(played_m, at_m, 1.01 * kStep) << one.lias;  // a filter goes a little beyond a step
  }
}

}  // namespace
}  // namespace ergotic::physics
