// SPDX-License-Identifier: BSD-3-Clause
// Wheels, bends, pressure, notes with channels of their own, and what is learnt.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "ergotic/tgr/keyboard.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

using Kind = Control::Kind;
using Bytes = std::vector<std::uint8_t>;

class ControlsTest : public ::testing::Test {
 protected:
  void use(const std::string& text) { keyboard_.use(readPlayMap(text, "map.yaml"), now_s_); }
  Keyboard::Played send(const Bytes& bytes) {
    now_s_ += 1.0;
    return keyboard_.play(bytes.data(), static_cast<int>(bytes.size()), now_s_);
  }
  /// Where the last stroke of each hand ends: slices from 0 on.
  static std::map<int, double> endsOf(const Strokes& strokes) {
    std::map<int, double> ends;
    for (const Stroke& stroke : strokes) {
      ends[stroke.index] = stroke.target_m;
    }
    return ends;
  }
  Keyboard keyboard_;
  double now_s_ = 0.0;
};

TEST_F(ControlsTest, TheBendOfAParameterIsAboutWhatItUsuallyIs) {
  use("controllers:\n  - {bend: true, parameter: tension}\n");
  const auto value = [&](std::uint8_t low, std::uint8_t high) {
    const auto changes = send({0xe4, low, high}).changes;
    return valueOf(changes.at(0), {100.0, 120.0, 160.0});
  };
  EXPECT_EQ(value(0, 64), 120.0) << "let go";
  EXPECT_EQ(value(0, 0), 100.0);
  EXPECT_EQ(value(127, 127), 160.0);
  EXPECT_EQ(value(0, 32), 110.0);
}

TEST_F(ControlsTest, PressureMovesAParameterOverItsRange) {
  use("controllers:\n  - {pressure: true, parameter: loss}\n");
  const auto changes = send({0xd3, 127}).changes;
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].parameter, "loss");
  EXPECT_EQ(changes[0].share, 1.0);
  EXPECT_FALSE(changes[0].is_bent);
  EXPECT_EQ(send({0xd3, 0}).changes.at(0).share, 0.0);
}

TEST_F(ControlsTest, OfSeveralKeysTheOneThatIsPressedMostCounts) {
  use("controllers:\n  - {pressure: true, parameter: loss}\n");
  EXPECT_EQ(send({0xa0, 60, 40}).changes.at(0).share, 40.0 / 127.0);
  EXPECT_EQ(send({0xa1, 62, 80}).changes.at(0).share, 80.0 / 127.0);
  EXPECT_EQ(send({0xa0, 60, 60}).changes.at(0).share, 80.0 / 127.0);
  EXPECT_EQ(send({0xa1, 62, 0}).changes.at(0).share, 60.0 / 127.0);
  send({0x80, 60, 0});  // its pressure ends with it
  EXPECT_EQ(send({0xa1, 62, 0}).changes.at(0).share, 0.0);
}

TEST_F(ControlsTest, ValuesGoByTheLogarithmOverMoreThanTwoDecades) {
  EXPECT_NEAR(valueOf({"", 0.5, false}, {1.0, 10.0, 10000.0}), 100.0, 1e-12);
  EXPECT_NEAR(valueOf({"", 0.5, true}, {1.0, 100.0, 10000.0}), 1000.0, 1e-12);
  EXPECT_NEAR(valueOf({"", -0.5, true}, {1.0, 100.0, 10000.0}), 10.0, 1e-13);
  EXPECT_EQ(valueOf({"", 0.5, false}, {1.0, 1.0, 100.0}), 50.5);
  EXPECT_EQ(valueOf({"", 1.0, false}, {0.1, 1.0, 0.3}), 0.3) << "the ends exactly";
}

TEST_F(ControlsTest, AWheelMovesHands) {
  use("controllers:\n"
      "  - {controller: 1, slices: [2, 5], from: -4 mm, to: 6 mm, speed: 0.1}\n"
      "  - {controller: 1, parameter: place}\n");
  const auto played = send({0xb0, 1, 127});
  EXPECT_EQ(endsOf(played.strokes), (std::map<int, double>{{2, 0.006}, {5, 0.006}}));
  EXPECT_EQ(played.strokes.at(0).glide_s, 0.0);
  EXPECT_NEAR(played.strokes.at(0).after_s, 0.1, 1e-12) << "10 mm at 0.1 m/s";
  EXPECT_EQ(played.changes.size(), 1U) << "and the parameter as well";
  EXPECT_EQ(endsOf(send({0xb7, 1, 0}).strokes), (std::map<int, double>{{2, -0.004}, {5, -0.004}}));
}

TEST_F(ControlsTest, BendAndPressureMoveHandsOfEndEffectors) {
  use("controllers:\n"
      "  - {bend: true, end_effector: bow, coordinates: 1, from: -10 mm, to: 10 mm}\n"
      "  - {pressure: true, end_effector: bow, coordinates: 0, to: 3 mm}\n");
  const Strokes bent = send({0xe0, 0, 0}).strokes;
  ASSERT_EQ(bent.size(), 1U);
  EXPECT_EQ(bent[0].end_effector, "bow");
  EXPECT_EQ(bent[0].index, 1);
  EXPECT_EQ(bent[0].target_m, -0.01);
  EXPECT_EQ(send({0xe0, 0, 64}).strokes.back().target_m, 0.0);
  EXPECT_EQ(send({0xe0, 127, 127}).strokes.back().target_m, 0.01);
  EXPECT_EQ(send({0xd0, 127}).strokes.back().target_m, 0.003);
}

TEST_F(ControlsTest, AnotherMapLetsGoOfHandsThatControlsMove) {
  use("keys:\n  - {slices: 0, to: 0.01, slide: {slices: 4, to: 0.01}}\n"
      "controllers:\n  - {controller: 1, slices: [2, 3], to: 0.01}\n");
  send({0x90, 60, 100});
  send({0xb0, 74, 100});
  send({0xb0, 1, 100});
  const Strokes strokes = keyboard_.use({}, now_s_);
  std::map<int, bool> let_go;
  for (const Stroke& stroke : strokes) {
    let_go[stroke.index] = stroke.lets_go;
  }
  EXPECT_EQ(let_go, (std::map<int, bool>{{0, false}, {2, true}, {3, true}, {4, true}}));
  EXPECT_TRUE(keyboard_.use({}, now_s_).empty());
}

TEST_F(ControlsTest, PressureOfAKeyTakesItsHandFurther) {
  use("keys:\n  - {notes: [60, 71], slices: [0, 1], to: 10 mm, pressure_to: 13 mm, back: 0.5}\n");
  send({0x90, 60, 100});
  send({0x90, 61, 100});
  EXPECT_EQ(endsOf(send({0xa0, 60, 127}).strokes), (std::map<int, double>{{0, 0.013}}));
  const auto both = endsOf(send({0xd0, 64}).strokes);  // of the channel: all keys
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NEAR(both.at(1), 0.01 + 0.003 * 64 / 127, 1e-15);
  const Strokes back = send({0x80, 60, 0}).strokes;
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].target_m, 0.0);
  EXPECT_NEAR(back[0].glide_s, 1.875 * (0.01 + 0.003 * 64 / 127) / 0.5, 1e-12);
  EXPECT_TRUE(send({0xa0, 60, 127}).strokes.empty()) << "it is up";
}

TEST_F(ControlsTest, AKeyThatAPedalKeepsIsPressedNoMore) {
  use("keys:\n  - {slices: 0, to: 10 mm, pressure_to: 13 mm}\n");
  send({0x90, 60, 100});
  send({0xd0, 127});
  send({0xb0, 64, 127});
  EXPECT_EQ(endsOf(send({0x80, 60, 0}).strokes), (std::map<int, double>{{0, 0.01}}));
  EXPECT_TRUE(send({0xd0, 10}).strokes.empty());
}

const char kMpeMap[] =
    "mpe: true\n"
    "keys:\n"
    "  - {notes: [60, 71], slices: [0, 1], to: 10 mm, pressure_to: 13 mm,\n"
    "     bend: {slices: [2, 3], from: -2 mm, to: 2 mm}, slide: {parameter: place}}\n"
    "controllers:\n"
    "  - {bend: true, parameter: tension}\n"
    "  - {pressure: true, parameter: loss}\n"
    "  - {controller: 74, parameter: brightness}\n";

TEST_F(ControlsTest, WithMpeANoteHasWhatItsOwnChannelSays) {
  use(kMpeMap);
  send({0x91, 60, 100});
  send({0x92, 61, 100});
  const auto pressed = send({0xd2, 127});
  EXPECT_EQ(endsOf(pressed.strokes), (std::map<int, double>{{1, 0.013}}));
  EXPECT_TRUE(pressed.changes.empty());
  EXPECT_EQ(endsOf(send({0xe1, 127, 127}).strokes), (std::map<int, double>{{2, 0.002}}));
  const auto slid = send({0xb2, 74, 127});
  ASSERT_EQ(slid.changes.size(), 1U);
  EXPECT_EQ(slid.changes[0].parameter, "place");
  EXPECT_EQ(slid.changes[0].share, 1.0);
}

TEST_F(ControlsTest, WithMpeTheFirstChannelIsThatOfAllNotes) {
  use(kMpeMap);
  send({0x91, 60, 100});
  const auto bent = send({0xe0, 0, 0});
  EXPECT_TRUE(bent.strokes.empty());
  EXPECT_EQ(bent.changes.at(0).parameter, "tension");
  EXPECT_EQ(send({0xd0, 9}).changes.at(0).parameter, "loss");
  EXPECT_EQ(send({0xb0, 74, 9}).changes.at(0).parameter, "brightness");
}

TEST_F(ControlsTest, WithMpeANoteBeginsWithWhatItsChannelSaidBefore) {
  use(kMpeMap);
  send({0xe3, 0, 0});
  send({0xd3, 127});
  const auto begun = send({0x93, 60, 100});
  EXPECT_EQ(endsOf(begun.strokes), (std::map<int, double>{{0, 0.013}, {2, -0.002}}));
  const auto& strokes = begun.strokes;
  const auto press = std::find_if(strokes.begin(), strokes.end(),
                                  [](const Stroke& stroke) { return stroke.glide_s > 0.0; });
  ASSERT_NE(press, strokes.end());
  EXPECT_EQ(press->target_m, 0.01) << "it is thrown as every note, and pressed further after that";
  EXPECT_NEAR(strokes.back().after_s, press->glide_s + 0.02, 1e-12);
}

TEST_F(ControlsTest, WithoutMpeAllChannelsCountAlike) {
  std::string map = kMpeMap;
  map.replace(0, 9, "mpe: false");
  use(map);
  for (const Bytes& told : std::vector<Bytes>{{0xb0, 101, 0}, {0xb0, 100, 6}, {0xb0, 6, 15}}) {
    send(told);  // the device says that it has 15 members
  }
  send({0x91, 60, 100});
  send({0x92, 61, 100});
  const auto pressed = send({0xd9, 127});
  EXPECT_EQ(endsOf(pressed.strokes), (std::map<int, double>{{0, 0.013}, {1, 0.013}}));
  EXPECT_EQ(pressed.changes.size(), 1U);
}

void configureMpe(MpeZones& zones, int manager, int members) {
  for (const auto& [controller, value] : std::map<int, int>{{101, 0}, {100, 6}}) {
    zones.hear(manager, controller, value);
  }
  zones.hear(manager, 6, members);
}

/// A letter for each channel: m of a member, - of others.
std::string membersOf(const MpeZones& zones) {
  std::string members;
  for (int channel = 0; channel < 16; ++channel) {
    members += zones.isMember(channel) ? 'm' : '-';
  }
  return members;
}

TEST(MpeZonesTest, ADeviceSaysHowManyMembersThereAre) {
  MpeZones zones;
  EXPECT_FALSE(zones.isOn());
  configureMpe(zones, 0, 5);
  EXPECT_TRUE(zones.isOn());
  EXPECT_EQ(membersOf(zones), "-mmmmm----------");
  zones.hear(0, 100, 0);  // the range of bends
  zones.hear(0, 6, 2);
  EXPECT_EQ(membersOf(zones), "-mmmmm----------");
  zones.hear(0, 100, 6);
  zones.hear(0, 99, 0);  // another parameter, which is not registered
  zones.hear(0, 6, 2);
  EXPECT_EQ(membersOf(zones), "-mmmmm----------");
  configureMpe(zones, 4, 2);  // no manager
  EXPECT_EQ(membersOf(zones), "-mmmmm----------");
  configureMpe(zones, 0, 127);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmmm");
  configureMpe(zones, 0, 0);
  EXPECT_FALSE(zones.isOn());
}

TEST(MpeZonesTest, TheUpperZoneGoesDownFromTheLastChannel) {
  MpeZones zones;
  configureMpe(zones, 15, 3);
  EXPECT_TRUE(zones.isOn());
  EXPECT_EQ(membersOf(zones), "------------mmm-");
  configureMpe(zones, 15, 15);
  EXPECT_EQ(membersOf(zones), "mmmmmmmmmmmmmmm-");
  configureMpe(zones, 15, 0);
  EXPECT_FALSE(zones.isOn());
}

TEST(MpeZonesTest, TheManagersChooseRegisteredParametersEachForItself) {
  MpeZones zones;
  zones.hear(0, 101, 0);
  zones.hear(15, 100, 6);
  zones.hear(0, 6, 4);
  zones.hear(15, 6, 4);
  EXPECT_FALSE(zones.isOn());
  zones.hear(15, 101, 0);
  zones.hear(15, 6, 4);
  EXPECT_EQ(membersOf(zones), "-----------mmmm-");
}

TEST(MpeZonesTest, ALaterZoneTakesChannelsFromTheOther) {
  MpeZones zones;
  configureMpe(zones, 0, 7);
  configureMpe(zones, 15, 7);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmm-") << "they fit beside each other";
  configureMpe(zones, 15, 10);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmm-");
  configureMpe(zones, 15, 2);
  EXPECT_EQ(membersOf(zones), "-mmmm--------mm-") << "what was taken does not come back";
  configureMpe(zones, 0, 13);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmm-");
  configureMpe(zones, 0, 1);
  EXPECT_EQ(membersOf(zones), "-m------------m-") << "one was left";
}

TEST(MpeZonesTest, AZoneThatHasNoMemberLeftIsOff) {
  for (const int members : {14, 15}) {
    MpeZones zones;
    configureMpe(zones, 15, 6);
    configureMpe(zones, 0, members);
    configureMpe(zones, 0, 0);
    EXPECT_FALSE(zones.isOn()) << members;
    configureMpe(zones, 0, 6);
    configureMpe(zones, 15, members);
    configureMpe(zones, 15, 0);
    EXPECT_FALSE(zones.isOn()) << members;
  }
}

TEST(MpeZonesTest, NoTwoConfigurationsShareAChannel) {
  for (int first = 0; first <= 15; ++first) {
    for (int later = 1; later <= 15; ++later) {
      for (const bool is_upper_later : {false, true}) {
        MpeZones zones;
        configureMpe(zones, is_upper_later ? 0 : 15, first);
        configureMpe(zones, is_upper_later ? 15 : 0, later);
        const std::string members = membersOf(zones);
        const auto count = std::count(members.begin(), members.end(), 'm');
        EXPECT_EQ(count, std::max(std::min(first + later, 14), later)) << first << ' ' << later;
        const char of_later_manager = members[is_upper_later ? 15 : 0];
        EXPECT_EQ(of_later_manager, '-') << first << ' ' << later;
      }
    }
  }
}

TEST(MpeZonesTest, AMapMaySayOtherwise) {
  MpeZones zones;
  zones.use(true);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmmm");
  configureMpe(zones, 0, 3);
  EXPECT_EQ(membersOf(zones), "-mmm------------");
  zones.use(false);
  EXPECT_FALSE(zones.isOn());
  zones.use(std::nullopt);
  EXPECT_EQ(membersOf(zones), "-mmm------------") << "the device says it once";
}

TEST(MpeZonesTest, AnUpperZoneTakesChannelsFromTheOneThatTheMapWants) {
  MpeZones zones;
  zones.use(true);
  configureMpe(zones, 15, 5);
  EXPECT_EQ(membersOf(zones), "-mmmmmmmmmmmmmm-");
  configureMpe(zones, 15, 15);
  EXPECT_EQ(membersOf(zones), "mmmmmmmmmmmmmmm-");
  zones.use(false);
  EXPECT_FALSE(zones.isOn());
}

TEST_F(ControlsTest, NotesOfTheUpperZoneHaveWhatTheirChannelsSay) {
  std::string map = kMpeMap;
  map.replace(0, 9, "");  // as the device says
  use(map);
  for (const Bytes& told : std::vector<Bytes>{{0xbf, 101, 0}, {0xbf, 100, 6}, {0xbf, 6, 4}}) {
    send(told);
  }
  send({0x9e, 60, 100});
  send({0x9b, 61, 100});
  EXPECT_EQ(endsOf(send({0xeb, 127, 127}).strokes), (std::map<int, double>{{3, 0.002}}));
  EXPECT_EQ(endsOf(send({0xde, 127}).strokes), (std::map<int, double>{{0, 0.013}}));
  const auto of_manager = send({0xef, 0, 0});
  EXPECT_TRUE(of_manager.strokes.empty());
  EXPECT_EQ(of_manager.changes.at(0).parameter, "tension");
  const auto of_nobody = send({0xd1, 127});
  EXPECT_TRUE(of_nobody.strokes.empty()) << "channel 2 is in no zone";
  EXPECT_EQ(of_nobody.changes.at(0).parameter, "loss");
}

TEST_F(ControlsTest, TellsProgramChanges) {
  EXPECT_EQ(send({0xc5, 17}).program, 17);
  EXPECT_FALSE(send({0xc5, 128}).program.has_value());
  EXPECT_FALSE(send({0xb0, 0, 3}).program.has_value()) << "banks mean nothing";
}

TEST_F(ControlsTest, LearnsTheControlThatMoves) {
  use("controllers:\n  - {controller: 1, parameter: volume}\n");
  keyboard_.learner().wait("tension");
  EXPECT_FALSE(send({0xb0, 21, 60}).learnt.has_value()) << "where it was is not known";
  EXPECT_FALSE(send({0xb0, 1, 60}).learnt.has_value());
  EXPECT_FALSE(send({0xb0, 21, 68}).learnt.has_value()) << "a little";
  const auto played = send({0xb0, 21, 69});
  ASSERT_TRUE(played.learnt.has_value());
  EXPECT_EQ(played.learnt->parameter, "tension");
  EXPECT_EQ(nameOf(played.learnt->control), "controller 21");
  EXPECT_EQ(played.changes.at(0).parameter, "tension");
  EXPECT_EQ(send({0xb0, 21, 127}).changes.at(0).share, 1.0);
  EXPECT_EQ(send({0xb0, 1, 127}).changes.at(0).parameter, "volume");
}

TEST_F(ControlsTest, WhatIsLearntTakesThePlaceOfTheMap) {
  use("controllers:\n  - {controller: 1, parameter: volume}\n");
  const auto learn = [&](const std::string& parameter, std::uint8_t controller) {
    keyboard_.learner().wait(parameter);
    send({0xb0, controller, 0});
    send({0xb0, controller, 127});
  };
  learn("tension", 1);
  EXPECT_EQ(send({0xb0, 1, 5}).changes.size(), 1U);
  EXPECT_EQ(send({0xb0, 1, 5}).changes.at(0).parameter, "tension");
  learn("loss", 1);
  EXPECT_EQ(send({0xb0, 1, 5}).changes.at(0).parameter, "loss");
  learn("loss", 2);
  EXPECT_EQ(send({0xb0, 2, 5}).changes.at(0).parameter, "loss");
  EXPECT_EQ(send({0xb0, 1, 5}).changes.at(0).parameter, "volume") << "one control each";
  keyboard_.use({}, now_s_);
  EXPECT_EQ(send({0xb0, 2, 5}).changes.size(), 1U) << "another map leaves it";
  keyboard_.learner().forget();
  EXPECT_TRUE(send({0xb0, 2, 5}).changes.empty());
}

TEST_F(ControlsTest, LearnsBendAndPressureButNoPedalsAndBanks) {
  keyboard_.learner().wait("tension");
  for (const std::uint8_t number :
       Bytes{0, 6, 32, 38, 64, 66, 67, 96, 97, 98, 99, 100, 101, 120, 123}) {
    send({0xb0, number, 0});
    EXPECT_FALSE(send({0xb0, number, 127}).learnt.has_value()) << int{number};
  }
  send({0xe0, 0, 64});
  EXPECT_EQ(nameOf(send({0xe0, 0, 80}).learnt.value().control), "the pitch bend");
  keyboard_.learner().wait("loss");
  send({0xd0, 0});
  EXPECT_EQ(nameOf(send({0xd0, 30}).learnt.value().control), "the pressure");
}

TEST_F(ControlsTest, AnEmptyNameEndsLearning) {
  keyboard_.learner().wait("tension");
  send({0xb0, 21, 0});
  keyboard_.learner().wait("");
  EXPECT_FALSE(send({0xb0, 21, 127}).learnt.has_value());
}

TEST(ControlLinesTest, TellWhatIsWrongWhere) {
  const auto complaint = [](const std::string& line) {
    return complaintOf<TextError>([&] { readPlayMap("controllers:\n  - " + line, "map.yaml"); });
  };
  EXPECT_THAT(complaint("{parameter: x}\n"), HasSubstr("missing key 'controller'"));
  EXPECT_THAT(complaint("{controller: 1}\n"), HasSubstr("missing key 'parameter'"));
  EXPECT_THAT(complaint("{bend: false, parameter: x}\n"), HasSubstr("allowed: true"));
  EXPECT_THAT(complaint("{bend: true, pressure: true, parameter: x}\n"),
              HasSubstr("allowed: one of them"));
  EXPECT_THAT(complaint("{bend: true, parameter: x, slices: 1, to: 0}\n"), HasSubstr("'slices'"));
  EXPECT_THAT(complaint("{pressure: true, slices: 1}\n"), HasSubstr("map.yaml:2:5"));
  EXPECT_THAT(complaint("{controller: 1, slices: 64, to: 0}\n"), HasSubstr("0...63"));
  EXPECT_THAT(complaint("{controller: 1, slices: 1, to: 2}\n"), HasSubstr("-1...1"));
  EXPECT_THAT(complaint("{controller: 1, slices: 1, to: 0, speed: 3}\n"), HasSubstr("0.001...2"));
  const auto of_keys = [](const std::string& what) {
    return complaintOf<TextError>(
        [&] { readPlayMap("keys:\n  - {slices: 0, to: 0.01, " + what + "}\n", "map.yaml"); });
  };
  EXPECT_THAT(of_keys("pressure_to: 2"), HasSubstr("-1...1"));
  EXPECT_THAT(of_keys("strikes: true, pressure_to: 0.02"), HasSubstr("allowed"));
  EXPECT_THAT(of_keys("bend: 3"), HasSubstr("bend"));
  EXPECT_THAT(of_keys("slide: {parameter: x, to: 1}"), HasSubstr("unknown key 'to'"));
  EXPECT_THAT(complaintOf<TextError>([] { readPlayMap("mpe: 3\n", "map.yaml"); }),
              HasSubstr("map.yaml:1:6"));
}

}  // namespace
}  // namespace ergotic::tgr
