// SPDX-License-Identifier: BSD-3-Clause
// What is known of plucked and bowed strings, by the sound of instruments that come along.
#include "ergotic/scene/text/read_truths.hpp"
#include "support/measure.hpp"
#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "tools/lib/truth_play.hpp"

namespace ergotic::tools {
namespace {

using test::cents;
using test::kRates;

/// A shipped scene with other outputs and truths than its own.
scene::ClaimingScene shipped(const std::string& name,
                             const std::string& outputs,
                             const std::string& truths) {
  const std::string file = repository("models/" + name + ".yaml");
  std::string text = textOf(file);
  text = text.substr(0, text.find("\noutputs:\n"));
  return scene::readTruths(text + "\noutputs:\n" + outputs + "truths:\n" + truths, file);
}

PlayedTruth played(const scene::ClaimingScene& claims, const scene::Truth& truth, double seconds) {
  return playTruth(claims.scene, truth, claims.scene.outputs, seconds, kRates,
                   physics::Precision::kDouble);
}

// Six places on one string

constexpr int kSpacings = 61;  // of string_3 of the guitar
constexpr int kPlaces[] = {5, 9, 14, 19, 24, 29};
constexpr int kPartials = 8;

/// What a tap leaves of partial j goes as sin(j pi u): six spectra, one set of modes. Of each
/// partial a gain is free, that of the place where it is heard.
TEST(SixPlacesTest, OnAStringHaveSixSpectraAndOneSetOfModes) {
  std::string taps;
  for (const int place : kPlaces) {
    taps += "  - {what: pitch, of: heard, play: {tap: 0.5 N, at: string_3.body." +
            std::to_string(place) + ", time: 0.5 ms}, near: G3, least: 100}\n";
  }
  const scene::ClaimingScene claims = shipped(
      "guitar", "  heard: {at: string_3.body@0.97, quantity: velocity, channel: 1}\n", taps);
  std::vector<std::vector<Line>> lines;
  for (const scene::Truth& truth : claims.truths) {
    const PlayedTruth one = played(claims, truth, 0.6);
    std::vector<Line>& of_place = lines.emplace_back();
    for (int j = 1; j <= kPartials; ++j) {
      of_place.push_back(lineNear(one.sounds[0], one.begin_s + 0.05, 0.5, 196.0 * j, 0.03));
    }
  }
  for (int j = 1; j <= kPartials; ++j) {
    std::vector<double> off_db;
    std::vector<double> hz;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const double share = std::abs(std::sin(j * M_PI * kPlaces[k] / kSpacings));
      if (share > 0.1) {
        const Line& line = lines[k][at(j - 1)];
        off_db.push_back(20.0 * std::log10(line.amplitude / share));
        hz.push_back(line.hz);
      }
    }
    ASSERT_GE(off_db.size(), 4U);
    const auto [least_db, most_db] = std::minmax_element(off_db.begin(), off_db.end());
    const auto [lowest, highest] = std::minmax_element(hz.begin(), hz.end());
    EXPECT_LT(*most_db - *least_db, 0.2) << "partial " << j;
    EXPECT_LT(cents(*highest, *lowest), 0.05) << "partial " << j;
  }
}

// A bowed string

constexpr double kBowed = 0.89;  // where violin_g is bowed, a fraction of the string

struct Slips {
  double in_period = 0.0;
  double longest = 0.0;   ///< from slip to slip, periods
  double shortest = 0.0;  ///< the same
  double share = 0.0;     ///< of the time
};

/// Half a second of violin_g under a bow at 0.1 m/s, 1 s after it began.
/// \param press_m  where the hand that presses wants to be
/// \param first_m  the same as the bow begins
Slips bow(double press_m, double first_m) {
  const std::string attack = std::to_string(first_m);
  const test::ScratchFile gesture("time_s,slice,target_m\n0,0,-0.018\n0,1,0\n0.3,1," + attack +
                                  "\n0.4,0,-0.018\n0.6,1," + attack + "\n0.9,1," +
                                  std::to_string(press_m) + "\n2.2,0,0.018\n");
  scene::ClaimingScene claims =
      shipped("violin_g",
              "  string: {at: string.body@0.89, quantity: velocity, channel: 1}\n"
              "  hair: {at: bow.hair_0, quantity: velocity, channel: 2}\n",
              "  - {what: pitch, of: string, play: {gesture: bow.csv}, near: G3, least: 100}\n");
  const std::size_t slash = gesture.path().rfind('/');
  claims.scene.file = gesture.path().substr(0, slash) + "/violin_g.yaml";
  claims.truths[0].gesture = gesture.path().substr(slash + 1);
  const PlayedTruth sound = played(claims, claims.truths[0], 1.9);
  constexpr double kSlipping = 0.01;  // m/s
  const double period = kRates.audio_hz / 196.0;
  std::vector<double> onsets;
  Slips slips;
  const auto first = static_cast<std::size_t>(1.4 * kRates.audio_hz);
  const std::size_t end = sound.sounds[0].samples.size();
  bool slipped = true;
  for (std::size_t n = first; n < end; ++n) {
    const bool is_slipping =
        std::abs(sound.sounds[0].samples[n] - sound.sounds[1].samples[n]) > kSlipping;
    slips.share += is_slipping ? 1.0 / static_cast<double>(end - first) : 0.0;
    if (is_slipping && !slipped) {
      onsets.push_back(static_cast<double>(n) / period);
    }
    slipped = is_slipping;
  }
  slips.in_period = static_cast<double>(onsets.size()) * period / static_cast<double>(end - first);
  slips.shortest = 1e9;
  for (std::size_t i = 1; i < onsets.size(); ++i) {
    slips.longest = std::max(slips.longest, onsets[i] - onsets[i - 1]);
    slips.shortest = std::min(slips.shortest, onsets[i] - onsets[i - 1]);
  }
  return slips;
}

/// Helmholtz: it slips once in a period, for as much of it as lies beyond the bow. It begins with
/// more pressure, as players do: from rest this motion needs a multiple of what keeps it.
TEST(BowedViolinTest, SlipsOnceInAPeriodWhereItIsPlayable) {
  for (const double press_m : {0.0034, 0.0036, 0.004}) {  // 0.21, 0.28 and 0.42 N
    const Slips slips = bow(press_m, 0.0045);
    EXPECT_NEAR(slips.in_period, 1.0, 0.02) << press_m;
    EXPECT_NEAR(slips.longest, 1.0, 0.02) << press_m;
    EXPECT_NEAR(slips.shortest, 1.0, 0.02) << press_m;
    EXPECT_NEAR(slips.share, 1.0 - kBowed, 0.02) << press_m;
  }
}

/// Below the least force of Schelleng it slips more often, above the largest raggedly.
TEST(BowedViolinTest, DoesNotWhereTheForceIsTooSmallOrTooLarge) {
  for (const double press_m : {0.0031, 0.0032}) {  // 0.01 and 0.08 N
    EXPECT_GT(bow(press_m, press_m).in_period, 1.9) << press_m;
  }
  for (const double press_m : {0.006, 0.008}) {  // 1.1 and 1.8 N
    const Slips slips = bow(press_m, press_m);
    EXPECT_GT(slips.longest - slips.shortest, 0.5) << press_m;
  }
}

}  // namespace
}  // namespace ergotic::tools
