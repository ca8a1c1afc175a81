// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// What most tests play at.
constexpr physics::Rates kRates{44100.0, 14};

/// Scenes made in code, in SI units: sections "audio" (0) and "gestural" (1).
class SceneBuilder {
 public:
  static constexpr int kAudio = 0;
  static constexpr int kGestural = 1;

  SceneBuilder();

  /// Each gives the index of the new module.
  int mass(double kg, double x = 0.0, double v = 0.0, int section = kAudio);
  int cell(double kg, double k, double z, double x = 0.0, double v = 0.0, int section = kAudio);
  int ground(double x = 0.0, int section = kAudio);
  int slice(int slice_index);
  int driven(int channel);
  /// A point of a grid; its connection is the last one.
  int point(int grid, double along, double across = 0.0);

  /// A tap on modules, which starts where they take it.
  int tap(std::vector<scene::Tap::Share> shares);

  /// Gives the index of the new link.
  int link(scene::LiaType type, int a, int b, double k, double z = 0.0);
  int spring(int a, int b, double k, double z = 0.0) {
    return link(scene::LiaType::kSpringDamper, a, b, k, z);
  }

  /// Fixed ends and `masses` masses between; gives the index of the first fixed end.
  int chain(int masses, double kg, double k, double z = 0.0);

  /// Modules that lie row by row, from `first` on; gives the index of the grid.
  int grid(int first, int columns, int rows = 1);
  /// An input of force; gives its index.
  int push(int mat, int channel = 0);

  void hear(int mat, int channel = 0, scene::Quantity quantity = scene::Quantity::kPosition);
  /// Every coordinate of its section, on channels from this on.
  void hearAxes(int mat,
                int first_channel = 0,
                scene::Quantity quantity = scene::Quantity::kPosition);

  scene::Scene scene;

 private:
  int add(scene::MatType type, double kg, double x, double v, int section);
};

/// Ticks an instrument, made of the settled scene, and keeps every output frame. `positions` is
/// held, or empty for no port.
class Player {
 public:
  explicit Player(std::unique_ptr<physics::Instrument> instrument);
  Player(const scene::Scene& scene,
         const physics::Rates& rates,
         physics::Precision precision = physics::Precision::kDouble)
      : Player(physics::compile(physics::settle(scene, rates).scene, rates, precision)) {}

  void tick();
  void ticks(int count) {
    for (int n = 0; n < count; ++n) {
      tick();
    }
  }

  std::unique_ptr<physics::Instrument> instrument;
  std::vector<double> positions;  ///< [ports] for the next ticks
  std::vector<double> forces;     ///< [ports] of the last tick
  std::vector<double> inputs;     ///< [R][input channels] for the next ticks
  std::array<physics::Touch, physics::kMaxTouches> touches{};  ///< of the next ticks
  std::vector<std::vector<double>> heard;                      ///< [output channels][frames]

 private:
  std::vector<double> outputs_;
};

}  // namespace ergotic::test
