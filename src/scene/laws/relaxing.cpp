// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/relaxing.hpp"

#include <array>
#include <cmath>

#include "scene/laws/cubic.hpp"
#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

constexpr double kTwoPi = 6.283185307179586;

const Relaxation* relaxation(const LinkInSteps& of, std::size_t r) {
  const std::vector<Relaxation>& all = of.lia.law->relaxations;
  return r < all.size() ? &all[r] : nullptr;
}

template <std::size_t r>
double branchStiffness(const LinkInSteps& of) {
  const Relaxation* const branch = relaxation(of, r);
  return branch == nullptr ? 0.0 : of.scene.valueOf(branch->stiffness);
}
/// Part by which q decays in a step.
template <std::size_t r>
double fading(const LinkInSteps& of) {
  const Relaxation* const branch = relaxation(of, r);
  return branch == nullptr ? 0.0 : -std::expm1(-of.units.step / branch->time);
}
/// Factor by which q follows the elongation in a step.
template <std::size_t r>
double following(const LinkInSteps& of) {
  const Relaxation* const branch = relaxation(of, r);
  return branch == nullptr ? 1.0 : fading<r>(of) * branch->time / of.units.step;
}

/// q <- q - fading q + following v in every step. By the mean of the forces before and after it a
/// step then stores K_r (2 - fading)/(4 following) (q^2 - q_last^2), exactly, and loses
/// K_r fading/(4 following) (q + q_last)^2.
struct Relaxing {
  static constexpr Number kNumbers[] = {number::stiffness,  number::damping, number::offset,
                                        branchStiffness<0>, fading<0>,       following<0>,
                                        branchStiffness<1>, fading<1>,       following<1>,
                                        branchStiffness<2>, fading<2>,       following<2>};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    Real elastic = c(0, l) * (u + c(2, l));
    for (std::size_t r = 0; r < kMaxRelaxations; ++r) {
      const Real stiffness = c(3 + 3 * r, l);
      const Real fading = c(4 + 3 * r, l);
      const Real following = c(5 + 3 * r, l);
      Real& q = c.state[kMaxRelaxations * l + r];
      const Real last = q;
      q += following * v - fading * q;
      elastic += stiffness * q;
      if (c.lost != nullptr) {
        const Real both = q + last;
        *c.lost += static_cast<double>(stiffness * fading / (Real(4) * following) * both * both);
      }
    }
    return {elastic, c(1, l) * v};
  }
};

const char* explicitOnly(const Lia& /*lia*/) {
  return "a link that remembers";
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return relaxingSlopes(scene, lia, 0.0);
}

double leastStiffness(const Scene& scene, const Lia& lia) {
  return rangeOf(scene, lia.stiffness).lowest;
}

constexpr LawWord kWords[] = {
    {"relaxing", "stiffness", "damping rest_length branches loss_factor material"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField()};

/// Logarithms of K_r/(eta K) and of the frequency at which a branch loses most, Hz, by powers of
/// eta: fitted to what the largest deviation is smallest with, for eta up to 0.5.
constexpr struct {
  std::array<double, 3> stiffness;
  std::array<double, 3> frequency;
} kConstantLoss[kMaxRelaxations] = {
    {{0.4964, 0.6296, -0.3916}, {4.715, 0.8373, -0.2502}},
    {{0.2132, 2.305, -0.8829}, {6.796, 0.6413, -0.128}},
    {{0.4939, 4.001, -0.8781}, {8.876, 0.8478, 0.006458}},
};

double exponentialOf(const std::array<double, 3>& powers, double eta) {
  return std::exp(powers[0] + eta * (powers[1] + eta * powers[2]));
}

}  // namespace

std::vector<Relaxation> relaxationsOf(double loss_factor, const Value& stiffness) {
  std::vector<Relaxation> all;
  for (const auto& branch : kConstantLoss) {
    all.push_back({loss_factor * exponentialOf(branch.stiffness, loss_factor) * stiffness,
                   1.0 / (kTwoPi * exponentialOf(branch.frequency, loss_factor))});
  }
  return all;
}

Slopes relaxingSlopes(const Scene& scene, const Lia& lia, double step) {
  Slopes slopes{rangeOf(scene, lia.stiffness), rangeOf(scene, lia.damping)};
  for (const Relaxation& branch : lia.law->relaxations) {
    const double half = 0.5 * step / branch.time;
    slopes.stiffness.highest +=
        rangeOf(scene, branch.stiffness).highest * (half > 0.0 ? std::tanh(half) / half : 1.0);
  }
  return slopes;
}

constexpr Law kRelaxingLaw = {
    {"relaxing spring", kWords, kFields, Law::Tables::kNone, false},
    Law::Kind::kRelaxing,
    explicitForm<Relaxing>(kMaxRelaxations),
    springForms<CubicCurve>,
    explicitOnly,
    true,   // has_linear_part
    false,  // switches
    false,  // is_held
    never,  // canGive
    never,  // givesForEver
    slopes,
    nullptr,  // growth
    nullptr,  // friction
    never,    // onlyBrakes
    leastStiffness,
};

}  // namespace ergotic::scene
