// SPDX-License-Identifier: BSD-3-Clause
// What tests of the physics share.
#pragma once

#include "support/energy.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::physics {

using ergotic::test::energiesOf;
using ergotic::test::imbalanceOf;
using ergotic::test::kineticEnergy;
using ergotic::test::Player;
using ergotic::test::SceneBuilder;
using scene::Geometry;
using scene::Lia;
using scene::LiaType;
using scene::Quantity;
using scene::Scheme;

constexpr double kRate = 44100.0;  // Hz
constexpr double kPi = 3.14159265358979323846;

}  // namespace ergotic::physics
