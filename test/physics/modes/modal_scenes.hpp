// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/physics.hpp"

namespace ergotic::physics {

constexpr Rates kModalRates{kRate, 10};

/// 30 masses of different weight, damped in proportion, that start displaced and moving under
/// gravity between springs with rest lengths.
inline SceneBuilder dampedString() {
  SceneBuilder b;
  constexpr double kMass = 1e-3;
  const double k = 0.5 * kMass * kRate * kRate;
  const int first = b.ground(1e-4);
  for (int i = 1; i <= 30; ++i) {
    const int m = b.mass(kMass * (1.0 + 0.02 * i), 1e-3 * std::sin(0.3 * i), 0.02 * i);
    const double stiffness = k * (1.0 - 0.01 * i);
    b.spring(m - 1, m, stiffness, 1e-7 * stiffness);
    b.scene.lias.back().rest_length = 1e-5 * i;
  }
  b.spring(first + 30, b.ground(), k, 1e-7 * k);
  b.scene.sections[0].gravity.x() = -9.8;
  b.hear(first + 7, 0);
  b.hear(first + 19, 1, scene::Quantity::kVelocity);
  b.hear(first + 31, 2, scene::Quantity::kForce);
  b.hear(first, 3, scene::Quantity::kForce);
  b.push(first + 12);
  return b;
}

/// Cells with springs of `k` to their neighbours and `held` k to their places, damped in
/// proportion.
struct Plate : SceneBuilder {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 10;
  static constexpr double kMass = 1e-3;
  Plate(double k, double held) {
    for (int i = 0; i < kColumns * kRows; ++i) {
      cell(kMass, held * k, 1e-6 * held * k);
    }
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        if (column + 1 < kColumns) {
          spring(of(column, row), of(column + 1, row), k, 1e-6 * k);
        }
        if (row + 1 < kRows) {
          spring(of(column, row), of(column, row + 1), k, 1e-6 * k);
        }
      }
    }
  }
  int of(int column, int row) const { return row * kColumns + column; }
};

/// A plate with free edges in a medium, with taps, a force input, a stop that it hits, and a slice
/// of the device that strikes it through an energy-stable contact.
inline Plate playedPlate() {
  const double k = 0.1 * Plate::kMass * kRate * kRate;
  Plate b(k, 2e3 / k);
  for (int i = 0; i < Plate::kColumns * Plate::kRows; ++i) {
    b.scene.mats[at(i)].position.x() = 1e-4 * std::cos(0.2 * i);
  }
  b.scene.sections[0].medium = {5e-4};
  b.hear(b.of(3, 4), 0);
  b.hear(b.of(9, 2), 1, scene::Quantity::kVelocity);
  b.scene.outputs.back().point.next = b.of(10, 2);
  b.scene.outputs.back().point.fraction = 0.4;
  b.push(b.of(5, 5));
  const int stop = b.ground(-2e-4);
  b.link(scene::LiaType::kContact, b.of(6, 3), stop, 0.02 * k, 1e-3);
  const int pick = b.point(b.grid(0, Plate::kColumns, Plate::kRows), 0.31, 0.77);
  b.scene.mats[at(pick)].rest.x() = 0.25;
  b.hear(pick, 2);
  const int slice = b.slice(0);
  b.link(scene::LiaType::kContact, slice, b.of(2, 7), 0.5 * k, 1e-2);
  b.scene.lias.back().scheme = scene::Scheme::kEnergyStable;
  b.link(scene::LiaType::kCubic, pick, slice, 50.0);
  b.scene.lias.back().law.edit().nonlinearity = {1e5};
  b.scene.lias.back().scheme = scene::Scheme::kEnergyStable;
  b.scene.lias.back().place = {321, 1};
  return b;
}

inline scene::Scene withModes(scene::Scene scene, int modes) {
  scene.sections[0].modes = modes;
  return scene;
}

inline std::string errorOf(const scene::Scene& scene) {
  return complaintOf<TextError>([&] { const test::Player player(scene, kModalRates); });
}

inline std::string described(const scene::Scene& scene, const Rates& rates = kModalRates) {
  const test::Player player(scene, rates);
  std::string all;
  for (const std::string& line : player.instrument->describe()) {
    all += line + '\n';
  }
  return all;
}

}  // namespace ergotic::physics
