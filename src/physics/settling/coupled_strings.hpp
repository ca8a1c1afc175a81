// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A string that is to sound at its pitch together with what it ends on.
struct CoupledString {
  std::string name;
  int first_mat = 0;
  int mats = 0;  ///< its two ends among them
  int first_lia = 0;
  int lias = 0;
  int first_bend = 0;
  int bends = 0;
  int partial = 1;        ///< partial that sounds at the pitch
  double pitch_hz = 0.0;  ///< above 0
  int info = -1;          ///< index in Scene::strings, -1: none
  scene::Place place;
};

/// Finds the coupled strings of a scene before it is tuned; a tuned scene has lost the requests.
std::vector<CoupledString> coupledStrings(const scene::Scene& scene);

/// Makes the springs and bends of each string softer or stiffer, all alike, until the mode of its
/// partial sounds at the pitch: that of the string and everything that springs join it to at its
/// rate, with their losses, but for other strings of this kind. By itself an ideal string of
/// impedance Z0 on a body of mobility Y(f) would be flat by about 1200/(pi ln 2) Z0 Im Y cents. A
/// string whose end yields so much that the mode has another shape is left as it was, with a
/// warning.
/// \pre all strings and bodies are tuned by themselves
void tuneCoupledStrings(scene::Scene& scene,
                        const std::vector<CoupledString>& strings,
                        const Rates& rates,
                        std::vector<std::string>& notes);

}  // namespace ergotic::physics
