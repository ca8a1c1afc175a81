// SPDX-License-Identifier: BSD-3-Clause
#include <complex>

#include "ergotic/physics/certificate/monodromy.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A string of a wave impedance whose links are at 0.9 of the explicit limit. \return its first mat
int addString(SceneBuilder& b, int masses, double impedance) {
  const double mass = impedance / (std::sqrt(0.9) * kRate);
  return b.chain(masses, mass, 0.9 * mass * kRate * kRate);
}

/// The same eigenvalues, with rows and columns of like size: stiffness in N/m and displacement in m
/// are far apart.
Eigen::MatrixXd balanced(Eigen::MatrixXd matrix) {
  for (bool changed = true; changed;) {
    changed = false;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const double ratio = matrix.row(i).norm() / matrix.col(i).norm();
      const double scale = std::exp2(std::round(0.5 * std::log2(ratio)));
      changed = changed || scale != 1.0;
      matrix.col(i) *= scale;
      matrix.row(i) /= scale;
    }
  }
  return matrix;
}

/// 24 masses without loss, joined for good through a filter to a slow mass.
struct JoinedString : SceneBuilder {
  /// \param share  of the chaplet in the slow mass
  JoinedString(int ratio, double share) : rates{kRate, ratio}, string(addString(*this, 24, 0.3)) {
    scene.lias[at(spring(slow, string + 9, 2000.0))].filtered = true;
    auto light = scene;
    light.mats[at(slow)].mass = scene::Value{1e3};
    kg = findChaplets(settle(light, rates).scene, rates).at(0).chaplet.mass() / share;
    scene.mats[at(slow)].mass = scene::Value{kg};
  }
  /// Gives the slow section modes of its own: that mass and others in a chain to the ground.
  void addSlowModes(int masses, double kappa) {
    const double stiffness = kappa * kg * std::pow(rates.gesturalHz(), 2);
    int last = slow;
    for (int i = 1; i < masses; ++i) {
      const int next = mass(kg, 0.0, 0.0, kGestural);
      spring(last, next, stiffness);
      last = next;
    }
    spring(last, ground(0.0, kGestural), stiffness);
  }
  double radius(bool with_dashpot = true) const {
    Settled settled = settle(scene, rates);
    if (!with_dashpot) {
      settled.scene.lias.back().damping = scene::Value{};
    }
    return spectralRadius(balanced(monodromy(settled.scene, rates)));
  }

  Rates rates;
  int slow = mass(1.0, 0.0, 0.0, kGestural);
  int string;
  double kg = 0.0;
};

TEST(FilteredStringTest, NeverGrowsOnAFreeSlowMass) {
  for (const int ratio : {4, 8, 14, 16, 44}) {
    for (const double share : {1.0 / 20.0, 1.0 / 50.0, 1.0 / 1000.0}) {
      EXPECT_LE(JoinedString(ratio, share).radius() - 1.0, 1e-9) << ratio << " " << share;
    }
  }
}

TEST(FilteredStringTest, NeverGrowsOnSlowModes) {
  for (const int ratio : {4, 8, 14, 16, 44}) {
    for (const double share : {1.0 / 20.0, 1.0 / 50.0}) {
      for (const double kappa : {0.01, 0.1, 0.5, 1.0, 1.86, 2.08, 2.33, 2.61, 2.93, 3.28}) {
        JoinedString b(ratio, share);
        b.addSlowModes(1, kappa);
        EXPECT_LE(b.radius() - 1.0, 1e-9) << ratio << " " << share << " " << kappa;
      }
      for (const double kappa : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        JoinedString b(ratio, share);
        b.addSlowModes(4, kappa);
        EXPECT_LE(b.radius() - 1.0, 1e-9) << ratio << " " << share << " chain " << kappa;
      }
    }
  }
}

TEST(FilteredStringTest, GrowsOnSlowModesWithoutTheSmallDashpot) {
  for (const int ratio : {4, 8, 14, 16, 44}) {
    JoinedString b(ratio, 1.0 / 50.0);
    b.addSlowModes(1, 2.33);
    EXPECT_GE(b.radius(false) - 1.0, 1e-3) << ratio;
  }
}

/// Energy at frequency f0 and energy of everything else, of a settled sound.
struct Split {
  double tone;
  double rest;
  double decibels() const { return 10.0 * std::log10(rest / tone); }
};
Split split(const std::vector<double>& sound, double f0) {
  std::complex<double> sum = 0.0;
  double all = 0.0;
  double weights = 0.0;
  const auto count = static_cast<double>(sound.size());
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const auto n = static_cast<double>(i);
    const double window = 1.0 - std::cos(2.0 * kPi * (n + 0.5) / count);
    sum += window * sound[i] * std::polar(1.0, -2.0 * kPi * f0 * n / kRate);
    weights += window;
  }
  const std::complex<double> amplitude = 2.0 * sum / weights;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const auto n = static_cast<double>(i);
    const double tone = (amplitude * std::polar(1.0, 2.0 * kPi * f0 * n / kRate)).real();
    all += std::pow(sound[i] - tone, 2);
  }
  return {0.5 * count * std::norm(amplitude), all};
}

/// What a string of 0.3 kg/s hears besides f0, dB, where a slice that is moved at f0 < fN and held
/// between the ticks drives it: all of it is above fN.
double imagesOn(int ratio, double f0, bool filtered) {
  SceneBuilder b;
  const int string = addString(b, 100, 0.3);
  for (int i = 1; i <= 100; ++i) {
    scene::Mat& mat = b.scene.mats[at(string + i)];
    mat.type = scene::MatType::kCell;
    mat.damping = scene::Value{5e-4};
  }
  b.scene.lias[at(b.spring(b.slice(0), string + 25, 1e4))].filtered = filtered;
  b.hear(string + 25);
  const Rates rates{kRate, ratio};
  Player player(b.scene, rates);
  const double tick = 1.0 / rates.gesturalHz();
  for (int n = 0; n * tick < 1.0; ++n) {
    player.positions[0] = 1e-3 * std::sin(2.0 * kPi * f0 * n * tick);
    player.tick();
  }
  const std::vector<double>& heard = player.heard[0];
  return split({heard.end() - 11025, heard.end()}, f0).decibels();
}

TEST(FilteredStringTest, HearsThirtyDecibelsLessOfTheSteps) {
  const struct {
    int ratio;
    double f0;
  } rows[] = {{14, 100.0}, {14, 400.0}, {44, 100.0}, {44, 200.0}};
  for (const auto& row : rows) {
    const double bare = imagesOn(row.ratio, row.f0, false);
    const double filtered = imagesOn(row.ratio, row.f0, true);
    RecordProperty("R" + std::to_string(row.ratio) + "_" + std::to_string(row.f0),
                   std::to_string(bare) + " " + std::to_string(filtered));
    EXPECT_LE(filtered, bare - 30.0) << row.ratio << " " << row.f0 << ": " << bare;
    EXPECT_LE(filtered, -30.0) << row.ratio << " " << row.f0;
  }
}

}  // namespace
}  // namespace ergotic::physics
