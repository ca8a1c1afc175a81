// SPDX-License-Identifier: BSD-3-Clause
// The definitions of models/lib: each by itself, with what it takes by default.
#include <filesystem>
#include <set>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/body_poles.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"

namespace ergotic::physics {
namespace {

struct Definition {
  const char* file;
  const char* name;
  double pitch_hz;
  int partial;  ///< that has it
  int rigid;    ///< of a net: motions that bend nothing
};

class LibraryTest : public testing::TestWithParam<Definition> {
 protected:
  /// Beside models, where its files are found.
  static scene::Scene read(const std::string& use) {
    const Definition& definition = GetParam();
    return scene::readYaml("ergotic: 1\ninclude: [lib/" + std::string(definition.file) +
                               ".yaml]\nsections: {a: {rate: audio}, k: {rate: gestural}}\nuse: [" +
                               use + "]\n",
                           test::repository("models/library_test.yaml"));
  }
};

/// Of what sounds as it is asked to: a cell, or a mode of a net.
double soundingHz(const scene::Scene& scene, const Definition& definition) {
  std::vector<double> cells;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.type == scene::MatType::kCell && mat.stiffness.factor > 0.0) {
      const double sigma = 0.5 * mat.damping.factor / mat.mass.factor;
      cells.push_back(std::sqrt(mat.stiffness.factor / mat.mass.factor - sigma * sigma) /
                      (2.0 * kPi));
    }
  }
  if (!cells.empty()) {
    return cells[at(definition.partial - 1)];
  }
  const test::BodyPoles body(scene, kRate);
  const double lambda = body.eigenvalues()[at(definition.rigid + definition.partial - 1)];
  return std::asin(0.5 * std::sqrt(lambda)) / kPi * kRate;
}

TEST_P(LibraryTest, SoundsAsItSaysAndCannotBlowUp) {
  const Definition& definition = GetParam();
  const scene::Scene open = read("{is: " + std::string(definition.name) + ", as: x, in: {s: a}}");
  const scene::Scene scene = settle(open, {kRate, 14}).scene;
  EXPECT_EQ(certify(scene, {kRate, 14}).verdict, Verdict::kPassive);
  EXPECT_NEAR(test::cents(soundingHz(scene, definition), definition.pitch_hz), 0.0, 0.5);
}

constexpr Definition kDefinitions[] = {
    {"strings", "steel_string", 110.0, 1, 0}, {"strings", "limp_string", 195.9977, 1, 0},
    {"bars", "marimba_bar", 130.8128, 1, 0},  {"bars", "xylophone_bar", 523.2511, 1, 0},
    {"bars", "metal_bar", 1046.5023, 1, 0},   {"bars", "tine", 261.6256, 1, 0},
    {"skins", "round_skin", 110.0, 1, 0},     {"skins", "kettledrum", 146.8324, 2, 0},
    {"skins", "tabla_skin", 261.6256, 1, 0},  {"plates", "free_plate", 90.0, 1, 3},
    {"plates", "held_plate", 150.0, 1, 0},    {"plates", "disc", 1046.5023, 1, 0},
    {"bells", "church_bell", 440.0, 2, 0},    {"boards", "board", 110.0, 1, 0},
};
INSTANTIATE_TEST_SUITE_P(Definitions,
                         LibraryTest,
                         testing::ValuesIn(kDefinitions),
                         [](const auto& of) { return std::string(of.param.name); });

/// Every file of the library stands in the table, but for what does not sound by itself: see
/// techniques_test.cpp.
TEST(LibraryFilesTest, AreAllTried) {
  const std::set<std::string> techniques{"mallets", "plectra", "bows", "keys", "clocks"};
  for (const auto& entry : std::filesystem::directory_iterator(test::repository("models/lib"))) {
    const std::string name = entry.path().stem();
    EXPECT_TRUE(techniques.count(name) > 0 ||
                std::any_of(std::begin(kDefinitions), std::end(kDefinitions),
                            [&](const Definition& one) { return one.file == name; }))
        << name;
  }
}

/// A marimba of twelve bars and as many mallets, as docs/scene.md shows it.
TEST(LibraryFilesTest, TwelveBarsAndTwelveMalletsAreATickOfNothing) {
  const scene::Scene open = scene::readYaml(
      "ergotic: 1\ninclude: [lib/bars.yaml, lib/mallets.yaml]\n"
      "sections: {bars: {rate: audio}, keys: {rate: gestural}}\n"
      "use:\n"
      "  - {for: {k: 0..11}, is: marimba_bar, as: 'bar_{k}', in: {s: bars},\n"
      "     with: {pitch: '=note(C3)*cents(100*k)'}}\n"
      "  - {for: {k: 0..11}, is: mallet, as: 'key_{k}', in: {s: bars, keys: keys}, with: {slice: "
      "=k}}\n"
      "lias:\n"
      "  'hit_{k}': {for: {k: 0..11}, type: power_contact, between: ['key_{k}.head', "
      "'bar_{k}.middle'],\n"
      "              stiffness: 1e7, exponent: 2, damping: 0.5}\n"
      "outputs:\n"
      "  'out_{k}': {for: {k: 0..11}, at: 'bar_{k}.edge', quantity: velocity, channel: 1}\n",
      test::repository("models/library_test.yaml"));
  const scene::Scene scene = settle(open, {kRate, 14}).scene;
  EXPECT_EQ(scene.ports.size(), 12U);
  const Certificate certificate = certify(scene, {kRate, 14});
  EXPECT_TRUE(certificate.verdict == Verdict::kPassive || certificate.verdict == Verdict::kBounded);
}

}  // namespace
}  // namespace ergotic::physics
