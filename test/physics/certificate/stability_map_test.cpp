// SPDX-License-Identifier: BSD-3-Clause
// Methods against stresses. With ERGOTIC_STABILITY_MAP=FILE each cell also becomes a line of FILE:
// lab/scripts/plot_stability_map draws it.
#include <optional>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// What became of a method under a stress.
struct StabilityOutcome {
  std::string verdict;        ///< of the certificate, before anything moved
  std::string findings;       ///< of the certificate
  double growth = 0.0;        ///< largest kinetic and potential energy, of that at the start
  double energy_error = 0.0;  ///< what the energy balance lacks, of the energy at the start
};

/// One cell of the map: a method that is played against a stress.
struct StabilityCase {
  std::string stress;
  std::string method;
  bool is_safe = false;
  std::string verdict;  ///< that must be foretold
  std::string finding;  ///< part of a finding that must be among those foretold
  std::function<StabilityOutcome(Precision)> run;
  std::function<double()> tightness = {};  ///< see tightnessOf; none: not measured
};

constexpr double kTightnessStep = 1e-4;  // of a rate
constexpr double kFar = 1e6;             // of growth: nobody need go on
constexpr double kMass = 1e-3;
constexpr double kUnit = kMass * kRate * kRate;  // stiffness of kappa = 1

/// What of the energy must not change, besides the balance of the energy accounts.
enum class Closed {
  kNo,   ///< loses energy, or a step apart from it is no measure (couplings, steep friction)
  kYes,  ///< no more may ever be stored than at the start
};

/// Largest energy and largest error so far.
class Witness {
 public:
  /// \param start  kinetic energy at the start, J; all there is
  Witness(const Instrument& instrument, Closed closed, double start, StabilityOutcome& outcome)
      : instrument_(instrument),
        swing_(instrument),
        closed_(closed),
        energies_(instrument.makeEnergies()),
        start_(start),
        outcome_(outcome) {}

  /// \param outside  energy of what the instrument does not know of
  void look(double outside = 0.0) {
    instrument_.readEnergies(energies_);
    const double energy = outside + (instrument_.options().precision == Precision::kDouble
                                         ? swing_.energyOf(instrument_, energies_)
                                         : kinetic());
    // A number that is none compares false with everything.
    outcome_.growth = energy / start_ <= kFar ? std::max(outcome_.growth, energy / start_) : kFar;
    stored_ = stored_.value_or(energies_.stored);
    const double made = closed_ == Closed::kYes ? energies_.stored - *stored_ : 0.0;
    outcome_.energy_error =
        std::max({outcome_.energy_error, std::abs(energies_.residual) / start_, made / start_});
  }
  bool isFar() const { return outcome_.growth >= kFar; }

 private:
  /// All that is looked at in single precision.
  double kinetic() const {
    double sum = 0.0;
    for (const SectionEnergy& section : energies_.sections) {
      sum += std::abs(section.kinetic);
    }
    return sum;
  }

  const Instrument& instrument_;
  test::Swing swing_;
  Closed closed_;
  Energies energies_;
  double start_;
  StabilityOutcome& outcome_;
  std::optional<double> stored_;  // after the first tick
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
Performance prepare(const scene::Scene& scene, const Rates& rates, Precision precision) {
  const Settled settled = settle(scene, rates);
  const Certificate certificate = certify(settled.scene, rates);
  return {{toString(certificate.verdict), testing::PrintToString(certificate.findings), 0.0, 0.0},
          Player(compile(settled.scene, rates, precision))};
}

StabilityOutcome play(const SceneBuilder& builder,
                      const Rates& rates,
                      int ticks,
                      Precision precision,
                      Closed closed = Closed::kYes) {
  Performance performance = prepare(builder.scene, rates, precision);
  Player& player = performance.player;
  Witness witness(*player.instrument, closed, kineticEnergyAtStart(builder.scene),
                  performance.outcome);
  for (int n = 0; n < ticks && !witness.isFar(); ++n) {
    player.tick();
    witness.look();
  }
  return performance.outcome;
}

/// The same at a rate a tenth above what the certificate asks for: close to it, energy is up to
/// 1/(1 - lambda/4) of what there was.
StabilityOutcome playAtStableRate(const SceneBuilder& builder,
                                  int ticks,
                                  Precision precision,
                                  Closed closed = Closed::kYes) {
  const Certificate refused = certify(builder.scene, {kRate, 1});
  return play(builder, {1.1 * refused.sections[0].stable_rate_hz, 1}, ticks, precision, closed);
}

/// The rate below which a scene really grows, found by playing, over the lowest that the
/// certificate allows: 1 if the verdict is as tight as can be.
double tightnessOf(const SceneBuilder& builder) {
  const double certified = certify(builder.scene, {kRate, 1}).sections[0].stable_rate_hz;
  double grows = 0.9;
  double holds = 1.0;
  while (holds - grows > kTightnessStep) {
    const double middle = 0.5 * (grows + holds);
    const Rates rates{middle * certified, 1};
    const bool is_far = play(builder, rates, 20000, Precision::kDouble, Closed::kNo).growth >= kFar;
    (is_far ? grows : holds) = middle;
  }
  return holds;
}

/// A string, struck in its middle. `kappa`, `zeta`: of its links.
SceneBuilder string(int masses, double kappa, double zeta, double speed = 1.0) {
  SceneBuilder b;
  const int first = b.chain(masses, kMass, kappa * kUnit, zeta * kMass * kRate);
  b.scene.mats[at(first + 1 + masses / 2)].push.edit().velocity.x() = speed;
  return b;
}

/// A net in space, all around fixed; struck aslant. `rest`: rest length of its springs, in meshes.
SceneBuilder net(int side, double kappa, double rest = 0.0, Scheme scheme = Scheme::kExplicit) {
  SceneBuilder b;
  const double mesh = 1e-3;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  for (int m = 0; m < side * side; ++m) {
    const int i = m % side;
    const int j = m / side;
    scene::Mat& mat = b.scene.mats[at(
        i == 0 || j == 0 || i == side - 1 || j == side - 1 ? b.ground() : b.mass(kMass))];
    mat.rest = mat.position = {mesh * i, mesh * j, 0.0};
  }
  for (int m = 0; m < side * side; ++m) {
    for (const int next : {m % side + 1 < side ? m + 1 : -1, m + side}) {
      if (next > 0 && next < side * side) {
        b.spring(m, next, kappa * kUnit);
        b.scene.lias.back().rest_length = rest * mesh;
        b.scene.lias.back().scheme = scheme;
      }
    }
  }
  const int middle = side / 2 * side + side / 2;
  b.scene.mats[at(middle)].push.edit().velocity = {20.0, 40.0, 100.0};
  return b;
}

/// A string over a barrier that is as long, or hard contacts all along it.
SceneBuilder stringOnBarrier(LiaType type, double kappa_contact, Scheme scheme) {
  SceneBuilder b = string(100, 0.9, 0.0, 10.0);
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
SceneBuilder cubicChain(double kappa_far, Scheme scheme) {
  SceneBuilder b = string(64, 0.25, 0.0, 0.0);
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
SceneBuilder rubbedMass(LiaType type, double steepness, Scheme scheme) {
  SceneBuilder b;
  const int m = b.mass(kMass, 0.0, 1e-6);
  const double initial = type == LiaType::kBow ? 2.0 / 3.0 : 0.63 * std::exp(0.5);
  const int l = b.link(type, b.ground(), m, 0.0, steepness * kMass * kRate / initial);
  b.scene.lias[at(l)].law.edit().width = {0.1};
  b.scene.lias[at(l)].scheme = scheme;
  return b;
}

/// A slow mass on a spring to the ground, joined by a spring to a fast string with fixed ends,
/// whose modes reach above half the slower rate: it grows unless filtered. Where there can be a
/// chaplet the slow mass can carry it.
struct JoinedMass {
  int ratio;          ///< R
  double slow_mass;   ///< of that of a module of the string
  double slow_kappa;  ///< of its spring to the ground, by the slow step
  double string_kappa;
  double coupling;  ///< its kappa at a module of the string
};
constexpr JoinedMass kJoinedMasses[] = {
    {2, 20.0, 1.0, 0.9, 0.5}, {14, 1e4, 2.33, 0.13, 0.7}, {44, 1e4, 3.0, 0.02, 1.0}};

SceneBuilder joinedScene(const JoinedMass& joined) {
  SceneBuilder b;
  const int first = b.chain(24, kMass, joined.string_kappa * kUnit);
  const double kg = joined.slow_mass * kMass;
  const int slow = b.mass(kg, 0.0, 1.0, SceneBuilder::kGestural);
  b.spring(slow, b.ground(0.0, SceneBuilder::kGestural),
           joined.slow_kappa * kg * std::pow(kRate / joined.ratio, 2));
  b.spring(slow, first + 10, joined.coupling * kUnit);
  return b;
}

/// The figures of a device (0.3 kg, 2 N s/m) on a wall, in multiples of the passivity limit.
/// Its force is given one tick late and held; between ticks it moves exactly.
StabilityOutcome pushWall(double multiple, Precision precision) {
  const Rates rates{kRate, 14};
  const double t = rates.ratio / rates.audio_hz;
  const double mass = 0.3;
  const double damping = DeviceTraits{}.damping;
  const double decay = std::exp(-damping / mass * t);
  const double glide = mass / damping * (1.0 - decay);  // way of a unit of speed over a tick
  const double wall = multiple * 2.0 * damping / (3.0 * t);
  SceneBuilder b;
  const int slice = b.slice(0);
  b.spring(slice, b.ground(0.0, SceneBuilder::kGestural), wall);
  Performance performance = prepare(b.scene, rates, precision);
  Player& player = performance.player;
  double x = 0.0;
  double v = 1.0;
  Witness witness(*player.instrument, Closed::kNo, 0.5 * mass * v * v, performance.outcome);
  for (int n = 0; n < 20000 && !witness.isFar(); ++n) {
    const double force = n > 0 ? player.forces[0] : 0.0;
    player.positions[0] = x;
    player.tick();
    witness.look(0.5 * mass * v * v);
    x += glide * v + (t - glide) * force / damping;
    v = decay * v + (1.0 - decay) * force / damping;
  }
  return performance.outcome;
}

StabilityOutcome joinedPlainly(const JoinedMass& joined, Precision precision) {
  return play(joinedScene(joined), {kRate, joined.ratio}, 60000, precision, Closed::kNo);
}

/// With a chaplet, and every mass of the string loses that share of its momentum per step.
StabilityOutcome joinedThroughChaplet(const JoinedMass& joined, double loss, Precision precision) {
  SceneBuilder b = joinedScene(joined);
  b.scene.lias.back().filtered = true;
  b.scene.sections[SceneBuilder::kAudio].medium = {loss * kMass * kRate};
  return play(b, {kRate, joined.ratio}, 20000, precision, Closed::kNo);
}

StabilityOutcome joinedAtOneRate(const JoinedMass& joined, Precision precision) {
  SceneBuilder b = joinedScene(joined);
  for (scene::Mat& mat : b.scene.mats) {
    mat.section = SceneBuilder::kAudio;
  }
  return play(b, {kRate, joined.ratio}, 20000, precision);
}

using Cases = std::vector<StabilityCase>;

void addLimits(Cases& cases) {
  const auto beyond = [&](const std::string& what, const SceneBuilder& b, Closed closed) {
    const std::string stress = what + " 1 % over the limit";
    cases.push_back({stress, "explicit", false, "unstable", "too stiff or too damped",
                     [=](Precision precision) {
                       return play(b, {kRate, 1}, 20000, precision, closed);
                     },
                     [=] { return tightnessOf(b); }});
    cases.push_back(
        {stress, "at the certified rate", true, "passive", "",
         [=](Precision precision) { return playAtStableRate(b, 20000, precision, closed); }});
  };
  beyond("stiffness", string(30, 1.013, 0.0), Closed::kYes);
  beyond("damping", string(30, 0.3, 0.356), Closed::kYes);
  beyond("net in space", net(9, 0.53), Closed::kNo);
  const std::string thrown = "net in space thrown about by more than its meshes";
  cases.push_back({thrown, "explicit", false, "unproven", "where its direction turns",
                   [=](Precision precision) {
                     return play(net(9, 0.4, 0.9), {kRate, 1}, 20000, precision, Closed::kNo);
                   }});
  cases.push_back(
      {thrown, "energy_stable", true, "passive", "", [=](Precision precision) {
         return play(net(9, 0.4, 0.9, Scheme::kEnergyStable), {kRate, 1}, 20000, precision);
       }});
}

void addRates(Cases& cases) {
  for (const JoinedMass& joined : kJoinedMasses) {
    const std::string stress = "two rates, " + std::to_string(joined.ratio) + " to 1";
    cases.push_back({stress, "no chaplet", false, joined.ratio == 2 ? "unstable" : "unproven",
                     "grows",
                     [=](Precision precision) { return joinedPlainly(joined, precision); }});
    cases.push_back({stress, "all at the audio rate", true, "passive", "",
                     [=](Precision precision) { return joinedAtOneRate(joined, precision); }});
    if (joined.ratio >= 4) {  // C2 needs that
      cases.push_back({stress, "chaplet + loss", true, "passive", "", [=](Precision precision) {
                         return joinedThroughChaplet(joined, 1e-4, precision);
                       }});
    }
  }
}

void addNonlinear(Cases& cases) {
  const auto both = [&](const std::string& stress, const std::string& verdict,
                        const std::string& finding, auto make) {
    cases.push_back({stress, "explicit", false, verdict, finding, [=](Precision precision) {
                       return play(make(Scheme::kExplicit), {kRate, 1}, 40000, precision);
                     }});
    cases.push_back({stress, "energy_stable", true, "passive", "", [=](Precision precision) {
                       return play(make(Scheme::kAuto), {kRate, 1}, 40000, precision);
                     }});
  };
  both("string on a barrier, kappa 30", "unproven", "comes and goes",
       [](Scheme scheme) { return stringOnBarrier(LiaType::kContact, 30.0, scheme); });
  both("string on a barrier, power 1.5", "unproven", "grows with its amplitude",
       [](Scheme scheme) { return stringOnBarrier(LiaType::kPowerContact, 30.0, scheme); });
  both("cubic chain at large amplitude", "unproven", "grows with its amplitude",
       [](Scheme scheme) { return cubicChain(10.0, scheme); });
}

void addFriction(Cases& cases) {
  const auto both = [&](const std::string& stress, LiaType type, double steepness) {
    for (const bool is_safe : {false, true}) {
      cases.push_back({stress, is_safe ? "energy_stable" : "explicit", is_safe,
                       is_safe ? "bounded" : "unproven", is_safe ? "" : "steep for the step",
                       [=](Precision precision) {
                         const Scheme scheme = is_safe ? Scheme::kAuto : Scheme::kExplicit;
                         return play(rubbedMass(type, steepness, scheme), {kRate, 1}, 40000,
                                     precision, Closed::kNo);
                       }});
    }
  };
  both("bow, h F'/M = 2.5", LiaType::kBow, 2.5);
  both("smooth bow, h F'/M = 4", LiaType::kSmoothBow, 4.0);
}

void addWalls(Cases& cases) {
  const std::string stress = "wall over the passivity limit";
  cases.push_back({stress, "2.2 x the limit", false, "unproven", "it will buzz or jump",
                   [](Precision precision) { return pushWall(2.2, precision); }});
  cases.push_back({stress, "0.45 x the limit", true, "passive", "",
                   [](Precision precision) { return pushWall(0.45, precision); }});
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

constexpr double kDiverged = 1e3;
constexpr double kHeld = 10.0;  // near the limit energy breathes, see the cases
constexpr double kEnergyError = 1e-11;
constexpr double kTight = 0.999;  // of what the certificate allows, where that is exact

class StabilityMapTest : public testing::TestWithParam<StabilityCase> {
 protected:
  static void SetUpTestSuite() {
    if (const char* path = std::getenv("ERGOTIC_STABILITY_MAP")) {
      std::ofstream(path)
          << "stress,method,safe,verdict,growth,growth_in_float,energy_error,tightness\n";
    }
  }
  static void write(const StabilityCase& cell,
                    const StabilityOutcome& outcome,
                    double growth_in_float,
                    double tightness) {
    if (const char* path = std::getenv("ERGOTIC_STABILITY_MAP")) {
      std::ofstream(path, std::ios::app)
          << '"' << cell.stress << "\",\"" << cell.method << "\"," << cell.is_safe << ','
          << outcome.verdict << ',' << outcome.growth << ',' << growth_in_float << ','
          << outcome.energy_error << ',' << tightness << '\n';
    }
  }
};

std::string nameOf(const testing::TestParamInfo<StabilityCase>& info) {
  std::string name = info.param.stress + "_" + info.param.method;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

TEST_P(StabilityMapTest, BehavesAsForetold) {
  const StabilityCase& cell = GetParam();
  const StabilityOutcome outcome = cell.run(Precision::kDouble);
  const double growth_in_float = cell.run(Precision::kFloat).growth;
  const double tightness = cell.tightness ? cell.tightness() : 0.0;
  write(cell, outcome, growth_in_float, tightness);
  EXPECT_EQ(outcome.verdict, cell.verdict) << outcome.findings.substr(0, 1000);
  EXPECT_THAT(outcome.findings, testing::HasSubstr(cell.finding));
  if (cell.tightness) {
    EXPECT_GT(tightness, kTight);
    EXPECT_LE(tightness, 1.0);
  }
  if (cell.is_safe) {
    EXPECT_LE(outcome.growth, kHeld);
    EXPECT_LE(growth_in_float, kHeld);
    EXPECT_LE(outcome.energy_error, kEnergyError);
  } else {
    EXPECT_GE(outcome.growth, kDiverged);
    EXPECT_GE(growth_in_float, kDiverged);
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, StabilityMapTest, testing::ValuesIn(allCases()), nameOf);

}  // namespace
}  // namespace ergotic::physics
