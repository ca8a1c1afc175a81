// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/accuracy.hpp"

#include <algorithm>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/lib/machine.hpp"
#include "tools/lib/options.hpp"

namespace {

using ergotic::tools::Measurement;

void printLine(const Measurement& m) {
  std::cout << m.problem << ',' << m.measure << ",\"" << m.family << "\","
            << (m.precision == ergotic::physics::Precision::kFloat ? "float" : "double") << ','
            << m.rates.audio_hz << ',' << m.rates.ratio << ',' << m.masses << ',' << m.exponent
            << ',' << m.error << ',' << m.unit << ',' << m.cost.cpu_s << ',' << m.cost.steps
            << ",\"" << ergotic::tools::processorName() << '"'
            << std::endl;  // some take their time: those that are done can be read
}

}  // namespace

int main(int argc, char** argv) {
  namespace tools = ergotic::tools;
  const std::map<std::string, void (*)(const tools::Sink&)> problems{
      {"string", tools::measureStrings}, {"barrier", tools::measureBarriers},
      {"bow", tools::measureBows},       {"hammer", tools::measureHammers},
      {"hand", tools::measureHands},     {"wall", tools::measureWalls}};
  std::vector<std::string> chosen;
  const auto add_options = [&](CLI::App& app) {
    app.add_option("--problem", chosen, "only this one; repeatable (default: all)")
        ->check(CLI::IsMember(problems))
        ->allow_extra_args(false);
  };
  const std::string what_it_does =
      "Measures how wrong problems with a known answer are played and what that costs, setting by "
      "setting, as CSV.";
  return tools::runTool("accuracy", what_it_does, add_options, argc, argv, [&] {
    std::cout << "problem,measure,family,precision,audio_hz,ratio,masses,exponent,error,unit,"
                 "cpu_s_per_s,steps_per_s,machine\n";
    for (const auto& [name, measure] : problems) {
      if (chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end()) {
        measure(printLine);
      }
    }
    return tools::kSuccess;
  });
}
