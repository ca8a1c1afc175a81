// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/rt/clock.hpp"
#include "tgr/drivers/jack/jack_device.hpp"
#include "tgr/drivers/jack/step_meter.hpp"
#include "tgr/require.hpp"
#include "tools/lib/device_process.hpp"
#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"

namespace ergotic {
namespace {

constexpr std::int64_t kLookNs = 100'000'000;

struct Options {
  tgr::JackDeviceConfig device;
  std::string client = "jack_tgr";
  std::string server;
  std::string log;
  double watchdog_ms = 0.0;
  bool undeclared = false;
  double seconds = 0.0;
  int measure = 0;
  std::vector<std::string> cable;
  int slice = 0;
  tgr::StepMeterConfig meter;
};

void declare(CLI::App& app, Options& options) {
  tgr::JackDeviceConfig& device = options.device;
  app.add_option("--client", options.client, "name of the JACK client")->capture_default_str();
  app.add_option("--server", options.server, "of JACK; empty: the default one");
  app.add_option("--slices", device.bank.slices, "1...64")->capture_default_str();
  app.add_option("--gesture", device.bank.gesture_file,
                 "CSV time_s,slice,target_m or tick,x0,...: where the virtual hands want to be");
  app.add_option("--gesture-rate", device.bank.gesture_rate,
                 "ticks per second of a gesture tick,x0,...");
  app.add_option("--metres-per-unit", device.metres_per_unit, "position at full scale")
      ->capture_default_str();
  app.add_option("--newtons-per-unit", device.newtons_per_unit, "force at full scale")
      ->capture_default_str();
  app.add_option("--latency-frames", device.latency_frames, "of its converters")
      ->capture_default_str();
  app.add_flag("--undeclared", options.undeclared, "JACK is not told of that latency");
  app.add_option("--watchdog-ms", options.watchdog_ms,
                 "no force when the heartbeat was missing for so long; 0: no watchdog, as behind "
                 "any plain sound card")
      ->capture_default_str();
  app.add_option("--log", options.log, "CSV time_ns,slice,force_n: every change of force");
  app.add_option("--seconds", options.seconds, "end after so long; 0: at SIGINT or SIGTERM")
      ->capture_default_str();
  app.add_option("--measure", options.measure,
                 "do not move; step a position so often and count the frames to its force");
  app.add_option("--cable", options.cable,
                 "with --measure: no device; from this port through a cable back to that one")
      ->expected(2);
  app.add_option("--slice", options.slice, "of the steps, from 0 on")->capture_default_str();
  app.add_option("--step", options.meter.step, "of a position, of full scale")
      ->capture_default_str();
  app.add_option("--threshold", options.meter.threshold, "what counts as an answer, of full scale")
      ->capture_default_str();
}

/// Prints what JACK has to say whenever that changes.
class Teller {
 public:
  explicit Teller(const audio::JackHost& host) : host_(host) {}
  void look() {
    const std::string message = host_.status().message;
    if (message != last_ && !message.empty()) {
      std::cerr << "jack_tgr: " << message << '\n';
    }
    last_ = message;
  }

 private:
  const audio::JackHost& host_;
  std::string last_;
};

int play(const Options& options, const tools::Signals& signals) {
  tools::ForceLog log(options.log);
  tgr::JackDevice device(options.device);
  tools::warnOfValues("jack_tgr", options.device.bank.gesture_file);
  {
    audio::JackHost host(device.jackConfig(options.client, options.server), device);
    Teller teller(host);
    std::int64_t look_due_ns = 0;
    signals.attend(options.seconds, [&] {
      // A station that recovers waits for this device: more often than the host looks by itself.
      if (const std::int64_t now_ns = rt::monotonicNs(); now_ns >= look_due_ns) {
        look_due_ns = now_ns + kLookNs;
        host.look();
      }
      teller.look();
      log.drain(device);
      return true;
    });
  }
  log.finish(device);
  return EXIT_SUCCESS;
}

audio::JackConfig cableConfig(const Options& options) {
  audio::JackConfig config;
  config.name = options.client;
  config.server = options.server;
  config.inputs = 1;
  config.outputs = 1;
  config.output_peers = {options.cable[0]};
  config.input_peers = {options.cable[1]};
  return config;
}

/// A line of JSON. \return whether the round trip is known
bool report(const tgr::StepSummary& summary, bool cable, std::int64_t declared) {
  const bool known = summary.answered > 0;
  using tools::Json;
  Json line = {{"steps", summary.answered + summary.unanswered + summary.disturbed},
               {"answered", summary.answered},
               {"disturbed", summary.disturbed},
               {"fewest_frames", summary.fewest_frames},
               {"most_frames", summary.most_frames}};
  if (known) {
    // The tick that sees the whole step answers as many frames later as a tick has.
    const std::int64_t tick = summary.most_frames - summary.fewest_frames + 1;
    line["round_trip_frames"] = summary.most_frames - (cable ? 0 : tick);
    if (!cable) {
      line["tick_frames"] = tick;
    }
  }
  line["declared_frames"] = declared;
  tools::printJsonLine(line, std::cout);
  return known;
}

int measure(const Options& options, const tools::Signals& signals) {
  tgr::requireWithin("slice", options.slice, 0, options.device.bank.slices - 1, "");
  const bool cable = !options.cable.empty();
  const tgr::JackDevice device(options.device);
  tgr::StepMeterConfig config = options.meter;
  config.channel = cable ? 0 : options.slice;
  config.latency_frames = cable ? 0 : options.device.latency_frames;
  tgr::StepMeter meter(config);
  const audio::JackHost host(
      cable ? cableConfig(options) : device.jackConfig(options.client, options.server), meter);
  Teller teller(host);
  std::vector<tgr::StepAnswer> answers;
  signals.attend(options.seconds, [&] {
    teller.look();
    tgr::StepAnswer answer;
    while (meter.poll(answer)) {
      answers.push_back(answer);
    }
    return static_cast<int>(answers.size()) < options.measure;
  });
  const audio::JackStatus status = host.status();
  const std::int64_t declared = cable ? status.input_latency_frames + status.output_latency_frames
                                      : device.declaredFrames(status.period_frames);
  return report(tgr::summaryOf(answers), cable, declared) ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace ergotic

int main(int argc, char** argv) {
  try {
    CLI::App app(
        "A virtual TGR behind a sound card, as a JACK client; `driver: jack` is wired to its "
        "ports.\n"
        "Behind a real card there is no watchdog unless the amplifier has one for the heartbeat.");
    ergotic::Options options;
    ergotic::declare(app, options);
    ergotic::tools::checkNumbers(app);
    CLI11_PARSE(app, argc, argv);
    constexpr double kSPerMs = 1e-3;
    options.device.watchdog_s = options.watchdog_ms * kSPerMs;
    options.device.declares_latency = !options.undeclared;
    const ergotic::tools::Signals signals;
    const bool measures = options.measure > 0 || !options.cable.empty();
    return measures ? ergotic::measure(options, signals) : ergotic::play(options, signals);
  } catch (const std::exception& error) {
    std::cerr << "jack_tgr: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
