// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "ergotic/physics/settling/chaplet.hpp"
#include "lab/lib/accuracy.hpp"
#include "tools/lib/partials.hpp"

namespace ergotic::tools {
namespace {

constexpr double kHammerSeconds = 0.6;
constexpr std::size_t kAfterBlow = 2205;  // after the blow

constexpr double kHammerKg = 0.005;
constexpr double kChapletShare = 0.1;  // of the hammer
constexpr double kHammerSpeed = 1.0;
constexpr double kWay = 0.004;  // before it touches

/// A felt hammer that is thrown at a string of 0.55 kg/s, 11 ms of contact. Bare or with a chaplet
/// it weighs the same, and it arrives at the same time: its first step is (R - 1) h longer than
/// that of R = 1, and held it lags half of that. The net is what else may move at the gestural
/// rate.
std::string hammerScene(bool filtered, int ratio) {
  const double early = (ratio - 1) / (2.0 * kRateHz);
  const double x = -kWay - kHammerSpeed * early;
  std::ostringstream yaml;
  yaml.precision(12);
  yaml << "ergotic: 1\n"
          "gestural_rate: "
       << kRateHz / ratio
       << "\n"
          "sections: {string: {rate: audio}, hand: {rate: gestural}}\n"
          "mats:\n"
          "  hammer: {type: mass, section: hand, mass: "
       << kHammerKg * (filtered ? 1.0 - kChapletShare : 1.0) << ", x: " << x << ", rest: " << x
       << ", v: " << kHammerSpeed
       << "}\n"
          "generators:\n"
          "  - {type: string, name: s, section: string, masses: "
       << kStringMasses << ", mass: " << 0.0025 / kStringMasses << ", frequency: " << kPitchHz
       << ", loss: 4.0e-5, damping: 0.005, to: [0.65, 0]}\n"
          "  - {type: mesh, name: action, section: hand, rows: 16, columns: 16, spacing: 0.01, "
          "mass: 0.001, stiffness: 100}\n";
  if (filtered) {
    yaml << "  - {type: chaplet, name: felt, section: string, from: hammer, mass: "
         << kHammerKg * kChapletShare << "}\n";
  }
  yaml << "lias:\n"
          "  touch: {type: power_contact, between: ["
       << (filtered ? "felt.1" : "hammer")
       << ", s@0.12], stiffness: 5.0e+6, exponent: 2.3}\n"
          "outputs: {v: {at: s@0.37, quantity: velocity, channel: 1}}\n";
  return yaml.str();
}

double rms(const std::vector<double>& sound) {
  double sum = 0.0;
  for (const double sample : sound) {
    sum += sample * sample;
  }
  return std::sqrt(sum);
}

/// What differs, of the whole.
double difference(const std::vector<double>& sound, const std::vector<double>& right) {
  std::vector<double> missing(right);
  for (std::size_t n = 0; n < right.size(); ++n) {
    missing[n] -= sound[n];
  }
  return rms(missing) / rms(right);
}

}  // namespace

void measureHammers(const Sink& sink) {
  Experiment reference(hammerScene(false, 1), {kRateHz, 1}, physics::Precision::kDouble);
  std::vector<double> right = reference.play(kHammerSeconds)[0];
  right.resize(static_cast<std::size_t>(kHammerSeconds * kRateHz));
  for (const bool filtered : {false, true}) {
    for (const int ratio : {1, 2, 4, 7, 14, 28, 44}) {
      if (filtered && ratio < scene::kChapletC2LowestRatio) {
        continue;
      }
      for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
        if (ratio == 1 && precision == physics::Precision::kDouble) {
          continue;  // the reference
        }
        const physics::Rates rates{kRateHz, ratio};
        Experiment experiment(hammerScene(filtered, ratio), rates, precision);
        const std::vector<double> sound = experiment.play(kHammerSeconds)[0];
        const PlayCost cost = experiment.cost(0.1);
        const auto say = [&](const char* what, double error, const char* unit) {
          sink({"hammer", what, filtered ? "chaplet" : "bare", precision, rates, kStringMasses, 2.3,
                error, unit, cost});
        };
        say("whole sound", 100.0 * difference(sound, right), "%");
        say("worst of ten partials",
            worstPartialDb(sound, right, stringPartials(kStringMasses, kPitchHz, kRateHz), kRateHz,
                           kAfterBlow),
            "dB");
      }
    }
  }
}

}  // namespace ergotic::tools
