// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/device.hpp"

#include <yaml-cpp/yaml.h>

#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"
#include "tgr/drivers/virtual/virtual_slice_fields.hpp"
#include "tgr/scripted_driver.hpp"

namespace ergotic::tgr {
namespace {

constexpr const char* kTwoDevices = R"(# two devices
devices:
  - driver: virtual
    settings:
      slices: 4
      mechanics: {mass: 0.4}
  - driver: lab/board
    settings: {ports: [1, 2], name: "a b"}
    calibration:
      - {metres_per_volt: 0.005, volts_per_newton: 0.05}
      - ~
)";

TEST(ReadDevicesTest, TakesDevicesWithTheirSettingsAndCalibrations) {
  const StationDevices devices = readDevices(kTwoDevices, "tgr.yaml");
  EXPECT_EQ(devices.file, "tgr.yaml");
  ASSERT_EQ(devices.devices.size(), 2U);
  EXPECT_EQ(devices.devices[0].driver, "virtual");
  EXPECT_EQ(devices.devices[0].place, "tgr.yaml");
  EXPECT_FALSE(devices.devices[0].calibration);
  EXPECT_EQ(devices.devices[1].driver, "lab/board");
  const YAML::Node& settings = *devices.devices[1].settings;
  EXPECT_EQ(settings["name"].Scalar(), "a b");
  EXPECT_EQ(settings["ports"].Mark().line, 7);
  EXPECT_EQ(settings["ports"].Mark().column, 22);
  ASSERT_TRUE(devices.devices[1].calibration);
  EXPECT_TRUE(devices.devices[1].calibration->slices[0].is_calibrated);
  EXPECT_FALSE(devices.devices[1].calibration->slices[1].is_calibrated);
  EXPECT_TRUE(devices.end_effectors.list.empty());
}

TEST(ReadDevicesTest, TakesEndEffectorsFromTheSameFile) {
  const StationDevices devices = readDevices(
      "devices: [{driver: virtual}]\n"
      "end_effectors:\n  thumb: {type: key, slices: [3], ports: [hammer]}\n",
      "tgr.yaml");
  EXPECT_EQ(devices.devices[0].settings, nullptr);
  ASSERT_EQ(devices.end_effectors.list.size(), 1U);
  EXPECT_EQ(devices.end_effectors.list[0].name, "thumb");
}

TEST(ReadDevicesTest, ReadsBackWhatIsWritten) {
  const StationDevices devices = readDevices(
      std::string(kTwoDevices) + "end_effectors: {k: {type: key, slices: [0], ports: [p]}}\n",
      "tgr.yaml");
  const std::string text = toYaml(devices);
  const StationDevices again = readDevices(text, "again.yaml");
  EXPECT_EQ(toYaml(again), text);
  ASSERT_EQ(again.devices.size(), 2U);
  EXPECT_EQ(again.devices[1].calibration->slices[0].metres_per_volt, 0.005);
  EXPECT_EQ(again.end_effectors.list.size(), 1U);
  EXPECT_THAT(text, HasSubstr("settings: {ports: [1, 2], name: a b}"));
}

TEST(ReadDevicesTest, SaysWhereATextIsWrong) {
  const auto complaint = [](const std::string& text) {
    return complaintOf([&] { readDevices(text, "tgr.yaml"); });
  };
  EXPECT_EQ(complaint(""), "tgr.yaml:1:1: error: missing key 'devices' of the file of devices");
  const std::string allowed =
      ", allowed: a list of 1 to 64 maps {driver: ..., settings: {...}, calibration: [...]}";
  EXPECT_EQ(complaint("devices: []"), "tgr.yaml:1:10: error: 'devices' is a list of 0" + allowed);
  EXPECT_EQ(complaint("devices: 3"), "tgr.yaml:1:10: error: 'devices' is a single value" + allowed);
  EXPECT_EQ(complaint("devices:\n"), "tgr.yaml:1:1: error: 'devices' is empty" + allowed);
  EXPECT_EQ(complaint("devices: [3]"),
            "tgr.yaml:1:11: error: a device is a single value, allowed: a map");
  EXPECT_EQ(complaint("devices:\n  - {settings: {}}"),
            "tgr.yaml:2:5: error: missing key 'driver' of a device");
  EXPECT_EQ(complaint("devices:\n  - driver: 'a b'"),
            "tgr.yaml:2:13: error: driver 'a b' is no name, allowed: letters, digits, '_', '-', "
            "'/'");
  EXPECT_EQ(complaint("devices:\n  - {driver: virtual, setting: {}}").substr(0, 49),
            "tgr.yaml:2:23: error: unknown key 'setting' of a ");
  EXPECT_EQ(complaint("devices:\n  - driver: x\n    calibration: [{max_volts: 0}]"),
            "tgr.yaml:3:31: error: 'max_volts' of calibration of slice 0 = 0 V is out of range, "
            "allowed: above 0...1000 V");
}

TEST(MakeDriversTest, SaysWhereSettingsAreWrongInTheWholeFile) {
  const auto complaint = [](const std::string& text) {
    const StationDevices devices = readDevices(text, "tgr.yaml");
    return complaintOf([&] { makeDrivers(devices, makeCoreDriver, false); });
  };
  EXPECT_EQ(complaint("devices:\n  - driver: virtual\n    settings:\n      mechanics:\n"
                      "        mass: 0\n"),
            "tgr.yaml:5:15: error: 'mass' of 'mechanics' of driver virtual = 0 kg is out of range, "
            "allowed: 0.001...100 kg");
  EXPECT_EQ(complaint("devices:\n  - driver: virtual\n    settings: 7\n").substr(0, 21),
            "tgr.yaml:3:15: error:");
  EXPECT_EQ(complaint("devices:\n  - driver: gremlin\n"),
            "tgr.yaml:2:13: error: device 0 (gremlin): no driver has the name 'gremlin', allowed: "
            "virtual, replay, and those of plugins where these are loaded");
  EXPECT_EQ(
      complaint("devices:\n  - driver: virtual\n    calibration: []\n"),
      "tgr.yaml:3:18: error: device 0 (virtual): a calibration of a device that speaks metres "
      "and newtons already");
  EXPECT_EQ(complaint("devices:\n  - {driver: virtual, settings: {slices: 40}}\n"
                      "  - {driver: virtual, settings: {slices: 25}}\n"),
            "tgr.yaml:2:3: error: 65 slices in all devices together, allowed: at most 64");
  EXPECT_EQ(
      complaint("devices:\n  - {driver: replay, settings: {file: /nowhere.csv}}\n"),
      "tgr.yaml:2:14: error: device 0 (replay): /nowhere.csv: cannot be read: No such file or "
      "directory");
}

TEST(MakeDriversTest, MakesOneDriverOfThem) {
  const test::ScratchFile positions("tick,x0,x1\n0,0.01,0.02\n1,0.03,0.04\n");
  const StationDevices devices = readDevices(
      "devices:\n  - driver: virtual\n    settings: {slices: 3}\n"
      "  - driver: replay\n    settings: {file: '" +
          positions.path() + "'}\n",
      "tgr.yaml");
  const DriverStack stack = makeDrivers(devices, makeCoreDriver, false);
  EXPECT_EQ(stack.faulty, nullptr);
  EXPECT_TRUE(stack.raw_parts.empty());
  ASSERT_EQ(stack.driver->slices(), 5);
  stack.driver->open(1000.0);
  const std::array<double, 5> forces{};
  std::array<double, 5> x{};
  stack.driver->exchange(forces.data(), x.data());
  EXPECT_EQ(x[3], 0.01);
  EXPECT_EQ(x[4], 0.02);
}

TEST(MakeDriversTest, PutsCalibrationsInFrontOfRawDevicesAndFaultsInFrontOfAll) {
  std::array<test::Script, 2> scripts;
  scripts[1].is_raw = true;
  const StationDevices devices = readDevices(
      "devices:\n  - driver: si\n  - driver: raw\n"
      "    calibration: [{metres_per_volt: 0.005, volts_per_newton: 0.05}]\n",
      "tgr.yaml");
  const DriverMaker make = [&](const std::string& name, const YAML::Node& settings,
                               const std::string& place) -> std::unique_ptr<Driver> {
    EXPECT_TRUE(settings.IsMap());
    EXPECT_EQ(settings.size(), 0U);
    EXPECT_EQ(place, "tgr.yaml");
    return std::make_unique<test::ScriptedDevice>(scripts[name == "raw" ? 1 : 0]);
  };
  const DriverStack stack = makeDrivers(devices, make, true);
  ASSERT_EQ(stack.raw_parts.size(), 1U);
  EXPECT_EQ(stack.raw_parts[0].device, 1);
  EXPECT_EQ(stack.raw_parts[0].first_slice, 2);
  EXPECT_EQ(stack.driver->uncalibrated(), 0b1000U);
  stack.raw_parts[0].calibrated->set(1, stack.raw_parts[0].calibrated->calibration().slices[0]);
  stack.driver->open(1000.0);
  scripts[0].positions = {0.01, 0.02};
  scripts[1].positions = {1.0, 2.0};
  const std::array<double, 4> forces{1.0, 2.0, 3.0, 4.0};
  std::array<double, 4> x{};
  stack.driver->exchange(forces.data(), x.data());
  EXPECT_EQ(stack.driver->uncalibrated(), 0U);
  EXPECT_EQ(x, (std::array<double, 4>{0.01, 0.02, 0.005, 0.01}));
  EXPECT_DOUBLE_EQ(scripts[1].forces[1], 0.2);
  ASSERT_NE(stack.faulty, nullptr);
  stack.faulty->inject({InjectedFault::kRail, 3, 1, 0.5});
  stack.driver->exchange(forces.data(), x.data());
  EXPECT_EQ(x[3], 0.5);
}

StationDevices installed(const std::string& name) {
  const std::string path = repository("config/" + name);
  return readDevices(textOf(path), path);
}

TEST(DeviceFilesTest, OfTheVirtualDeviceSaysAllItsDefaults) {
  const StationDevices devices = installed("virtual.yaml");
  ASSERT_EQ(devices.devices.size(), 1U);
  const YAML::Node& settings = *devices.devices[0].settings;
  const VirtualDriverConfig read = readVirtualSettings(settings, "virtual.yaml");
  const VirtualDriverConfig plain;
  for (const VirtualSliceField& field : kVirtualSliceFields) {
    EXPECT_EQ(read.slice.*field.member, plain.slice.*field.member) << field.key;
    EXPECT_TRUE(settings["mechanics"][field.key]) << field.key;
  }
  EXPECT_EQ(read.slices, plain.slices);
  EXPECT_EQ(read.seed, plain.seed);
  EXPECT_EQ(read.extra_delay_ticks, plain.extra_delay_ticks);
}

TEST(DeviceFilesTest, OfARawVirtualDeviceLeavesItsSlicesToBeCalibrated) {
  const DriverStack stack = makeDrivers(installed("virtual_raw.yaml"), makeCoreDriver, false);
  ASSERT_EQ(stack.raw_parts.size(), 1U);
  EXPECT_EQ(stack.driver->slices(), 3);
  EXPECT_EQ(stack.driver->uncalibrated(), 7U);
  EXPECT_EQ(stack.raw_parts[0].calibrated->calibration().slices[2].volts_per_newton, -0.05);
}

/// A slice at a stop is no fault, a sensor at its rail is one.
TEST(DeviceFilesTest, OfVoltsTellAnEndStopFromARail) {
  const VirtualSliceConfig slice;
  for (const char* name : {"comedi.yaml", "jack.yaml"}) {
    const StationDevices devices = installed(name);
    for (const SliceCalibration& c : devices.devices.at(0).calibration->slices) {
      const double stop = slice.stop / c.metres_per_volt;
      EXPECT_GT(c.rest_volts - 1.2 * stop, c.low_volts) << name;
      EXPECT_LT(c.rest_volts + 1.2 * stop, c.high_volts) << name;
      EXPECT_GT(c.low_volts, -10.0) << name << ": a rail of an input that reaches +-10 V";
      EXPECT_LT(c.high_volts, 10.0) << name;
    }
  }
}

TEST(MakeCoreDriverTest, FindsTheFileOfAReplayBesideTheFileOfTheDevices) {
  EXPECT_EQ(complaintOf(
                [] { makeCoreDriver("replay", YAML::Load("{file: x.csv}"), "/nowhere/tgr.yaml"); }),
            "/nowhere/x.csv: cannot be read: No such file or directory");
  EXPECT_EQ(complaintOf([] { makeCoreDriver("replay", YAML::Load("{}"), "tgr.yaml"); }),
            "tgr.yaml:1:1: error: missing key 'file' of driver replay");
}

}  // namespace
}  // namespace ergotic::tgr
