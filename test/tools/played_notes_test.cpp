// SPDX-License-Identifier: BSD-3-Clause
// Instruments that come along, played by notes through the maps that come with them: one key at a
// time sounds its pitch, with all hands that it takes.
#include <algorithm>
#include <cmath>
#include <vector>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/measure.hpp"
#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "tools/lib/measures.hpp"
#include "tools/lib/player.hpp"
#include "tools/midi_bytes.hpp"

namespace ergotic::tools {
namespace {

using test::cents;
using test::kRates;
using test::MidiBytes;
using test::ScratchFile;

constexpr double kBeginS = 0.25;
constexpr std::uint32_t kPulsesPerS = 960;

struct Melody {
  const char* name;
  std::vector<int> notes;
  double step_s;        ///< from note to note
  double held_s;        ///< longer than the step: slurred
  int partial;          ///< that is measured
  double within_cents;  ///< of equal temperament
};
void PrintTo(const Melody& melody, std::ostream* out) {
  *out << melody.name;
}

class MelodyTest : public ::testing::TestWithParam<Melody> {};

struct KeyStroke {
  double begin_s;
  double held_s;
  int note;
  int velocity;
};

/// The left channel, for so long.
Sound playedOf(const char* name, const std::vector<KeyStroke>& strokes, double seconds) {
  MidiBytes song;
  for (const KeyStroke& stroke : strokes) {
    const auto note = static_cast<std::uint8_t>(stroke.note);
    const auto velocity = static_cast<std::uint8_t>(stroke.velocity);
    const auto pulse = [](double s) { return static_cast<std::uint32_t>(s * kPulsesPerS); };
    song.add(1, pulse(stroke.begin_s), {0x90, note, velocity});
    song.add(1, pulse(stroke.begin_s + stroke.held_s), {0x80, note, 0});
  }
  const std::string file = repository("models/" + std::string(name) + ".yaml");
  auto performer = station::makePerformer(scene::readYaml(textOf(file), file), kRates,
                                          physics::Precision::kFloat, {});
  SoundInputs inputs({}, performer->instrument->scene(), kRates.audio_hz);
  const ScratchFile midi(song.text());
  const auto player =
      makeSongPlayer(std::move(performer), std::move(inputs), {}, readSong(midi.path()), "");
  const auto channels = static_cast<std::size_t>(player->outputChannels());
  std::vector<double> frames(static_cast<std::size_t>(kRates.ratio) * channels);
  Sound sound;
  sound.rate_hz = kRates.audio_hz;
  for (double t = 0.0; t < seconds && player->next(frames.data()); t += 1.0 / kRates.gesturalHz()) {
    for (std::size_t i = 0; i < frames.size(); i += channels) {
      sound.samples.push_back(frames[i]);
    }
  }
  return sound;
}

/// Until half a second after the last note.
Sound playedOf(const Melody& melody) {
  constexpr int kVelocity = 90;
  std::vector<KeyStroke> strokes;
  double begin_s = kBeginS;
  for (const int note : melody.notes) {
    strokes.push_back({begin_s, melody.held_s, note, kVelocity});
    begin_s += melody.step_s;
  }
  return playedOf(melody.name, strokes, begin_s + 0.5);
}

double loudest(const Sound& sound, double from_s, double to_s) {
  const auto at = [&sound](double s) {
    return sound.samples.begin() + std::lround(std::min(s, sound.seconds()) * sound.rate_hz);
  };
  const auto [least, most] = std::minmax_element(at(from_s), at(to_s));
  return std::max(-*least, *most);
}

TEST_P(MelodyTest, EachKeySoundsItsPitchAndEndsQuietly) {
  const Melody& melody = GetParam();
  const Sound sound = playedOf(melody);
  for (std::size_t i = 0; i < melody.notes.size(); ++i) {
    const double begin_s = kBeginS + (static_cast<double>(i) + 0.35) * melody.step_s;
    const double hz = melody.partial * 440.0 * std::exp2((melody.notes[i] - 69) / 12.0);
    const Line line = lineNear(sound, begin_s, 0.6 * melody.step_s, hz, 0.04);
    EXPECT_NEAR(cents(line.hz, hz), 0.0, melody.within_cents) << "note " << melody.notes[i];
    EXPECT_GT(line.amplitude, 2e-4) << "note " << melody.notes[i];
  }
  // A finger that lets go of a string, a bow that is lifted: all quieter than the notes.
  const double last_s = kBeginS + static_cast<double>(melody.notes.size() - 1) * melody.step_s;
  const double ended_s = last_s + melody.held_s;
  EXPECT_LT(loudest(sound, ended_s, sound.seconds()), 1.1 * loudest(sound, kBeginS, ended_s));
}

INSTANTIATE_TEST_SUITE_P(
    Instruments,
    MelodyTest,
    ::testing::Values(Melody{"violin_g", {55, 57, 60, 64, 67, 62}, 0.5, 0.45, 1, 10.0},
                      Melody{"violin_g", {55, 59, 62, 66, 67}, 0.5, 0.52, 1, 12.0},
                      Melody{"hurdy", {62, 64, 67, 71, 74}, 0.6, 0.55, 2, 16.0},
                      Melody{"guitar", {50, 53, 56, 58, 61, 63, 64, 67, 72}, 0.5, 0.4, 2, 10.0},
                      Melody{"guitar", {50, 53, 56, 58, 60, 62, 64, 67, 72}, 0.5, 0.4, 2, 10.0},
                      Melody{"saw", {64, 69, 76, 83}, 1.0, 0.9, 1, 12.0},
                      Melody{"sitar", {48, 50, 53, 49}, 0.8, 0.6, 1, 10.0},
                      Melody{"monochord", {48, 50, 53, 55, 36}, 0.8, 0.7, 1, 6.0},
                      Melody{"harmonics", {45, 57, 64, 69, 76}, 0.8, 0.5, 1, 6.0}));

struct Played {
  const char* name;
  int note;
};
void PrintTo(const Played& played, std::ostream* out) {
  *out << played.name;
}

class VelocityTest : public ::testing::TestWithParam<Played> {};

TEST_P(VelocityTest, WhoPlaysHarderIsLouder) {
  constexpr double kStepS = 1.5;
  constexpr double kHeldS = 0.3;
  const auto [name, note] = GetParam();
  std::vector<KeyStroke> strokes;
  for (const int velocity : {20, 64, 110, 127}) {
    const double begin_s = kBeginS + static_cast<double>(strokes.size()) * kStepS;
    strokes.push_back({begin_s, kHeldS, note, velocity});
  }
  const Sound sound = playedOf(name, strokes, strokes.back().begin_s + kStepS);
  std::vector<double> peaks;
  for (const KeyStroke& stroke : strokes) {
    peaks.push_back(loudest(sound, stroke.begin_s, stroke.begin_s + kStepS));
  }
  EXPECT_GT(peaks[0], 3e-3);
  EXPECT_GT(peaks[1], 1.2 * peaks[0]);
  EXPECT_GT(peaks[2], 1.05 * peaks[1]);
  EXPECT_GT(peaks[2], 2.0 * peaks[0]);
  EXPECT_GT(peaks[3], 0.95 * peaks[2]) << "faster than a hand can go";
  EXPECT_LT(peaks[2], 0.98) << "the limiter is for chords";
}

INSTANTIATE_TEST_SUITE_P(Instruments,
                         VelocityTest,
                         ::testing::Values(Played{"carillon", 60},
                                           Played{"cimbalom", 60},
                                           Played{"cymbal", 49},
                                           Played{"drum", 60},
                                           Played{"guitar", 40},
                                           Played{"guitar", 64},
                                           Played{"guitar", 67},
                                           Played{"kalimba12", 60},
                                           Played{"koto", 62},
                                           Played{"marimba12", 48},
                                           Played{"monochord", 60},
                                           Played{"piano12", 60},
                                           Played{"plate6", 60},
                                           Played{"steelpan", 60},
                                           Played{"string", 72},
                                           Played{"tabla", 38},
                                           Played{"tamtam", 60},
                                           Played{"timpani", 48}));

}  // namespace
}  // namespace ergotic::tools
