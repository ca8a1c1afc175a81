// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/wav.hpp"

#include <unistd.h>

#include <filesystem>
#include <random>

#include "support/test.hpp"

namespace ergotic::audio {
namespace {

class WavTest : public testing::Test {
 protected:
  WavTest() { std::filesystem::create_directories(folder_); }
  ~WavTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::vector<double> roundTrip(const std::vector<double>& samples,
                                int channels,
                                WavFormat format) const {
    WavWriter writer(path("x.wav"), 44100.0, channels, format);
    writer.write(samples.data(), static_cast<std::int64_t>(samples.size()) / channels);
    writer.finish();
    WavReader reader(path("x.wav"));
    EXPECT_EQ(reader.sampleRate(), 44100.0);
    EXPECT_EQ(reader.channels(), channels);
    EXPECT_EQ(reader.frames() * channels, static_cast<std::int64_t>(samples.size()));
    return reader.readAll();
  }

 private:
  std::string folder_ = testing::TempDir() + "ergotic_wav_" + std::to_string(getpid());
};

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> samples(count);
  for (double& sample : samples) {
    sample = uniform(random);
  }
  return samples;
}

TEST_F(WavTest, DoubleKeepsEveryBit) {
  std::vector<double> samples = noise(3 * 40'000);
  samples[0] = 1e-300;
  samples[1] = -1e6;
  EXPECT_EQ(roundTrip(samples, 3, WavFormat::kDouble), samples);
}

TEST_F(WavTest, FloatKeepsEveryBitOfAFloat) {
  std::vector<double> samples = noise(24 * 1000);
  for (double& sample : samples) {
    sample = static_cast<double>(static_cast<float>(sample));
  }
  samples[5] = 20.0;
  EXPECT_EQ(roundTrip(samples, 24, WavFormat::kFloat), samples);
}

TEST_F(WavTest, TwentyFourBitsRoundToTheNearestStep) {
  const std::vector<double> samples = noise(2 * 10'000);
  const std::vector<double> back = roundTrip(samples, 2, WavFormat::k24);
  ASSERT_EQ(back.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_LE(std::abs(back[i] - samples[i]), 0.5000001 / 8388608.0) << "sample " << i;
  }
}

TEST_F(WavTest, TwentyFourBitsClipAndCount) {
  const std::vector<double> samples{1.5, -1.5, 1.0, -1.0, 0.5};
  WavWriter writer(path("clip.wav"), 48000.0, 1, WavFormat::k24);
  writer.write(samples.data(), 5);
  EXPECT_EQ(writer.clippedSamples(), 2);
  writer.finish();
  constexpr double kTop = 8388607.0 / 8388608.0;
  EXPECT_EQ(WavReader(path("clip.wav")).readAll(),
            (std::vector<double>{kTop, -1.0, kTop, -1.0, 0.5}));
}

TEST_F(WavTest, BlocksOfFloatsAndDoublesJoinWithoutASeam) {
  const std::vector<double> samples{0.5, -0.25, 0.125, 0.0625};
  const std::vector<float> floats{0.75F, -0.75F};
  WavWriter writer(path("blocks.wav"), 44100.0, 2, WavFormat::kDouble);
  writer.write(samples.data(), 2);
  writer.write(floats.data(), 1);
  EXPECT_EQ(writer.frames(), 3);
  writer.finish();
  WavReader reader(path("blocks.wav"));
  std::vector<double> first(2);
  EXPECT_EQ(reader.read(first.data(), 1), 1);
  EXPECT_EQ(first, (std::vector<double>{0.5, -0.25}));
  EXPECT_EQ(reader.readAll(), (std::vector<double>{0.125, 0.0625, 0.75, -0.75}));
  EXPECT_EQ(reader.read(first.data(), 1), 0);
}

TEST_F(WavTest, ShortFilesArePlainWav) {
  roundTrip({0.0}, 1, WavFormat::kFloat);
  std::ifstream file(path("x.wav"), std::ios::binary);
  std::string magic(4, ' ');
  file.read(magic.data(), 4);
  EXPECT_EQ(magic, "RIFF");
}

TEST_F(WavTest, NonFiniteSamplesAreRefusedWhereTheyStand) {
  WavWriter writer(path("nan.wav"), 44100.0, 2, WavFormat::kFloat);
  std::vector<double> samples(10, 0.25);
  writer.write(samples.data(), 5);
  samples[7] = std::nan("");
  const std::string message = complaintOf([&] { writer.write(samples.data(), 5); });
  EXPECT_THAT(message, HasSubstr("nan.wav: sample 8 of channel 2 is nan"));
  const float infinite = -std::numeric_limits<float>::infinity();
  const std::vector<float> two{infinite, 0.0F};
  EXPECT_THROW(writer.write(two.data(), 1), Exception);
  writer.finish();
  EXPECT_EQ(WavReader(path("nan.wav")).frames(), 5);
}

TEST_F(WavTest, AFullDiskIsAnError) {
  const std::vector<double> samples(1 << 16, 0.5);
  const std::string message = complaintOf([&] {
    WavWriter writer("/dev/full", 44100.0, 1, WavFormat::kDouble);
    writer.write(samples.data(), 1 << 16);
    writer.finish();
  });
  EXPECT_THAT(message, HasSubstr("/dev/full"));
}

TEST_F(WavTest, UnusableFilesNamePathAndReason) {
  const std::string missing = complaintOf([&] { WavReader reader(path("missing.wav")); });
  EXPECT_THAT(missing, HasSubstr("missing.wav"));
  EXPECT_THAT(missing, HasSubstr("No such file"));
  std::ofstream(path("text.wav")) << "this is not a sound file at all, not even a little";
  const std::string text = complaintOf([&] { WavReader reader(path("text.wav")); });
  EXPECT_THAT(text, HasSubstr("text.wav: cannot read: "));
}

TEST_F(WavTest, UnusableSettingsAreRefused) {
  EXPECT_THROW(WavWriter(path("a.wav"), 44100.5, 1, WavFormat::kFloat), Exception);
  EXPECT_THROW(WavWriter(path("a.wav"), std::nan(""), 1, WavFormat::kFloat), Exception);
  EXPECT_THROW(WavWriter(path("a.wav"), 44100.0, 0, WavFormat::kFloat), Exception);
  EXPECT_THROW(WavWriter(path("no/folder/a.wav"), 44100.0, 1, WavFormat::kFloat), Exception);
  EXPECT_EQ(wavFormatOf("24"), WavFormat::k24);
  EXPECT_THROW(wavFormatOf("16"), Exception);
}

}  // namespace
}  // namespace ergotic::audio
