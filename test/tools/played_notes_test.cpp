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

MidiBytes songOf(const Melody& melody) {
  MidiBytes song;
  for (std::size_t i = 0; i < melody.notes.size(); ++i) {
    const auto note = static_cast<std::uint8_t>(melody.notes[i]);
    const double begin_s = kBeginS + static_cast<double>(i) * melody.step_s;
    const auto pulse = [](double s) { return static_cast<std::uint32_t>(s * kPulsesPerS); };
    song.add(1, pulse(begin_s), {0x90, note, 90});
    song.add(1, pulse(begin_s + melody.held_s), {0x80, note, 0});
  }
  return song;
}

/// The left channel, until half a second after the last note.
Sound playedOf(const Melody& melody) {
  const std::string file = repository("models/" + std::string(melody.name) + ".yaml");
  auto performer = station::makePerformer(scene::readYaml(textOf(file), file), kRates,
                                          physics::Precision::kFloat, {});
  SoundInputs inputs({}, performer->instrument->scene(), kRates.audio_hz);
  const ScratchFile midi(songOf(melody).text());
  const auto player =
      makeSongPlayer(std::move(performer), std::move(inputs), {}, readSong(midi.path()), "");
  const auto channels = static_cast<std::size_t>(player->outputChannels());
  std::vector<double> frames(static_cast<std::size_t>(kRates.ratio) * channels);
  Sound sound;
  sound.rate_hz = kRates.audio_hz;
  const double seconds = kBeginS + static_cast<double>(melody.notes.size()) * melody.step_s + 0.5;
  for (double t = 0.0; t < seconds && player->next(frames.data()); t += 1.0 / kRates.gesturalHz()) {
    for (std::size_t i = 0; i < frames.size(); i += channels) {
      sound.samples.push_back(frames[i]);
    }
  }
  return sound;
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
                      Melody{"saw", {64, 69, 76, 83}, 1.0, 0.9, 1, 12.0},
                      Melody{"sitar", {48, 50, 53, 49}, 0.8, 0.6, 1, 10.0},
                      Melody{"monochord", {48, 50, 53, 55, 36}, 0.8, 0.7, 1, 6.0},
                      Melody{"harmonics", {45, 57, 64, 69, 76}, 0.8, 0.5, 1, 6.0}));

}  // namespace
}  // namespace ergotic::tools
