// SPDX-License-Identifier: BSD-3-Clause
#include "audio/midi_sources.hpp"

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/exception.hpp"
#include "support/test.hpp"

namespace ergotic::audio {
namespace {

bool wants(const std::string& wish, const std::vector<std::string>& names, bool is_physical) {
  return MidiSources(wish).wants(names, is_physical);
}

TEST(MidiSourcesTest, AreUsuallyAllThatAreHardware) {
  EXPECT_TRUE(wants(kPhysicalMidi, {"system:midi_capture_1"}, true));
  EXPECT_FALSE(wants(kPhysicalMidi, {"physical:out"}, false));
}

TEST(MidiSourcesTest, AreThoseWithANameInWhichTheWishIsFound) {
  const std::vector<std::string> names = {"system:midi_capture_2", "alsa_pcm:nanoKEY2/midi_1"};
  EXPECT_TRUE(wants("nanoKEY", names, true));
  EXPECT_TRUE(wants("NANOkey[0-9]", names, false)) << "hardware or not";
  EXPECT_TRUE(wants("capture_(1|2)$", names, true));
  EXPECT_FALSE(wants("nanoKONTROL", names, true));
}

TEST(MidiSourcesTest, AreNoneIfNoneShallBe) {
  EXPECT_FALSE(wants(kNoMidi, {"none:out"}, true));
  EXPECT_FALSE(wants("", {"system:midi_capture_1"}, true));
}

TEST(MidiSourcesTest, WhatIsNoRegularExpressionIsRefused) {
  EXPECT_THAT(complaintOf<Exception>([] { MidiSources("nano["); }),
              HasSubstr("allowed: physical, none, or a part of the names of ports"));
}

}  // namespace
}  // namespace ergotic::audio
