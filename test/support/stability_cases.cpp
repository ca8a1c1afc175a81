// SPDX-License-Identifier: BSD-3-Clause
#include "support/stability_cases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/scene_builder.hpp"
#include "support/wrong_coupling.hpp"

namespace ergotic::test {
namespace {

using physics::Energies;
using physics::Rates;
using scene::LiaType;
using scene::Scheme;
using Builder = SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kFar = 1e6;  // of growth: nobody need go on
constexpr double kMass = 1e-3;
constexpr double kUnit = kMass * kRate * kRate;  // stiffness of kappa = 1
constexpr const char* kNotOffered = "not offered";

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// What of the energy must not change, besides the balance of the books.
enum class Closed {
  kNo,   ///< loses energy, or a step apart from it is no measure (couplings, steep friction)
  kYes,  ///< no more may ever be stored than at the start
};

/// Largest kinetic energy and largest error so far.
class Witness {
 public:
  /// \param start  kinetic energy at the start, J
  Witness(const physics::Instrument& instrument, Closed closed, double start)
      : instrument_(instrument),
        closed_(closed),
        energies_(instrument.makeEnergies()),
        start_(start) {}

  /// \param outside  energy of what the instrument does not know of
  void look(double outside = 0.0) {
    instrument_.readEnergies(energies_);
    double kinetic = outside;
    for (const physics::SectionEnergy& section : energies_.sections) {
      kinetic += std::abs(section.kinetic);
    }
    // A number that is none compares false with everything.
    growth_ = kinetic / start_ <= kFar ? std::max(growth_, kinetic / start_) : kFar;
    error_ = std::max(error_, std::abs(energies_.residual) / start_);
    stored_ = is_first_ ? energies_.stored : stored_;
    is_first_ = false;
    if (closed_ == Closed::kYes) {
      error_ = std::max(error_, (energies_.stored - stored_) / start_);
    }
  }
  bool isFar() const { return growth_ >= kFar; }
  void giveTo(StabilityOutcome& outcome) const {
    outcome.growth = growth_;
    outcome.energy_error = error_;
  }

 private:
  const physics::Instrument& instrument_;
  Closed closed_;
  Energies energies_;
  double start_;
  bool is_first_ = true;
  double stored_ = 0.0;  // after the first tick
  double growth_ = 0.0;
  double error_ = 0.0;
};

double kineticEnergyAtStart(const scene::Scene& scene) {
  double energy = 0.0;
  for (const scene::Mat& mat : scene.mats) {
    energy += 0.5 * mat.mass.factor * mat.push->velocity.squaredNorm();
  }
  return energy;
}

struct Performance {
  StabilityOutcome outcome;
  Player player;
};

/// Judges a scene and makes it ready to play.
Performance prepare(const scene::Scene& scene, const Rates& rates) {
  const physics::Settled settled = physics::settle(scene, rates);
  const physics::Certificate certificate = physics::certify(settled.scene, rates);
  StabilityOutcome outcome;
  outcome.verdict = toString(certificate.verdict);
  for (const std::string& finding : certificate.findings) {
    outcome.findings += finding + "\n";
  }
  return {outcome, Player(physics::compile(settled.scene, rates, physics::Precision::kDouble))};
}

StabilityOutcome play(const Builder& builder,
                      const Rates& rates,
                      int ticks,
                      Closed closed = Closed::kYes) {
  Performance performance = prepare(builder.scene, rates);
  Player& player = performance.player;
  Witness witness(*player.instrument, closed, kineticEnergyAtStart(builder.scene));
  for (int n = 0; n < ticks && !witness.isFar(); ++n) {
    player.tick();
    witness.look();
  }
  witness.giveTo(performance.outcome);
  return performance.outcome;
}

/// The same at a rate a tenth above what the certificate asks for: close to it, kinetic energy is
/// up to 1/(1 - lambda/4) of what there was.
StabilityOutcome playAtStableRate(const Builder& builder, int ticks, Closed closed = Closed::kYes) {
  const physics::Certificate refused = physics::certify(builder.scene, {kRate, 1});
  return play(builder, {1.1 * refused.sections[0].stable_rate_hz, 1}, ticks, closed);
}

/// A string, struck in its middle. `kappa`, `zeta`: of its links.
Builder string(int masses, double kappa, double zeta, double speed = 1.0) {
  Builder b;
  const int first = b.chain(masses, kMass, kappa * kUnit, zeta * kMass * kRate);
  b.scene.mats[at(first + 1 + masses / 2)].push.edit().velocity.x() = speed;
  return b;
}

/// A net in space, all around fixed; struck aslant. `rest`: rest length of its springs, in meshes.
Builder net(int side, double kappa, double rest = 0.0, Scheme scheme = Scheme::kExplicit) {
  Builder b;
  const double mesh = 1e-3;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  const auto index = [side](int i, int j) { return j * side + i; };
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const bool rim = i == 0 || j == 0 || i == side - 1 || j == side - 1;
      const int m = rim ? b.ground() : b.mass(kMass);
      scene::Mat& mat = b.scene.mats[at(m)];
      mat.rest = mat.position = {mesh * i, mesh * j, 0.0};
    }
  }
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      for (const auto& [ni, nj] : {std::pair(i + 1, j), std::pair(i, j + 1)}) {
        if (ni < side && nj < side) {
          b.spring(index(i, j), index(ni, nj), kappa * kUnit);
          b.scene.lias.back().rest_length = rest * mesh;
          b.scene.lias.back().scheme = scheme;
        }
      }
    }
  }
  b.scene.mats[at(index(side / 2, side / 2))].push.edit().velocity = {20.0, 40.0, 100.0};
  return b;
}

/// A string over a barrier that is as long, or hard contacts all along it.
Builder stringOnBarrier(LiaType type, double kappa_contact, Scheme scheme) {
  Builder b = string(100, 0.9, 0.0, 10.0);
  const int barrier = b.ground(-1e-5);
  for (int m = 1; m <= 100; ++m) {
    scene::Lia& lia = b.scene.lias[at(b.link(type, barrier, m, kappa_contact * kUnit))];
    lia.law.edit().exponent = {type == LiaType::kPowerContact ? 1.5 : 1.0};
    // The slope of the power law is as steep at an overlap of 0.1 mm.
    lia.stiffness.factor *= type == LiaType::kPowerContact ? 1.0 / (1.5 * std::sqrt(1e-4)) : 1.0;
    lia.scheme = scheme;
  }
  return b;
}

/// 64 masses on hardening springs; every third one is struck as if to go a centimetre per step,
/// where the slope of a spring is `kappa_far`.
Builder cubicChain(double kappa_far, Scheme scheme) {
  Builder b = string(64, 0.25, 0.0, 0.0);
  const double far = 1e-2;
  for (scene::Lia& lia : b.scene.lias) {
    lia.type = LiaType::kCubic;
    lia.law.edit().nonlinearity = {kappa_far * kUnit / (3.0 * far * far)};
    lia.scheme = scheme;
  }
  for (int m = 1; m <= 64; m += 3) {
    b.scene.mats[at(m)].push.edit().velocity.x() = far * kRate;
  }
  return b;
}

/// A mass that slips a little against a bow at rest. `steepness`: h F'/M at no slip.
Builder rubbedMass(LiaType type, double steepness, Scheme scheme) {
  Builder b;
  const int m = b.mass(kMass, 0.0, 1e-6);
  const double initial = type == LiaType::kBow ? 2.0 / 3.0 : 0.63 * std::exp(0.5);
  const int l = b.link(type, b.ground(), m, 0.0, steepness * kMass * kRate / initial);
  b.scene.lias[at(l)].law.edit().width = {0.1};
  b.scene.lias[at(l)].scheme = scheme;
  return b;
}

Builder joinedScene(const JoinedMass& joined) {
  Builder b;
  const int first = b.chain(joined.masses, kMass, joined.string_kappa * kUnit);
  const double kg = joined.slow_mass * kMass;
  const int slow = b.mass(kg, 0.0, 1.0, Builder::kGestural);
  b.spring(slow, b.ground(0.0, Builder::kGestural),
           joined.slow_kappa * kg * std::pow(kRate / joined.ratio, 2));
  b.spring(slow, first + 1 + joined.at, joined.coupling * kUnit);
  return b;
}

/// The figures of a device (0.3 kg, 2 N s/m) on a wall, in multiples of the passivity limit.
/// Its force is given one tick late and held; between ticks it moves exactly.
StabilityOutcome pushWall(double multiple) {
  const Rates rates{kRate, 14};
  const double t = rates.ratio / rates.audio_hz;
  const double mass = 0.3;
  const double damping = physics::DeviceTraits{}.damping;
  const double decay = std::exp(-damping / mass * t);
  const double glide = mass / damping * (1.0 - decay);  // way of a unit of speed over a tick
  const double wall = multiple * 2.0 * damping / (3.0 * t);
  Builder b;
  const int slice = b.slice(0);
  b.spring(slice, b.ground(0.0, Builder::kGestural), wall);
  Performance performance = prepare(b.scene, rates);
  Player& player = performance.player;
  double x = 0.0;
  double v = 1.0;
  Witness witness(*player.instrument, Closed::kNo, 0.5 * mass * v * v);
  for (int n = 0; n < 20000 && !witness.isFar(); ++n) {
    const double force = n > 0 ? player.forces[0] : 0.0;
    player.positions[0] = x;
    player.tick();
    witness.look(0.5 * mass * v * v);
    x += glide * v + (t - glide) * force / damping;
    v = decay * v + (1.0 - decay) * force / damping;
  }
  witness.giveTo(performance.outcome);
  return performance.outcome;
}

StabilityOutcome wrongly(Joining joining, int ratio) {
  StabilityOutcome outcome;
  outcome.verdict = kNotOffered;
  outcome.growth = joinedMass(ratio, joining).growth(60000);
  return outcome;
}

StabilityOutcome joinedPlainly(int ratio) {
  return play(joinedScene(joinedMass(ratio)), {kRate, ratio}, 60000, Closed::kNo);
}

/// With a chaplet, and every mass of the string loses that share of its momentum per step.
StabilityOutcome joinedThroughChaplet(int ratio, double loss) {
  Builder b = joinedScene(joinedMass(ratio));
  b.scene.lias.back().filtered = true;
  b.scene.sections[Builder::kAudio].medium = {loss * kMass * kRate};
  return play(b, {kRate, ratio}, 20000, Closed::kNo);
}

StabilityOutcome joinedAtOneRate(int ratio) {
  Builder b = joinedScene(joinedMass(ratio));
  for (scene::Mat& mat : b.scene.mats) {
    mat.section = Builder::kAudio;
  }
  return play(b, {kRate, ratio}, 20000);
}

using Cases = std::vector<StabilityCase>;

void addLimits(Cases& cases) {
  const std::string stiff = "stiffness 1 % over the limit";
  const std::string damped = "damping 1 % over the limit";
  const std::string spatial = "net in space 1 % over the limit";
  const auto stiffString = [] { return string(30, 1.013, 0.0); };
  const auto dampedString = [] { return string(30, 0.3, 0.356); };
  const auto stiffNet = [] { return net(9, 0.53); };
  cases.push_back({stiff, "explicit", false, "unstable", "too stiff or too damped", [=] {
                     return play(stiffString(), {kRate, 1}, 20000);
                   }});
  cases.push_back({stiff, "at the certified rate", true, "passive", "",
                   [=] { return playAtStableRate(stiffString(), 20000); }});
  cases.push_back({damped, "explicit", false, "unstable", "too stiff or too damped", [=] {
                     return play(dampedString(), {kRate, 1}, 20000);
                   }});
  cases.push_back({damped, "at the certified rate", true, "passive", "",
                   [=] { return playAtStableRate(dampedString(), 20000); }});
  cases.push_back({spatial, "explicit", false, "unstable", "too stiff or too damped", [=] {
                     return play(stiffNet(), {kRate, 1}, 20000, Closed::kNo);
                   }});
  cases.push_back({spatial, "at the certified rate", true, "passive", "",
                   [=] { return playAtStableRate(stiffNet(), 20000, Closed::kNo); }});
  const std::string thrown = "net in space thrown about by more than its meshes";
  cases.push_back({thrown, "explicit", false, "unproven", "a line that turns", [=] {
                     return play(net(9, 0.4, 0.9), {kRate, 1}, 20000, Closed::kNo);
                   }});
  cases.push_back({thrown, "guarded", true, "passive", "", [=] {
                     return play(net(9, 0.4, 0.9, Scheme::kGuarded), {kRate, 1}, 20000);
                   }});
}

void addRates(Cases& cases) {
  for (const int ratio : {2, 14, 44}) {
    const std::string stress = "two rates, " + std::to_string(ratio) + " to 1";
    for (const auto& [name, joining] : {std::pair("decimate + hold", Joining::kDecimateHold),
                                        std::pair("hold + last force", Joining::kHoldLast),
                                        std::pair("hold + sum", Joining::kHoldSum)}) {
      cases.push_back({stress, name, false, kNotOffered, "",
                       [=, how = joining] { return wrongly(how, ratio); }});
    }
    cases.push_back({stress, "no chaplet", false, ratio == 2 ? "unstable" : "unproven", "grows",
                     [=] { return joinedPlainly(ratio); }});
    cases.push_back({stress, "all at the audio rate", true, "passive", "",
                     [=] { return joinedAtOneRate(ratio); }});
    if (ratio >= 4) {  // C2 needs that
      cases.push_back({stress, "chaplet + loss", true, "passive", "",
                       [=] { return joinedThroughChaplet(ratio, 1e-4); }});
    }
  }
}

void addNonlinear(Cases& cases) {
  const auto both = [&](const std::string& stress, const std::string& verdict,
                        const std::string& finding, auto make) {
    cases.push_back({stress, "explicit", false, verdict, finding, [=] {
                       return play(make(Scheme::kExplicit), {kRate, 1}, 40000);
                     }});
    cases.push_back({stress, "guarded", true, "passive", "", [=] {
                       return play(make(Scheme::kAuto), {kRate, 1}, 40000);
                     }});
  };
  both("string on a barrier, kappa 30", "unstable", "switches its stiffness",
       [](Scheme scheme) { return stringOnBarrier(LiaType::kContact, 30.0, scheme); });
  both("string on a barrier, power 1.5", "unproven", "grows with its amplitude",
       [](Scheme scheme) { return stringOnBarrier(LiaType::kPowerContact, 30.0, scheme); });
  both("cubic chain at large amplitude", "unproven", "grows with its amplitude",
       [](Scheme scheme) { return cubicChain(10.0, scheme); });
}

void addFriction(Cases& cases) {
  const auto both = [&](const std::string& stress, LiaType type, double steepness) {
    for (const bool is_safe : {false, true}) {
      cases.push_back(
          {stress, is_safe ? "guarded" : "explicit", is_safe, is_safe ? "bounded" : "unstable",
           is_safe ? "" : "steep for the step", [=] {
             const Scheme scheme = is_safe ? Scheme::kAuto : Scheme::kExplicit;
             return play(rubbedMass(type, steepness, scheme), {kRate, 1}, 40000, Closed::kNo);
           }});
    }
  };
  both("bow, h F'/M = 2.5", LiaType::kBow, 2.5);
  both("smooth bow, h F'/M = 4", LiaType::kSmoothBow, 4.0);
}

void addWalls(Cases& cases) {
  const std::string stress = "wall over the passivity limit";
  cases.push_back({stress, "2.2 x the limit", false, "unproven", "it will buzz or jump",
                   [] { return pushWall(2.2); }});
  cases.push_back({stress, "0.45 x the limit", true, "passive", "", [] { return pushWall(0.45); }});
}

Cases allCases() {
  Cases cases;
  addLimits(cases);
  addRates(cases);
  addNonlinear(cases);
  addFriction(cases);
  addWalls(cases);
  return cases;
}

}  // namespace

const std::vector<StabilityCase>& stabilityCases() {
  static const Cases kCases = allCases();
  return kCases;
}

}  // namespace ergotic::test
