// SPDX-License-Identifier: BSD-3-Clause
// Hands that hold modules anywhere in the model, on their way from tick to tick.
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr physics::Rates kHoldRates{44100.0, 14};

std::unique_ptr<Performer> chain(int masses) {
  const std::string scene =
      "ergotic: 1\n"
      "sections: {string: {rate: audio}}\n"
      "generators:\n"
      "  - {type: string, name: s, section: string, masses: " +
      std::to_string(masses) +
      ", mass: 1.0e-4, frequency: 100, loss: 1.0e-5, from: [0, 0], to: [0.5, 0]}\n"
      "outputs:\n"
      "  sound: {quantity: velocity, at: s@0.8, channel: 1}\n";
  return makePerformer(scene::readYaml(scene, "chain.yaml"), kHoldRates, {}, {});
}

struct HoldRig {
  HoldRig() {
    StationConfig config;
    config.rates = kHoldRates;
    auto performer = chain(30);
    model = performer.get();
    station = std::make_unique<Station>(config, tgr::makeVirtualDriver({}), std::move(performer));
  }
  bool hold(std::size_t hand, const Hold& hold) const { return station->hold(hand, hold, model); }
  void run(int ticks) {
    for (int n = 0; n < ticks; ++n) {
      station->cycle({0, true});
      Event event;
      while (station->poll(event)) {
        const std::unique_ptr<Performer> performer(event.performer);
        if (event.type == Event::Type::kHold) {
          told.push_back(event);
        }
      }
    }
  }
  void ask(Command::Type type, Performer* performer = nullptr) const {
    Command command;
    command.type = type;
    command.performer = performer;
    station->submit(command);
  }
  const Performer* model = nullptr;  // that hands are meant for
  std::unique_ptr<Station> station;
  std::vector<Event> told;  // of hands that hold
};

Hold drawTo(int mat, double goal_m) {
  Hold hold;
  hold.mat = mat;
  hold.takes_hold = true;
  hold.goal[0] = goal_m;
  hold.ticks_left = 50;
  hold.stiffness = 500.0;
  hold.damping = 0.5;
  hold.most_force = 10.0;
  return hold;
}

TEST(HoldsTest, AHandGoesOnAStraightLineFromWhereTheModuleWas) {
  HoldRig rig;
  ASSERT_TRUE(rig.hold(2, drawTo(9, 0.005)));
  rig.run(26);  // one tick to take hold, then half of the way
  ASSERT_EQ(rig.told.size(), 1U);
  EXPECT_EQ(rig.told[0].tick, 0);
  EXPECT_EQ(rig.told[0].index, 2);
  EXPECT_EQ(rig.told[0].hold.mat, 9);
  EXPECT_TRUE(rig.told[0].hold.takes_hold);
  ASSERT_TRUE(rig.hold(2, drawTo(9, 0.001)));
  rig.run(51);
  ASSERT_EQ(rig.told.size(), 2U);
  EXPECT_NEAR(rig.told[1].hold.at[0], 0.0025, 1e-9) << "it goes on from there";
  EXPECT_FALSE(rig.told[1].hold.takes_hold);
  rig.ask(Command::Type::kKeyframe);
  rig.run(1);
  ASSERT_EQ(rig.told.size(), 3U) << "with every keyframe all that hold are told";
  EXPECT_EQ(rig.told[2].hold.at[0], 0.001);
  EXPECT_EQ(rig.told[2].hold.ticks_left, 0);
  ASSERT_TRUE(rig.hold(2, {}));
  rig.run(1);
  ASSERT_EQ(rig.told.size(), 4U);
  EXPECT_EQ(rig.told[3].hold.mat, physics::Touch::kNothing);
}

TEST(HoldsTest, AllLetGoWhenAnotherModelPlays) {
  HoldRig rig;
  ASSERT_TRUE(rig.hold(0, drawTo(25, 0.005)));
  rig.run(10);
  Performer* const next = chain(12).release();
  rig.ask(Command::Type::kSwap, next);
  for (int n = 0; n < 50; ++n) {  // targets for the old model come in every tick
    ASSERT_TRUE(rig.hold(1, drawTo(7, 0.005)));
    rig.run(1);
  }
  rig.model = next;
  rig.told.clear();
  rig.ask(Command::Type::kKeyframe);
  rig.run(50);
  EXPECT_THAT(rig.told, IsEmpty());
  ASSERT_TRUE(rig.hold(0, drawTo(25, 0.005)));
  rig.run(1);
  EXPECT_THAT(rig.told, IsEmpty()) << "it has no module of that number";
}

TEST(HoldsTest, OfManyTargetsInATickTheNewestCountsAndNoneIsRefused) {
  HoldRig rig;
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(rig.hold(0, drawTo(9, 1e-6 * n)));
  }
  rig.run(1);
  ASSERT_EQ(rig.told.size(), 1U);
  EXPECT_EQ(rig.told[0].hold.goal[0], 1e-6 * 999);
  ASSERT_TRUE(rig.hold(0, drawTo(9, 0.001)));
  ASSERT_TRUE(rig.hold(0, {}));
  rig.run(1);
  ASSERT_EQ(rig.told.size(), 2U);
  EXPECT_EQ(rig.told[1].hold.mat, physics::Touch::kNothing);
}

TEST(HoldsTest, AHandTakesHoldWhereTheModuleIsWhateverItsTargetSays) {
  HoldRig rig;
  ASSERT_TRUE(rig.hold(0, drawTo(9, 0.005)));
  rig.run(200);
  Hold other = drawTo(10, 0.0);
  other.takes_hold = false;
  ASSERT_TRUE(rig.hold(0, other));
  rig.run(2);
  EXPECT_TRUE(rig.told.back().hold.takes_hold);
}

TEST(HoldsTest, WhatIsOutsideItsRangeIsRefused) {
  const HoldRig rig;
  EXPECT_FALSE(rig.hold(physics::kMaxTouches, drawTo(9, 0.005)));
  const auto refuses = [&rig](const auto& spoil) {
    Hold hold = drawTo(9, 0.005);
    spoil(hold);
    return !rig.hold(0, hold);
  };
  EXPECT_TRUE(refuses([](Hold& hold) { hold.ticks_left = -1; }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.ticks_left = kMaxHoldTicks + 1; }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.stiffness = std::nan(""); }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.damping = -1.0; }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.most_force = -1.0; }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.goal[1] = std::nan(""); }));
  EXPECT_TRUE(refuses([](Hold& hold) { hold.at[2] = INFINITY; }));
}

}  // namespace
}  // namespace ergotic::station
