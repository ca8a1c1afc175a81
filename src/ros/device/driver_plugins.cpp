// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/driver_plugins.hpp"

#include <yaml-cpp/yaml.h>

#include <optional>

#include <pluginlib/class_loader.hpp>

#include "ergotic/bag/positions.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/tgr/replay_driver.hpp"

namespace ergotic::node {
namespace {

const char kPackage[] = "ergotic";
const char kBaseClass[] = "ergotic::tgr::DriverFactory";

std::string pluginNamed(const std::string& driver) {
  return driver.find('/') == std::string::npos ? std::string(kPackage) + "/" + driver : driver;
}

struct BagOfStation {
  std::string bag;
  std::string station;
};

/// The bag that a `replay` shall play; nothing if it plays something else.
std::optional<BagOfStation> bagOf(const std::string& driver, const YAML::Node& settings) {
  // Of anything else the core's replay driver says what is wrong, and where.
  const auto is_text = [&](const char* key) { return settings[key] && settings[key].IsScalar(); };
  if (driver != "replay" || !settings.IsMap() || !is_text("bag")) {
    return std::nullopt;
  }
  if (settings.size() == 1) {
    return BagOfStation{settings["bag"].Scalar(), ""};
  }
  return settings.size() == 2 && is_text("station")
             ? std::optional(BagOfStation{settings["bag"].Scalar(), settings["station"].Scalar()})
             : std::nullopt;
}

}  // namespace

class DriverPlugins::Loader : public pluginlib::ClassLoader<tgr::DriverFactory> {
 public:
  Loader() : ClassLoader(kPackage, kBaseClass) {}

  std::string existing() {
    std::string names = "virtual, replay";
    for (const std::string& name : getDeclaredClasses()) {
      names += ", " + name;
    }
    return names;
  }
};

DriverPlugins::DriverPlugins() {
  try {
    loader_ = std::make_unique<Loader>();
  } catch (const pluginlib::PluginlibException& failure) {
    throw Exception(std::string("no drivers can be loaded: ") + failure.what());
  }
}

DriverPlugins::~DriverPlugins() = default;

std::unique_ptr<tgr::Driver> DriverPlugins::make(const std::string& driver,
                                                 const YAML::Node& settings,
                                                 const std::string& place) {
  if (const auto bag = bagOf(driver, settings)) {
    return tgr::makeReplayDriver(bag::readPositions(bag->bag, bag->station));
  }
  if (driver == "virtual" || driver == "replay") {
    return tgr::makeCoreDriver(driver, settings, place);
  }
  const std::string plugin = pluginNamed(driver);
  if (!loader_->isClassAvailable(plugin)) {
    throw Exception("there is no driver '" + driver + "', allowed: " + loader_->existing());
  }
  try {
    return loader_->createUniqueInstance(plugin)->make(settings, place);
  } catch (const pluginlib::PluginlibException& failure) {
    throw DeviceError("driver '" + driver + "' cannot be loaded: " + failure.what());
  }
}

}  // namespace ergotic::node
