// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>

#include "lab/lib/accuracy.hpp"
#include "tools/lib/partials.hpp"

namespace ergotic::tools {
namespace {

constexpr double kReferenceHz = 16.0 * 88200.0;
constexpr double kBowSpeed = 0.2;
constexpr int kBowedMasses = 60;
constexpr double kSettled = 1.5;  // s, until the motion repeats itself

/// A bow that nothing brakes, F = N sqrt(2 a) v exp(-a v^2 + 1/2): `a` s^2/m^2, `force` N.
std::string bowScene(const char* scheme, double a, double force, const std::string& bowed) {
  std::ostringstream yaml;
  yaml << "ergotic: 1\n"
          "sections: {room: {rate: audio}}\n"
       << bowed
       << "lias:\n"
          "  rub: {type: smooth_bow, between: [bow, "
       << (bowed.find("generators") == std::string::npos ? "mass" : "s@0.13")
       << "], damping: " << force * std::sqrt(2.0 * a) / 0.63 << ", width: " << 2.0 / std::sqrt(a)
       << ", scheme: " << scheme << "}\n"
       << "outputs: {v: {at: "
       << (bowed.find("generators") == std::string::npos ? "mass" : "s@0.13")
       << ", quantity: velocity, channel: 1}}\n";
  return yaml.str();
}

const char* const kBow = "  bow: {type: mass, mass: 1.0e+6, v: 0.2}\n";

/// 1 g at 200 Hz with a hundredth of the critical damping.
std::string oscillator() {
  std::ostringstream yaml;
  const double omega = 2.0 * M_PI * 200.0;
  yaml << "mats:\n"
       << kBow << "  mass: {type: cell, mass: 0.001, stiffness: " << 1e-3 * omega * omega
       << ", damping: " << 2.0 * 0.01 * omega * 1e-3 << ", v: " << kBowSpeed << "}\n";
  return yaml.str();
}

/// 196 Hz, 0.3 kg/s, with losses; held as at the end of a stick, so that it repeats itself soon.
std::string bowedString() {
  std::ostringstream yaml;
  yaml << "mats:\n"
       << kBow << "generators:\n"
       << "  - {type: string, name: s, masses: " << kBowedMasses
       << ", mass: " << 8e-4 / kBowedMasses
       << ", frequency: 196, loss: 4.0e-5, damping: 2.0e-3, to: [0.33, 0], "
          "pluck: {at: 0.13, height: "
       << kBowSpeed * (1.0 - 0.13) / (2.0 * 196.0) << "}}\n";
  return yaml.str();
}

/// Rate at which the motion of one bowed thing repeats, from the sound once it has settled.
double pitchOf(const std::vector<double>& sound, double guess_hz, double rate_hz) {
  const auto begin = static_cast<std::size_t>(kSettled * rate_hz);
  double pitch = guess_hz;
  for (int pass = 0; pass < 4; ++pass) {
    pitch = partialAt(sound, pitch, rate_hz, begin).frequency_hz;
  }
  return pitch;
}

struct Bowed {
  const char* name;
  std::string scene;  // what is bowed
  double steepness;   // a
  double force;
  double guess_hz;
};

double playBow(const Bowed& bowed, Experiment& experiment, double rate_hz) {
  const std::vector<double> sound = experiment.play(kSettled + 0.52)[0];
  return pitchOf(sound, bowed.guess_hz, rate_hz);
}

}  // namespace

void measureBows(const Sink& sink) {
  for (const Bowed& bowed : {Bowed{"bowed oscillator", oscillator(), 100.0, 0.5, 143.0},
                             Bowed{"bowed string", bowedString(), 100.0, 0.15, 196.0}}) {
    const physics::Rates fine{kReferenceHz, 1};
    Experiment reference(bowScene("energy_stable", bowed.steepness, bowed.force, bowed.scene), fine,
                         physics::Precision::kDouble);
    const double right_hz = playBow(bowed, reference, kReferenceHz);
    for (const char* scheme : {"explicit", "energy_stable"}) {
      const std::string yaml = bowScene(scheme, bowed.steepness, bowed.force, bowed.scene);
      for (const double rate_hz : {44100.0, 88200.0, 176400.0}) {
        const physics::Rates rates{rate_hz, 14};
        const bool is_playable = isPlayable(yaml, rates);
        for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
          Experiment experiment(yaml, rates, precision);
          const double error =
              is_playable ? cents(playBow(bowed, experiment, rate_hz), right_hz) : kNotPlayed;
          sink({"bow", "pitch", std::string(bowed.name) + ", " + scheme, precision, rates, 0, 0.0,
                std::abs(error), "cents", experiment.cost(0.1)});
        }
      }
    }
  }
}

}  // namespace ergotic::tools
