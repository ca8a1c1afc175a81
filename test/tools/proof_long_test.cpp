// SPDX-License-Identifier: BSD-3-Clause
// What `check --proof` writes, before scripts/check_proof: of models, of random scenes that are
// vouched for, and with one number changed.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "support/physics.hpp"
#include "support/small_scene.hpp"
#include "support/tool_process.hpp"
#include "tools/lib/sha256.hpp"
#include "tools/proofs.hpp"

namespace ergotic {
namespace {

namespace fs = std::filesystem;
using test::SmallScene;

constexpr unsigned kScenes = 100;
// What the script does not know: it refuses to verify bodies in tune, and says so.
constexpr const char* kOfBodies = "lib_truths";
constexpr int kGolden = 8;  // of those models are vouched for

/// ERGOTIC_PROOFS asks for more.
unsigned scenes() {
  const char* const asked = std::getenv("ERGOTIC_PROOFS");
  return asked == nullptr ? kScenes : static_cast<unsigned>(std::strtoul(asked, nullptr, 10));
}

std::string digestOf(const std::string& text) {
  tools::Sha256 sum;
  sum.add(text);
  return sum.digest();
}

/// True if it is vouched for; then its proof lies beside its text.
bool write(const SmallScene& small, const std::string& stem) {
  std::ofstream(stem + ".yaml") << small.text();
  const scene::Scene scene =
      physics::settle(scene::readYaml(small.text(), stem + ".yaml"), small.rates).scene;
  physics::Proof proof;
  const physics::Certificate certificate = physics::certify(scene, small.rates, {}, &proof);
  if (certificate.verdict > physics::Verdict::kBounded || !scene.tanks.empty()) {
    return false;
  }
  tools::writeProof(stem + ".json", scene, small.rates, certificate.verdict, proof);
  return true;
}

/// \return how many of a folder's scenes, written out, are vouched for; of those the proof must be
///         verified
int verified(const std::string& folder, const std::string& ending) {
  int models = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(repository(folder))) {
    const ScratchFile proof;
    const ScratchFile written;
    const std::string model = writtenOut(entry.path().string(), written.path());
    if (entry.path().extension() == ending && entry.path().stem() != kOfBodies &&
        test::run("check", model + " --proof " + proof.path()).code == 0) {
      EXPECT_EQ(python("scripts/check_proof " + proof.path() + " " + model), 0) << model;
      ++models;
    }
  }
  return models;
}

TEST(ProofTest, OfEveryShippedModelIsVerified) {
  EXPECT_EQ(verified("models", ".yaml"), 4);
  EXPECT_EQ(verified("test/golden/models", ".mdl"), kGolden);
}

TEST(ProofTest, OfRandomScenesAreVerifiedAndRefusedWithOneNumberChanged) {
  const ScratchFile place;
  const fs::path folder = place.path() + ".proofs";
  fs::create_directory(folder);
  const auto isWritten = [&](unsigned seed) {
    const SmallScene plain = test::smallScene(seed);
    const SmallScene small = seed % 2 == 0 ? plain : test::withTaps(plain, seed);
    return write(small, (folder / std::to_string(seed)).string());
  };
  unsigned seed = 0;
  for (unsigned written = 0; written < scenes(); ++seed) {
    written += isWritten(seed) ? 1 : 0;
  }
  // What is split off a table; a spring between two places of one module.
  EXPECT_TRUE(isWritten(1122) && isWritten(1330) && isWritten(1287));
  EXPECT_EQ(python("test/support/falsify_proofs.py " + folder.string()), 0) << "in " << folder;
  if (!HasFailure()) {
    fs::remove_all(folder);
  }
}

/// A scene, and one number or word of it changed, which is why it is not vouched for then.
struct Lie {
  std::string text;
  std::string said;
  std::string instead;
  std::string reason;
};

/// A mass that is damped, and a guarded contact that hands its energy on.
const std::string kDamped =
    "ergotic: 1\nsections: {s: {rate: audio}}\nmats:\n  g: {type: ground}\n"
    "  m: {type: mass, mass: 1}\n  c: {type: cell, mass: 1, stiffness: 0, damping: 1}\nlias:\n"
    "  own: {type: spring_damper, between: [m, g], stiffness: 2e4, damping: 10}\n"
    "  hit: {type: contact, between: [m, c], stiffness: 1e3, scheme: guarded}\n";
const std::string kSnapping =
    kDamped +
    "  l: {type: conditional, between: [m, g], stiffness: 6e9, engage: 0.005, "
    "release: 0.01, scheme: explicit}\n";
const std::string kTable =
    kDamped +
    "  l: {type: table, between: [m, g], elastic: [[-1, -1], [1, 1]], scheme: explicit}\n";
/// Drives, less than what is around it brakes.
const std::string kDriving =
    kDamped + "  l: {type: table, between: [m, g], viscous: [[-1, 1], [1, -1]]}\n";
const std::string kFinger =
    "ergotic: 1\nparameters: {place: {value: 0.5, range: [0.2, 0.8]}}\nsections: {s: {}}\n"
    "generators:\n  - {type: string, name: string, masses: 30, mass: 1e-4, stiffness: 175033,\n"
    "     to: [1, 0]}\nmats:\n  g: {type: ground}\n"
    "  p: {type: point, along: string, at: $place, power: 1}\n"
    "lias:\n  l: {type: spring, between: [p, g], stiffness: 233000}\n";
const std::string kInSpace =
    "ergotic: 1\nsections: {s: {geometry: space}}\nmats:\n  g: {type: ground}\n"
    "  m: {type: mass, mass: 1, at: [0.1, 0, 0]}\nlias:\n"
    "  l: {type: spring, between: [m, g], stiffness: 1e4, rest_length: 0, scheme: explicit}\n";
const std::string kLever =
    "ergotic: 1\nsections: {s: {}}\nmats:\n  g: {type: ground}\n  m: {type: mass, mass: 1}\n"
    "  t: {type: tap, of: m, weights: 10}\nlias:\n"
    "  l: {type: spring, between: [t, g], stiffness: 7.7e7}\n";
/// Pushed away, and held by more than that.
const std::string kHeld =
    "ergotic: 1\nsections: {s: {}, p: {geometry: scalar}}\nmats:\n"
    "  g: {type: ground, section: s}\n  f: {type: ground, section: p}\n"
    "  m: {type: mass, section: p, mass: 1}\nlias:\n"
    "  n: {type: spring, between: [m, f], stiffness: -1000}\n"
    "  l: {type: spring, between: [m, g], stiffness: 3000}\n";
const std::string kTwoRates =
    "ergotic: 1\nparameters: {k: {value: 1, range: [1, 1]}}\n"
    "sections: {fast: {geometry: plane}, slow: {rate: gestural, pose: {position: [0, 0, 0],\n"
    "  rotation: [0, 0, 0]}}, along: {rate: gestural}}\nmats:\n"
    "  a: {type: mass, section: along, mass: 1}\n  b: {type: mass, section: slow, mass: 1}\n"
    "  f: {type: mass, section: fast, mass: 0.1}\nlias:\n"
    "  l: {type: spring, between: [a, f], stiffness: 1e4*$k}\n"
    "  r: {type: spring, between: [b, f], stiffness: 1e4}\n";
/// Two scalar masses that are joined, and one in a line that both of them see.
const std::string kRing =
    "ergotic: 1\nsections: {s: {}, t: {pose: {rotation: [0, 0, 0]}}, l: {geometry: line}}\nmats:\n"
    "  a: {type: mass, section: s, mass: 1}\n  b: {type: mass, section: t, mass: 1}\n"
    "  c: {type: mass, section: l, mass: 1}\nlias:\n"
    "  ab: {type: spring, between: [a, b], stiffness: 2.3e9}\n"
    "  bc: {type: spring, between: [b, c], stiffness: 2.3e9}\n"
    "  ca: {type: spring, between: [c, a], stiffness: 2.3e9}\n";
/// Beyond a quarter of the rate a cell is worst where it is damped least.
const std::string kMatched =
    "ergotic: 1\nparameters: {z: {value: 1, range: [0, 1]}}\nsections: {s: {}}\nmats:\n"
    "  g: {type: ground}\n  c: {type: cell, mass: 1, stiffness: 7.78e9, damping: 44100*$z}\n"
    "lias:\n  l: {type: spring, between: [c, g], stiffness: 1}\n";

scene::Scene settled(const std::string& text, const std::string& file = "lie.yaml") {
  return physics::settle(scene::readYaml(text, file), {44100.0, 14}).scene;
}

/// What scripts/check_proof says of the proof of `text` if it stands beside the network of another.
std::string refusal(const std::string& text, const std::string& other, bool says_passive = false) {
  const physics::Rates rates{44100.0, 14};
  physics::Proof proof;
  const physics::Verdict found = physics::certify(settled(text), rates, {}, &proof).verdict;
  EXPECT_LE(found, physics::Verdict::kBounded) << text;
  const ScratchFile file;
  const ScratchFile said;
  const ScratchFile beside(other);
  tools::writeProof(file.path(), settled(other, beside.path()), rates,
                    says_passive ? physics::Verdict::kPassive : found, proof);
  const int code = python("scripts/check_proof " + file.path() + " 2> " + said.path());
  EXPECT_EQ(code, said.text().empty() ? 0 : 1);
  return said.text();
}

TEST(ProofTest, IsRefusedForEveryReasonThatIsMissing) {
  const std::vector<Lie> lies = {
      {kSnapping, "damping: 1}", "damping: 0}", "a mass keeps what a link gives"},
      {kSnapping, "conditional, between: [m, g], stiffness: 6e9, engage: 0.005, release: 0.01",
       "contact, between: [m, g], stiffness: 6e9", "it switches"},
      {kTable, "[-1, -1], [1, 1]", "[-1, 1], [1, -1]", "l: its ends give"},
      {kFinger, "233000", "263000", "it does not hold wherever points lie"},
      {kFinger, "power: 1", "power: 1000", "a point brings too much"},
      {kLever, "7.7e7", "7.9e7", "the factor is not that of the network"},
      {kInSpace, "rest_length: 0", "rest_length: 0.05", "it turns"},
      {kHeld, "geometry: scalar", "geometry: plane", "axes"},
      {kTwoRates, "[1, 1]", "[0.5, 1]", "island"},
      {kTwoRates, "rotation: [0, 0, 0]", "rotation: [0, 0, 1]", "island: its axes"},
      {kRing, "rotation: [0, 0, 0]", "rotation: [0, 0, 3.141592653589793]", "its axis"},
  };
  for (const Lie& lie : lies) {
    std::string other = lie.text;
    const std::size_t at = other.find(lie.said);
    ASSERT_NE(at, std::string::npos) << lie.said;
    other.replace(at, lie.said.size(), lie.instead);
    EXPECT_THAT(refusal(lie.text, other), HasSubstr(lie.reason)) << lie.instead;
  }
  for (const std::string& text :
       {kSnapping, kTable, kFinger, kLever, kInSpace, kHeld, kTwoRates, kRing, kMatched}) {
    EXPECT_EQ(refusal(text, text), "") << text;
  }
  EXPECT_THAT(refusal(kTable, kTable, true), HasSubstr("its verdict"));
  EXPECT_THAT(refusal(kFinger, kFinger, true), HasSubstr("its verdict"));
}

/// Three rates, of which one is the gestural one; sections that are turned.
const std::string kRates =
    "ergotic: 1\ngestural_rate: 3000\nsections:\n  fast: {geometry: plane}\n"
    "  slow: {rate: gestural, geometry: plane, pose: {position: [0, 0, 1], rotation: [0.1, 0.2, "
    "0.3]"
    "}}\n"
    "  third: {rate: {divisor: 3}, modes: all}\n  own: {rate: auto}\nmats:\n"
    "  g: {type: ground, section: third}\n  f: {type: mass, section: fast, mass: 1}\n"
    "  s: {type: mass, section: slow, mass: 1}\n  t: {type: mass, section: third, mass: 1}\n"
    "  o: {type: mass, section: own, mass: 1}\n  w: {type: ground, section: own}\nlias:\n"
    "  l: {type: spring, between: [t, g], stiffness: 1e4}\n"
    "  a: {type: spring, between: [o, w], stiffness: 1e4}\n";
/// Points where they are written, between links, and where hands and parameters take them.
const std::string kPoints =
    "ergotic: 1\ngestural_rate: 3000\nparameters: {u: {value: 0.2, range: [0.1, 0.3]}}\nsections:\n"
    "  s: {}\n  h: {rate: gestural}\ngenerators:\n"
    "  - {type: string, name: s, section: s, masses: 9, mass: 1, stiffness: 1e4, damping: 1,\n"
    "     loss: 1, to: [1, 0]}\n"
    "  - {type: mesh, name: m, section: s, rows: 5, columns: 4, spacing: 0.1, mass: 1,\n"
    "     stiffness: 1e4, neighbours: 8, edges: corners}\nmats:\n"
    "  g: {type: ground, section: s}\n  hand: {type: slice, section: h}\n"
    "  still: {type: point, along: s, at: 0.43}\n  moved: {type: point, along: s, at: $u}\n"
    "  guided: {type: point, along: s, at: 0.5, guide: {mat: hand, scale: 2}, range: [0.4, 0.6]}\n"
    "  over: {type: point, along: m, at: [2*$u, 0.61]}\n"
    "  across: {type: point, along: m, at: [0.41, 0.61], guide: [~, {mat: hand, scale: 2}],\n"
    "    range: [~, [0.26, 0.74]]}\nlias:\n"
    "  a: {type: spring, between: [still, g], stiffness: 1e3}\n"
    "  b: {type: spring, between: [moved, g], stiffness: 1e3}\n"
    "  c: {type: spring, between: [guided, g], stiffness: 1e3}\n"
    "  d: {type: spring, between: [over, g], stiffness: 1e3}\n"
    "  e: {type: spring, between: [s@0.37, m@0.5:0.3], stiffness: 1e3}\n"
    "  f: {type: spring, between: [s@0.2, g], stiffness: 1e3}\n"
    "  h: {type: spring, between: [across, g], stiffness: 1e3}\n";
/// Places that are many, in two sections.
const std::string kTaps =
    "ergotic: 1\nsections: {s: {}, p: {geometry: plane}}\nmats:\n  g: {type: ground, section: s}\n"
    "  a: {type: mass, section: s, mass: 1}\n  b: {type: mass, section: s, mass: 2}\n"
    "  c: {type: mass, section: p, mass: 1}\n  lever: {type: tap, of: a, weights: 3}\n"
    "  both: {type: tap, of: [b, a, g], weights: [2, -1.5, 0.5]}\n"
    "  mean: {type: tap, of: [a, b]}\n  far: {type: tap, of: c, weights: 0.5}\nlias:\n"
    "  k: {type: spring, between: [both, g], stiffness: 1e4}\n"
    "  l: {type: spring, between: [lever, mean], stiffness: 1e4}\n"
    "  m: {type: contact, between: [mean, both], stiffness: 1e4}\n"
    "  n: {type: spring, between: [far, lever], stiffness: 1e4}\n";
/// Settling raises the slower section, for the contact; what is felt stays where it is.
const std::string kRaised =
    "ergotic: 1\ngestural_rate: 3000\nsections: {fast: {}, slow: {rate: gestural}}\nmats:\n"
    "  g: {type: ground, section: fast}\n  hand: {type: slice, section: slow}\n"
    "  m: {type: mass, section: slow, mass: 1}\n  f: {type: mass, section: fast, mass: 1}\nlias:\n"
    "  own: {type: spring, between: [f, g], stiffness: 1e4}\n"
    "  held: {type: spring, between: [m, hand], stiffness: 1e3}\n"
    "  hit: {type: contact, between: [m, f], stiffness: 1e4}\n";
/// A spring that is stretched where its ends rest.
const std::string kStretched =
    "ergotic: 1\nsections: {s: {geometry: plane}}\nmats:\n  g: {type: ground}\n"
    "  m: {type: mass, mass: 1, at: [0.1, 0]}\nlias:\n"
    "  l: {type: spring, between: [m, g], stiffness: 1e4, rest_length: 0.05}\n";
/// What generators, agents, filters and settling make beside what is written.
const std::string kMade =
    "ergotic: 1\ngestural_rate: 3000\nparameters: {m: {value: 1e-3, range: [1e-3, 2e-3]}}\n"
    "sections: {flat: {geometry: plane}, s: {}, h: {rate: gestural}}\ngenerators:\n"
    "  - {type: string, name: tense, section: flat, masses: 5, mass: 1e-3, stiffness: 1e4,\n"
    "     damping: 1e-2, rest_length_ratio: 0.5, to: [1, 0]}\n"
    "  - {type: string, name: coarse, section: s, masses: 12, mass: 1e-3, frequency: 440,\n"
    "     coarse: true, damping: 1e-4, to: [1, 0]}\n"
    "  - {type: string, name: tuned, section: s, masses: 6, mass: 1e-3, frequency: 220,\n"
    "     damping: 1e-4, loss: 1e-3, to: [1, 0]}\n"
    "  - {type: mesh, name: net, section: flat, rows: 3, columns: 4, spacing: 0.1, mass: $m,\n"
    "     stiffness: 1e3, rest_length_ratio: 0.8}\n"
    "  - {type: chaplet, name: soft, section: s, from: hand, mass: 2e-3}\n"
    "mats:\n  hand: {type: slice, section: h}\n"
    "lias:\n  reach: {type: spring, between: [soft.1, coarse.3], stiffness: 1}\n"
    "ports: {p: {mat: hand, slice: 0, filter: {mass: 1e-2, frequency: 100}}}\n"
    "agents: {a: {mat: tense.2, stiffness: 1, points: [[0, 0], [1, 0.01]]}}\n";

TEST(ProofTest, IsRefusedUnderTheNameOfAnotherScene) {
  const std::vector<Lie> lies = {
      {kRates, "divisor: 3", "divisor: 5", "third: divisor is not 5"},
      {kRates, "divisor: 3", "divisor: 1", "third: divisor is not 1"},
      {kRates, "rate: gestural", "rate: audio", "slow: divisor is not 1"},
      {kRates, "rate: 3000", "rate: 5000", "slow: divisor is not 9"},
      {kRates, "own: {rate: auto", "own: {rate: {divisor: 30}", "own: divisor is not 30"},
      {kRates, "0.3]", "0.4]", "slow: it is turned otherwise"},
      {kRates, "0.1, 0.2, 0.3", "0, 0, 0", "slow: it is turned otherwise"},
      {kRates, "own: {", "own: {geometry: line, ", "own: geometry is scalar, not line"},
      {kRates, "modes: all", "modes: 1", "third: modes is no, not some"},
      {kPoints, "at: 0.43", "at: 0.44", "still: it lies elsewhere"},
      {kPoints, "at: $u", "at: 0.2", "moved: it lies elsewhere"},
      {kPoints, "at: $u", "at: 1.5*$u", "moved: it lies elsewhere"},
      {kPoints, "[0.4, 0.6]", "[0.4, 0.5]", "guided: it lies elsewhere"},
      {kPoints, "guide: {mat: hand, scale: 2}, ", "", "guided: it lies elsewhere"},
      {kPoints, "2*$u, 0.61]", "2*$u, 0.6]", "over: it lies elsewhere"},
      {kPoints, "[0.26, 0.74]", "[0.26, 0.76]", "across: it lies elsewhere"},
      {kPoints, "[~, {mat: hand, scale: 2}]", "{mat: hand, scale: 2}", "across: it lies elsewhere"},
      {kPoints, "s@0.37", "s@0.38", "e: between"},
      {kPoints, "0.5:0.3", "0.5:0.5", "e: between"},
      {kPoints, "s@0.2", "s@0.3", "f: between"},
      {kPoints, "spacing: 0.1, mass: 1", "spacing: 0.1, mass: 2", "m.0.1: mass is 1, not 2"},
      {kPoints, "masses: 9", "masses: 8", "s.10 of mats is not in the proof"},
      {kPoints, "  f: {", "  more: {type: damper, between: [s.1, g], damping: 1}\n  f: {",
       "more of lias is not in the scene"},
      {kTaps, "weights: 3", "weights: 3.1", "lever: it lies elsewhere"},
      {kTaps, "[2, -1.5", "[2, -1.4", "both: it lies elsewhere"},
      {kTaps, "of: [a, b]", "of: [b]", "mean: it lies elsewhere"},
      {kTaps, "of: c, weights: 0.5", "of: c", "far: it lies elsewhere"},
      {kTaps, "[both, g]", "[mean, g]", "k: between"},
      {kRaised, "rate: gestural}", "rate: gestural, medium: 1}", "slow.raised: medium"},
      {kRaised, "stiffness: 1e4}\n  held", "stiffness: 2e4}\n  held", "own: stiffness"},
      {kStretched, "[0.1, 0]", "[0.05, 0]", "l: what pulls at any length is not split off"},
      {kStretched, "[0.1, 0]", "[0.2, 0]", "l.tension: it is no part of l"},
      {kTable, "[1, 1]", "[1, 2]", "l: elastic is"},
      {kDriving, "[-1, 1]", "[-1, 2]", "l: viscous is"},
      {kMade, "ratio: 0.5", "ratio: 0.6", "tense.link.0: rest_length"},
      {kMade, "frequency: 220", "frequency: 221", "tuned.link.0: stiffness"},
      {kMade, "gestural_rate: 3000", "gestural_rate: 2950", "soft.link.0: stiffness"},
      {kMade, "frequency: 100", "frequency: 90", "p.filter: stiffness"},
      {kMade, "mat: tense.2", "mat: tense.3", "a.hand: between"},
  };
  for (const Lie& lie : lies) {
    std::string other = lie.text;
    const std::size_t at = other.find(lie.said);
    ASSERT_NE(at, std::string::npos) << lie.said;
    other.replace(at, lie.said.size(), lie.instead);
    EXPECT_THAT(refusalUnderTheNameOf(lie.text, other), HasSubstr(lie.reason)) << lie.instead;
  }
  const ScratchFile points("# m, N\n-1, -1\n1 1 # the last one\n");
  std::string from_file = kTable;
  from_file.replace(from_file.find("[[-1, -1], [1, 1]]"), 18,
                    "{file: " + points.path().substr(5) + "}");  // beside the scene
  EXPECT_THAT(
      refusalUnderTheNameOf(from_file, std::regex_replace(kTable, std::regex("1, 1"), "1, 2")),
      HasSubstr("l: elastic is"));
  for (const std::string& text :
       {kRates, kPoints, kTaps, kRaised, kStretched, kMade, kTable, kDriving, from_file}) {
    EXPECT_EQ(refusalUnderTheNameOf(text, text), "") << text;
  }
}

TEST(ProofTest, MustBeToldAGesturalRateThatTheSceneDoesNotWish) {
  const ScratchFile proof;
  const ScratchFile written;
  const std::string model = writtenOut(repository("models/fretted_string.yaml"), written.path());
  EXPECT_EQ(test::run("check", model + " --gestural-rate 2000 --proof " + proof.path()).code, 0);
  const std::string command = "scripts/check_proof " + proof.path() + " " + model;
  EXPECT_EQ(python(command + " 2>/dev/null"), 1);
  EXPECT_EQ(python(command + " 2000"), 0);
}

TEST(ProofTest, ThereIsNoneOfWhatIsNotVouchedFor) {
  const ScratchFile scene(
      "ergotic: 1\nsections:\n  s: {rate: audio}\nmats:\n  g: {type: ground}\n"
      "  m: {type: mass, mass: 1}\nlias:\n"
      "  l: {type: cubic, between: [m, g], stiffness: 1, nonlinearity: 1, scheme: explicit}\n");
  const std::string proof = scene.path() + ".json";
  const test::Outcome outcome = test::run("check", scene.path() + " --proof " + proof);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("not written: the scene is unproven"));
  EXPECT_FALSE(test::exists(proof));
}

TEST(ProofTest, IsRefusedBesideAnotherScene) {
  const ScratchFile proof;
  test::run("check", repository("models/string.yaml") + " --proof " + proof.path());
  EXPECT_EQ(python("scripts/check_proof " + proof.path()), 0);
  EXPECT_EQ(python("scripts/check_proof " + proof.path() + " " + repository("models/duet.yaml") +
                   " 2>/dev/null"),
            1);
}

TEST(Sha256Test, IsThatOfTheStandard) {
  EXPECT_EQ(digestOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digestOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digestOf(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace ergotic
