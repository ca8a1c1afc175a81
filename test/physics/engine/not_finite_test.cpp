// SPDX-License-Identifier: BSD-3-Clause
// Numbers that are none, in the state and in what an instrument is given: nothing crashes, it is
// seen, and from a sound state it plays on as if nothing had been.
#include <cstring>

#include "constants.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"

namespace ergotic::physics {
namespace {
constexpr double kValues[] = {std::nan(""), kInfinity, -1e300, 1e30, 1e-310};
constexpr std::size_t kTank = 4;  // number of an energy-stable link: the energy that it may spend
constexpr int kTicksToSee = 3;
constexpr int kTicksAfter = 3;

using State = std::vector<unsigned char>;

State stateOf(const Instrument& instrument) {
  State state(instrument.stateSize());
  instrument.saveState(state.data());
  return state;
}

/// Visits the places of all floating-point numbers: `visit(offset, is_double)`.
template <class Visit>
void forEachNumber(const StateEntry& entry, const Visit& visit) {
  const std::size_t element =
      entry.numbers.doubles * sizeof(double) + entry.numbers.floats * sizeof(float);
  for (std::size_t at = 0; element > 0 && at + element <= entry.size; at += element) {
    for (std::size_t i = 0; i < entry.numbers.doubles; ++i) {
      visit(entry.offset + at + i * sizeof(double), true);
    }
    for (std::size_t i = 0; i < entry.numbers.floats; ++i) {
      visit(entry.offset + at + entry.numbers.doubles * sizeof(double) + i * sizeof(float), false);
    }
  }
}

void put(State& state, std::size_t offset, bool is_double, double value) {
  const float narrow = static_cast<float>(value);
  is_double ? std::memcpy(&state[offset], &value, sizeof value)
            : std::memcpy(&state[offset], &narrow, sizeof narrow);
}

/// Whether all positions, and what energy-stable links may spend, are numbers.
bool movesOnNumbers(const Instrument& instrument) {
  const State state = stateOf(instrument);
  bool are_numbers = true;
  for (const StateEntry& entry : instrument.stateEntries()) {
    const bool is_energy_stable = entry.name.rfind("energy_stable", 0) == 0;
    std::size_t of_element = 0;
    forEachNumber(entry, [&](std::size_t offset, bool is_double) {
      double wide = 0.0;
      float narrow = 0.0F;
      std::memcpy(&wide, &state[offset], is_double ? sizeof wide : 0);
      std::memcpy(&narrow, &state[offset], is_double ? 0 : sizeof narrow);
      const bool counts = entry.name == "x" || (is_energy_stable && of_element == kTank);
      are_numbers = are_numbers && (!counts || (std::isfinite(wide) && std::isfinite(narrow)));
      of_element = (of_element + 1) % (entry.numbers.doubles + entry.numbers.floats);
    });
  }
  return are_numbers;
}

/// An instrument that is spoilt again and again.
class Patient {
 public:
  Patient(const scene::Scene& scene, const Rates& rates, Precision precision)
      : sick_(scene, rates, precision) {
    calm(sick_);
    sick_.ticks(20);
    start_ = stateOf(*sick_.instrument);
    sick_.ticks(kTicksAfter);
    sound_ = stateOf(*sick_.instrument);
    EXPECT_TRUE(sick_.instrument->isFinite());
  }

  /// \return numbers that were spoilt
  int spoilState() {
    int spoilt = 0;
    for (const StateEntry& entry : sick_.instrument->stateEntries()) {
      forEachNumber(entry, [&](std::size_t offset, bool is_double) {
        for (const double value : kValues) {
          State state = start_;
          put(state, offset, is_double, value);
          sick_.instrument->loadState(state.data());
          expectSeen(entry.name + " + " + std::to_string(offset - entry.offset), value);
          ++spoilt;
        }
      });
    }
    return spoilt;
  }

  void spoilInputs() {
    spoilEach(sick_.inputs, "input");
    spoilEach(sick_.positions, "position");
  }

 private:
  static void calm(Player& player) {
    std::fill(player.inputs.begin(), player.inputs.end(), 1e-4);
    std::fill(player.positions.begin(), player.positions.end(), -1e-3);
  }

  void spoilEach(std::vector<double>& numbers, const std::string& what) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      for (const double value : kValues) {
        sick_.instrument->loadState(start_.data());
        numbers[i] = value;
        sick_.tick();
        calm(sick_);
        expectSeen(what + ' ' + std::to_string(i), value);
      }
    }
  }

  /// As a station sees it: by the forces and the sound, and by a look inside.
  void expectSeen(const std::string& where, double value) {
    const auto finite = [](double v) { return std::isfinite(v); };
    bool is_seen = false;
    for (int n = 0; n < kTicksToSee; ++n) {
      sick_.tick();
      is_seen = is_seen || !std::all_of(sick_.forces.begin(), sick_.forces.end(), finite);
      for (const std::vector<double>& channel : sick_.heard) {
        is_seen = is_seen || !std::isfinite(channel.back());
      }
    }
    is_seen = is_seen || !sick_.instrument->isFinite();
    EXPECT_TRUE(is_seen || movesOnNumbers(*sick_.instrument)) << where << " = " << value;
    expectRecovery(where, value);
  }

  void expectRecovery(const std::string& where, double value) {
    sick_.instrument->loadState(start_.data());
    calm(sick_);
    sick_.ticks(kTicksAfter);
    EXPECT_EQ(stateOf(*sick_.instrument), sound_) << where << " = " << value;
  }

  Player sick_;
  State start_;
  State sound_;  // what comes of it when nothing was spoilt
};

void expectSafe(const scene::Scene& scene, const std::string& what) {
  SCOPED_TRACE(what);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    Patient patient(scene, chooseRates(scene, kRate), precision);
    EXPECT_GT(patient.spoilState(), 100);
    patient.spoilInputs();
  }
}

std::string sceneText(const std::string& geometry, const std::string& rest) {
  return "ergotic: 1\ngestural_rate: 5512\nsections: {a: {geometry: " + geometry +
         ", medium: 1e-3}, h: {rate: gestural}, c: {rate: {divisor: 4}}}\n" + rest +
         "ports: {k: {mat: k, slice: 0}}\n"
         "inputs: {push: {mat: m, quantity: force, channel: 1},\n"
         "  lead: {mat: w, quantity: position, channel: 2}}\n"
         "outputs: {x: {at: m, quantity: position, channel: 1},\n"
         "  f: {at: q, quantity: force, channel: 2}}\n";
}

/// A law between all kinds of modules and rates, with this scheme.
scene::Scene sceneOfLink(const std::string& law, const std::string& scheme, const char* geometry) {
  const std::string link = ", " + law + ", scheme: " + scheme + "}\n";
  const std::string z = std::string(geometry) == "space" ? ", 0" : "";
  const std::string text = sceneText(
      geometry,
      "mats:\n  k: {type: slice, section: h}\n  w: {type: driven, section: a}\n"
      "  m: {type: mass, section: a, mass: 1e-3, at: [1e-3, 0" +
          z +
          "]}\n"
          "  n: {type: cell, section: a, mass: 1e-3, stiffness: 1e3, damping: 1e-3, at: [2e-3, 0" +
          z +
          "]}\n"
          "  q: {type: mass, section: c, mass: 1e-2}\n  g: {type: ground, section: a}\n"
          "lias:\n  held: {type: spring_damper, between: [m, g], stiffness: 1e3, damping: 1e-3}\n"
          "  slow: {type: spring_damper, between: [q, g], stiffness: 1e3, damping: 1e-3}\n"
          "  inside: {between: [m, n]" +
          link + "  hand: {between: [k, m]" + link + "  across: {between: [q, n]" + link +
          "  led: {between: [w, n]" + link);
  return scene::readYaml(text, "law.yaml");
}

struct LawCase {
  const char* fields;
  bool guardable;
};
constexpr LawCase kLaws[] = {
    {"type: spring_damper, stiffness: 1e3, damping: 1e-2", false},
    {"type: contact, stiffness: 1e3, damping: 1e-2, threshold: 1e-3", true},
    {"type: power_contact, stiffness: 1e5, exponent: 1.7, damping: 1e-2", true},
    {"type: felt, stiffness: 1e5, exponent: 2.3, damping: 1", true},
    {"type: quadratic, stiffness: 1e3, nonlinearity: 1e4", true},
    {"type: cubic, stiffness: 1e3, nonlinearity: 1e6", true},
    {"type: clipped_cubic, stiffness: 1e3, nonlinearity: 1e6, stiffness_limit: 2e3", true},
    {"type: cubic_contact, stiffness: 1e3, nonlinearity: 1e6, stiffness_limit: 2e3", true},
    {"type: pluck, stiffness: 1e3, width: 1e-3, damping: 1e-2", true},
    {"type: pluck, table: [[-1e-3, 0], [0, 1], [1e-3, 0]]", true},
    {"type: bow, damping: 1e-1, width: 1e-1", true},
    {"type: bow, table: [[-1, 0], [-0.1, -1], [0.1, 1], [1, 0]]", true},
    {"type: smooth_bow, damping: 1e-1, width: 1e-1", true},
    {"type: table, elastic: [[-1e-3, -1], [0, 0], [1e-3, 2]]", true},
    {"type: table, viscous: {points: [[-1, -0.1], [0, 0.1], [2, 0.2]], interpolation: monotone}",
     true},
    {"type: conditional, stiffness: 1e3, engage: 1e-3, release: 2e-3", true},
};

class NotFiniteLawTest : public testing::TestWithParam<LawCase> {};
TEST_P(NotFiniteLawTest, IsSeenInEveryLaw) {
  for (const char* geometry : {"scalar", "space"}) {
    expectSafe(sceneOfLink(GetParam().fields, "explicit", geometry),
               std::string(geometry) + " explicit");
    if (GetParam().guardable) {
      expectSafe(sceneOfLink(GetParam().fields, "energy_stable", geometry),
                 std::string(geometry) + " energy_stable");
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Laws, NotFiniteLawTest, testing::ValuesIn(kLaws));

TEST(NotFiniteTest, IsSeenInPointsThatAreGuided) {
  for (const char* scheme : {"explicit", "energy_stable"}) {
    expectSafe(scene::readYaml(
                   sceneText("scalar",
                             "generators:\n"
                             "  - {type: string, name: s, section: a, masses: 5, mass: 1e-3,"
                             " stiffness: 1e4, damping: 1e-2, to: [1, 0]}\n"
                             "  - {type: mesh, name: net, section: a, rows: 3, columns: 3,"
                             " mass: 1e-3, stiffness: 1e3, spacing: 0.1}\n"
                             "mats:\n  k: {type: slice, section: h}\n"
                             "  w: {type: driven, section: a}\n"
                             "  m: {type: mass, section: a, mass: 1e-3}\n"
                             "  q: {type: mass, section: c, mass: 1e-2}\n"
                             "  led: {type: point, along: s, at: 0.4, guide: {mat: w, scale: 10}}\n"
                             "  held: {type: point, along: s, at: 0.6, speed: 2,"
                             " guide: {mat: k, scale: 10}, range: [0.5, 0.7]}\n"
                             "  bridge: {type: point, along: net, at: [0.3, 0.8],"
                             " guide: {mat: m, scale: 3}}\n"
                             "lias:\n  a: {type: contact, between: [k, led], stiffness: 1e3,"
                             " threshold: 0.1, scheme: " +
                                 std::string(scheme) +
                                 "}\n"
                                 "  b: {type: cubic, between: [q, held], stiffness: 1e3,"
                                 " nonlinearity: 1e4, scheme: " +
                                 std::string(scheme) +
                                 "}\n"
                                 "  c: {type: spring, between: [m, bridge], stiffness: 1e3}\n"
                                 "  d: {type: spring, between: [m, led], stiffness: 1e3}\n"),
                   "points.yaml"),
               scheme);
  }
}

TEST(NotFiniteTest, IsSeenInModesAndPoints) {
  SceneBuilder b;
  const int first = b.chain(6, 1e-3, 1e4, 1e-3);
  b.spring(b.slice(0), first + 3, 1e3, 1e-2);
  b.push(first + 2);
  b.hear(b.point(b.grid(first, 8), 0.3));
  b.scene.sections[0].modes = scene::kAllModes;
  b.scene.gestural_rate_hz = 5512.0;
  expectSafe(b.scene, "modes");
}

TEST(NotFiniteTest, IsSeenInStringsThatRunInBlocks) {
  SceneBuilder b;
  const int first = b.chain(40, 1e-3, 1e4, 1e-3);
  const int other = b.chain(40, 1e-3, 1e4, 1e-3);
  b.link(LiaType::kContact, b.slice(0), first + 20, 1e3, 1e-2);
  b.push(first + 2);
  b.hear(first + 10);
  b.hear(other + 10, 1, Quantity::kForce);
  b.scene.gestural_rate_hz = 5512.0;
  expectSafe(b.scene, "blocks");
}

TEST(NotFiniteTest, IsSeenBehindAChaplet) {
  expectSafe(scene::readYaml(sceneText("scalar",
                                       "generators:\n"
                                       "  - {type: chaplet, name: p, section: a, from: k,"
                                       " mass: 1e-2}\n"
                                       "lias: {x: {type: contact, between: [p.1, m],"
                                       " stiffness: 1e3, threshold: 1e-2},\n"
                                       "  y: {type: spring, between: [w, q], stiffness: 1e2}}\n"
                                       "mats:\n  k: {type: slice, section: h}\n"
                                       "  w: {type: driven, section: a}\n"
                                       "  m: {type: cell, section: a, mass: 1e-3,"
                                       " stiffness: 1e3, damping: 1e-3}\n"
                                       "  q: {type: mass, section: c, mass: 1e-2}\n"),
                             "chaplet.yaml"),
             "chaplet");
}

TEST(NotFiniteTest, IsSeenInSectionsThatSleep) {
  SceneBuilder b;
  const int bar = b.cell(1e-3, 1e3, 1e-2);
  b.link(LiaType::kContact, b.slice(0), bar, 1e3);
  b.push(bar);
  b.hear(bar);
  b.scene.sections[0].sleep_energy = 1.0;
  b.scene.gestural_rate_hz = 5512.0;
  expectSafe(b.scene, "sleep");
}

TEST(NotFiniteTest, IsSeenInCoefficientsThatFollowSound) {
  const std::string path = repository("test/golden/models/audio_params.mdl");
  expectSafe(scene::readSceneFile(path), path);
}

}  // namespace
}  // namespace ergotic::physics
