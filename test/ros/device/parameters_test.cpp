// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <tuple>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue with(const std::string& name, const XmlRpcValue& value) {
  XmlRpcValue values;
  values[name] = value;
  return values;
}

/// What is said of one parameter, "" if it is taken.
std::string refusalOf(const std::string& name, const XmlRpcValue& value) {
  return complaintOf([&] { readParameters(with(name, value), "/station"); });
}

TEST(ParametersTest, AreTheDefaultsWhereNothingIsSaid) {
  const Parameters p = readParameters(XmlRpcValue(), "/station");
  EXPECT_EQ(p.safety.force_limit_n, 20.0);
  EXPECT_EQ(p.safety.frozen_s, 0.1);
  EXPECT_EQ(p.driver, "virtual");
  EXPECT_TRUE(p.jack);
}

TEST(ParametersTest, LetNoTickWaitLongerThanATickForAThread) {
  EXPECT_EQ(readParameters(XmlRpcValue(), "/station").compile.wait_limit_ns, physics::kOneTick);
  EXPECT_EQ(physics::liveOptions().wait_limit_ns, physics::kOneTick);
}

TEST(ParametersTest, WhatTookThePlaceOfAllIsRefused) {
  for (const XmlRpcValue& value : {XmlRpcValue(3), XmlRpcValue("frozen=0"), XmlRpcValue(true)}) {
    EXPECT_THAT(complaintOf([&] { readParameters(value, "/station"); }),
                HasSubstr("parameter /station is no map"));
  }
}

TEST(ParametersTest, AreWhatIsSaid) {
  XmlRpcValue values;
  values["force_limit"] = 5;  // YAML does not tell 5 from 5.0
  values["max_missing"] = 30.0;
  values["ramp"] = 0.5;
  values["driver"] = "jack";
  values["jack"] = "none";
  values["autoengage"] = true;
  const Parameters p = readParameters(values, "/station");
  EXPECT_EQ(p.safety.force_limit_n, 5.0);
  EXPECT_EQ(p.safety.max_missing, 30);
  EXPECT_EQ(p.safety.ramp_s, 0.5);
  EXPECT_EQ(p.driver, "jack");
  EXPECT_FALSE(p.jack);
  EXPECT_TRUE(p.autoengage);
}

TEST(ParametersTest, AreToldWhereTheyAreUnusual) {
  EXPECT_EQ(unusual(readParameters(XmlRpcValue(), "/station")), "");
  XmlRpcValue values;
  values["force_limit"] = 5;
  values["ramp"] = 0.3;
  values["presence"] = "topic";
  values["max_missing"] = 20;  // the default
  EXPECT_EQ(unusual(readParameters(values, "/station")),
            "force_limit: 5, ramp: 0.3, presence: topic");
}

TEST(ParametersTest, LimitStallsAsTheDeviceNeedsUnlessTheySayOtherwise) {
  const Parameters real = withStallLimits(readParameters(XmlRpcValue(), "/station"), true);
  EXPECT_EQ(real.max_stall, 0.05);
  EXPECT_EQ(real.max_stalls, 3);
  EXPECT_EQ(real.watchdog, 0.02);
  const Parameters simulated = withStallLimits(readParameters(XmlRpcValue(), "/station"), false);
  EXPECT_EQ(simulated.max_stall, 1.0);
  EXPECT_EQ(simulated.max_stalls, 1'000'000);
  EXPECT_EQ(simulated.watchdog, 1.0);
  XmlRpcValue values;
  values["max_stall"] = 0.02;
  values["max_stalls"] = 5;
  values["watchdog"] = 0.1;
  for (const bool can_hurt : {true, false}) {
    const Parameters given = withStallLimits(readParameters(values, "/station"), can_hurt);
    EXPECT_EQ(given.max_stall, 0.02);
    EXPECT_EQ(given.max_stalls, 5);
    EXPECT_EQ(given.watchdog, 0.1);
    EXPECT_THAT(toYaml(given, {}), HasSubstr("max_stall: 0.02"));
  }
}

TEST(ParametersTest, SetWhatThePortMayGiveAndAreWrittenDown) {
  XmlRpcValue values;
  values["energy_cap"] = 0.5;
  values["energy_supply"] = 0.25;
  values["slice_mass"] = 2;
  const Parameters p = readParameters(values, "/station");
  EXPECT_EQ(p.safety.energy_cap_j, 0.5);
  EXPECT_EQ(p.safety.energy_supply_w, 0.25);
  EXPECT_EQ(p.safety.slice_mass_kg, 2.0);
  const YAML::Node written = YAML::Load(toYaml(p, readDevices(p)));
  EXPECT_EQ(written["energy_cap"].as<double>(), 0.5);
  EXPECT_EQ(written["energy_supply"].as<double>(), 0.25);
  EXPECT_EQ(written["slice_mass"].as<double>(), 2.0);
}

/// The chain refuses what is out of its own ranges: both say the same.
TEST(ParametersTest, HaveTheRangesOfTheSafetyChain) {
  for (const auto& [name, least, most] : {std::tuple{"energy_cap", 0.001, 10.0},
                                          {"energy_supply", 0.0, 20.0},
                                          {"slice_mass", 0.01, 100.0}}) {
    for (const double end : {least, most}) {
      const Parameters p = readParameters(with(name, end), "/station");
      EXPECT_NO_THROW(tgr::SafetyChain(p.safety, 1, 1e-3)) << name << " " << end;
    }
    EXPECT_NE(refusalOf(name, std::nextafter(least, -1.0)), "") << name;
    EXPECT_NE(refusalOf(name, std::nextafter(most, 1e9)), "") << name;
  }
}

TEST(ParametersTest, AreRefusedWhereNobodyReadsThem) {
  EXPECT_EQ(refusalOf("force_limt", 5),
            "parameter /station/force_limt is not known; did you mean 'force_limit'?");
  const std::string refusal = refusalOf("quux_of_the_player", 5);
  EXPECT_EQ(
      refusal.rfind("parameter /station/quux_of_the_player is not known, allowed: model, ", 0), 0U)
      << refusal;
  EXPECT_THAT(refusal, HasSubstr(", force_limit, "));
  EXPECT_NE(refusalOf("safety", with("force_limit", 5)), "") << "a map is none of them either";
}

TEST(ParametersTest, LeaveToOthersWhatTheyRead) {
  EXPECT_EQ(refusalOf("diagnostic_period", 0.5), "");
  EXPECT_EQ(refusalOf("num_worker_threads", 2), "");
}

TEST(ParametersTest, AreRefusedOutsideTheirRange) {
  EXPECT_EQ(refusalOf("force_limit", 200), "");
  EXPECT_EQ(refusalOf("force_limit", 200.5),
            "parameter /station/force_limit is 200.5, allowed: 0...200");
  EXPECT_EQ(refusalOf("ramp", std::numeric_limits<double>::quiet_NaN()),
            "parameter /station/ramp is nan, allowed: 0.1...10");
  EXPECT_EQ(refusalOf("jack", "perhaps"),
            "parameter /station/jack is perhaps, allowed: auto, none");
}

TEST(ParametersTest, ThatNamePortsAreRefusedIfTheyAreNoRegularExpression) {
  EXPECT_EQ(refusalOf("midi_connect", "nanoKEY"), "");
  EXPECT_THAT(refusalOf("midi_connect", "nano["),
              AllOf(HasSubstr("parameter /station/midi_connect is nano[,"),
                    HasSubstr("allowed: physical, none")));
  EXPECT_EQ(refusalOf("midi_programs", "yes"),
            "parameter /station/midi_programs is yes, allowed: always, never, simulated");
}

/// `presence:=$UNSET` of a shell must not mean that there is no switch.
TEST(ParametersTest, AreRefusedWhereAChoiceIsEmpty) {
  EXPECT_EQ(refusalOf("presence", ""),
            "parameter /station/presence is empty, allowed: none, topic");
  for (const char* const name : {"realtime", "force_after_swap", "precision", "isa", "jack",
                                 "midi_connect", "midi_programs"}) {
    EXPECT_THAT(refusalOf(name, ""), HasSubstr(" is empty, allowed: ")) << name;
  }
  EXPECT_EQ(refusalOf("end_effectors", ""), "") << "a text may be empty";
}

TEST(ParametersTest, AreRefusedWithAFractionWhereOnlyWholeNumbersAreMeant) {
  EXPECT_EQ(refusalOf("max_missing", 2.5),
            "parameter /station/max_missing is 2.5, allowed: 0...1000, whole numbers");
  EXPECT_EQ(refusalOf("max_missing", 1001),
            "parameter /station/max_missing is 1001, allowed: 0...1000, whole numbers");
  EXPECT_NE(refusalOf("threads", 1e300), "");
}

TEST(ParametersTest, AreRefusedWhenOfAnotherType) {
  EXPECT_EQ(refusalOf("force_limit", "5"),
            "parameter /station/force_limit is the text '5', allowed: 0...200");
  EXPECT_EQ(
      refusalOf("max_missing", true),
      "parameter /station/max_missing is true, for which YAML takes on and yes, too, allowed: "
      "0...1000, whole numbers");
  EXPECT_EQ(refusalOf("autoengage", 1),
            "parameter /station/autoengage is the number 1, allowed: true or false");
  EXPECT_EQ(refusalOf("autoengage", "perhaps"),
            "parameter /station/autoengage is the text 'perhaps', allowed: true or false");
  EXPECT_EQ(refusalOf("driver", with("a", 1)),
            "parameter /station/driver is a map, allowed: a string");
}

/// `rosparam set /station/jack_name 007`
TEST(ParametersTest, AreToBeQuotedWhereYamlMakesNumbersAndSwitchesOfWords) {
  const std::string quote = "; quote it for YAML and for the shell: \"'...'\"";
  EXPECT_EQ(refusalOf("jack_name", 7),
            "parameter /station/jack_name is the number 7, allowed: a string" + quote);
  EXPECT_EQ(refusalOf("model", 1.5),
            "parameter /station/model is the number 1.5, allowed: a string" + quote);
  EXPECT_EQ(refusalOf("jack_name", false),
            "parameter /station/jack_name is false, for which YAML takes off and no, too, allowed: "
            "a string" +
                quote);
  EXPECT_EQ(refusalOf("realtime", true),
            "parameter /station/realtime is true, for which YAML takes on and yes, too, allowed: "
            "off, require, try" +
                quote);
  EXPECT_THAT(refusalOf("precision", false), HasSubstr("allowed: auto, double, float" + quote));
}

/// YAML makes false of `off` and `no`, and `roslaunch` leaves them as they are.
TEST(ParametersTest, MayBeSwitchedOffInAnyWord) {
  for (const XmlRpcValue& off :
       {XmlRpcValue(false), XmlRpcValue("off"), XmlRpcValue("no"), XmlRpcValue("False")}) {
    XmlRpcValue values;
    for (const char* const name : {"realtime", "presence", "jack", "midi_programs", "midi_connect",
                                   "force_after_swap", "energies", "gamepads"}) {
      values[name] = off;
    }
    const Parameters p = readParameters(values, "/station");
    EXPECT_EQ(p.realtime, Realtime::kOff);
    EXPECT_FALSE(p.presence);
    EXPECT_FALSE(p.jack);
    EXPECT_EQ(p.midi_programs, MidiPrograms::kNever);
    EXPECT_EQ(p.midi_connect, "none");
    EXPECT_EQ(p.force_after_swap, station::SwapForce::kNever);
    EXPECT_FALSE(p.compile.metered);
    EXPECT_FALSE(p.gamepads);
    const EarlyParameters early = readEarlyParameters(values, "/station");
    EXPECT_EQ(early.realtime, Realtime::kOff);
    EXPECT_FALSE(early.gamepads);
    EXPECT_THAT(early.refusals, testing::IsEmpty());
  }
  for (const XmlRpcValue& on : {XmlRpcValue(true), XmlRpcValue("yes"), XmlRpcValue("On")}) {
    EXPECT_TRUE(readParameters(with("autoengage", on), "/station").autoengage);
    EXPECT_TRUE(readEarlyParameters(with("allow_remote", on), "/station").allow_remote);
  }
}

TEST(ParametersTest, ThatAreHeardFirstAreNotReplacedWithoutAWord) {
  XmlRpcValue values;
  values["realtime"] = 3;
  values["priority"] = "high";
  values["allow_remote"] = "perhaps";
  values["tf_prefix"] = "/left";
  const EarlyParameters early = readEarlyParameters(values, "/station");
  EXPECT_EQ(early.realtime, Realtime::kTry);
  EXPECT_EQ(early.priority, readParameters(XmlRpcValue(), "/station").priority);
  EXPECT_FALSE(early.allow_remote);
  EXPECT_TRUE(early.gamepads);
  EXPECT_EQ(early.tf_prefix, "");
  EXPECT_THAT(early.refusals,
              testing::ElementsAre(HasSubstr("/station/allow_remote is the text 'perhaps'"),
                                   HasSubstr("/station/realtime is the number 3, allowed: off"),
                                   HasSubstr("/station/priority is the text 'high'"),
                                   HasSubstr("/station/tf_prefix is /left, allowed: letters")));
}

TEST(ParametersTest, TellARecordingWhatStoodOnTheSlices) {
  const tgr::EndEffectors hands = readEndEffectors(
      "end_effectors:\n  bow: {type: bow, slices: [3, 4], ports: ['', ''], lever: 2}\n");
  tgr::StationDevices devices = readDevices(readParameters(XmlRpcValue(), "/station"));
  devices.end_effectors = hands;
  const auto read =
      recordedEndEffectors(toYaml(readParameters(XmlRpcValue(), "/station"), devices));
  ASSERT_EQ(read.list.size(), 1U);
  EXPECT_EQ(read.list[0].name, "bow");
  EXPECT_EQ(read.list[0].slices, (std::vector<int>{3, 4}));
  for (const char* const broken : {"", "device: 7", "device: 'devices: ['", "[", "{device: }"}) {
    EXPECT_THAT(recordedEndEffectors(broken).list, testing::IsEmpty()) << broken;
  }
}

TEST(ParametersTest, HaveAPrefixOfFrames) {
  for (const char* const prefix : {"left", "hall/left_2"}) {
    EXPECT_EQ(readParameters(with("tf_prefix", prefix), "/station").tf_prefix, prefix);
    EXPECT_EQ(readEarlyParameters(with("tf_prefix", prefix), "/station").tf_prefix, prefix);
  }
  for (const char* const prefix : {"left/", "/left", "a//b", "a b"}) {
    EXPECT_THAT(complaintOf([&] { readParameters(with("tf_prefix", prefix), "/station"); }),
                HasSubstr("/station/tf_prefix is "))
        << prefix;
  }
}

}  // namespace
}  // namespace ergotic::node
