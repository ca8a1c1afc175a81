// SPDX-License-Identifier: BSD-3-Clause
// What tests of the physics share.
#pragma once

#include <random>
#include <sstream>
#include <string>

#include "constants.hpp"
#include "support/energy.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::physics {

using ergotic::test::energiesOf;
using ergotic::test::imbalanceOf;
using ergotic::test::kineticEnergy;
using ergotic::test::kRates;
using ergotic::test::Player;
using ergotic::test::SceneBuilder;
using scene::Geometry;
using scene::Lia;
using scene::LiaType;
using scene::Quantity;
using scene::Scheme;

constexpr double kRate = 44100.0;  // Hz
constexpr double kStep = 1.0 / kRate;
constexpr double kTick = 14.0 / kRate;  // at kRates
constexpr Rates kEveryFrame{kRate, 1};
constexpr double kUnbalanced = 1e-10;  // what energies may miss, of the largest energy stored

/// Reads back as the same number.
inline std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

inline double uniform(std::mt19937& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}

}  // namespace ergotic::physics
