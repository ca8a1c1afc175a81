// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>

#include "ergotic/advice/accuracy.hpp"
#include "lab/lib/accuracy.hpp"
#include "tools/lib/partials.hpp"

namespace ergotic::tools {
namespace {

struct Kind {
  const char* family;
  const char* more;  // keys of the generator
  std::vector<int> masses;
};

std::string stringScene(int masses, const char* more) {
  std::ostringstream yaml;
  yaml << "ergotic: 1\n"
          "sections: {string: {rate: audio}}\n"
          "generators:\n"
          "  - {type: string, name: s, masses: "
       << masses << ", mass: " << 0.0025 / masses << ", frequency: " << kPitchHz
       << ", to: [0.65, 0], pluck: {at: 0.13, height: 0.001}" << more
       << "}\n"
          "outputs: {out: {at: s@0.957, quantity: velocity, channel: 1}}\n";
  return yaml.str();
}

/// Each partial is looked for where it is foretold.
double worstCents(const std::vector<double>& sound, const scene::StringCut& cut, double rate_hz) {
  double worst = 0.0;
  double ideal_hz = 0.0;
  for (const double foretold : physics::partialsOf(cut, kPitchHz / rate_hz, true)) {
    ideal_hz += kPitchHz;
    const double is_hz = partialAt(sound, foretold * rate_hz, rate_hz).frequency_hz;
    worst = std::max(worst, std::abs(cents(is_hz, ideal_hz)));
  }
  return worst;
}

}  // namespace

void measureStrings(const Sink& sink) {
  const Kind kinds[] = {
      {"plain", "", {20, 40, 80, 120, 160}},
      {"plain, with losses", ", loss: 1.0e-5, damping: 1.0e-4", {20, 40, 80, 160}},
      {"coarse", ", coarse: true", {20, 24, 32, 40}}};
  for (const Kind& kind : kinds) {
    for (const double rate_hz : measuredRates()) {
      for (const int masses : kind.masses) {
        const std::string yaml = stringScene(masses, kind.more);
        const physics::Rates rates{rate_hz, 14};
        const scene::StringCut cut{masses, std::string(kind.family) == "coarse"};
        const bool is_playable = isPlayable(yaml, rates);
        for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
          Experiment experiment(yaml, rates, precision);
          const double error =
              is_playable ? worstCents(experiment.play(0.52)[0], cut, rate_hz) : kNotPlayed;
          sink({"string", "worst of ten partials", kind.family, precision, rates, masses, 0.0,
                error, "cents", experiment.cost(0.1)});
        }
      }
    }
  }
}

}  // namespace ergotic::tools
