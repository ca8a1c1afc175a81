// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "support/scene_builder.hpp"

namespace ergotic::test {

/// Adds networks of masses of 1 g and linear springs to a scalar section. They start at random
/// places, within a millimetre. Each function gives the index of the first module.
struct Nets {
  explicit Nets(SceneBuilder& b) : to(b) {}

  enum class Ends { kFixed, kFree, kFixedAndFree };
  int string(int modules, Ends ends = Ends::kFixed);
  /// A string with springs to the second neighbours too.
  int bar(int modules);
  /// Rows of masses with their four neighbours, or eight; clamped: the border does not move.
  int plate(int rows, int columns, bool corners, bool clamped);
  /// Squares with one random diagonal each, modules in random order.
  int triangles(int side);
  int star(int rays);

  int module(bool moves);
  void join(int a, int b);
  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }

  SceneBuilder& to;
  int section = SceneBuilder::kAudio;
  double rate_hz = 44100.0;      ///< of the section
  double kappa = 0.1;            ///< K h^2 / M of a spring
  double zeta = 0.01;            ///< Z h / M
  double scatter = 0.0;          ///< of the coefficients of one network, relative
  bool has_one_ratio = true;     ///< Z / K is the same for all springs
  double rest_length = 0.0;      ///< largest of a spring, m
  double ground_position = 0.0;  ///< m from rest
  bool has_cells = false;        ///< every third mass is a cell
  std::mt19937 random{1};
};

}  // namespace ergotic::test
