// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/device.hpp"

#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "ergotic/tgr/replay_driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "scene/names.hpp"
#include "scene/text/source_text.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

std::unique_ptr<Driver> makeReplay(const YAML::Node& node, const std::string& place) {
  const Settings settings(node, place, "driver replay");
  settings.top().allow({"file"});
  return makeReplayDriver(readPositionsCsv(scene::besideFile(settings.top().word("file"), place)));
}

/// Runs an action; an error without a place of its own is reported with this one.
template <class Action>
auto at(const std::string& file,
        scene::Place place,
        const std::string& title,
        const Action& action) {
  try {
    return action();
  } catch (const TextError&) {
    throw;
  } catch (const DeviceError&) {
    throw;
  } catch (const Exception& error) {
    throw TextError(file, place.line, place.column, title + error.what());
  }
}

}  // namespace

std::unique_ptr<Driver> makeCoreDriver(const std::string& driver,
                                       const YAML::Node& settings,
                                       const std::string& place) {
  if (driver == "virtual") {
    return makeVirtualDriver(readVirtualSettings(settings, place));
  }
  if (driver == "replay") {
    return makeReplay(settings, place);
  }
  throw Exception("no driver has the name " + scene::quoted(driver) +
                  ", allowed: virtual, replay, and those of plugins where these are loaded");
}

DriverStack makeDrivers(const StationDevices& devices,
                        const DriverMaker& make,
                        bool allow_fault_injection) {
  DriverStack stack;
  std::vector<std::unique_ptr<Driver>> drivers;
  const YAML::Node none(YAML::NodeType::Map);
  int first_slice = 0;
  for (std::size_t i = 0; i < devices.devices.size(); ++i) {
    const DeviceConfig& config = devices.devices[i];
    const std::string title = "device " + std::to_string(i) + " (" + config.driver + "): ";
    std::unique_ptr<Driver> driver = at(devices.file, config.driver_at, title, [&] {
      return make(config.driver, config.settings ? *config.settings : none, config.place);
    });
    if (driver->isRaw() || config.calibration) {
      auto calibrated = at(devices.file, config.calibration_at, title, [&] {
        return makeCalibratedDriver(std::move(driver), config.calibration.value_or(Calibration{}));
      });
      stack.raw_parts.push_back({static_cast<int>(i), first_slice, calibrated.get()});
      driver = std::move(calibrated);
    }
    first_slice += driver->slices();
    drivers.push_back(std::move(driver));
  }
  stack.driver = drivers.size() == 1 ? std::move(drivers.front())
                                     : at(devices.file, devices.devices_at, "",
                                          [&] { return combine(std::move(drivers)); });
  if (allow_fault_injection) {
    auto faulty = makeFaultyDriver(std::move(stack.driver));
    stack.faulty = faulty.get();
    stack.driver = std::move(faulty);
  }
  return stack;
}

}  // namespace ergotic::tgr
