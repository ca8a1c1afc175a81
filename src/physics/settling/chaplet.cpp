// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/chaplet.hpp"

#include <cmath>
#include <utility>

#include "constants.hpp"

namespace ergotic::physics {
namespace {}

Chaplet::Chaplet(std::vector<scene::ChapletStage> stages, double step_s, int ratio)
    : stages_(std::move(stages)), step_s_(step_s), ratio_(ratio) {}

double Chaplet::mass() const {
  double sum = 0.0;
  for (const scene::ChapletStage& stage : stages_) {
    sum += stage.mass;
  }
  return sum;
}

double Chaplet::seriesStiffness() const {
  double compliance = 0.0;
  for (const scene::ChapletStage& stage : stages_) {
    compliance += 1.0 / stage.stiffness;
  }
  return 1.0 / compliance;
}

double Chaplet::nyquistHz() const {
  return 0.5 / (ratio_ * step_s_);
}

Chaplet::Port Chaplet::portAt(double frequency_hz, const ChapletLoad& load) const {
  // With z = e^(jwh): a velocity is (1 - 1/z) x/h, and M (z - 2 + 1/z) x/h^2 is the force.
  const double angle = 2.0 * kPi * frequency_hz * step_s_;
  const std::complex<double> rate = (1.0 - std::polar(1.0, -angle)) / step_s_;
  const double acceleration = -4.0 * std::pow(std::sin(angle / 2.0) / step_s_, 2);
  Port port{1.0, load.stiffness + load.damping * rate};
  for (auto stage = stages_.rbegin(); stage != stages_.rend(); ++stage) {
    port.force += stage->mass * acceleration * port.position;
    port.position += port.force / (stage->stiffness + stage->damping * rate);
  }
  return port;
}

double Chaplet::gain(double frequency_hz, const ChapletLoad& load) const {
  return 1.0 / std::abs(portAt(frequency_hz, load).position);
}

double Chaplet::holdGain(double frequency_hz) const {
  const double angle = kPi * frequency_hz * step_s_;
  return std::abs(std::sin(ratio_ * angle) / (ratio_ * std::sin(angle)));
}

double Chaplet::apparentMass(double frequency_hz, const ChapletLoad& load) const {
  const Port port = portAt(frequency_hz, load);
  return -(port.force / port.position).real() / std::pow(2.0 * kPi * frequency_hz, 2);
}

double Chaplet::apparentDamping(double frequency_hz, const ChapletLoad& load) const {
  const Port port = portAt(frequency_hz, load);
  return (port.force / port.position).imag() / (2.0 * kPi * frequency_hz);
}

double decibels(double gain) {
  return 20.0 * std::log10(gain);
}

}  // namespace ergotic::physics
