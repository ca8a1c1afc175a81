// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include "scene/generate/scene_builder.hpp"

/// What the scenes of `bench` are made of: masses of a gram at 44.1 kHz.
namespace ergotic::tools {

/// The same numbers everywhere, as those of the standard library's distributions are not.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  /// minimum <= x < maximum
  double number(double minimum, double maximum) {
    return minimum + (maximum - minimum) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  int below(int count) { return static_cast<int>(number(0.0, count)); }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[static_cast<std::size_t>(below(static_cast<int>(i)))]);
    }
  }

 private:
  std::mt19937 engine_;
};

constexpr double kBenchRateHz = 44100.0;
constexpr double kBenchMass = 1e-3;  // kg
/// Stiffness, N/m, of a link with h^2 K/M = kappa.
scene::Value benchStiffness(double kappa);
/// Damping of every link, N s/m: so little that nothing fades during a measurement.
scene::Value benchDamping();

/// A scene with one section at the audio rate.
scene::SceneBuilder benchBuilder(const char* name,
                                 scene::Geometry geometry = scene::Geometry::kScalar);

/// A mass, or a ground, where it rests. \return its index
int addModule(scene::SceneBuilder& builder,
              const Eigen::Vector3d& rest,
              bool moves,
              int section = 0);
void addSpring(scene::SceneBuilder& builder, int a, int b, const scene::Value& stiffness);
/// Keeps `upper` above `lower`.
void addContact(scene::SceneBuilder& builder, int lower, int upper, const scene::Value& stiffness);

/// Rows and columns of a net, with as many modules as near as can be. `count` grows with both.
struct Size {
  int rows = 0;
  int columns = 0;
};
template <class Count>
Size sizeFor(int modules, int least, const Count& count) {
  Size size{least, least};
  while (count(size.rows + 1, size.rows + 1) <= modules) {
    ++size.rows;
  }
  size.columns = size.rows;
  while (count(size.rows, size.columns + 1) <= modules) {
    ++size.columns;
  }
  const auto miss = [&](int columns) {
    const int difference = count(size.rows, columns) - modules;
    return difference < 0 ? -difference : difference;
  };
  size.columns += miss(size.columns + 1) < miss(size.columns) ? 1 : 0;
  return size;
}

/// Gives every mass and link coefficients of its own, from 85 to 115 % of what they are.
void scatterCoefficients(scene::Scene& scene, Dice& dice);

/// Gives every mass a velocity; the momentum of all is 0.
void stir(scene::Scene& scene, Dice& dice);

/// Points of a jittered lattice between fixed edges, joined to triangles with one diagonal of each
/// cell or the other, in an order of a file rather than of the lattice: shuffled, then breadth
/// first from one of them. Every link and mass has coefficients of its own.
void addTriangulation(scene::SceneBuilder& builder, int modules, Dice& dice);

/// As many links as twice the masses, between any two.
void addRandomGraph(scene::SceneBuilder& builder, int modules, Dice& dice);

/// A cubic lattice with links along its three axes, one corner of which is fixed.
void addCube(scene::SceneBuilder& builder, int modules);

}  // namespace ergotic::tools
