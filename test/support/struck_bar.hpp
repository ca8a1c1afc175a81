// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::test {

/// YAML of a bar that slice 0 strikes, with the parameter `tone`; `output` is its only output,
/// `{at: bar, channel: 1, ...}`.
inline std::string struckBar(const std::string& output) {
  return R"(ergotic: 1
name: struck
gestural_rate: 3150
parameters:
  tone: {value: 2000, range: [1000, 8000]}
sections:
  sound: {rate: audio}
  keys: {rate: gestural}
mats:
  key: {type: slice, section: keys, rest: -0.002}
  bar: {type: cell, section: sound, mass: 0.001, stiffness: $tone, damping: 0.001}
lias:
  felt: {type: contact, between: [key, bar], stiffness: 500, damping: 0.02}
ports:
  hand: {mat: key, slice: 0}
outputs:
  left: )" +
         output + "\n";
}

}  // namespace ergotic::test
