// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/tgr/device.hpp"
#include "files/read_file.hpp"
#include "scene/limits.hpp"
#include "tgr/drivers/virtual/virtual_device.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"
#include "tools/lib/device_process.hpp"
#include "tools/lib/options.hpp"

namespace ergotic {
namespace {

struct Options {
  tgr::VirtualDeviceConfig device;
  std::string file;
  std::optional<int> slices;
  std::optional<std::string> gesture;
  std::optional<double> gesture_rate;
  std::string log;
  double watchdog_ms = 10.0;
  double seconds = 0.0;
  int priority = 0;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("--shm", options.device.shared_memory, "name of the shared memory")->required();
  app.add_option("--device", options.file,
                 "YAML file of devices: the settings of the first whose driver is `virtual`");
  app.add_option("--slices", options.slices, "1...64, in place of the file's; without one: 12");
  app.add_option("--gesture", options.gesture,
                 "CSV time_s,slice,target_m or tick,x0,...: where the virtual hands want to be");
  app.add_option("--gesture-rate", options.gesture_rate, "Hz, of the ticks of a CSV tick,x0,...");
  app.add_option("--rate", options.device.rate_hz, "steps of the mechanics, Hz")
      ->capture_default_str();
  app.add_option("--watchdog-ms", options.watchdog_ms,
                 "zero force when the driver was not heard of for so long")
      ->capture_default_str();
  app.add_option("--log", options.log, "CSV time_ns,slice,force_n: every change of force");
  app.add_option("--seconds", options.seconds, "end after so long; 0: at SIGINT or SIGTERM")
      ->capture_default_str();
  app.add_option("--priority", options.priority, "SCHED_FIFO priority, 1...99; 0: none")
      ->capture_default_str();
}

/// Reads the first virtual device in a file.
tgr::VirtualDriverConfig readDevice(const std::string& path) {
  const tgr::StationDevices devices =
      tgr::readDevices(files::readFile(path, scene::kMaxTextBytes), path);
  const auto found =
      std::find_if(devices.devices.begin(), devices.devices.end(),
                   [](const tgr::DeviceConfig& device) { return device.driver == "virtual"; });
  if (found == devices.devices.end()) {
    throw Exception(path + ": no device of it has the driver virtual");
  }
  return found->settings ? tgr::readVirtualSettings(*found->settings, found->place)
                         : tgr::VirtualDriverConfig{};
}

/// The device of the file, if there is one, changed by what the command line says.
tgr::VirtualDeviceConfig deviceOf(const Options& options) {
  tgr::VirtualDeviceConfig device = options.device;
  if (!options.file.empty()) {
    device.bank = readDevice(options.file);
  }
  device.bank.slices = options.slices.value_or(device.bank.slices);
  device.bank.gesture_file = options.gesture.value_or(device.bank.gesture_file);
  device.bank.gesture_rate = options.gesture_rate.value_or(device.bank.gesture_rate);
  constexpr double kSPerMs = 1e-3;
  device.watchdog_s = options.watchdog_ms * kSPerMs;
  return device;
}

int run(const Options& options) {
  const tools::Signals signals;
  tools::ForceLog log(options.log);
  const tgr::VirtualDeviceConfig config = deviceOf(options);
  tgr::VirtualDevice device(config);
  tools::warnOfValues("virtual_tgr", config.bank.gesture_file);
  std::atomic<bool> stop{false};
  std::thread mechanics([&] {
    if (options.priority > 0) {
      if (const rt::Outcome outcome = rt::makeRealtime(options.priority); !outcome.ok) {
        std::cerr << "virtual_tgr: warning: " << outcome.message << '\n';
      }
    }
    device.run(stop);
  });
  signals.attend(options.seconds, [&] {
    log.drain(device);
    return true;
  });
  stop = true;
  mechanics.join();
  log.finish(device);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace ergotic

int main(int argc, char** argv) {
  try {
    CLI::App app("A virtual TGR as a process of its own; `driver: virtual` finds it by its name.");
    ergotic::Options options;
    ergotic::declare(app, options);
    ergotic::tools::checkNumbers(app);
    CLI11_PARSE(app, argc, argv);
    return ergotic::run(options);
  } catch (const std::exception& error) {
    std::cerr << "virtual_tgr: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
