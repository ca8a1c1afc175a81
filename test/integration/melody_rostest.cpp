// SPDX-License-Identifier: BSD-3-Clause
// A MIDI file that is played to a station: whether all notes come to the slices in time, and when
// they sound.
#include <iostream>

#include <ergotic/PlayMap.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "integration/gesture_record.hpp"
#include "integration/melody_player.hpp"
#include "integration/station_services.hpp"
#include "support/jack_server.hpp"
#include "support/reference_threads.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr std::int64_t kBeforeNs = 10'000'000;  // a note is sent
constexpr std::int64_t kUntilPlayedNs = 25'000'000;
constexpr std::int64_t kHeldUpNs = 500'000;
constexpr int kKeys = 4;
constexpr double kWayM = 0.006;
// Where a key meets its bar: half of its way, where it is fastest.
constexpr double kBarM = 0.003;

// Four keys below bars that ring for 0.1 s, each heard by an output of its own.
const char kKeysAndBars[] = R"(ergotic: 1
name: keys and bars
sections:
  keys: {rate: gestural}
  bars: {rate: audio}
mats:
  'key_{k}': {for: {k: 0..3}, type: slice, coupling: smooth, section: keys, at: ['=0.1*k', 0], rest: -0.003}
  'bar_{k}': {for: {k: 0..3}, type: cell, section: bars, mass: 0.02, stiffness: 150 kN/m, damping: 2.5,
              at: ['=0.1*k', 0]}
lias:
  'touch_{k}': {for: {k: 0..3}, type: contact, between: ['key_{k}', 'bar_{k}'], stiffness: 400, damping: 0.1}
ports:
  'key_{k}': {for: {k: 0..3}, mat: 'key_{k}', slice: =k}
outputs:
  'bar_{k}': {for: {k: 0..3}, at: 'bar_{k}', quantity: velocity, channel: =k+1, gain: 20}
)";
// Notes from 60 on strike. Note 72 stays down as long as it is held.
const char kMap[] = R"(keys:
  - {notes: [60, 63], slices: [0, 1, 2, 3], to: 6 mm, speed: [0.1, 1], back: 1, strikes: true}
  - {notes: [72, 72], slices: 0, to: 6 mm, speed: [0.1, 1], back: 1}
)";
constexpr int kFirstNote = 60;
constexpr int kHeldNote = 72;

class MelodyTest : public ::testing::Test {
 protected:
  struct World {
    World() {
      server.start();
      node.setParam("/station/model", kKeysAndBars);
      node.setParam("/station/midi_connect", "none");
      node.setParam("/station/jack_connect", false);
      node.setParam("/station/limiter", false);
      allowStalls(node);
      station = startStation({{"JACK_DEFAULT_SERVER", server.name()}});
    }
    JackServer server{"melody"};
    ::ros::NodeHandle node;
    Listener<Status> status{node, "/station/status"};
    GestureRecord gesture{node};
    std::unique_ptr<ChildProcess> station;
  };

  static void SetUpTestSuite() { world_ = std::make_unique<World>(); }
  static void TearDownTestSuite() {
    world_->server.kill();  // it would wait for a client that is gone
    world_.reset();
  }
  void SetUp() override {
    ASSERT_TRUE(eventually([] {
      const Status status = world_->status.latest();
      return status.model == "keys and bars" && status.audio_running && status.clock_locked;
    })) << world_->status.latest().message;
    PlayMap map;
    map.request.map = kMap;
    ASSERT_TRUE(::ros::service::call("/station/play_map", map));
    ASSERT_TRUE(map.response.success) << map.response.message;
    ASSERT_TRUE(eventually([] { return world_->gesture.count() > 0; }));
    before_ = world_->gesture.newest();
  }

  struct Onset {
    double tick = 0.0;  // with its fraction
    int slice = 0;
  };
  /// When slices have gone up through the place of the bars, since the test began.
  std::vector<Onset> onsets() const {
    std::vector<Onset> found;
    const auto ticks = world_->gesture.from(before_);
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      for (int slice = 0; slice < kKeys; ++slice) {
        const double last = ticks[i - 1].positions[static_cast<std::size_t>(slice)];
        const double now = ticks[i].positions[static_cast<std::size_t>(slice)];
        if (last < kBarM && now >= kBarM) {
          const double share = (kBarM - last) / (now - last);
          found.push_back({static_cast<double>(ticks[i - 1].tick) + share, slice});
        }
      }
    }
    std::sort(found.begin(), found.end(),
              [](const Onset& a, const Onset& b) { return a.tick < b.tick; });
    return found;
  }
  /// What JACK leaves out, it leaves out with its notes.
  static std::string lost() {
    return "JACK has lost periods " + std::to_string(world_->status.latest().xruns) + " times";
  }
  static double placeOf(std::size_t slice) {
    return world_->gesture.from(world_->gesture.newest()).back().positions[slice];
  }

  /// Plays what was written, until all of its notes have come or long after.
  void play(const MelodyWriter& writer) {
    const ScratchFile file;
    writer.save(file.path());
    melody_ = readMelody(file.path());
    player_.connectTo("ergotic:midi_in");
    sent_ = player_.play(melody_);
    for (std::size_t i = 0; i < melody_.size(); ++i) {
      if (melody_[i].isNoteOn()) {
        notes_.push_back(i);
      }
    }
    ASSERT_TRUE(eventually([this] { return player_.isOver(); }));
    EXPECT_TRUE(eventually([this] { return onsets().size() >= notes_.size(); }, 2.0));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // for more than there should be
  }

  /// That the notes that came keep the distances of the file to a tick, but where the machine stood
  /// still, or JACK came so late that the station was told of a note when it should have begun.
  void expectInTime(const std::vector<Onset>& came) const {
    const double hz = world_->status.latest().gestural_rate;
    std::vector<double> late;
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      late.push_back(came[i].tick - melody_[notes_[i]].time_s * hz);
    }
    std::vector<double> sorted = late;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    double most = 0.0;
    std::size_t note = 0;
    Trials trials(
        [this](std::int64_t from_ns, std::int64_t to_ns) {
          return std::max(reference_.longestStallNs(from_ns, to_ns),
                          player_.mostLateNs(from_ns, to_ns));
        },
        static_cast<int>(notes_.size()));
    while (trials.goOn()) {
      const double off = std::abs(late[note] - usual);
      most = std::max(most, off);
      const std::int64_t sent_ns = player_.sentNs(notes_[note]);
      trials.judgeThat(
          off <= 1.0, {sent_ns - kBeforeNs, sent_ns + kUntilPlayedNs, kHeldUpNs},
          "note " + std::to_string(note) + ", which is off by " + std::to_string(off) + " ticks,");
      ++note;
    }
    std::cout << notes_.size() << " notes, off by " << most << " ticks of " << 1e3 / hz
              << " ms at most\n";
  }

  /// Of the first slice.
  void expectAllComeAndTheKeyIsUp(const MelodyWriter& notes) {
    play(notes);
    const std::vector<Onset> came = onsets();
    ASSERT_EQ(came.size(), notes_.size()) << lost();
    expectInTime(came);
    EXPECT_LT(placeOf(0), 0.1 * kWayM) << "the key is not up";
  }

  static std::unique_ptr<World> world_;
  ReferenceThreads reference_;
  MelodyPlayer player_{"player", world_->server.name()};
  std::vector<MelodyEvent> melody_;
  std::vector<std::int64_t> sent_;  // [events] frames of JACK
  std::vector<std::size_t> notes_;  // events that begin them
  std::int64_t before_ = 0;         // tick
};
std::unique_ptr<MelodyTest::World> MelodyTest::world_;

/// Eighths on three keys, and between them a second track on the fourth; after two bars it gets
/// faster.
struct Melody {
  Melody() {
    constexpr int kEighth = MelodyWriter::kPulses / 2;
    constexpr int kNotes = 15;
    constexpr int kFaster = 8 * kEighth;
    writer.addTempo(0, 500'000);
    writer.addTempo(kFaster, 400'000);
    const auto add = [&](int track, int pulse, int key) {
      writer.addNote(track, pulse, kEighth / 2, static_cast<std::uint8_t>(kFirstNote + key), 127);
      const double quarters = static_cast<double>(pulse) / MelodyWriter::kPulses;
      const double faster = std::max(quarters - 4.0, 0.0);
      keys[0.5 * (quarters - faster) + 0.4 * faster] = key;
    };
    for (int i = 0; i < kNotes; ++i) {
      add(1, i * kEighth, i % 3);
      if (i % 2 == 1) {
        add(2, i * kEighth + 79, 3);
      }
    }
  }
  MelodyWriter writer;
  std::map<double, int> keys;  // by the time at which they begin, s
};

TEST_F(MelodyTest, ItsNotesComeInOrderAndInTimeAndSound) {
  const MelodyListener listener(
      world_->server.name(), {"ergotic:out_1", "ergotic:out_2", "ergotic:out_3", "ergotic:out_4"},
      30.0);
  const Melody melody;
  play(melody.writer);
  const std::vector<Onset> came = onsets();
  ASSERT_EQ(notes_.size(), melody.keys.size());
  ASSERT_EQ(came.size(), notes_.size()) << lost();
  auto wanted = melody.keys.begin();
  for (std::size_t i = 0; i < notes_.size(); ++i, ++wanted) {
    EXPECT_NEAR(melody_[notes_[i]].time_s, wanted->first, 1e-6) << "of the file";
    EXPECT_EQ(came[i].slice, wanted->second) << "note " << i;
  }
  expectInTime(came);

  constexpr float kHeard = 0.001F;
  constexpr std::int64_t kLongest = 11025;  // frames in which a note has to sound
  std::vector<double> latencies_ms;
  for (std::size_t i = 0; i < notes_.size(); ++i) {
    const std::int64_t sent = sent_[notes_[i]];
    const auto key = static_cast<std::size_t>(came[i].slice);
    const std::int64_t heard = listener.firstLouder(key, kHeard, sent, sent + kLongest);
    ASSERT_GE(heard, 0) << "note " << i << " does not sound";
    latencies_ms.push_back(1e3 * static_cast<double>(heard - sent) /
                           world_->status.latest().audio_rate);
  }
  std::sort(latencies_ms.begin(), latencies_ms.end());
  EXPECT_GT(latencies_ms.front(), 2.0) << "it sounded before it could";
  std::cout << "from the frame of a note to its sound: " << latencies_ms[latencies_ms.size() / 2]
            << " ms in the median, " << latencies_ms.front() << " to " << latencies_ms.back()
            << " ms\n";
}

/// Twenty a second.
MelodyWriter trill(std::uint8_t note) {
  constexpr int kTwentieth = MelodyWriter::kPulses / 10;  // of a second, at the usual tempo
  MelodyWriter writer;
  for (int i = 0; i < 40; ++i) {
    writer.addNote(1, i * kTwentieth, kTwentieth / 2, note, 127);
  }
  return writer;
}

TEST_F(MelodyTest, TwentyStrokesASecondDoNotPileUp) {
  expectAllComeAndTheKeyIsUp(trill(kFirstNote));
}

TEST_F(MelodyTest, TwentyNotesASecondOfAKeyThatIsHeldDoNotPileUp) {
  expectAllComeAndTheKeyIsUp(trill(kHeldNote));
}

}  // namespace
}  // namespace ergotic::test
