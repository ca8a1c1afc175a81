// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>

#include "ergotic/exception.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {

constexpr double kRate = 44100.0;
constexpr Rates kRates{kRate, 10};

inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct Built : test::SceneBuilder {
  int force(int mat, int channel = 0) {
    scene::Input input;
    input.name = "in" + std::to_string(scene.inputs.size());
    input.mat = mat;
    input.channel = channel;
    scene.inputs.push_back(input);
    return static_cast<int>(scene.inputs.size()) - 1;
  }
  int point(int first, int columns, int rows, double along, double across) {
    scene.grids.push_back({"g" + std::to_string(scene.grids.size()), first, columns, rows});
    scene::Mat mat;
    mat.name = "p" + std::to_string(scene.mats.size());
    mat.type = scene::MatType::kPoint;
    mat.rest.x() = 0.25;
    scene.mats.push_back(mat);
    scene::Connection connection;
    connection.mat = static_cast<int>(scene.mats.size()) - 1;
    connection.grid = static_cast<int>(scene.grids.size()) - 1;
    connection.along = {along};
    connection.across = {across};
    connection.place = {500, 1};
    scene.connections.push_back(connection);
    return connection.mat;
  }
};

/// 30 masses of different weight, damped in proportion, that start displaced and moving under
/// gravity between springs with rest lengths.
inline Built dampedString() {
  Built b;
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
  b.force(first + 12);
  return b;
}

struct Plate : Built {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 10;
  static constexpr double kMass = 1e-3;
  int first = 0;
  int of(int column, int row) const { return first + row * kColumns + column; }
};

/// A plate with free edges in a medium, with taps, a force input, a stop that it hits, and a slice
/// of the device that strikes it through a guarded contact.
inline Plate playedPlate() {
  Plate b;
  const double k = 0.1 * Plate::kMass * kRate * kRate;
  b.first = static_cast<int>(b.scene.mats.size());
  for (int i = 0; i < Plate::kColumns * Plate::kRows; ++i) {
    b.cell(Plate::kMass, 2e3, 1e-6 * 2e3, 1e-4 * std::cos(0.2 * i));
  }
  for (int row = 0; row < Plate::kRows; ++row) {
    for (int column = 0; column < Plate::kColumns; ++column) {
      if (column + 1 < Plate::kColumns) {
        b.spring(b.of(column, row), b.of(column + 1, row), k, 1e-6 * k);
      }
      if (row + 1 < Plate::kRows) {
        b.spring(b.of(column, row), b.of(column, row + 1), k, 1e-6 * k);
      }
    }
  }
  b.scene.sections[0].medium = {5e-4};
  b.hear(b.of(3, 4), 0);
  b.hear(b.of(9, 2), 1, scene::Quantity::kVelocity);
  b.scene.outputs.back().point.next = b.of(10, 2);
  b.scene.outputs.back().point.fraction = 0.4;
  b.force(b.of(5, 5));
  const int stop = b.ground(-2e-4);
  b.link(scene::LiaType::kContact, b.of(6, 3), stop, 0.02 * k, 1e-3);
  const int pick = b.point(b.first, Plate::kColumns, Plate::kRows, 0.31, 0.77);
  b.hear(pick, 2);
  const int slice = b.slice(0);
  b.link(scene::LiaType::kContact, slice, b.of(2, 7), 0.5 * k, 1e-2);
  b.scene.lias.back().scheme = scene::Scheme::kGuarded;
  b.link(scene::LiaType::kCubic, pick, slice, 50.0);
  b.scene.lias.back().law.edit().nonlinearity = {1e5};
  b.scene.lias.back().scheme = scene::Scheme::kGuarded;
  b.scene.lias.back().place = {321, 1};
  return b;
}

inline scene::Scene withModes(scene::Scene scene, int modes) {
  scene.sections[0].modes = modes;
  return scene;
}

inline std::string errorOf(const scene::Scene& scene) {
  try {
    const test::Player player(scene, kRates);
  } catch (const TextError& error) {
    return error.what();
  }
  return "";
}

inline std::string described(const scene::Scene& scene, const Rates& rates = kRates) {
  const test::Player player(scene, rates);
  std::string all;
  for (const std::string& line : player.instrument->describe()) {
    all += line + '\n';
  }
  return all;
}

}  // namespace ergotic::physics
