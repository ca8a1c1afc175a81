// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>

#include "lab/lib/accuracy.hpp"

namespace ergotic::tools {
namespace {

constexpr int kPhases = 16;
constexpr double kApproach = 5.0;  // samples of free flight

/// A mass that comes at 1 m/s and stays in contact for 1 ms: closed form.
struct Impact {
  double exponent;
  double mass = 5e-3;
  double speed = 1.0;
  double duration = 1e-3;
  double deepest = 0.0;
  double stiffness = 0.0;

  explicit Impact(double a) : exponent(a) {
    const double share = 1.0 / (a + 1.0);
    const double integral = std::sqrt(M_PI) * std::tgamma(1.0 + share) / std::tgamma(0.5 + share);
    deepest = duration * speed / (2.0 * integral);
    stiffness = (a + 1.0) * mass * speed * speed / (2.0 * std::pow(deepest, a + 1.0));
  }
  double peakForce() const { return stiffness * std::pow(deepest, exponent); }
};

struct Errors {
  double duration = 0.0;
  double peak = 0.0;
  double rebound = 0.0;
};

/// Duration: from where the straight line before crosses the wall to where that after does. Peak:
/// the largest force that the mass was given in any step.
Errors judge(const Impact& impact,
             const std::vector<std::vector<double>>& heard,
             double start,
             double rate_hz) {
  const std::vector<double>& p = heard[0];
  const double out_speed = heard[1].back() / rate_hz;
  // The wall pushes it back: below 0.
  const double strongest = -*std::min_element(heard[2].begin(), heard[2].end());
  const double step = impact.speed / rate_hz;
  const double out = static_cast<double>(p.size() - 1) - p.back() / out_speed;
  return {(out + start / step) / (rate_hz * impact.duration) - 1.0,
          strongest / impact.peakForce() - 1.0, -heard[1].back() / impact.speed - 1.0};
}

std::string impactScene(const Impact& impact, const char* scheme, double before) {
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "ergotic: 1\n"
          "sections: {room: {rate: audio}}\n"
          "mats:\n"
          "  ball: {type: mass, mass: "
       << impact.mass << ", x: " << before << ", v: " << impact.speed
       << "}\n"
          "  wall: {type: ground}\n"
          "lias:\n"
          "  touch: {type: power_contact, between: [ball, wall], stiffness: "
       << impact.stiffness << ", exponent: " << impact.exponent << ", scheme: " << scheme
       << "}\n"
          "outputs:\n"
          "  x: {at: ball, quantity: position, channel: 1}\n"
          "  v: {at: ball, quantity: velocity, channel: 2}\n"
          "  f: {at: ball, quantity: force, channel: 3}\n";
  return yaml.str();
}

void measure(double exponent,
             const char* scheme,
             double rate_hz,
             physics::Precision precision,
             const Sink& sink) {
  const Impact impact(exponent);
  const physics::Rates rates{rate_hz, 1};
  const double step = impact.speed / rate_hz;
  const double seconds = 1.3 * impact.duration + 2.0 * kApproach / rate_hz;
  Errors rms;
  PlayCost cost;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double start = -(kApproach + phase / double{kPhases}) * step;
    Experiment experiment(impactScene(impact, scheme, start - step), rates, precision);
    const Errors e = judge(impact, experiment.play(seconds), start, rate_hz);
    rms.duration += e.duration * e.duration / kPhases;
    rms.peak += e.peak * e.peak / kPhases;
    rms.rebound += e.rebound * e.rebound / kPhases;
    cost = phase == 0 ? experiment.cost(seconds) : cost;
  }
  const auto say = [&](const char* what, double square) {
    sink({"barrier", what, scheme, precision, rates, 0, exponent, 100.0 * std::sqrt(square), "%",
          cost});
  };
  say("duration", rms.duration);
  say("peak force", rms.peak);
  say("rebound", rms.rebound);
}

}  // namespace

void measureBarriers(const Sink& sink) {
  for (const char* scheme : {"explicit", "energy_stable"}) {
    for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
      for (const double exponent : {1.0, 1.5, 2.3, 3.0}) {
        for (const double rate_hz : measuredRates()) {
          measure(exponent, scheme, rate_hz, precision, sink);
        }
      }
    }
  }
}

}  // namespace ergotic::tools
