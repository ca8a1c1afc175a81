// SPDX-License-Identifier: BSD-3-Clause
// What is read of MIDI files, and what is refused.
#include "tools/lib/song.hpp"

#include <random>

#include "ergotic/exception.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tools/midi_bytes.hpp"

namespace ergotic::tools {
namespace {

using test::MidiBytes;
using test::ScratchFile;

/// Two tracks; a quarter takes 0.5 s, from the first one on 1 s.
MidiBytes twoTracks() {
  MidiBytes song;
  song.tempo(1, 0, 500'000).tempo(1, 480, 1'000'000);
  song.add(1, 960, {0xb0, 7, 100});
  song.add(2, 240, {0x91, 60, 64}).add(2, 480, {62, 1});  // running status
  song.add(2, 500, {0xf0, 3, 1, 2, 0xf7}).add(2, 720, {0xc1, 5}).add(2, 1440, {0x81, 60, 0});
  return song;
}

std::string refusalOfSong(const std::string& bytes) {
  const ScratchFile file(bytes);
  try {
    readSong(file.path());
  } catch (const Exception& refusal) {
    EXPECT_THAT(refusal.what(), testing::StartsWith(file.path() + ": "));
    return refusal.what();
  }
  return "";
}

TEST(SongTest, HasTheMessagesOfAllTracksInOrderAtTheTimesOfAllTempos) {
  const ScratchFile file(twoTracks().text());
  const Song song = readSong(file.path());
  ASSERT_EQ(song.messages.size(), 5U);
  const double times_s[] = {0.25, 0.5, 1.0, 1.5, 2.5};
  const std::array<std::uint8_t, 3> bytes[] = {
      {0x91, 60, 64}, {0x91, 62, 1}, {0xc1, 5, 0}, {0xb0, 7, 100}, {0x81, 60, 0}};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(song.messages[i].time_s, times_s[i], 1e-9) << i;
    EXPECT_EQ(song.messages[i].bytes, bytes[i]) << i;
    EXPECT_EQ(song.messages[i].size, i == 2 ? 2 : 3) << i;
  }
  EXPECT_THAT(song.warnings, testing::IsEmpty());
}

/// libsmf gives the first event of a later track too early.
TEST(SongTest, ATrackThatBeginsLateIsInOrderToo) {
  MidiBytes bytes;
  bytes.add(1, 0, {0x90, 60, 1}).add(1, 240, {0x90, 61, 1}).add(2, 481, {0x90, 62, 1});
  const ScratchFile file(bytes.add(1, 481, {0x90, 63, 1}).text());
  std::vector<int> notes;
  for (const Song::Message& message : readSong(file.path()).messages) {
    notes.push_back(message.bytes[1]);
  }
  EXPECT_THAT(notes, testing::ElementsAre(60, 61, 63, 62));
}

TEST(SongTest, WhatIsNoMidiFileIsRefusedWithPlaceAndReason) {
  EXPECT_THAT(refusalOfSong("0,0,0.01\n"),
              AllOf(HasSubstr("byte 0: error"), HasSubstr("not a MIDI file")));
  const std::string good = twoTracks().text();
  const auto with = [&](std::size_t at, char byte) {
    std::string bad = good;
    bad[at] = byte;
    return refusalOfSong(bad);
  };
  EXPECT_THAT(with(9, 2), HasSubstr("byte 8: error: the format is 2, allowed: 0 and 1"));
  EXPECT_THAT(with(12, '\xe7'), HasSubstr("byte 12: error: the division is 59360, allowed: 1"));
  EXPECT_THAT(with(11, 3), HasSubstr("the file has 2 tracks, allowed: 3"));
  EXPECT_THAT(with(23, '\x12'), HasSubstr("byte 23: error: an event begins with 0x12"));
  EXPECT_THAT(refusalOfSong(MidiBytes().tempo(1, 0, 0).text()), HasSubstr("a tempo is 0 us"));
  EXPECT_THAT(refusalOfSong(MidiBytes().tempo(1, 0, 1).text()),
              HasSubstr("no message of a channel is in it"));
  MidiBytes endless;
  for (const std::uint32_t pulse : {0U, 250'000'000U, 500'000'000U, 750'000'000U}) {
    endless.tempo(1, pulse, 0xffffff).add(1, pulse, {0x90, 60, 1});
  }
  EXPECT_THAT(refusalOfSong(endless.text()), HasSubstr("allowed: 0...1e6 s"));
  EXPECT_THROW(readSong("/nowhere/song.mid"), Exception);
}

/// libsmf ends the process at many of them.
TEST(SongTest, AFileThatBreaksOffAnywhereIsRefused) {
  const std::string good = twoTracks().text();
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_NE(refusalOfSong(good.substr(0, size)), "") << size;
  }
}

TEST(SongTest, AnyBytesAreReadOrRefused) {
  const std::string good = twoTracks().text();
  std::mt19937 random(1);
  int read = 0;
  for (int n = 0; n < 3000; ++n) {
    std::string bad = good;
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
      bad[random() % bad.size()] = static_cast<char>(random());
    }
    read += refusalOfSong(bad).empty() ? 1 : 0;
  }
  EXPECT_GT(read, 300);
  EXPECT_LT(read, 2700);
}

}  // namespace
}  // namespace ergotic::tools
