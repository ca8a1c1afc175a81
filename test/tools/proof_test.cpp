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
