// SPDX-License-Identifier: BSD-3-Clause
// Sections of many divisors beside one another, against their equations.
#include <algorithm>
#include <utility>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// Masses one after the other, each stepped at its own rate, joined by springs and dampers that
/// are stepped at the faster of their two rates. Written out from the equations alone.
class Row {
 public:
  Row(std::vector<int> divisors, double kappa, double zeta)
      : divisors_(std::move(divisors)), kappa_(kappa), zeta_(zeta) {
    const std::size_t n = divisors_.size();
    x_.assign(n, 0.0);
    d_.assign(n, 0.0);
    force_.assign(n, 0.0);
    x_[0] = 1.0;
  }
  const std::vector<double>& frame() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (isDue(i)) {
        const double step = divisors_[i];
        d_[i] += step * step * force_[i];
        x_[i] += d_[i];
        force_[i] = 0.0;
      }
    }
    for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
      stepLink(i, i + 1);
    }
    stepLink(0, 0);  // the first one is held by a spring of its own rate
    ++now_;
    return x_;
  }

 private:
  bool isDue(std::size_t i) const { return now_ % divisors_[i] == 0; }
  double slip(std::size_t i, int step) const { return isDue(i) ? d_[i] / step : 0.0; }
  void stepLink(std::size_t a, std::size_t b) {
    const int step = std::min(divisors_[a], divisors_[b]);
    if (now_ % step != 0) {
      return;
    }
    if (a == b) {
      force_[a] -= kappa_ * x_[a] + zeta_ * slip(a, step);
      return;
    }
    const double f = kappa_ * (x_[a] - x_[b]) + zeta_ * (slip(a, step) - slip(b, step));
    force_[a] -= f * step / divisors_[a];
    force_[b] += f * step / divisors_[b];
  }

  std::vector<int> divisors_;
  double kappa_;
  double zeta_;
  int now_ = 0;
  std::vector<double> x_;
  std::vector<double> d_;
  std::vector<double> force_;
};

// The tick is 14 frames: divisors below, of and above it; of two neighbours one divides the other.
const std::vector<int> kDivisors{56, 28, 14, 1, 7, 1, 2, 1, 28};

/// The same row as a scene, with a section for every divisor.
SceneBuilder rowScene(double kappa, double zeta) {
  SceneBuilder b;
  b.scene.sections.clear();
  std::vector<int> section_of(57, -1);
  for (const int divisor : kDivisors) {
    if (section_of[at(divisor)] < 0) {
      section_of[at(divisor)] = static_cast<int>(b.scene.sections.size());
      scene::Section section;
      section.name = "every" + std::to_string(divisor);
      section.divisor = divisor;
      b.scene.sections.push_back(section);
    }
  }
  const double k = kappa * kRate * kRate;
  for (std::size_t i = 0; i < kDivisors.size(); ++i) {
    const int m = b.mass(1.0, i == 0 ? 1.0 : 0.0, 0.0, section_of[at(kDivisors[i])]);
    b.hear(m, m);
    if (i > 0) {
      b.spring(m - 1, m, k, zeta * kRate);
    }
  }
  b.spring(0, b.ground(0.0, section_of[at(kDivisors[0])]), k, zeta * kRate);
  return b;
}

TEST(ManyRatesTest, SectionsOfManyDivisorsMoveAsTheirEquationsSay) {
  Player player(rowScene(2e-4, 1e-4).scene, {kRate, 14});
  Row row(kDivisors, 2e-4, 1e-4);
  player.ticks(200);
  for (int n = 0; n < 2800; ++n) {
    const std::vector<double>& expected = row.frame();
    for (std::size_t i = 0; i < kDivisors.size(); ++i) {
      ASSERT_NEAR(player.heard[i][at(n)], expected[i], 1e-12) << "mass " << i << ", frame " << n;
    }
  }
  EXPECT_GT(std::abs(player.heard.back().back()), 1e-3) << "it came through to the last one";
}

TEST(ManyRatesTest, EnergyBalancesAtEveryTickWhateverStepsAreUnderWay) {
  Player player(rowScene(2e-4, 1e-4).scene, {kRate, 14});
  for (int n = 0; n < 400; ++n) {
    player.tick();
    const Energies energies = energiesOf(player);
    ASSERT_LT(std::abs(energies.residual), 1e-12 * energies.stored) << n;
  }
  EXPECT_LT(energiesOf(player).stored, 0.9 * 2e-4 * kRate * kRate) << "some was dissipated";
}

TEST(ManyRatesTest, LinkBetweenDivisorsThatDoNotDivideEachOtherIsRefused) {
  SceneBuilder b;
  b.scene.sections[0].divisor = 2;
  b.scene.sections[1].gestural = false;
  b.scene.sections[1].divisor = 7;
  b.spring(b.mass(1.0), b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural), 1.0);
  EXPECT_THAT(complaintOf([&] {
                compile(b.scene, {kRate, 14}, Precision::kDouble);
              }),
              AllOf(HasSubstr("'l0'"), HasSubstr("2 and 7")));
}

}  // namespace
}  // namespace ergotic::physics
