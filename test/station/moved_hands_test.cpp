// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <complex>

#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr double kMouseHz = 125.0;
constexpr physics::Rates kSweepRates{44100.0, 14};

/// A station whose sound is kept.
class HeardSound : public FramePort {
 public:
  void push(std::int64_t /*first*/, const float* frames, int nframes) noexcept override {
    for (int i = 0; i < nframes; ++i) {
      sound.push_back(static_cast<double>(frames[2 * i]));
    }
  }
  bool pull(std::int64_t /*first*/, float* frames, int nframes) noexcept override {
    std::fill_n(frames, nframes, 0.0F);
    return false;
  }
  std::vector<double> sound;
};

/// A string of 98 Hz that rings, while a hand draws it aside by a spring.
const char kDrawnString[] =
    "ergotic: 1\n"
    "sections: {string: {rate: audio}, keys: {rate: gestural}}\n"
    "mats:\n"
    "  hand: {type: slice, section: keys, coupling: smooth}\n"
    "  place: {type: point, along: string, at: 0.31}\n"
    "generators:\n"
    "  - {type: string, name: string, section: string, masses: 60, mass: 5.0e-5, frequency: 98, "
    "loss: 2.0e-6,\n"
    "     from: [0, 0], to: [0.65, 0], pluck: {at: 0.2, height: 0.003}}\n"
    "lias:\n"
    "  drawn: {type: spring_damper, between: [hand, place], stiffness: 200, damping: 0.01}\n"
    "ports:\n"
    "  hand: {mat: hand, slice: 0}\n"
    "outputs:\n"
    "  sound: {quantity: velocity, at: string@0.83, channel: 1}\n";

std::unique_ptr<Station> makeStation() {
  StationConfig config;
  config.rates = kSweepRates;
  config.output_channels = 2;
  PerformerPolicy policy;
  policy.allow_unproven = true;
  return std::make_unique<Station>(
      config, tgr::makeVirtualDriver({}),
      makePerformer(scene::readYaml(kDrawnString, "drawn.yaml"), kSweepRates, {}, policy));
}

/// A hand that goes by some speed, of which a mouse tells 125 times a second.
/// \param jumps  the hand is where the mouse is, at once
std::vector<double> swept(double speed, bool jumps) {
  constexpr double kFromM = -0.09;
  constexpr double kSeconds = 1.8;
  HeardSound heard;
  const std::unique_ptr<Station> station = makeStation();
  station->setFramePort(&heard);
  double next_s = 0.0;
  const double tick_s = 1.0 / kSweepRates.gesturalHz();
  for (double now_s = 0.0; now_s < kSeconds; now_s += tick_s) {
    if (now_s >= next_s) {
      tgr::HandMove wanted;
      wanted.target_m = kFromM + speed * next_s;
      wanted.time_s = 1.0 + next_s;
      wanted.grip = tgr::HandGrip::kQuick;
      wanted.jumps = jumps;
      EXPECT_TRUE(station->move(wanted));
      next_s += 1.0 / kMouseHz;
    }
    station->cycle({0, true});
  }
  return heard.sound;
}

/// The level of a sine of this frequency in the end of a sound, by a window whose lobes beside it
/// are 92 dB down.
double levelAt(const std::vector<double>& sound, double hz) {
  const auto count = static_cast<std::size_t>(1.3 * kSweepRates.audio_hz);
  const double* const last = &sound[sound.size() - count];
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    const double window =
        0.35875 - 0.48829 * std::cos(u) + 0.14128 * std::cos(2.0 * u) - 0.01168 * std::cos(3.0 * u);
    sum += window * last[i] *
           std::polar(1.0, -2.0 * M_PI * hz * static_cast<double>(i) / kSweepRates.audio_hz);
  }
  return std::abs(sum) / (0.35875 * static_cast<double>(count)) * 2.0;
}

/// Levels at the multiples of the mouse's rate below 2 kHz, dB over that of the whole sound.
std::vector<double> linesIn(const std::vector<double>& sound) {
  double square = 0.0;
  for (const double sample : sound) {
    square += sample * sample;
  }
  const double level = std::sqrt(2.0 * square / static_cast<double>(sound.size()));
  EXPECT_GT(level, 0.01) << "the string does not sound";
  std::vector<double> lines;
  for (int k = 1; k <= 15; ++k) {
    lines.push_back(20.0 * std::log10(levelAt(sound, k * kMouseHz) / level));
  }
  return lines;
}

TEST(MovedHandsTest, TargetsOf125HzLeaveNoLineInTheSoundOfAString) {
  constexpr double kInaudible = -60.0;
  const std::vector<double> still = linesIn(swept(0.0, false));
  const std::vector<double> even = linesIn(swept(0.1, false));
  const std::vector<double> stairs = linesIn(swept(0.1, true));
  double of_stairs = -1000.0;
  double of_even = -1000.0;
  int judged = 0;
  for (std::size_t k = 0; k < still.size(); ++k) {
    if (still[k] < kInaudible - 6.0) {  // else a partial of the string is there
      EXPECT_LT(even[k], kInaudible) << 125 * (k + 1) << " Hz";
      of_stairs = std::max(of_stairs, stairs[k]);
      of_even = std::max(of_even, even[k]);
      ++judged;
    }
  }
  EXPECT_GE(judged, 10);
  EXPECT_GT(of_stairs, of_even + 6.0) << "a staircase is louder";
}

constexpr std::int64_t kNever = -1;
constexpr std::int64_t kStalledTicks = 4;

/// Where a slice was, tick by tick, if a stroke that is due at some tick was asked for before
/// `tick`. \param stalled  the first of four ticks that did not run in time
std::vector<double> struck(double due_tick, std::int64_t tick, std::int64_t stalled = kNever) {
  constexpr std::int64_t kTicks = 400;
  const std::unique_ptr<Station> station = makeStation();
  tgr::HandMove stroke;
  stroke.target_m = 0.01;
  stroke.glide_s = 0.02;
  stroke.grip = tgr::HandGrip::kKey;
  while (station->nextTick() < kTicks) {
    if (station->nextTick() == 0 || station->nextTick() == 100) {  // the hand holds the slice
      tgr::HandMove hold;
      hold.grip = tgr::HandGrip::kKey;
      EXPECT_TRUE(station->move(hold));
    }
    if (station->nextTick() == tick) {
      EXPECT_TRUE(station->move(stroke, due_tick));
    }
    if (station->nextTick() == stalled) {
      station->catchUp(kStalledTicks, 1'000'000);
    } else {
      station->cycle({0, true});
    }
  }
  std::vector<GestureTick> ticks(kTicks);
  EXPECT_EQ(station->pollGestures(ticks.data(), ticks.size()), ticks.size());
  std::vector<double> places;
  for (const GestureTick& gesture : ticks) {
    places.push_back(gesture.position[0]);
  }
  return places;
}

TEST(MovedHandsTest, AMoveThatIsDueAtATickDoesNotDependOnWhenItWasAskedFor) {
  constexpr double kDueTick = 200.37;
  const std::vector<double> early = struck(kDueTick, 120);
  EXPECT_NEAR(early.at(200), 0.0, 2e-5);
  EXPECT_NEAR(early.back(), 0.01, 2e-3);
  EXPECT_EQ(struck(kDueTick, 199), early);
  EXPECT_EQ(struck(kDueTick, 200), early);
  EXPECT_NE(struck(kDueTick, 205), early) << "this one comes too late";
  EXPECT_EQ(struck(100.0, 205), struck(205.0, 205)) << "and is due at once";
  EXPECT_NE(struck(kDueTick + 0.2, 120), early);
}

TEST(MovedHandsTest, AStallOfTheStationChangesNothing) {
  constexpr double kDueTick = 200.37;
  const std::vector<double> whole = struck(kDueTick, 120);
  EXPECT_EQ(struck(kDueTick, 120, 150), whole) << "between order and stroke";
  EXPECT_EQ(struck(kDueTick, 195, 195), whole) << "the order waits for it";
  EXPECT_EQ(struck(kDueTick, 199, 199), whole) << "it is asked for when its time is over";
  EXPECT_EQ(struck(kDueTick, 120, 199), whole) << "over its beginning";
  EXPECT_EQ(struck(kDueTick, 120, 230), whole) << "on its way";
}

TEST(MovedHandsTest, RefusesHandsThatAreNotThere) {
  const std::unique_ptr<Station> station = makeStation();
  tgr::HandMove move;
  EXPECT_TRUE(station->move(move));
  move.slice = 12;
  EXPECT_FALSE(station->move(move));
  move.slice = 0;
  move.target_m = 1.0;
  EXPECT_FALSE(station->move(move));
}

}  // namespace
}  // namespace ergotic::station
