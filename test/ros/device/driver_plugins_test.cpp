// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/driver_plugins.hpp"

#include <yaml-cpp/yaml.h>

#include <thread>

#include <rosbag/bag.h>

#include "bag/open_bag.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// A workspace with Ergotic and a package of somebody else, wherever the tests run.
class DriverPluginsTest : public ::testing::Test {
 protected:
  DriverPluginsTest() {
    test::findBuiltPackages();
    plugins_ = std::make_unique<DriverPlugins>();
  }

  std::string refusalOf(const std::string& driver, const std::string& settings) {
    return complaintOf([&] { plugins_->make(driver, YAML::Load(settings), "devices.yaml"); });
  }

  std::unique_ptr<DriverPlugins> plugins_;
};

TEST_F(DriverPluginsTest, LoadWhatSomebodyElseExports) {
  const auto driver =
      plugins_->make("third_party_device/still", YAML::Load("{height: 0.002}"), "devices.yaml");
  driver->open(1000.0);
  const std::array<double, 2> forces{};
  std::array<double, 2> positions{};
  EXPECT_EQ(driver->exchange(forces.data(), positions.data()), tgr::kExchangeOk);
  EXPECT_EQ(positions, (std::array<double, 2>{0.002, 0.002}));
  driver->close();
}

TEST_F(DriverPluginsTest, MakeTheDriversOfTheCoreWithoutAnyPlugin) {
  EXPECT_NE(plugins_->make("virtual", YAML::Load("{}"), "devices.yaml"), nullptr);
}

TEST_F(DriverPluginsTest, FindTheirOwnByTheShortName) {
  EXPECT_THAT(refusalOf("nowhere/comedi", "{}"), HasSubstr("ergotic/comedi"));
  EXPECT_THAT(refusalOf("comedi", "{}"), Not(HasSubstr("there is no driver")));
}

TEST_F(DriverPluginsTest, NameTheDriversThereAreWhenOneIsNot) {
  const std::string refusal = refusalOf("virtuel", "{}");
  EXPECT_THAT(refusal, HasSubstr("there is no driver 'virtuel', allowed: "));
  for (const char* name :
       {"virtual", "replay", "ergotic/comedi", "ergotic/jack", "third_party_device/still"}) {
    EXPECT_THAT(refusal, HasSubstr(name));
  }
}

TEST_F(DriverPluginsTest, SayWhyALibraryCannotBeLoaded) {
  EXPECT_THAT(refusalOf("third_party_device/missing", "{}"),
              HasSubstr("third_party_device_that_was_not_built"));
}

TEST_F(DriverPluginsTest, PassOnWhatADriverSaysOfItsSettings) {
  EXPECT_THAT(refusalOf("third_party_device/still", "{height: 1}"),
              HasSubstr("devices.yaml: error: height is 1"));
}

TEST_F(DriverPluginsTest, SayWhichBagCannotBeReplayed) {
  EXPECT_THAT(refusalOf("replay", "{bag: /nowhere/take.bag}"), HasSubstr("/nowhere/take.bag"));
}

/// The station lists its takes, each a bag, while it loads the driver of its device.
TEST_F(DriverPluginsTest, AreLoadedWhileAnotherThreadOpensBags) {
  constexpr int kTimes = 100;
  std::thread bags([] {
    for (int i = 0; i < kTimes; ++i) {
      EXPECT_THROW(bag::openToRead("/nowhere/take.bag"), rosbag::BagException);
    }
  });
  for (int i = 0; i < kTimes; ++i) {
    DriverPlugins plugins;
    EXPECT_NE(plugins.make("third_party_device/still", YAML::Load("{}"), "devices.yaml"), nullptr);
    EXPECT_THAT(complaintOf([&] {
                  plugins.make("third_party_device/missing", YAML::Load("{}"), "devices.yaml");
                }),
                HasSubstr("cannot be loaded"));
  }
  bags.join();
}

}  // namespace
}  // namespace ergotic::node
