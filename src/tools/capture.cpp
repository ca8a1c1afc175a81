// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/capture.hpp"

#include <signal.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/sound_level.hpp"

namespace {

std::atomic<bool> stop{false};

void onSignal(int) {
  stop = true;
}

void stopOnSignals() {
  struct sigaction action {};
  action.sa_handler = onSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

using ergotic::tools::Json;

void declare(CLI::App& app, ergotic::audio::CaptureConfig& config, std::string& format) {
  app.add_option("--out,out", config.path, "WAV file")->required();
  app.add_option("--out-format", format, "format of the samples")
      ->check(CLI::IsMember({"float", "double", "24"}))
      ->capture_default_str();
  app.add_option("--port", config.ports, "port to record, client:name; repeatable");
  app.add_option("--match", config.match, "record all ports matching this regular expression");
  app.add_option("--seconds", config.seconds, "length; without: until SIGINT or SIGTERM")
      ->check(CLI::PositiveNumber)
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--wait", config.wait_s, "seconds to wait for the ports to appear")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--server", config.server, "name of the JACK server");
  ergotic::tools::checkNumbers(app);
}

/// Adds loudness and true peak of the file to the report, and prints them on stderr.
void addLevel(const std::string& path, Json& report) {
  const ergotic::tools::SoundLevel level = ergotic::tools::levelOf(path);
  report["loudness_lufs"] = level.loudness ? Json(*level.loudness) : Json();
  report["true_peak_dbtp"] = level.true_peak_db;
  std::cerr << "capture: " << path << ": " << describe(level) << std::endl;
}

/// Records until the time is over or a signal comes, and prints what was recorded as a line of
/// JSON. \return the exit code of the program
int record(const ergotic::audio::CaptureConfig& config) {
  stopOnSignals();
  const auto report =
      ergotic::audio::capture(config, stop, [](const std::vector<std::string>& channels) {
        std::cerr << "capture: recording";
        for (const std::string& channel : channels) {
          std::cerr << " " << channel;
        }
        std::cerr << std::endl;
      });
  Json line{{"frames", report.frames},
            {"first_jack_frame", report.first_jack_frame},
            {"sample_rate", static_cast<std::int64_t>(report.sample_rate_hz)},
            {"dropped", report.dropped},
            {"lost", report.lost},
            {"xruns", report.xruns}};
  addLevel(config.path, line);
  ergotic::tools::printJsonLine(line, std::cout);
  std::cout.flush();
  if (!report.message.empty()) {
    std::cerr << "capture: " << report.message << std::endl;
  }
  return report.dropped == 0 && report.message.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ergotic::audio::CaptureConfig config;
    CLI::App app("Records JACK ports to a WAV file, sample by sample.");
    std::string format = "float";
    declare(app, config, format);
    CLI11_PARSE(app, argc, argv);
    config.format = ergotic::audio::wavFormatOf(format);
    return record(config);
  } catch (const std::exception& error) {
    std::cerr << "capture: error: " << error.what() << std::endl;
    return 1;
  }
}
