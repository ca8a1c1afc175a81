// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"
#include "lab/lib/bench_report.hpp"

namespace ergotic::tools {
namespace {

constexpr int kLargeModules = 200'000;
constexpr double kMinSeconds = 0.01;
constexpr double kMaxSeconds = 3600.0;
constexpr int kMaxRuns = 1000;

struct Case {
  const BenchKind* kind;
  int modules;
};

std::vector<Case> casesOf(const BenchOptions& options) {
  std::vector<const BenchKind*> kinds;
  for (const std::string& name : options.scenes) {
    kinds.push_back(&benchKindNamed(name));
  }
  if (kinds.empty()) {
    for (const BenchKind& kind : benchKinds()) {
      kinds.push_back(&kind);
    }
  }
  std::vector<Case> cases;
  for (const BenchKind* kind : kinds) {
    for (const int modules :
         options.sizes.empty() ? std::vector<int>{kind->modules} : options.sizes) {
      cases.push_back({kind, modules});
    }
  }
  if (options.sizes.empty() && options.scenes.empty()) {
    for (const BenchKind* kind : kinds) {
      if (kind->is_plain && kind->modules < kLargeModules) {
        cases.push_back({kind, kLargeModules});
      }
    }
  }
  return cases;
}

BenchSettings settingsOf(const BenchOptions& options) {
  BenchSettings settings;
  settings.compile = chosenOptions(options.compile, physics::Precision::kFloat);
  settings.compile.metered = options.metered;
  settings.runs = options.runs;
  settings.seconds = options.seconds;
  return settings;
}

void printList() {
  for (const BenchKind& kind : benchKinds()) {
    std::printf("%-14s %7d modules: %s\n", kind.name, kind.modules, kind.what);
  }
}

void writeJson(const std::string& path, const Json& report) {
  std::ofstream file(path);
  printJson(report, file);
  file << '\n';
  file.flush();
  if (!file) {
    throw Exception(path + ": cannot be written");
  }
}

}  // namespace

void addOptions(CLI::App& app, BenchOptions& options) {
  app.add_option("--scene", options.scenes, "scenes by name, see --list (default: all)");
  app.add_option("--size", options.sizes,
                 "modules, that is masses and links (default: what each scene is made for; with "
                 "all scenes also 200000)")
      ->check(CLI::Range(kMinBenchModules, kMaxBenchModules));
  addOptions(app, options.compile);
  app.add_flag("--metered,!--no-meter", options.metered, "keep the energy accounts (default)");
  app.add_option("--runs", options.runs, "whose median counts")
      ->capture_default_str()
      ->check(CLI::Range(1, kMaxRuns));
  app.add_option("--seconds", options.seconds, "that all runs of a scene take together")
      ->capture_default_str()
      ->check(CLI::Range(kMinSeconds, kMaxSeconds));
  app.add_option("--json", options.json, "file for everything that is known");
  app.add_flag("--list", options.list, "say which scenes there are");
}

int bench(const BenchOptions& options) {
  if (options.list) {
    printList();
    return kSuccess;
  }
  const std::vector<Case> cases = casesOf(options);
  const BenchSettings settings = settingsOf(options);
  const MachineLimits limits = probeMachine(settings.compile.isa, settings.compile.precision);
  printHead(settings, limits);
  std::vector<BenchResult> results;
  for (const Case& item : cases) {
    results.push_back(measure(*item.kind, item.modules, settings));
    printRow(results.back(), limits);
  }
  if (!options.json.empty()) {
    writeJson(options.json, reportOf(settings, limits, results));
  }
  return kSuccess;
}

}  // namespace ergotic::tools
