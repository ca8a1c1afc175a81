// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_settings.hpp"

#include <yaml-cpp/yaml.h>

#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

std::string complaint(const std::string& text) {
  return complaintOf([&] { readComediSettings(YAML::Load(text), "devices.yaml"); });
}

std::string with(const std::string& more) {
  return "{ai_channels: [0, 1], ao_channels: [0, 1], " + more + "}";
}

TEST(ComediSettingsTest, NeedsChannelsOnly) {
  const ComediSettings s =
      readComediSettings(YAML::Load("{ai_channels: [4, 2], ao_channels: [0, 1]}"), "");
  EXPECT_EQ(s.board, "/dev/comedi0");
  EXPECT_EQ(s.slices(), 2);
  EXPECT_THAT(s.ai_channels, ElementsAre(4, 2));
  EXPECT_THAT(s.ao_channels, ElementsAre(0, 1));
  EXPECT_EQ(s.ai_subdevice, -1);
  EXPECT_EQ(s.ai_range.index, -1);
  EXPECT_EQ(s.ai_range.low_volts, -10.0);
  EXPECT_EQ(s.ai_range.high_volts, 10.0);
  EXPECT_EQ(s.ai_reference, 0U);
  EXPECT_EQ(s.average, 1);
  EXPECT_THAT(s.safe_volts, ElementsAre(0.0, 0.0));
  EXPECT_FALSE(s.damping.has_value());
}

TEST(ComediSettingsTest, TakesWhatIsSaid) {
  const ComediSettings s = readComediSettings(
      YAML::Load(
          with("board: /dev/comedi3, ai_subdevice: 4, ao_subdevice: 5, ai_range: 2, ao_range: [-5, "
               "5.5], ai_reference: diff, ao_reference: common, discard: 1, average: 4, deglitch: "
               "true, safe_volts: [0.5, -0.25], damping: 1.5")),
      "");
  EXPECT_EQ(s.damping, 1.5);
  EXPECT_EQ(s.board, "/dev/comedi3");
  EXPECT_EQ(s.ai_subdevice, 4);
  EXPECT_EQ(s.ao_subdevice, 5);
  EXPECT_EQ(s.ai_range.index, 2);
  EXPECT_EQ(s.ao_range.index, -1);
  EXPECT_EQ(s.ao_range.low_volts, -5.0);
  EXPECT_EQ(s.ao_range.high_volts, 5.5);
  EXPECT_EQ(s.ai_reference, 2U);
  EXPECT_EQ(s.ao_reference, 1U);
  EXPECT_EQ(s.discard, 1);
  EXPECT_EQ(s.average, 4);
  EXPECT_TRUE(s.deglitch);
  EXPECT_THAT(s.safe_volts, ElementsAre(0.5, -0.25));
}

TEST(ComediSettingsTest, TakesOneSafeVoltageForAll) {
  EXPECT_THAT(readComediSettings(YAML::Load(with("safe_volts: 0.25")), "").safe_volts,
              ElementsAre(0.25, 0.25));
}

TEST(ComediSettingsTest, NamesPlaceSettingValueAndWhatIsAllowed) {
  EXPECT_THAT(complaint("ai_channels: [0]\nao_channels: [0]\naverage: 65"),
              AllOf(HasSubstr("devices.yaml:3:10: error: "), HasSubstr("'average'"),
                    HasSubstr("65"), HasSubstr("1...64")));
  EXPECT_THAT(complaint(with("volume: 1")), HasSubstr("'volume' of driver comedi"));
  EXPECT_THAT(complaint("{ai_channels: [0]}"), HasSubstr("missing key 'ao_channels'"));
}

TEST(ComediSettingsTest, RefusesWhatNoBoardCanDo) {
  EXPECT_EQ(complaint("{ai_channels: [3, 3], ao_channels: [0, 1]}"),
            "devices.yaml:1:19: error: ai_channels: channel 3 comes twice, allowed: each once");
  EXPECT_THAT(complaint("{ai_channels: [], ao_channels: []}"), HasSubstr("'ai_channels'"));
  EXPECT_THAT(complaint("{ai_channels: [0, 1], ao_channels: [0]}"), HasSubstr("as many"));
  EXPECT_EQ(complaint("{ai_channels: [1, 0.5], ao_channels: [0]}"),
            "devices.yaml:1:19: error: 'ai_channels' of driver comedi = 0.5 is not a whole number, "
            "allowed: 0...255");
  EXPECT_THAT(complaint("{ai_channels: 0.5, ao_channels: [0]}"),
              HasSubstr("devices.yaml:1:15: error: 'ai_channels' of driver comedi = 0.5 is not a"));
  EXPECT_THAT(complaint("{ai_channels: [-1], ao_channels: [0]}"), HasSubstr("0...255"));
  EXPECT_THAT(complaint(with("board: [a]")), HasSubstr("a single value"));
  EXPECT_THAT(complaint(with("ai_range: [5, -5]")),
              AllOf(HasSubstr("devices.yaml:1:54: error: "), HasSubstr("[5, -5] V, allowed: "),
                    HasSubstr("[low, high]")));
  EXPECT_THAT(complaint(with("ai_range: [0, .nan]")), HasSubstr("'ai_range'"));
  EXPECT_THAT(complaint(with("ao_range: wide")), HasSubstr("0...255"));
  EXPECT_THAT(complaint(with("ai_reference: earth")), HasSubstr("ground, common, diff, other"));
  EXPECT_THAT(complaint(with("deglitch: 3")), HasSubstr("false, true"));
  EXPECT_THAT(complaint(with("safe_volts: [0]")), HasSubstr("'safe_volts'"));
  EXPECT_THAT(complaint(with("safe_volts: 0.6")), HasSubstr("-0.5...0.5 V"));
}

}  // namespace
}  // namespace ergotic::tgr
