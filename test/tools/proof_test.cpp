// SPDX-License-Identifier: BSD-3-Clause
// What `check --proof` writes, before scripts/check_proof: of models, of random scenes that are
// vouched for, and with one number changed.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <sys/wait.h>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/small_scene.hpp"
#include "support/tool_process.hpp"
#include "tools/lib/proof_file.hpp"
#include "tools/lib/sha256.hpp"

namespace ergotic {
namespace {

namespace fs = std::filesystem;
using test::ScratchFile;
using test::SmallScene;

constexpr unsigned kScenes = 100;

/// ERGOTIC_PROOFS asks for more.
unsigned scenes() {
  const char* const asked = std::getenv("ERGOTIC_PROOFS");
  return asked == nullptr ? kScenes : static_cast<unsigned>(std::strtoul(asked, nullptr, 10));
}

/// Of a script of this repository.
int python(const std::string& command) {
  const int status = std::system(("/usr/bin/python3 " + repository("") + command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
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
  if (certificate.verdict > physics::Verdict::kBounded) {
    return false;
  }
  tools::writeProof(stem + ".json", scene, small.rates, certificate.verdict, proof);
  return true;
}

TEST(ProofTest, OfEveryShippedModelIsVerified) {
  int models = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(repository("models"))) {
    if (entry.path().extension() == ".yaml") {
      const ScratchFile proof;
      const std::string model = entry.path().string();
      EXPECT_EQ(test::run("check", model + " --proof " + proof.path()).code, 0) << model;
      EXPECT_EQ(python("scripts/check_proof " + proof.path() + " " + model), 0) << model;
      ++models;
    }
  }
  EXPECT_GE(models, 4);
}

TEST(ProofTest, OfRandomScenesAreVerifiedAndRefusedWithOneNumberChanged) {
  const ScratchFile place;
  const fs::path folder = place.path() + ".proofs";
  fs::create_directory(folder);
  unsigned seed = 0;
  for (unsigned written = 0; written < scenes(); ++seed) {
    written += write(test::smallScene(seed), (folder / std::to_string(seed)).string()) ? 1 : 0;
  }
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
/// Beyond a quarter of the rate a cell is worst where it is damped least.
const std::string kMatched =
    "ergotic: 1\nparameters: {z: {value: 1, range: [0, 1]}}\nsections: {s: {}}\nmats:\n"
    "  g: {type: ground}\n  c: {type: cell, mass: 1, stiffness: 7.78e9, damping: 44100*$z}\n"
    "lias:\n  l: {type: spring, between: [c, g], stiffness: 1}\n";

scene::Scene settled(const std::string& text) {
  return physics::settle(scene::readYaml(text, "lie.yaml"), {44100.0, 14}).scene;
}

/// What scripts/check_proof says of the proof of `text` if it stands beside the network of another.
std::string refusal(const std::string& text, const std::string& other, bool says_passive = false) {
  const physics::Rates rates{44100.0, 14};
  physics::Proof proof;
  const physics::Verdict found = physics::certify(settled(text), rates, {}, &proof).verdict;
  EXPECT_LE(found, physics::Verdict::kBounded) << text;
  const ScratchFile file;
  const ScratchFile said;
  tools::writeProof(file.path(), settled(other), rates,
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
      {kInSpace, "rest_length: 0", "rest_length: 0.05", "it turns"},
      {kHeld, "geometry: scalar", "geometry: plane", "axes"},
      {kTwoRates, "[1, 1]", "[0.5, 1]", "island"},
      {kTwoRates, "rotation: [0, 0, 0]", "rotation: [0, 0, 1]", "island: its axes"},
  };
  for (const Lie& lie : lies) {
    std::string other = lie.text;
    const std::size_t at = other.find(lie.said);
    ASSERT_NE(at, std::string::npos) << lie.said;
    other.replace(at, lie.said.size(), lie.instead);
    EXPECT_THAT(refusal(lie.text, other), HasSubstr(lie.reason)) << lie.instead;
  }
  for (const std::string& text :
       {kSnapping, kTable, kFinger, kInSpace, kHeld, kTwoRates, kMatched}) {
    EXPECT_EQ(refusal(text, text), "") << text;
  }
  EXPECT_THAT(refusal(kTable, kTable, true), HasSubstr("its verdict"));
  EXPECT_THAT(refusal(kFinger, kFinger, true), HasSubstr("its verdict"));
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
