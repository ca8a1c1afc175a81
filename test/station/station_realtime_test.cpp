// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/station/station.hpp"
#include "support/audio_host.hpp"
#include "support/realtime_scope.hpp"
#include "support/scene_builder.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::kRates;

/// A string under a slice that plucks it, tuned by a parameter.
scene::Scene pluckedString() {
  test::SceneBuilder b;
  const int left = b.chain(60, 1e-3, 2e4, 1e-3);
  for (scene::Lia& lia : b.scene.lias) {
    lia.stiffness = {1.0, 0};
  }
  b.scene.parameters.push_back({"stiffness", 2e4, 1e4, 3e4, {1, 1}});
  const int hand = b.slice(0);
  b.link(scene::LiaType::kPluck, hand, left + 20, 1e3, 0.1);
  b.scene.lias.back().law.edit().width = {1e-3};
  b.hear(left + 30);
  return b.scene;
}

struct Live {
  Live() {
    StationConfig config = test::Bench::quickConfig();
    config.rates = kRates;
    auto driver = std::make_unique<test::ScriptedDriver>(1, log, [](std::int64_t n, int) {
      return 0.005 * (static_cast<double>(std::abs(n % 2000 - 1000)) / 500.0 - 1.0);
    });
    PerformerPolicy policy;
    policy.allow_unproven = true;
    station = std::make_unique<Station>(
        config, std::move(driver),
        makePerformer(pluckedString(), kRates, physics::Precision::kDouble, policy));
    next = makePerformer(pluckedString(), kRates, physics::Precision::kDouble, policy);
    coefficients = next->instrument->prepare({2.5e4});
    rig = tgr::makeRig(next->instrument->scene(), {}, 1);
  }
  test::DriverLog log;
  std::unique_ptr<Station> station;
  std::unique_ptr<Performer> next;
  std::unique_ptr<physics::Coefficients> coefficients;
  std::unique_ptr<tgr::Rig> rig;
};

TEST(StationRealtimeTest, TickDoesNothingThatItMayNotWhateverIsAsked) {
  Live live;
  Station& station = *live.station;
  const auto at = [&](Command::Type type) {
    Command command;
    command.type = type;
    ASSERT_TRUE(station.submit(command));
  };
  const auto tick = [&](int n) {
    if (n % 25'000 == 10) {
      at(Command::Type::kEngage);
    } else if (n == 20'000) {
      Command command;
      command.type = Command::Type::kParameter;
      command.value = 2.5e4;
      command.coefficients = live.coefficients.release();
      ASSERT_TRUE(station.submit(command));
    } else if (n == 40'000) {
      at(Command::Type::kKeyframe);
    } else if (n == 50'000) {
      Command command;
      command.type = Command::Type::kSwap;
      command.performer = live.next.release();
      ASSERT_TRUE(station.submit(command));
    } else if (n == 60'000) {
      Command command;
      command.type = Command::Type::kConfigure;
      command.rig = live.rig.release();
      ASSERT_TRUE(station.submit(command));
    } else if (n % 25'000 == 20'000) {
      station.stop();
    } else if (n == 70'000) {
      station.makeSafe(FaultReason::kEmergencyStop);
    } else if (n == 71'000) {
      at(Command::Type::kRecover);
    }
    if (n % 30'000 == 29'999) {
      station.catchUp(100, 30'000'000);
    } else {
      station.cycle({0, false});
    }
  };
  test::expectRealtime([&] {
    for (int n = 0; n < 100'000; ++n) {
      tick(n);
    }
  });
  int handed_back = 0;
  int recovered = 0;
  Event event;
  while (station.poll(event)) {
    const bool owns =
        event.performer != nullptr || event.coefficients != nullptr || event.rig != nullptr;
    handed_back += owns ? 1 : 0;
    recovered += event.type == Event::Type::kRecovered ? 1 : 0;
    delete event.performer;
    delete event.coefficients;
    delete event.rig;
  }
  EXPECT_EQ(handed_back, 3) << "swap, parameter and configuration took place";
  EXPECT_EQ(recovered, 1);
  const Snapshot* snapshot = station.snapshot();
  ASSERT_NE(snapshot, nullptr);
  EXPECT_GT(snapshot->counters.peak_force_n, 0.0) << "the string was touched";
}

/// A finger on a string in three dimensions that a parameter moves, a place that a guide moves, a
/// energy-stable contact.
const char kMovedPlaces[] = R"(ergotic: 1
name: moved places
parameters:
  place: {value: 0.3, range: [0.1, 0.9]}
sections:
  string: {rate: audio, geometry: space}
  keys: {rate: gestural}
mats:
  key: {type: slice, section: keys}
  slider: {type: slice, section: keys}
  finger: {type: point, along: s, at: $place, speed: 2}
  led: {type: point, along: s, at: 0.5, guide: {mat: slider, scale: 20}}
  damper: {type: ground, section: string, at: [0.3, 0, 0]}
generators:
  - {type: string, name: s, section: string, masses: 30, mass: 1.0e-4, stiffness: 2000,
     rest_length_ratio: 0.5, from: [0, 0, 0], to: [0.6, 0, 0]}
lias:
  touch: {type: contact, between: [key, led], stiffness: 500, threshold: 0.3, scheme: energy_stable}
  hold: {type: spring, between: [finger, damper], stiffness: 100}
ports:
  a: {mat: key, slice: 0}
  b: {mat: slider, slice: 1}
)";

TEST(StationRealtimeTest, PlacesMoveWhilePlaying) {
  PerformerPolicy policy;
  policy.allow_unproven = true;
  auto made = makePerformer(scene::readYaml(kMovedPlaces, "places.yaml"), kRates,
                            physics::Precision::kDouble, policy);
  Performer& performer = *made;
  const auto slowly = [](std::int64_t n, int) {
    return 0.01 * std::sin(1e-3 * static_cast<double>(n));
  };
  test::DriverLog log;
  StationConfig config = test::Bench::quickConfig();
  config.rates = kRates;
  Station station(config, std::make_unique<test::ScriptedDriver>(2, log, slowly), std::move(made));
  auto coefficients = performer.instrument->prepare({0.7});
  Command move;
  move.type = Command::Type::kParameter;
  move.value = 0.7;
  move.coefficients = coefficients.release();
  test::expectRealtime([&] {
    for (int n = 0; n < 6000; ++n) {
      if (n == 3000) {
        ASSERT_TRUE(station.submit(move));
      }
      station.cycle({0, false});
    }
  });
  Event event;
  while (station.poll(event)) {
    delete event.coefficients;
  }
  ASSERT_TRUE(performer.motion.refresh());
  const MotionFrame& motion = performer.motion.latest();
  const std::vector<scene::Mat>& mats = performer.instrument->scene().mats;
  std::size_t first = 0;  // of the finger's displacements
  for (std::size_t m = 0; mats[m].name != "finger"; ++m) {
    first += static_cast<std::size_t>(
        scene::dimensionsOf(performer.instrument->scene().sectionOf(mats[m]).geometry));
  }
  EXPECT_NEAR(motion.displacement[first], 0.4F * 0.6F, 0.02F) << "0.3 to 0.7 of 0.6 m";
  EXPECT_NE(motion.energies.sections[0].from_inputs, 0.0) << "work of the places that move";
  ASSERT_EQ(motion.tanks.size(), 32U) << "the springs of the string, and the touch";
  for (const physics::TankReport& tank : motion.tanks) {
    EXPECT_GT(tank.active, 0);
  }
}

TEST(StationRealtimeTest, AudioBridgeDoesNothingThatItMayNotOnEitherSide) {
  AudioBridgeConfig config;
  config.rates = kRates;
  config.output_channels = 1;
  config.input_channels = 1;
  AudioBridge bridge(config);
  bridge.audioStarted(kRates.audio_hz, 140);
  std::vector<float> in(140, 0.5F);
  std::vector<float> out(140);
  const float* inputs = in.data();
  float* outputs = out.data();
  std::vector<float> frames(14, 0.25F);
  test::expectRealtime([&] {
    for (std::int64_t block = 0; block < 1000; ++block) {
      const std::int64_t first = block * 140;
      bridge.process({140, {first, first * 22676}, &inputs, &outputs, 1, 1});
      for (std::int64_t n = block * 10; n < (block + 1) * 10; ++n) {
        bridge.track(n, n * 317460);
        bridge.pull(n * 14, frames.data(), 14);
        bridge.push(n * 14, frames.data(), 14);
      }
    }
  });
  EXPECT_EQ(out[0], 0.5F) << "input came back through both rings";
}

}  // namespace
}  // namespace ergotic::station
