// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/latency.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"
#include "ergotic/station/timer_source.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "lab/lib/bench_scenes.hpp"
#include "tools/lib/machine.hpp"

namespace ergotic::tools {
namespace {

constexpr int kSlices = 12;
constexpr const char* kScene = "station7k";  // of bench, at another size

/// A plate comes in whole rows and columns, so the one nearest to a number may have fewer.
scene::Scene plateOfAtLeast(int modules) {
  for (int asked = modules;; asked += 1 + asked / 100) {
    scene::Scene scene = benchKindNamed(kScene).make(asked);
    if (modulesOf(scene) >= static_cast<std::size_t>(modules)) {
      return scene;
    }
  }
}

scene::Scene latencyScene(const LatencyOptions& options) {
  if (options.scene.empty()) {
    return plateOfAtLeast(options.modules);
  }
  SceneOptions read;
  read.scene = options.scene;
  return readScene(read);
}

std::unique_ptr<station::Performer> performerOf(const LatencyOptions& options) {
  scene::Scene scene = latencyScene(options);
  const physics::Rates rates =
      physics::chooseRates(scene, options.rate_hz, options.rate_hz / options.ratio);
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  policy.slices = kSlices;
  return station::makePerformer(std::move(scene), rates,
                                chosenOptions(options.compile, physics::Precision::kFloat), policy);
}

/// A station that plays, and what an operator does meanwhile.
class LiveStation {
 public:
  explicit LiveStation(std::unique_ptr<station::Performer> performer)
      : modules_(modulesOf(performer->instrument->scene())),
        config_(configOf(*performer)),
        station_(config_, makeDriver(), std::move(performer)) {
    station_.setMeter(&meter_);
  }

  /// \return what the system refused
  std::vector<std::string> play(const LatencyOptions& options) {
    station::TimerSource source(station_, nullptr);
    source.start({options.priority, true, options.cpu});
    station_.submit({station::Command::Type::kEngage});
    constexpr auto kPeriod = std::chrono::milliseconds(10);
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
    for (int n = 0; std::chrono::steady_clock::now() < end; ++n) {
      moveHands(n);
      attend();
      std::this_thread::sleep_for(kPeriod);
    }
    source.stop();
    attend();
    return source.warnings();
  }

  const physics::Rates& rates() const { return config_.rates; }
  const station::TickMeter& meter() const { return meter_; }
  const station::Snapshot& last() const { return last_; }
  std::size_t modules() const { return modules_; }

 private:
  static station::StationConfig configOf(const station::Performer& performer) {
    station::StationConfig config;
    config.rates = performer.instrument->rates();
    return config;
  }
  static std::unique_ptr<tgr::Driver> makeDriver() {
    tgr::VirtualDriverConfig config;
    config.slices = kSlices;
    return tgr::makeVirtualDriver(config);
  }

  /// Every hand goes up and down by 5 mm, each at its own speed.
  void moveHands(int step) {
    for (int slice = 0; slice < kSlices; ++slice) {
      const double angle = 0.01 * step * (1.0 + 0.3 * slice);
      station_.driver().setTarget(slice, 0.005 * std::sin(angle));
    }
  }

  /// Takes what the station tells, as the node does.
  void attend() {
    station::Event event;
    while (station_.poll(event)) {
    }
    while (station_.pollGestures(gestures_.data(), gestures_.size()) > 0) {
    }
    if (const station::Snapshot* snapshot = station_.snapshot()) {
      last_ = *snapshot;
    }
  }

  std::size_t modules_;
  station::StationConfig config_;
  station::TickMeter meter_;
  station::Station station_;
  station::Snapshot last_;
  std::array<station::GestureTick, 256> gestures_{};
};

Json settingsReport(const LatencyOptions& options,
                    const LiveStation& live,
                    const std::vector<std::string>& warnings) {
  const physics::Rates& rates = live.rates();
  return {{"scene", options.scene.empty() ? kScene : options.scene},
          {"modules", live.modules()},
          {"slices", kSlices},
          {"rate_hz", rates.audio_hz},
          {"frames_per_tick", rates.ratio},
          {"ticks_per_s", rates.gesturalHz()},
          {"period_us", 1e6 / rates.gesturalHz()},
          {"seconds", options.seconds},
          {"priority", options.priority},
          {"cpu", options.cpu},
          {"instrument", toString(chosenOptions(options.compile, physics::Precision::kFloat))},
          {"refused", warnings}};
}

Json countersReport(const station::Snapshot& last) {
  const station::Counters& c = last.counters;
  return {{"ticks", c.ticks},
          {"late_wake_up", c.late_wake_up},
          {"late_device", c.late_device},
          {"late_compute", c.late_compute},
          {"stalls", c.stalls},
          {"caught_up", c.catch_up_ticks},
          {"lost", c.lost_ticks},
          {"peak_force_n", c.peak_force_n},
          {"fault", tgr::toString(last.fault)}};
}

Json reportOf(const LatencyOptions& options,
              const LiveStation& live,
              const std::vector<std::string>& warnings,
              bool bins) {
  const double period_us = 1e6 / live.rates().gesturalHz();
  const station::TickMeter& meter = live.meter();
  return {{"machine", Json{{"processor", processorName()},
                           {"cores", std::thread::hardware_concurrency()},
                           {"kernel", kernelName()}}},
          {"settings", settingsReport(options, live, warnings)},
          {"ticks", countersReport(live.last())},
          {"wake_up", histogramReport(meter.wake_up, period_us, bins)},
          {"exchange", histogramReport(meter.exchange, period_us, bins)},
          {"compute", histogramReport(meter.compute, period_us, bins)},
          {"tick", histogramReport(meter.whole, period_us, bins)}};
}

}  // namespace

Json histogramReport(const station::TickHistogram& histogram, double period_us, bool bins) {
  const std::array<std::pair<const char*, double>, 4> kQuantiles{
      {{"p50", 0.5}, {"p99", 0.99}, {"p99_99", 0.9999}, {"max", 1.0}}};
  Json us = Json::object();
  Json share = Json::object();
  for (const auto& [name, part] : kQuantiles) {
    const double value = 1e-3 * static_cast<double>(histogram.quantileNs(part));
    us[name] = value;
    share[name] = value / period_us;
  }
  Json report = {
      {"count", histogram.count()}, {"us", std::move(us)}, {"share_of_period", std::move(share)}};
  if (bins) {
    Json up_to = Json::array();
    Json counts = Json::array();
    for (const station::TickHistogram::Bin& bin : histogram.bins()) {
      up_to.push_back(1e-3 * static_cast<double>(bin.high_ns + 1));
      counts.push_back(bin.count);
    }
    report["up_to_us"] = std::move(up_to);
    report["counts"] = std::move(counts);
  }
  return report;
}

void addOptions(CLI::App& app, LatencyOptions& options) {
  constexpr double kMaxSeconds = 86400.0;
  app.add_option("scene", options.scene,
                 "path of a scene (default: a plate that 12 slices play at 6 places)");
  app.add_option("--modules", options.modules, "masses and links of that plate, at least")
      ->capture_default_str()
      ->check(CLI::Range(kMinBenchModules, kMaxBenchModules));
  app.add_option("--rate", options.rate_hz, "audio rate, Hz")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--ratio", options.ratio, "audio frames per tick")
      ->capture_default_str()
      ->check(CLI::Range(1, physics::kMaxRatio));
  addOptions(app, options.compile);
  app.add_option("--seconds", options.seconds, "how long to play")
      ->capture_default_str()
      ->check(CLI::Range(0.1, kMaxSeconds));
  app.add_option("--priority", options.priority, "SCHED_FIFO priority; 0: an ordinary thread")
      ->capture_default_str()
      ->check(CLI::Range(0, 99));
  app.add_option("--cpu", options.cpu, "to run on; -1: any")->capture_default_str();
  app.add_option("--json", options.json, "file for everything, histograms included");
}

int latency(const LatencyOptions& options) {
  LiveStation live(performerOf(options));
  const std::vector<std::string> warnings = live.play(options);
  for (const std::string& warning : warnings) {
    std::cerr << "warning: " << warning << '\n';
  }
  printText(reportOf(options, live, warnings, false), std::cout);
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    printJson(reportOf(options, live, warnings, true), file);
    file << std::endl;
    if (!file) {
      throw Exception(options.json + ": cannot be written");
    }
  }
  return live.last().state == station::ForceState::kFault ? kFailure : kSuccess;
}

}  // namespace ergotic::tools
