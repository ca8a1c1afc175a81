// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/text/read_scene.hpp"

namespace CLI {
class App;  // its header takes seconds to compile
}

namespace ergotic::tools {

enum ExitCode {
  kSuccess = 0,
  kFailure = 1,  ///< the scene, a file or a device is at fault; the reason is on stderr
  kUsage = 2,    ///< the command line is
  kRefused = 3,  ///< `check`: the scene is unstable; `render`: the recording has gaps
};

/// The scene and the rates that a tool is asked for.
struct SceneOptions {
  std::string scene;              ///< path; may be empty for a recording
  std::vector<std::string> set;   ///< NAME=VALUE
  std::string variant;            ///< variant of the scene; empty: none
  double rate_hz = 0.0;           ///< 0: 44100
  double gestural_rate_hz = 0.0;  ///< 0: as the scene wishes
};

void addOptions(CLI::App& app, SceneOptions& options);

/// Options of the compilation, as far as they are given to a tool.
struct CompileChoice {
  std::string precision;  ///< empty: not given
  std::string isa;        ///< empty: not given
  int threads = 0;        ///< 0: not given
};

void addOptions(CLI::App& app, CompileChoice& choice);

void addTargetOption(CLI::App& app, std::string& target, const std::string& help);

void addEndEffectorsOption(CLI::App& app, std::string& file);

/// Splits NAME=TEXT. \throws CLI::ValidationError if there is no name or no text
std::pair<std::string, std::string> splitAssignment(const std::string& text);

/// \throws CLI::ValidationError if one is not NAME=NUMBER
scene::Overrides overridesOf(const std::vector<std::string>& set);

/// Reads and validates the scene asked for. \throws TextError, Exception
scene::Scene readScene(const SceneOptions& options);

/// \throws Exception if the scene cannot be run at the rates asked for
physics::Rates chosenRates(const scene::Scene& scene, const SceneOptions& options);

/// Options of the compilation: those given to the tool, and `otherwise` for the rest.
physics::CompileOptions chosenOptions(
    const CompileChoice& choice, physics::CompileOptions otherwise = physics::Precision::kAuto);

/// "float, avx2, 1 thread".
std::string toString(const physics::CompileOptions& options);

/// Note on a scene in samples of another rate; empty if there is none.
std::string conversionNote(const scene::Scene& scene, const physics::Rates& rates);

/// Requires finite numbers: `nan` would pass every check of a range. \pre all options are there
void checkNumbers(CLI::App& app);

/// Parses a command line and runs `tool`; errors go to stderr. \return the exit code
int runTool(CLI::App& app, int argc, char** argv, const std::function<int()>& tool);

/// As above, for a tool given by its name, its purpose and a function that adds its options.
int runTool(const std::string& name,
            const std::string& what_it_does,
            const std::function<void(CLI::App&)>& add_options,
            int argc,
            char** argv,
            const std::function<int()>& tool);

/// As above, for a tool whose options are known to `addOptions`.
template <class Options>
int runTool(const std::string& name,
            const std::string& what_it_does,
            int argc,
            char** argv,
            int (*tool)(const Options&)) {
  Options options;
  const auto add = [&options](CLI::App& app) { addOptions(app, options); };
  return runTool(name, what_it_does, add, argc, argv, [&] { return tool(options); });
}

}  // namespace ergotic::tools
