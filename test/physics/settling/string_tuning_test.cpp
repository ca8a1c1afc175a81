// SPDX-License-Identifier: BSD-3-Clause
// A string that asks for a frequency sounds there: at every rate, damped or not.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/settling/steps.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::cents;

struct Wish {
  double hz = 110.0;
  int masses = 1;
  std::string fields;   ///< more, of the generator
  std::string section;  ///< its fields
  Rates rates{kRate, 14};
};

std::ostream& operator<<(std::ostream& out, const Wish& wish) {
  return out << wish.hz << " Hz, " << wish.masses << " masses, " << wish.fields << " {"
             << wish.section << "} at " << wish.rates.audio_hz;
}

scene::Scene open(const Wish& wish) {
  const bool is_flat = wish.section.find("plane") != std::string::npos;
  std::ostringstream yaml;
  yaml.precision(17);
  yaml << "ergotic: 1\nparameters: {p: {value: 2, range: [1, 3]}}\nsections: {a: {" << wish.section
       << "}}\ngenerators:\n  - {type: string, name: s, masses: " << wish.masses
       << ", frequency: " << wish.hz
       << ", to: " << (wish.section.find("line") != std::string::npos ? "[0.65], " : "[0.65, 0], ")
       << wish.fields << "}\noutputs: {o: {at: s@0.5, quantity: position, channel: 1, axis: "
       << (is_flat ? "y" : "x") << "}}\n";
  return scene::readYaml(yaml.str(), "string.yaml");
}

double sectionRate(const Wish& wish, const scene::Scene& scene) {
  return wish.rates.audio_hz / divisorOf(scene.sections[0], wish.rates);
}

double toldCents(const Wish& wish) {
  const Settled settled = settle(open(wish), wish.rates);
  const scene::Scene& scene = settled.scene;
  return cents(stringPitchHz(scene, scene.strings[0], sectionRate(wish, scene)), wish.hz);
}

/// Let go in the shape of its first mode, heard in its middle about six times in a period.
double playedCents(const Wish& wish, Precision precision = Precision::kDouble) {
  scene::Scene scene = settle(open(wish), wish.rates).scene;
  const int axis = scene.outputs[0].axis;
  for (int i = 0; i <= wish.masses + 1; ++i) {
    scene.mats[at(i)].position[axis] += 1e-5 * std::sin(kPi * i / (wish.masses + 1));
  }
  const double rate_hz = sectionRate(wish, scene);
  const auto step = std::lround(wish.rates.audio_hz / rate_hz);
  const auto every = std::max(1L, std::lround(rate_hz / (6.0 * wish.hz)));
  Player player(scene, wish.rates, precision);
  player.ticks(static_cast<int>(20.0 / wish.hz * wish.rates.gesturalHz()) + 10);
  // Along a line what is heard is a place, not a displacement.
  const double middle = scene.sections[0].geometry == Geometry::kLine ? 0.325 : 0.0;
  std::vector<double> steps;
  for (std::size_t n = 0; n < player.heard[0].size(); n += static_cast<std::size_t>(step * every)) {
    steps.push_back(player.heard[0][n] - middle);
  }
  return cents(std::arg(test::poleOf(steps)) / (2.0 * kPi * static_cast<double>(every)) * rate_hz,
               wish.hz);
}

std::vector<Wish> wishes() {
  std::vector<Wish> all;
  for (const double rate_hz : {22050.0, 44100.0, 48000.0, 96000.0, 192000.0}) {
    const Rates rates{rate_hz, 14};
    for (const double hz : {55.0, 110.0, 440.0, 1760.0, 4186.0}) {
      const int most = static_cast<int>(rate_hz / (kPi * hz)) - 1;
      for (const int masses : {1, 3, 20, 80}) {
        if (masses <= std::max(most, 1)) {
          for (const char* lossy :
               {"", ", loss: 2e-3", ", damping: 1e-4", ", loss: 2e-2, damping: 1e-4"}) {
            all.push_back({hz, masses, "mass: 1e-4" + std::string(lossy), "", rates});
          }
        }
      }
    }
  }
  for (const char* section :
       {"medium: 0.01", "rate: gestural", "rate: gestural, medium: 0.01", "rate: {divisor: 7}"}) {
    all.push_back({110.0, 6, "mass: 1e-4", section});
    all.push_back({110.0, 6, "mass: 5e-5*$p, loss: 1e-3*$p, damping: 1e-3", section});
  }
  for (const char* geometry : {"geometry: plane", "geometry: plane, medium: 0.01"}) {
    for (const char* stretched :
         {"", ", rest_length_ratio: 0.5", ", rest_length_ratio: 0.9, loss: 1e-2",
          ", rest_length_ratio: 0.5, scheme: energy_stable"}) {
      all.push_back({1760.0, 3, "mass: 1e-4" + std::string(stretched), geometry});
    }
  }
  for (const char* coarse : {"", ", loss: 2e-3", ", damping: 1e-4"}) {
    all.push_back({440.0, 20, "coarse: true, mass: 1e-4" + std::string(coarse), ""});
    all.push_back({4186.0, 4, "coarse: true, mass: 1e-4" + std::string(coarse), ""});
  }
  return all;
}

TEST(StringTuningTest, EveryStringIsToldToSoundWhereItWasAskedTo) {
  for (const Wish& wish : wishes()) {
    EXPECT_NEAR(toldCents(wish), 0.0, 1e-8) << wish;
  }
}

TEST(StringTuningTest, EveryStringSoundsWhereItWasAskedTo) {
  for (const Wish& wish : wishes()) {
    EXPECT_NEAR(playedCents(wish), 0.0, 1e-4) << wish;
  }
}

TEST(StringTuningTest, SinglePrecisionIsInTuneToo) {
  for (const double hz : {440.0, 1760.0, 4186.0}) {
    EXPECT_NEAR(playedCents({hz, 2, "mass: 1e-4, loss: 2e-3", ""}, Precision::kFloat), 0.0, 0.1)
        << hz;
  }
}

TEST(StringTuningTest, MassThatIsAParameterKeepsThePitch) {
  const Wish wish{880.0, 9, "mass: 5e-5*$p, damping: 1e-3*$p", ""};
  scene::Scene scene = settle(open(wish), wish.rates).scene;
  for (const double value : {1.0, 2.0, 3.0}) {
    scene.parameters[0].value = value;
    EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], kRate), 880.0, 1e-9) << value;
  }
}

std::string wishRefusal(const Wish& wish) {
  try {
    settle(open(wish), wish.rates);
  } catch (const TextError& error) {
    return error.what();
  }
  return {};
}

Wish cutInto(int masses, Wish wish) {
  wish.masses = masses;
  return wish;
}

/// What is advised works, and no more than that.
void expectMost(const Wish& wish, int most) {
  const std::string advice = "at most " + std::to_string(most) + " masses";
  EXPECT_THAT(wishRefusal(wish), HasSubstr(advice)) << wish;
  for (int masses = 3; masses <= most; ++masses) {
    EXPECT_EQ(wishRefusal(cutInto(masses, wish)), "") << wish;
  }
  EXPECT_NE(wishRefusal(cutInto(most + 1, wish)), "") << wish;
}

TEST(StringTuningTest, RefusalsAdviseHowManyMassesWouldDo) {
  expectMost({4186.0, 20, "coarse: true, mass: 1e-4", ""}, 4);
  expectMost({1500.0, 20, "coarse: true, mass: 1e-4", ""}, 13);
  expectMost(
      {1760.0, 20, "mass: 1e-4, rest_length_ratio: 0.9, scheme: energy_stable", "geometry: line"},
      5);
  EXPECT_THAT(wishRefusal({9000.0, 20, "coarse: true, mass: 1e-4", ""}),
              HasSubstr("Use a higher rate or a lower frequency"));
  EXPECT_THAT(wishRefusal({23000.0, 1, "mass: 1e-4", ""}),
              HasSubstr("below half its rate, 22050 Hz"));
  EXPECT_THAT(wishRefusal({440.0, 1, "mass: 1e-6, damping: 1", ""}),
              HasSubstr("less damping or loss"));
}

TEST(StringTuningTest, TheVerdictAdvisesHowManyMassesCanBeStepped) {
  Wish wish{4186.0, 20, "mass: 1e-4", ""};
  const auto advice =
      HasSubstr("cannot be stepped at 4186 Hz with 20 masses. Use at most 4 masses, ");
  const Settled cut = settle(open(wish), wish.rates);
  EXPECT_THAT(cut.notes, ::testing::IsEmpty());
  EXPECT_THAT(certify(cut.scene, wish.rates).findings, ::testing::ElementsAre(advice));
  for (const int masses : {4, 5}) {
    const Settled settled = settle(open(cutInto(masses, wish)), wish.rates);
    const bool is_stable = certify(settled.scene, wish.rates).verdict == Verdict::kPassive;
    EXPECT_EQ(is_stable, masses == 4);
    EXPECT_EQ(settled.scene.body_limits.empty(), masses == 4);
  }
}

TEST(StringTuningTest, TheVerdictAdvisesTheRateAtWhichItCanBeStepped) {
  for (const char* fields : {"mass: 1e-4", "mass: 1e-4, loss: 2e-2, damping: 5e-2"}) {
    Wish wish{4186.0, 5, fields, ""};
    const std::vector<scene::BodyLimit> limits = settle(open(wish), wish.rates).scene.body_limits;
    ASSERT_EQ(limits.size(), 1U) << fields;
    const std::string advice = "a rate of ";
    const double rate_hz =
        std::stod(limits[0].text.substr(limits[0].text.find(advice) + advice.size()));
    for (const double off : {0.0, -2.0}) {
      wish.rates = {rate_hz + off, 14};
      const Settled settled = settle(open(wish), wish.rates);
      const bool is_stable = certify(settled.scene, wish.rates).verdict == Verdict::kPassive;
      EXPECT_EQ(is_stable, off == 0.0) << fields << ", " << rate_hz + off;
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
