// SPDX-License-Identifier: BSD-3-Clause
#include <signal.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "tgr/drivers/virtual/virtual_device.hpp"

namespace ergotic {
namespace {

struct Options {
  tgr::VirtualDeviceConfig device;
  std::string log;
  double watchdog_ms = 10.0;
  double seconds = 0.0;
  int priority = 0;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("--shm", options.device.shared_memory, "name of the shared memory")->required();
  app.add_option("--slices", options.device.bank.slices, "1...64")->capture_default_str();
  app.add_option("--gesture", options.device.bank.gesture_file,
                 "CSV time_s,slice,target_m: where the virtual hands want to be");
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

/// SIGINT and SIGTERM, blocked in this thread and in those that it starts.
sigset_t blockSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

/// Drains the records until the time is over or a signal comes.
void attend(tgr::VirtualDevice& device,
            std::ostream& log,
            double seconds,
            const sigset_t& signals) {
  constexpr double kNsPerS = 1e9;
  constexpr timespec kPause{0, 10'000'000};
  const std::int64_t start_ns = rt::monotonicNs();
  int signal = -1;
  bool over = false;
  while (signal < 0 && !over) {
    signal = sigtimedwait(&signals, nullptr, &kPause);
    tgr::drainForces(device, log);
    log.flush();
    over = seconds > 0.0 && static_cast<double>(rt::monotonicNs() - start_ns) > seconds * kNsPerS;
  }
}

int run(const Options& options) {
  const sigset_t signals = blockSignals();
  std::ofstream log;
  if (!options.log.empty()) {
    log.open(options.log);
    log << "time_ns,slice,force_n\n" << std::flush;
    if (!log) {
      throw Exception(options.log + ": cannot be written");
    }
  }
  tgr::VirtualDevice device(options.device);
  std::atomic<bool> stop{false};
  std::thread mechanics([&] {
    if (options.priority > 0) {
      if (const rt::Outcome outcome = rt::makeRealtime(options.priority); !outcome.ok) {
        std::cerr << "virtual_tgr: warning: " << outcome.message << '\n';
      }
    }
    device.run(stop);
  });
  attend(device, log, options.seconds, signals);
  stop = true;
  mechanics.join();
  tgr::drainForces(device, log);
  log.flush();
  if (!options.log.empty() && (!log || device.droppedRecords() > 0)) {
    throw Exception(options.log + ": incomplete, " + std::to_string(device.droppedRecords()) +
                    " records dropped");
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace ergotic

int main(int argc, char** argv) {
  CLI::App app("A virtual TGR as a process of its own; `driver: virtual` finds it by its name.");
  ergotic::Options options;
  ergotic::declare(app, options);
  CLI11_PARSE(app, argc, argv);
  constexpr double kSPerMs = 1e-3;
  options.device.watchdog_s = options.watchdog_ms * kSPerMs;
  try {
    return ergotic::run(options);
  } catch (const ergotic::Exception& error) {
    std::cerr << "virtual_tgr: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
