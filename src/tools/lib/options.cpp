// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/options.hpp"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"

namespace ergotic::tools {
namespace {
constexpr double kDefaultRateHz = 44100.0;

/// \return why there is no such level here; empty if there is
std::string refusalOfIsa(const std::string& name) {
  try {
    rt::isaNamed(name);
  } catch (const Exception& refusal) {
    return refusal.what();
  }
  return {};
}

std::string refusalOfNumber(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return std::isfinite(value) ? "" : "'" + text + "' is not a finite number";
}

}  // namespace

void checkNumbers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name().rfind("FLOAT", 0) == 0) {
      option->check(&refusalOfNumber);
    }
  }
}

void addOptions(CLI::App& app, SceneOptions& options) {
  app.add_option("--set", options.set, "value of a parameter of the scene, NAME=VALUE")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  app.add_option("--variant", options.variant, "of the scene, one of its 'variants'")
      ->type_name("NAME");
  app.add_option("--rate", options.rate_hz, "audio rate, Hz (default: 44100)")
      ->check(CLI::PositiveNumber);
  app.add_option("--gestural-rate", options.gestural_rate_hz,
                 "wanted gestural rate, Hz; the nearest whole fraction of the audio rate is taken "
                 "(default: as the scene wishes)")
      ->check(CLI::PositiveNumber);
}

void addOptions(CLI::App& app, CompileChoice& choice) {
  app.add_option("--precision", choice.precision,
                 "of the instrument (default: auto, double where a body moves freely, else float)")
      ->check(CLI::IsMember({"auto", "float", "double"}));
  app.add_option("--isa", choice.isa,
                 "instruction set of the kernels; all give the same samples (default: the best "
                 "that this processor has)")
      ->type_name("NAME")
      ->check(&refusalOfIsa);
  app.add_option("--threads", choice.threads,
                 "that share the work; any number gives the same samples (default: 1)")
      ->check(CLI::Range(1, physics::kMaxThreads));
}

void addTargetOption(CLI::App& app, std::string& target, const std::string& help) {
  app.add_option("--target", target, help + ", such as \"1 cent\", \"0.1 dB\" or \"0.5 %\"")
      ->type_name("ACCURACY");
}

void addEndEffectorsOption(CLI::App& app, std::string& file) {
  app.add_option("--end-effectors", file, "what stands on the slices: a station's device file")
      ->type_name("F.yaml");
}

std::pair<std::string, std::string> splitAssignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw CLI::ValidationError(text, "not of the form NAME=VALUE");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

scene::Overrides overridesOf(const std::vector<std::string>& set) {
  scene::Overrides overrides;
  for (const std::string& assignment : set) {
    const auto [name, text] = splitAssignment(assignment);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != '\0') {
      throw CLI::ValidationError("--set " + assignment, "'" + text + "' is not a number");
    }
    if (!overrides.emplace(name, value).second) {
      throw CLI::ValidationError("--set " + assignment, name + " is set twice");
    }
  }
  return overrides;
}

scene::Scene readScene(const SceneOptions& options) {
  return scene::readSceneFile(options.scene, overridesOf(options.set), {options.variant});
}

physics::Rates chosenRates(const scene::Scene& scene, const SceneOptions& options) {
  const double rate_hz = options.rate_hz > 0.0 ? options.rate_hz : kDefaultRateHz;
  return physics::chooseRates(scene, rate_hz, options.gestural_rate_hz);
}

physics::CompileOptions chosenOptions(const CompileChoice& choice,
                                      physics::CompileOptions options) {
  if (!choice.precision.empty()) {
    options.precision = choice.precision == nameOf(physics::Precision::kAuto)
                            ? physics::Precision::kAuto
                            : physics::precisionNamed(choice.precision);
  }
  if (!choice.isa.empty()) {
    options.isa = rt::isaNamed(choice.isa);
  }
  if (choice.threads > 0) {
    options.threads = choice.threads;
  }
  return options;
}

std::string toString(const physics::CompileOptions& options) {
  return std::string(nameOf(options.precision)) + ", " + nameOf(options.isa) + ", " +
         std::to_string(options.threads) + (options.threads == 1 ? " thread" : " threads");
}

std::string conversionNote(const scene::Scene& scene, const physics::Rates& rates) {
  if (scene.time_unit_s == 1.0 || scene.time_unit_s * rates.audio_hz == 1.0) {
    return {};
  }
  std::ostringstream note;
  note << scene.file << ": counts in samples of " << 1.0 / scene.time_unit_s << " Hz; converted "
       << "through SI units to " << rates.audio_hz << " Hz, it keeps its pitch but not its samples";
  return note.str();
}

int runTool(CLI::App& app, int argc, char** argv, const std::function<int()>& tool) {
  checkNumbers(app);
  try {
    app.parse(argc, argv);
    return tool();
  } catch (const CLI::Error& error) {
    return app.exit(error) == 0 ? kSuccess : kUsage;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return kFailure;
  }
}

int runTool(const std::string& name,
            const std::string& what_it_does,
            const std::function<void(CLI::App&)>& add_options,
            int argc,
            char** argv,
            const std::function<int()>& tool) {
  CLI::App app(what_it_does, name);
  add_options(app);
  return runTool(app, argc, argv, tool);
}

}  // namespace ergotic::tools
