// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <string>

/// Numbers of a scene, what may change them, and where they stand in its text.
namespace ergotic::scene {

/// Position in a text, for messages; line and column count from 1.
struct Place {
  int line = 0;
  int column = 0;
  int origin = 0;  ///< 0: the scene's own text; else what Scene::origins[origin - 1] says
};

/// Another text that parts of a scene were written out from.
struct Origin {
  std::string file;
  std::string chain;  ///< lines for messages: the instance that it is in, and where that is used
};

/// A number of the scene: `factor`, or `factor` times a parameter or the sample of an audio input.
struct Value {
  double factor = 0.0;
  int parameter = -1;  ///< index in Scene::parameters, -1: none
  int audio = -1;      ///< index in Scene::audio_parameters, -1: none
};
inline Value operator*(double k, const Value& v) {
  return {k * v.factor, v.parameter, v.audio};
}

/// A number that may change while playing. Only these can.
struct Parameter {
  std::string name;
  double value = 0.0;
  double minimum = 0.0;
  double maximum = 0.0;
  std::string unit;  ///< SI, for readers; empty: not said
  Place place{};
};

/// A number that follows an audio input from sample to sample (`.mdl` audioParam). Only places on
/// strings and meshes have a range, so nothing is proven of what else it moves: masses, stiffness,
/// damping, nonlinearity and widths.
struct AudioParameter {
  std::string name;
  int channel = 0;     ///< audio channel, from 0
  double value = 0.0;  ///< value at the present sample
  Place place;
  double scale = 1.0;  ///< factor of the sample
  double offset = 0.0;
  double minimum = -std::numeric_limits<double>::infinity();  ///< range of the value
  double maximum = std::numeric_limits<double>::infinity();
  double at(double sample) const noexcept {
    return std::clamp(offset + scale * sample, minimum, maximum);
  }
};

}  // namespace ergotic::scene
