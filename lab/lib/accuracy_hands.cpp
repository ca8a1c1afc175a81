// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "constants.hpp"
#include "lab/lib/accuracy.hpp"
#include "tools/lib/partials.hpp"

namespace ergotic::tools {
namespace {
constexpr double kHandSpeed = 0.05;  // m/s
constexpr double kApart = 3.2e-4;    // m, of hand and string at the start
constexpr double kStart = 0.02;      // s, until the hand is as fast as that
constexpr double kHandSeconds = 0.8;
constexpr std::size_t kAfterPluck = 4410;  // the plectrum has let go

/// A plectrum of 30 kN/m that slips off at 0.8 N, in a hand.
std::string pluckScene(const std::string& coupling, int ratio) {
  std::ostringstream yaml;
  yaml.precision(12);
  yaml << "ergotic: 1\n"
          "gestural_rate: "
       << kRateHz / ratio
       << "\n"
          "sections: {string: {rate: audio}, hands: {rate: gestural}}\n"
          "mats:\n"
          "  hand: {type: slice, section: hands, coupling: "
       << coupling
       << "}\n"
          "generators:\n"
          "  - {type: string, name: s, section: string, masses: "
       << kStringMasses << ", mass: " << 0.0025 / kStringMasses << ", frequency: " << kPitchHz
       << ", loss: 4.0e-6, to: [0.65, 0]}\n"
          "lias:\n"
          "  pluck: {type: pluck, between: [hand, s@0.12], stiffness: 3.0e+4, width: 3.0e-4}\n"
          "ports: {hand: {mat: hand, slice: 0}}\n"
          "outputs: {v: {at: s@0.37, quantity: velocity, channel: 1}}\n";
  return yaml.str();
}

/// It comes from below, starts slowly, and goes on evenly.
double placeAt(double time) {
  const double way = time < kStart
                         ? 0.5 * kHandSpeed * (time - std::sin(kPi * time / kStart) * kStart / kPi)
                         : kHandSpeed * (time - 0.5 * kStart);
  return way - kApart;
}

}  // namespace

void measureHands(const Sink& sink) {
  Experiment reference(pluckScene("hold", 1), {kRateHz, 1}, physics::Precision::kDouble);
  const std::vector<double> right = reference.play(kHandSeconds, placeAt)[0];
  const std::vector<double> partials = stringPartials(kStringMasses, kPitchHz, kRateHz);
  for (const char* const coupling : {"hold", "chaplet", "smooth"}) {
    for (const int ratio : {4, 7, 14, 28, 44}) {
      for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
        const physics::Rates rates{kRateHz, ratio};
        Experiment experiment(pluckScene(coupling, ratio), rates, precision);
        const std::vector<double> sound = experiment.play(kHandSeconds, placeAt)[0];
        sink({"hand", "worst of ten partials", coupling, precision, rates, kStringMasses, 0.0,
              worstPartialDb(sound, right, partials, kRateHz, kAfterPluck), "dB",
              experiment.cost(0.1)});
      }
    }
  }
}

}  // namespace ergotic::tools
