// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::test {

// Two devices: one of two slices that speaks volts and was never calibrated, one of three that
// speaks metres. A link between them is what both hands feel.
inline const char kDevices[] = R"(devices:
  - driver: virtual
    settings: {slices: 2, volts: {metres_per_volt: -0.004, rest_volts: 1.5, volts_per_newton: 0.05}}
    calibration: [{volts_per_newton: 0.05, full_scale_newtons: 200}, {volts_per_newton: 0.05, full_scale_newtons: 200}]
  - driver: virtual
    settings: {slices: 3}
)";
inline const char kModel[] = R"(ergotic: 1
name: two hands
sections:
  hands: {rate: gestural}
mats:
  left: {type: slice, section: hands}
  right: {type: slice, section: hands}
  press: {type: slice, section: hands}
  ground: {type: ground, section: hands}
lias:
  between: {type: spring_damper, between: [left, right], stiffness: 300, damping: 1}
  floor: {type: spring_damper, between: [press, ground], stiffness: 200, damping: 1}
ports:
  left: {mat: left, slice: 0}
  right: {mat: right, slice: 2}
  press: {mat: press, slice: 4}
)";
// The same ports, the right one before a wall, and a plate that takes a while to load.
inline const char kWalled[] = R"(ergotic: 1
name: walled hands
sections:
  hands: {rate: gestural}
  plate: {rate: audio}
mats:
  left: {type: slice, section: hands}
  right: {type: slice, section: hands}
  press: {type: slice, section: hands}
  ground: {type: ground, section: hands}
generators:
  - {type: mesh, name: plate, section: plate, rows: 200, columns: 200, spacing: 0.01, mass: 1.0e-4,
     stiffness: 2000, damping: 1.0e-3, edges: fixed}
lias:
  wall: {type: spring_damper, between: [right, ground], stiffness: 1500, damping: 1}
ports:
  left: {mat: left, slice: 0}
  right: {mat: right, slice: 2}
  press: {mat: press, slice: 4}
)";
constexpr double kMetresPerVolt = -0.004;
constexpr double kRestVolts = 1.5;

}  // namespace ergotic::test
