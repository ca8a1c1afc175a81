// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>

#include "comedi/comedi_rig.hpp"
#include "support/realtime_scope.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

/// Position of a mass on a spring at `t_s` after a constant force came.
double stepResponse(const tgr::VirtualSliceConfig& s, double force, double t_s) {
  const double mass = s.mass + s.hand_mass;
  const double decay = (s.damping + s.hand_damping) / (2.0 * mass);
  const double omega = std::sqrt(s.hand_stiffness / mass - decay * decay);
  return force / s.hand_stiffness *
         (1.0 -
          std::exp(-decay * t_s) * (std::cos(omega * t_s) + decay / omega * std::sin(omega * t_s)));
}

std::string complaintOnOpen(const ComediStandinBoard& board, const std::string& settings) {
  ComediRig rig(board, settings);
  return complaintOf<DeviceError>([&] { rig.driver().open(1000.0); });
}

TEST(ComediDriverTest, SeesAForceStepAsTheEquationOfTheSliceSays) {
  const ComediStandinBoard board = plainBoard();
  ComediRig rig(board);
  rig.driver().open(1000.0);
  const double volts = comediVolts(kMidCount + 1000);
  const double force = kNewtonsPerVolt * (volts - board.no_force_volts);
  for (int n = 0; n < 500; ++n) {
    ASSERT_EQ(rig.exchange(volts), tgr::kExchangeOk);
    const double x = stepResponse(board.slice, force, 1e-3 * n);
    const double seen = kMetresPerVolt * (rig.inputs[0] - board.rest_volts);
    ASSERT_NEAR(seen, x, 0.5 * kMetresPerVolt * kVoltsPerCount + 1e-4 * std::abs(x)) << n;
  }
}

TEST(ComediDriverTest, GivesMultiplesOfTheResolution) {
  ComediRig rig;
  rig.driver().open(1000.0);
  for (int n = 0; n < 100; ++n) {
    rig.exchange(0.3);
    const double counts = (rig.inputs[1] + 10.0) / kVoltsPerCount;
    EXPECT_NEAR(counts, std::round(counts), 1e-6);
  }
}

TEST(ComediDriverTest, KeepsTheChannelsOfSlicesApart) {
  ComediRig rig(plainBoard(), "{ai_channels: [3, 1], ao_channels: [0, 2]}");
  rig.driver().open(1000.0);
  const double outputs[] = {1.0, -2.0};
  rig.driver().exchange(outputs, rig.inputs.data());
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.0, kVoltsPerCount);
  EXPECT_NEAR(comediStandinOutputVolts(2), -2.0, kVoltsPerCount);
  EXPECT_EQ(comediStandinOutputVolts(1), comediVolts(kMidCount));
  comediStandinHold(1, 0.02);
  for (int n = 0; n < 2000; ++n) {
    rig.driver().exchange(outputs, rig.inputs.data());
  }
  EXPECT_NEAR(rig.inputs[1], comediVolts(kMidCount) + 0.02 / kMetresPerVolt, 1e-3);
  EXPECT_NEAR(rig.inputs[0], comediVolts(kMidCount), 1e-9);
}

TEST(ComediDriverTest, MakesOneListOfInstructionsPerTick) {
  ComediRig rig;
  rig.driver().open(1000.0);
  const ComediCounters before = ComediRig::counters();
  for (int n = 0; n < 100; ++n) {
    rig.exchange(0.1);
  }
  const ComediCounters after = ComediRig::counters();
  EXPECT_EQ(after.lists - before.lists, 100);
  EXPECT_EQ(after.reading_lists - before.reading_lists, 100);
}

TEST(ComediDriverTest, AveragesWhatIsNotDiscardedToTheSameVolts) {
  ComediRig plain;
  plain.driver().open(1000.0);
  plain.exchange(1.0);
  plain.exchange(1.0);
  const double once = plain.inputs[2];
  ComediRig many(plainBoard(), threeSlices("discard: 2, average: 5"));
  many.driver().open(1000.0);
  many.exchange(1.0);
  many.exchange(1.0);
  EXPECT_NEAR(many.inputs[2], once, 1e-12);
  EXPECT_NE(once, comediVolts(kMidCount));
}

TEST(ComediDriverTest, TakesTheNarrowestRangeThatHoldsWhatIsAsked) {
  ComediRig rig(plainBoard(), threeSlices("ao_range: [-4, 4], ai_range: [-5, 5]"));
  rig.driver().open(1000.0);
  rig.exchange(1.2345);
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.2345, 0.25 * kVoltsPerCount);
  rig.exchange(7.0);
  EXPECT_EQ(comediStandinOutputVolts(0), 5.0);
}

TEST(ComediDriverTest, LimitsVoltsAndTakesWhatIsNoNumberForNoForce) {
  ComediRig rig;
  rig.driver().open(1000.0);
  const double infinity = std::numeric_limits<double>::infinity();
  rig.exchange(infinity);
  EXPECT_EQ(comediStandinOutputVolts(0), 10.0);
  rig.exchange(-1e308);
  EXPECT_EQ(comediStandinOutputVolts(0), -10.0);
  rig.exchange(std::nan(""));
  EXPECT_EQ(comediStandinOutputVolts(0), comediVolts(kMidCount));
}

TEST(ComediDriverTest, LeavesSafeVoltsBehind) {
  ComediRig rig(plainBoard(),
                "{ai_channels: [0, 1], ao_channels: [0, 1], safe_volts: [0.25, -0.5]}");
  rig.driver().open(1000.0);
  EXPECT_NEAR(comediStandinOutputVolts(0), 0.25, kVoltsPerCount) << "from the start";
  rig.exchange(5.0);
  EXPECT_NEAR(comediStandinOutputVolts(1), 5.0, kVoltsPerCount);
  rig.driver().close();
  EXPECT_NEAR(comediStandinOutputVolts(0), 0.25, kVoltsPerCount);
  EXPECT_NEAR(comediStandinOutputVolts(1), -0.5, kVoltsPerCount);
  EXPECT_EQ(ComediRig::counters().opened, 1);
  EXPECT_EQ(ComediRig::counters().closed, 1);
}

TEST(ComediDriverTest, ExchangesInRealTime) {
  ComediRig rig;
  rig.driver().open(1000.0);
  expectRealtime([&] {
    for (int n = 0; n < 1000; ++n) {
      rig.exchange(0.1);
      rig.driver().makeSafe();
    }
  });
}

TEST(ComediDriverTest, SaysWhyABoardCannotBeOpenedAndWhatToDo) {
  ComediStandinBoard board = plainBoard();
  board.open_error = EACCES;
  EXPECT_THAT(
      complaintOnOpen(board, threeSlices()),
      AllOf(HasSubstr("/dev/comedi0"), HasSubstr("Permission denied"), HasSubstr("iocard")));
  board.open_error = EBUSY;
  EXPECT_THAT(complaintOnOpen(board, threeSlices()), HasSubstr("another program"));
  EXPECT_THAT(complaintOnOpen(plainBoard(), threeSlices("board: /dev/comedi7")),
              AllOf(HasSubstr("/dev/comedi7"), HasSubstr("No such file"), HasSubstr("modprobe"),
                    HasSubstr("comedi_config")));
}

TEST(ComediDriverTest, SaysWhatABoardHasInPlaceOfWhatWasAsked) {
  ComediStandinBoard board = plainBoard();
  const auto complaint = [&](const std::string& more) {
    return complaintOnOpen(board, threeSlices(more));
  };
  EXPECT_THAT(complaint("ai_subdevice: 0"),
              AllOf(HasSubstr("subdevice 0"), HasSubstr("the first is 1")));
  EXPECT_THAT(complaint("ao_subdevice: 9"), HasSubstr("the first is 2"));
  EXPECT_THAT(complaint("ai_range: 3"),
              AllOf(HasSubstr("ai_range 3"), HasSubstr("0: [-10, 10] V, 1: [-5, 5] V")));
  EXPECT_THAT(complaint("ao_range: [-12, 12]"),
              AllOf(HasSubstr("ao_range [-12, 12] V"), HasSubstr("2: [-5, 5] V")));
  EXPECT_THAT(complaint("ao_range: 1"), HasSubstr("ao_range 1")) << "it is in mA";
  EXPECT_THAT(complaint("ai_reference: common"),
              AllOf(HasSubstr("ai_reference common"), HasSubstr("ground diff")));
  EXPECT_THAT(complaintOnOpen(board, "{ai_channels: [0, 4], ao_channels: [0, 1]}"),
              AllOf(HasSubstr("no channel 4"), HasSubstr("0...3")));
  EXPECT_THAT(
      complaintOnOpen(board, "{ai_channels: [0], ao_channels: [1], ao_range: 3, safe_volts: -0.1}"),
      AllOf(HasSubstr("safe_volts of slice 0"), HasSubstr("[0, 10] V")));
  EXPECT_EQ(complaint("deglitch: true"), "");
  board.can_deglitch = false;
  EXPECT_THAT(complaint("deglitch: true"), HasSubstr("deglitch"));
}

TEST(ComediDriverTest, SharesABoardWithNobody) {
  ComediRig rig;
  rig.driver().open(1000.0);
  const auto other = tgr::ComediFactory().make(YAML::Load(threeSlices()), "");
  EXPECT_THAT(complaintOf<DeviceError>([&] { other->open(1000.0); }),
              HasSubstr("another program uses it"));
  rig.driver().close();
  EXPECT_NO_THROW(other->open(1000.0));
}

TEST(ComediDriverTest, SpeaksVolts) {
  EXPECT_TRUE(ComediRig().driver().isRaw());
}

}  // namespace
}  // namespace ergotic::test
