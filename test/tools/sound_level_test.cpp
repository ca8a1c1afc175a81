// SPDX-License-Identifier: BSD-3-Clause
// Loudness and true peak against closed forms of ITU-R BS.1770-4, and what is made of them.
#include "tools/lib/sound_level.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tools/lib/frame_writer.hpp"

namespace ergotic::tools {
namespace {

using test::ScratchFile;

constexpr double kSoundRate = 48000.0;

/// A sine of 997 Hz, the same in all channels.
std::vector<double> sine(double amplitude, double seconds, int channels, double hz = 997.0) {
  std::vector<double> frames;
  for (int n = 0; n < static_cast<int>(seconds * kSoundRate); ++n) {
    const double x = amplitude * std::sin(2.0 * kPi * hz * n / kSoundRate + 0.25 * kPi);
    frames.insert(frames.end(), static_cast<std::size_t>(channels), x);
  }
  return frames;
}

void write(FrameWriter& writer, const std::vector<double>& frames, int channels) {
  writer.write(frames.data(), static_cast<std::int64_t>(frames.size()) / channels);
  writer.finish();
}

SoundLevel levelOfSine(double amplitude, int channels, double hz = 997.0) {
  const ScratchFile file;
  FrameWriter writer(file.path(), kSoundRate, channels, audio::WavFormat::kDouble);
  write(writer, sine(amplitude, 5.0, channels, hz), channels);
  return levelOf(file.path());
}

TEST(SoundLevelTest, ASineOfFullScaleIsThreeDecibelsBelowItInOneChannel) {
  // BS.1770-4: 0 dBFS at 997 Hz in one channel reads -3.01 LUFS, in two channels 3.01 dB more.
  EXPECT_NEAR(*levelOfSine(1.0, 1).loudness, -3.01, 0.02);
  EXPECT_NEAR(*levelOfSine(1.0, 2).loudness, 0.0, 0.02);
  EXPECT_NEAR(*levelOfSine(0.1, 2).loudness, -20.0, 0.02);
  EXPECT_NEAR(*levelOfSine(0.1, 3).loudness, -23.01 + 4.77, 0.03);
}

TEST(SoundLevelTest, TheTruePeakLiesBetweenTheSamples) {
  // A quarter of the rate, 45 degrees off: all samples are at 0.707 of the wave's peak.
  const SoundLevel level = levelOfSine(0.5, 1, kSoundRate / 4.0);
  EXPECT_NEAR(level.peaks[0], 0.5 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(level.true_peak_db, 20.0 * std::log10(0.5), 0.3);
}

TEST(SoundLevelTest, SaysWhatClipsAndWhatIsSilent) {
  const SoundLevel loud = levelOfSine(1.5, 2);
  EXPECT_THAT(describe(loud), HasSubstr("; channel 1 clips: its peak is 1.50, allowed 1"));
  const SoundLevel silent = levelOfSine(0.0, 2);
  EXPECT_FALSE(silent.loudness);
  EXPECT_EQ(describe(silent), "softer than -70 LUFS, silent");
  EXPECT_EQ(normalizingGain(silent, -18.0), 1.0);
}

TEST(SoundLevelTest, NormalizingStopsAtTheHighestPeak) {
  EXPECT_NEAR(normalizingGain(levelOfSine(0.1, 2), -18.0), std::pow(10.0, 2.0 / 20.0), 1e-3);
  EXPECT_NEAR(normalizingGain(levelOfSine(0.1, 2), -0.5), 10.0 * std::pow(10.0, -1.0 / 20.0), 0.02);
}

TEST(FrameWriterTest, NormalizesAndFadesAsIsWished) {
  const ScratchFile file;
  SoundWish wish;
  wish.loudness = -18.0;
  wish.fade_s = 0.5;
  FrameWriter writer(file.path(), kSoundRate, 2, audio::WavFormat::kFloat, wish);
  const std::vector<double> played = sine(0.5, 5.0, 2);
  write(writer, played, 2);
  EXPECT_NEAR(*writer.level()->loudness, -18.0, 0.2) << "the fade takes a little";
  const std::vector<double> kept = audio::WavReader(file.path()).readAll();
  ASSERT_EQ(kept.size(), played.size());
  for (std::size_t i = 0; i < kept.size(); i += 997) {
    const double left_s =
        (static_cast<double>(kept.size() / 2 - 1) - static_cast<double>(i / 2)) / kSoundRate;
    const double fade = left_s < 0.5 ? 0.5 - 0.5 * std::cos(kPi * left_s / 0.5) : 1.0;
    EXPECT_NEAR(kept[i], writer.gain() * fade * played[i], 1e-6) << i;
  }
  EXPECT_EQ(kept.back(), 0.0);
}

TEST(FrameWriterTest, FollowsLinksAndRefusesWhatIsNoRegularFile) {
  const ScratchFile target("old");
  const ScratchFile place;
  const std::string link = place.path() + ".link";
  ASSERT_EQ(symlink(target.path().c_str(), link.c_str()), 0);
  FrameWriter writer(link, kSoundRate, 1, audio::WavFormat::kFloat);
  write(writer, sine(0.1, 0.1, 1), 1);
  EXPECT_EQ(audio::WavReader(target.path()).frames(), 4800);
  char to[4096] = {};
  EXPECT_GT(readlink(link.c_str(), to, sizeof to), 0) << "the link is still one";
  unlink(link.c_str());
  for (const char* const path : {"/dev/null", "/tmp"}) {
    EXPECT_THAT(
        complaintOf<Exception>([&] { FrameWriter(path, kSoundRate, 1, audio::WavFormat::kFloat); }),
        HasSubstr("is no regular file"))
        << path;
  }
}

}  // namespace
}  // namespace ergotic::tools
