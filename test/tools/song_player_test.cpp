// SPDX-License-Identifier: BSD-3-Clause
// A MIDI file plays a scene offline: which slices move when, and which parameters.
#include <cmath>

#include "ergotic/audio/wav.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"
#include "tools/lib/player.hpp"
#include "tools/lib/score.hpp"
#include "tools/midi_bytes.hpp"

namespace ergotic::tools {
namespace {

using test::kRates;
using test::MidiBytes;
using test::ScratchFile;

constexpr double kTickHz = 3150.0;
constexpr double kWayM = 0.01;
constexpr std::size_t kSlices = 3;

// Three slices, each heard by an output of its own, and a constant that is as loud as a parameter.
const char kThreeSlices[] = R"(ergotic: 1
parameters: {volume: {value: 1, range: [0, 2]}}
sections: {k: {rate: gestural}}
mats:
  'key_{k}': {for: {k: 0..2}, type: slice, section: k, at: ['=0.1*k', 0]}
  wall: {type: ground, section: k, x: 1}
  floor: {type: ground, section: k}
  place: {type: ground, section: k, x: 0.5}
lias: {touch: {type: contact, between: [key_0, wall], stiffness: 100}}
ports: {'key_{k}': {for: {k: 0..2}, mat: 'key_{k}', slice: =k}}
outputs:
  'key_{k}': {for: {k: 0..2}, at: 'key_{k}', quantity: position, channel: =k+1}
  place: {at: place, quantity: position, channel: 4, gain: $volume}
)";
const char kMapOfThree[] = R"(keys:
  - {notes: [60, 62], slices: [0, 1, 2], to: 10 mm, speed: 0.5, back: 0.5}
controllers: [{controller: 7, parameter: volume}]
)";
constexpr double kGlideS = tgr::HandMove::kPeakOfMean * kWayM / 0.5;

std::unique_ptr<station::Performer> threeSlices(const std::string& scene = kThreeSlices) {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  return station::makePerformer(scene::readYaml(scene, "nowhere/three.yaml"), kRates,
                                physics::Precision::kDouble, policy);
}

Song songOf(const MidiBytes& bytes) {
  const ScratchFile file(bytes.text());
  return readSong(file.path());
}

std::unique_ptr<Player> threeSlicesPlayedBy(const Song& song,
                                            const std::string& map,
                                            const std::string& scene = kThreeSlices) {
  auto performer = threeSlices(scene);
  SoundInputs inputs({}, performer->instrument->scene(), kRates.audio_hz);
  return makeSongPlayer(std::move(performer), std::move(inputs), {}, song, map);
}

/// [ticks][outputs], of the last frame of each.
using Ticks = std::vector<std::array<double, kSlices + 1>>;

Ticks heard(const Song& song,
            const std::string& map_text,
            int ticks,
            const std::string& scene = kThreeSlices) {
  const ScratchFile map(map_text);
  const auto player = threeSlicesPlayedBy(song, map.path(), scene);
  Ticks heard;
  std::vector<double> frames(static_cast<std::size_t>(kRates.ratio * player->outputChannels()));
  for (int n = 0; n < ticks; ++n) {
    EXPECT_TRUE(player->next(frames.data()));
    heard.emplace_back();
    std::copy(frames.end() - kSlices - 1, frames.end(), heard.back().begin());
  }
  return heard;
}

/// The first tick after which the slice is beyond half of its way, with the share of a tick.
double halfWayAt(const Ticks& heard, std::size_t slice) {
  for (std::size_t n = 1; n < heard.size(); ++n) {
    const double before = heard[n - 1][slice];
    const double now = heard[n][slice];
    if (now > 0.5 * kWayM) {
      return static_cast<double>(n) - (now - 0.5 * kWayM) / (now - before);
    }
  }
  return 0.0;
}

/// Notes at 0.25 s, 0.501041666 s and 1.5 s, of two tracks, after a change of tempo.
MidiBytes threeNotes() {
  MidiBytes song;
  song.tempo(1, 0, 500'000).tempo(1, 480, 1'000'000);
  song.add(1, 240, {0x90, 60, 100});
  return song.add(2, 481, {0x90, 61, 100}).add(2, 960, {0x90, 62, 100});
}

TEST(SongPlayerTest, StrokesBeginWhenTheirNotesDo) {
  const Song song = songOf(threeNotes());
  const Ticks played = heard(song, kMapOfThree, 5200);
  const double times_s[] = {0.25, 0.5 + 1.0 / 480.0, 1.5};
  for (std::size_t slice = 0; slice < kSlices; ++slice) {
    const double begin = times_s[slice] * kTickHz;
    for (std::size_t n = 0; n < static_cast<std::size_t>(begin); ++n) {
      ASSERT_NEAR(played[n][slice], 0.0, 1e-5) << "slice " << slice << ", tick " << n;
    }
    EXPECT_NEAR(halfWayAt(played, slice) - begin, 0.5 * kGlideS * kTickHz, 1.5) << slice;
  }
  // Each is as late as the others, to a tenth of a tick, whatever share of a tick it is due at.
  const double first = halfWayAt(played, 0) - times_s[0] * kTickHz;
  EXPECT_NEAR(halfWayAt(played, 1) - times_s[1] * kTickHz, first, 0.1);
  EXPECT_NEAR(halfWayAt(played, 2) - times_s[2] * kTickHz, first, 0.1);
}

/// A hand that meets a spring goes as far at the first note as at one that comes much later.
TEST(SongPlayerTest, TheFirstNoteMeetsAsMuchForceAsLaterOnes) {
  std::string scene = kThreeSlices;
  const std::string contact = "contact, between: [key_0, wall], stiffness: 100";
  scene.replace(scene.find(contact), contact.size(),
                "spring, between: [key_0, floor], stiffness: 200");
  MidiBytes song;
  song.add(1, 240, {0x90, 60, 100}).add(1, 480, {0x80, 60, 0});    // from 0.25 s to 0.5 s
  song.add(1, 2880, {0x90, 60, 100}).add(1, 3120, {0x80, 60, 0});  // from 3 s to 3.25 s
  const Ticks played = heard(songOf(song), kMapOfThree, 11000, scene);
  const auto furthest = [&](double from_s) {
    const auto from = static_cast<std::size_t>(from_s * kTickHz);
    double most = 0.0;
    for (std::size_t n = from; n < from + static_cast<std::size_t>(0.4 * kTickHz); ++n) {
      most = std::max(most, played[n][0]);
    }
    return most;
  };
  EXPECT_GT(furthest(3.0), 0.1 * kWayM);
  EXPECT_NEAR(furthest(0.25), furthest(3.0), 1e-3 * kWayM);
}

TEST(SongPlayerTest, PlaysBitForBitWhatTheSameMovesDoAtAStation) {
  const Ticks played = heard(songOf(threeNotes()), kMapOfThree, 5200);
  replay::OfflineStation station(threeSlices(), tgr::makeVirtualDriver({}), kSlices + 1);
  station::Command engage;
  engage.type = station::Command::Type::kEngage;
  station.submit(engage);
  const double times_s[] = {0.25, 0.5 + 1.0 / 480.0, 1.5};
  std::vector<double> frames(static_cast<std::size_t>(kRates.ratio) * (kSlices + 1));
  for (std::size_t n = 0; n < played.size(); ++n) {
    for (std::size_t slice = 0; slice < kSlices; ++slice) {
      if (std::floor(times_s[slice] * kTickHz + 1e-6) == static_cast<double>(n)) {
        tgr::HandMove move;
        move.slice = static_cast<int>(slice);
        move.target_m = kWayM;
        move.glide_s = kGlideS;
        move.grip = tgr::HandGrip::kKey;
        station.move(move, times_s[slice] * kTickHz);
      }
    }
    station.cycle(frames.data());
    ASSERT_TRUE(std::equal(played[n].begin(), played[n].end(), frames.end() - kSlices - 1)) << n;
  }
}

TEST(SongPlayerTest, AControllerSetsItsParameterFromItsTickOn) {
  MidiBytes bytes;
  bytes.add(1, 960, {0xb0, 7, 127}).add(1, 1440, {0xb0, 7, 64}).add(1, 1440, {0xb0, 7, 0});
  const Ticks played = heard(songOf(bytes), kMapOfThree, 5000);
  for (std::size_t n = 0; n < played.size(); ++n) {
    const double volume = n < 3150 ? 1.0 : n < 4725 ? 2.0 : 0.0;
    ASSERT_NEAR(played[n][kSlices], 0.5 * volume, 1e-6) << n;
  }
}

TEST(SongPlayerTest, CoordinatesOfAnEndEffectorBecomeItsSlices) {
  tgr::EndEffectorConfig ball;
  ball.name = "mallet";
  ball.type = tgr::EndEffectorType::kBall;
  ball.slices = {4, 2, 7};
  tgr::EndEffectors end_effectors;
  end_effectors.list = {ball};
  const SongMap map{
      tgr::readPlayMap("keys: [{end_effector: mallet, coordinates: 2, to: 0.01}]", "map"), "map"};
  MidiBytes bytes;
  const scene::Scene scene = scene::readYaml(kThreeSlices, "three.yaml");
  const Score score =
      scoreOf(songOf(bytes.add(1, 480, {0x90, 60, 100})), map, scene, end_effectors, 12);
  ASSERT_EQ(score.moves.size(), 3U);
  EXPECT_THAT(score.warnings, testing::IsEmpty());
  std::array<double, 3> q{};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(score.moves[i].move.slice, ball.slices[i]);
    EXPECT_EQ(score.moves[i].time_s, 0.5);
    q[i] = score.moves[i].move.target_m;
  }
  std::array<double, 3> x{};
  std::array<double, 9> jacobian{};
  ASSERT_TRUE(tgr::makeKinematics(ball, "")->forward(q.data(), x.data(), jacobian.data()));
  EXPECT_NEAR(x[0], 0.0, 1e-6);
  EXPECT_NEAR(x[1], 0.0, 1e-6);
  EXPECT_NEAR(x[2], 0.01, 1e-6);
}

TEST(SongPlayerTest, WithoutAMapEachSliceIsAKeyFromMiddleCOn) {
  const auto player = threeSlicesPlayedBy(songOf(threeNotes()), "");
  EXPECT_THAT(player->gestureWarnings(10.0, 0.0), testing::IsEmpty());
  EXPECT_NEAR(player->usualSeconds(), 4.5, 1e-9);
}

TEST(SongPlayerTest, SaysWhatItPassesOver) {
  const ScratchFile map(
      "keys:\n"
      "  - {notes: [60, 61], slices: [0, 40], to: 10 mm}\n"
      "  - {notes: [62, 80], end_effector: mallet, coordinates: 2, to: -0.01}\n"
      "controllers: [{controller: 7, parameter: colour}]\n");
  MidiBytes bytes = threeNotes();
  bytes.add(1, 0, {0xc0, 5}).add(1, 0, {0xb0, 7, 1});
  const auto player = threeSlicesPlayedBy(songOf(bytes), map.path());
  EXPECT_THAT(
      player->gestureWarnings(1.0, 0.0),
      testing::ElementsAre(
          HasSubstr("end-effector 'mallet' are passed over"),
          HasSubstr("1 of 3 notes have no key and are passed over: they are within 62...62"),
          HasSubstr("program changes are passed over"),
          HasSubstr("the scene has no parameter 'colour'"),
          HasSubstr("slice is 40, allowed: 0...11"), HasSubstr("it ends 0.5 s after")));
}

TEST(SongPlayerTest, RefusesASongOfWhichNoNoteHasAKey) {
  const ScratchFile map(
      "keys:\n  - {notes: [40, 50], slices: 0, to: 10 mm}\n"
      "  - {notes: [70, 70], slices: 0, to: 10 mm}\ntranspose: 2\n");
  try {
    threeSlicesPlayedBy(songOf(threeNotes()), map.path());
    FAIL();
  } catch (const Exception& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("no note has a key: its notes are 60...62, " +
                                          map.path() + " has keys for 38...48, 68"));
  }
}

TEST(SongPlayerTest, RenderPlaysAnInstrumentByTheMapBesideIt) {
  MidiBytes bytes;
  bytes.add(1, 48, {0x90, 72, 100}).add(1, 96, {0x90, 40, 90}).add(1, 480, {0x80, 72, 0});
  const ScratchFile song(bytes.text());
  const std::string scene = test::repository("models/string.yaml");
  std::vector<double> sounds[2];
  for (std::vector<double>& sound : sounds) {
    const ScratchFile wav;
    const test::Outcome outcome =
        test::run("render", scene + " --midi " + song.path() + " --out " + wav.path());
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    sound = audio::WavReader(wav.path()).readAll();
  }
  EXPECT_EQ(sounds[0], sounds[1]);
  EXPECT_EQ(sounds[0].size(), 2U * 154350U) << "3.5 s";
  const auto is_heard = [](double sample) { return std::abs(sample) > 0.01; };
  EXPECT_TRUE(std::any_of(sounds[0].begin(), sounds[0].end(), is_heard));
  EXPECT_FALSE(std::any_of(sounds[0].begin(), sounds[0].begin() + 2 * 2205, is_heard));
}

TEST(SongPlayerTest, RenderRefusesWhatDoesNotGoTogether) {
  const std::string scene = test::repository("models/string.yaml");
  const std::string gesture = test::repository("models/string_demo.csv");
  const test::Outcome both = test::run("render", scene + " --midi x.mid --gesture " + gesture);
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.text, AllOf(HasSubstr("--midi"), HasSubstr("--gesture")));
  EXPECT_EQ(test::run("render", scene + " --map x.yaml").code, 2);
  EXPECT_EQ(test::run("render", scene + " --midi x.mid --feel slice:0").code, 2);
  const test::Outcome no_song = test::run("render", scene + " --midi " + gesture);
  EXPECT_EQ(no_song.code, 1);
  EXPECT_THAT(no_song.text, HasSubstr(gesture + ": byte 0: error: this is not a MIDI file"));
}

}  // namespace
}  // namespace ergotic::tools
