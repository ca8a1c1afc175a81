// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

/// A scene: what the instrument is made of, before any rate or precision is chosen.
///
/// Plain data. Everything is in SI units when `Scene::time_unit_s` is 1. Scenes read from `.mdl`
/// files count time in samples of 44.1 kHz instead (`time_unit_s = 1 / 44100`): a stiffness is then
/// in kg/sample^2, a velocity in m/sample. `compile` turns both into steps of the rate it is asked
/// for, so that either kind keeps its pitch at any rate.
///
/// Motion is along the x axis of a section (1D). A module rests at (rest_x, y, z) of its section's
/// frame; the y-z plane is the workbench, on which only the picture depends.
namespace ergotic::scene {

/// Where in a text something was said, for messages; line and column count from 1.
struct Place {
  int line = 0;
  int column = 0;
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
  Place place;
};

/// A number that follows an audio input from sample to sample (`.mdl` audioParam). It has no range,
/// so nothing is proven of what it moves. Only stiffness, damping and nonlinearity may follow one.
struct AudioParameter {
  std::string name;
  int channel = 0;     ///< audio channel, from 0
  double value = 0.0;  ///< the present sample
  Place place;
};

/// Modules that are stepped together, at one rate, in one frame.
struct Section {
  std::string name;
  bool gestural = false;  ///< stepped once per tick; otherwise `divisor` holds
  int divisor = 1;        ///< audio frames per step, 1: the audio rate
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< section frame in frame `model`
  double gravity = 0.0;                                    ///< acceleration along x, m/time_unit^2
  Place place;
};

enum class MatType {
  kMass,    ///< (MAS) free inertia
  kGround,  ///< (SOL) fixed point
  kCell,    ///< (CEL) mass with a spring and a damper to x = 0 of its section's plane
  kDriven,  ///< its position is an input (`.mdl` posInput)
  kSlice,   ///< a device slice: its position is the hand's, its force is felt by the hand
};

/// (MAT) A material point: takes a force, gives a position.
struct Mat {
  std::string name;
  MatType type = MatType::kMass;
  int section = 0;
  Value mass{1.0};        ///< kg, > 0; mass and cell
  Value stiffness{};      ///< kg/time_unit^2, cell only
  Value damping{};        ///< kg/time_unit, cell only
  double force = 0.0;     ///< constant force along x (kg m/time_unit^2)
  double rest_x = 0.0;    ///< m; displacements are stored and displayed from here
  double y = 0.0;         ///< m, place on the workbench
  double z = 0.0;         ///< m
  double position = 0.0;  ///< m, absolute along x (not from rest_x), at the start
  double velocity = 0.0;  ///< m/time_unit at the start
  Place place;
};

enum class LiaType {
  kSpringDamper,  ///< (RES, FRO, REF) f = K e + Z v
  kContact,       ///< (BUT) f = K e + Z v while x_b - x_a < threshold, e = x_a - x_b + threshold
  kQuadratic,     ///< f = K e + Q sgn(e) e^2 + Z v
  kCubic,         ///< f = K e + Q e^3 + Z v
  kClippedCubic,  ///< cubic up to the tipping point, slope K_limit beyond
  kCubicContact,  ///< the clipped cubic law, gated like a contact
  kPluck,         ///< plectrum, or a table force(e) when `table` is given
  kBow,           ///< piecewise linear friction, or a table force(v) when `table` is given
  kSmoothBow,     ///< f = 0.63 Z v exp(-4 (v/width)^2 + 0.5)
};

/// (LIA) An interaction: takes two positions, gives one force, -f to `a` and +f to `b`,
/// with e = x_a - x_b - rest_length and v = v_a - v_b.
/// The laws are written out in docs/physics.md.
struct Lia {
  std::string name;
  LiaType type = LiaType::kSpringDamper;
  int a = 0;  ///< index in Scene::mats
  int b = 0;
  Value stiffness{};        ///< K, kg/time_unit^2
  Value damping{};          ///< Z, kg/time_unit
  Value nonlinearity{};     ///< Q, kg/(m time_unit^2) or kg/(m^2 time_unit^2)
  Value stiffness_limit{};  ///< K_limit, kg/time_unit^2
  Value limit_damping{};    ///< extra damping beyond the tipping point, kg/time_unit
  /// Contacts: threshold, m. Pluck: width of the plectrum, m. Bow: width of the friction curve,
  /// m/time_unit.
  Value width{};
  /// Clipped cubic laws: |e| at which the slope K_limit takes over, m. `.mdl` files mean
  /// sqrt(K_limit - K) / Q, YAML sqrt((K_limit - K) / Q), where the force is continuous.
  double tipping_point = 0.0;
  double rest_length = 0.0;  ///< m, along x; not for contacts
  /// Points of a force law, sorted by the first: (e, force) for a pluck, (v, force) for a bow;
  /// straight lines between, 0 outside.
  std::vector<std::pair<double, double>> table;
  Place place;
};

/// A slice of the device that is a module of the scene. Model and hand may be scaled:
/// x_model = (x_hand - offset) / position_scale, F_hand = force_scale * F_model.
struct Port {
  std::string name;
  int mat = 0;          ///< a kSlice
  int slice = 0;        ///< slice of the device, from 0
  double offset = 0.0;  ///< m
  double position_scale = 1.0;
  double force_scale = 1.0;
  Place place;
};

enum class Quantity { kPosition, kVelocity, kForce };

/// A point of a line of modules: (1 - fraction) of `mat` and fraction of `next`.
struct Point {
  int mat = 0;
  int next = -1;  ///< -1: `mat` alone
  double fraction = 0.0;
};

/// An audio-rate input: position of a kDriven, or force on any other module.
struct Input {
  std::string name;
  Quantity quantity = Quantity::kForce;
  int mat = 0;
  int channel = 0;  ///< audio channel, from 0
  Value gain{1.0};  ///< m or kg m/time_unit^2 per unit of the channel
  Place place;
};

/// An audio-rate output. Force is the sum of the forces of all links on the module.
struct Output {
  std::string name;
  Quantity quantity = Quantity::kPosition;
  Point point;
  int channel = 0;  ///< audio channel, from 0; outputs on one channel add up
  Value gain{1.0};  ///< per m, m/time_unit or kg m/time_unit^2
  Place place;
};

/// A generated string: what its closed-form pitch is computed from, and how it is named.
struct StringInfo {
  std::string name;
  int first = 0;    ///< index of the first mat (an end point)
  int count = 0;    ///< mats, both fixed ends included
  Value mass;       ///< of one mass, kg
  Value stiffness;  ///< of one link
  Value damping;    ///< of one link
  Value loss;       ///< of one mass to the ground
};

/// A whole scene.
/// \invariant after `validate`: every index is legal, names are unique, masses are positive.
struct Scene {
  std::string name;
  std::string file;                  ///< where it came from, for messages
  std::string text;                  ///< the source text, kept with every recording
  double time_unit_s = 1.0;          ///< see the top of this file
  double gestural_rate_hz = 3000.0;  ///< wanted; the real one is the audio rate over an integer
  std::vector<Parameter> parameters;
  std::vector<AudioParameter> audio_parameters;
  std::vector<Section> sections;
  std::vector<Mat> mats;
  std::vector<Lia> lias;
  std::vector<Port> ports;
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<StringInfo> strings;
  std::vector<std::string> warnings;  ///< from reading, `file:line:col: warning: ...`

  double valueOf(const Value& v) const {
    if (v.audio >= 0) {
      return v.factor * audio_parameters[static_cast<std::size_t>(v.audio)].value;
    }
    return v.parameter < 0 ? v.factor
                           : v.factor * parameters[static_cast<std::size_t>(v.parameter)].value;
  }
  /// 1 + the highest channel, 0 if there is none.
  int inputChannels() const;
  int outputChannels() const;
};

/// Checks every rule that does not depend on how the scene was written.
/// \throws TextError with the place of the first offence, its value and the allowed range
void validate(const Scene& scene);

}  // namespace ergotic::scene
