// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/wav.hpp"

#include <unistd.h>

#include <filesystem>
#include <random>

#include "audio/wav_header.hpp"
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

/// Little-endian, of bytes.
std::uint64_t numberAt(const std::string& bytes, std::size_t at, int width) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + at, static_cast<std::size_t>(width));
  return number;
}

std::string bytesOf(const std::vector<float>& samples) {
  std::string bytes(samples.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return bytes;
}

/// A header with what is said of sizes, in place of the truth.
std::string headerSaying(std::uint32_t riff, std::uint32_t data) {
  std::string header = wavHeader({44100, 1, 4, true}, 0);
  std::memcpy(header.data() + 4, &riff, 4);
  std::memcpy(header.data() + header.size() - 4, &data, 4);
  return header;
}

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

TEST(WavHeaderTest, IsPlainForUpToTwoChannels) {
  for (const int channels : {1, 2, 3, 24}) {
    for (const int bytes : {2, 3, 4}) {
      const WavShape shape{48000, channels, bytes, bytes == 4};
      const std::string header = wavHeader(shape, 10);
      const bool is_plain = channels <= 2;
      EXPECT_EQ(header.substr(0, 4), "RIFF");
      EXPECT_EQ(numberAt(header, 4, 4) + 8, header.size() + 10U * channels * bytes);
      EXPECT_EQ(header.substr(8, 8), "WAVEfmt ");
      EXPECT_EQ(numberAt(header, 16, 4), is_plain ? (bytes == 4 ? 18 : 16) : 40);
      EXPECT_EQ(numberAt(header, 20, 2), is_plain ? (bytes == 4 ? 3 : 1) : 0xFFFE);
      EXPECT_EQ(numberAt(header, 22, 2), channels);
      EXPECT_EQ(numberAt(header, 32, 2), channels * bytes);
      EXPECT_EQ(header.substr(header.size() - 8, 4), "data");
      EXPECT_EQ(numberAt(header, header.size() - 4, 4), 10U * channels * bytes);
    }
  }
}

TEST(WavHeaderTest, IsRf64OnlyWhere32BitsDoNotHoldTheSize) {
  const WavShape shape{44100, 2, 3, false};
  const std::size_t length = wavHeader(shape, 0).size();
  const auto most = static_cast<std::int64_t>((0xFFFFFFFEU - (length - 8)) / 6);
  EXPECT_EQ(wavHeader(shape, most).substr(0, 4), "RIFF");
  const std::string header = wavHeader(shape, most + 1);
  EXPECT_EQ(header.size(), length);
  EXPECT_EQ(header.substr(0, 4), "RF64");
  EXPECT_EQ(numberAt(header, 4, 4), 0xFFFFFFFFU);
  EXPECT_EQ(header.substr(12, 4), "ds64");
  EXPECT_EQ(numberAt(header, 20, 8), length - 8 + 6 * static_cast<std::uint64_t>(most + 1));
  EXPECT_EQ(numberAt(header, 28, 8), 6 * static_cast<std::uint64_t>(most + 1));
  EXPECT_EQ(numberAt(header, 36, 8), static_cast<std::uint64_t>(most + 1));
  EXPECT_EQ(numberAt(header, header.size() - 4, 4), 0xFFFFFFFFU);
}

TEST_F(WavTest, OddNumbersOfBytesArePadded) {
  EXPECT_EQ(roundTrip({0.5, -0.5, 0.25}, 1, WavFormat::k24),
            (std::vector<double>{0.5, -0.5, 0.25}));
  EXPECT_EQ(std::filesystem::file_size(path("x.wav")) % 2, 0);
}

/// Of recorders that were killed, or wrote to a pipe.
TEST_F(WavTest, WhatDoesNotSayHowLongItIsIsReadUpToItsEnd) {
  const std::vector<float> samples{0.5F, -0.25F, 0.125F};
  std::string rf64 = wavHeader({44100, 1, 4, true}, std::int64_t{1} << 32);
  std::memset(rf64.data() + 20, 0, 24);  // sizes
  for (const std::string& header :
       {headerSaying(0, 0), headerSaying(0xFFFFFFFF, 0xFFFFFFFF), headerSaying(0, 0xFFFFFFFF),
        headerSaying(0xFFFFFFFF, 0), wavHeader({44100, 1, 4, true}, 0),
        wavHeader({44100, 1, 4, true}, kUnknownFrames), rf64}) {
    std::ofstream(path("killed.wav"), std::ios::binary) << header << bytesOf(samples) << "\x01\x02";
    WavReader reader(path("killed.wav"));
    EXPECT_TRUE(reader.isUnfinished());
    EXPECT_EQ(reader.sampleRate(), 44100.0);
    EXPECT_EQ(reader.frames(), 3);
    EXPECT_EQ(reader.readAll(), (std::vector<double>{0.5, -0.25, 0.125}));
  }
}

TEST_F(WavTest, KilledFilesOfEveryFormatAreRead) {
  for (const int bytes : {1, 2, 3, 4}) {
    for (const int channels : {1, 2, 3}) {
      std::ofstream(path("killed.wav"), std::ios::binary)
          << wavHeader({48000, channels, bytes, false}, kUnknownFrames)
          << std::string(static_cast<std::size_t>(5 * channels * bytes), '\x40');
      WavReader reader(path("killed.wav"));
      EXPECT_EQ(reader.channels(), channels);
      EXPECT_EQ(reader.frames(), 5);
      const std::vector<double> sound = reader.readAll();
      EXPECT_EQ(sound.size(), 5U * channels);
      EXPECT_NEAR(sound.back(), bytes == 1 ? -0.5 : 0.5, 0.01);
    }
  }
}

TEST_F(WavTest, EmptyFilesAreNotTakenForKilledOnes) {
  const std::string other = "LIST\x08" + std::string("\0\0\0", 3) + "INFOabcd";
  std::string header = wavHeader({44100, 1, 4, true}, 0);
  for (const std::string& after : {std::string(), other}) {
    const auto riff = static_cast<std::uint32_t>(header.size() + after.size() - 8);
    std::memcpy(header.data() + 4, &riff, 4);
    std::ofstream(path("empty.wav"), std::ios::binary) << header << after;
    WavReader reader(path("empty.wav"));
    EXPECT_FALSE(reader.isUnfinished());
    EXPECT_EQ(reader.frames(), 0);
    EXPECT_TRUE(reader.readAll().empty());
  }
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
