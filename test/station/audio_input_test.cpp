// SPDX-License-Identifier: BSD-3-Clause
// What comes in at an audio input may be anything.
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const float kNone = std::nanf("");

/// A string that a hand presses, at a place that an input leads about; a second input pushes it.
std::unique_ptr<Performer> ledFinger(const physics::Rates& rates) {
  const char* const text =
      "ergotic: 1\nsections: {a: {}, h: {rate: gestural}}\n"
      "generators:\n"
      "  - {type: string, name: s, section: a, masses: 9, mass: 1e-3, stiffness: 1e4,"
      " damping: 1e-2, loss: 5e-2, to: [1, 0]}\n"
      "mats:\n  w: {type: driven, section: a}\n  k: {type: slice, section: h}\n"
      "  f: {type: point, along: s, at: 0.4, guide: {mat: w, scale: 10}}\n"
      "lias:\n  press: {type: contact, between: [f, k], stiffness: 500, damping: 1e-2,"
      " threshold: 0.02}\n"
      "  lean: {type: spring, between: [w, f], stiffness: 1}\n"
      "ports: {k: {mat: k, slice: 0}}\n"
      "inputs: {lead: {mat: w, quantity: position, channel: 1},"
      " push: {mat: s.3, quantity: force, channel: 1}}\n"
      "outputs: {o: {at: s.5, quantity: velocity, channel: 1}}\n";
  return makePerformer(scene::readYaml(text, "finger.yaml"), rates, {});
}

/// Plays the string with force on; a sample comes in for one tick.
class Played : public Bench {
 public:
  Played() : Bench({}, still, quickConfig(), 1), frames(2) {
    station->setFramePort(&frames);
    EXPECT_TRUE(swap(ledFinger(station->config().rates)));
    run(200);
    engage();
    EXPECT_NE(log.forces[0], 0.0);
  }

  void hear(float sample) {
    frames.input_level = sample;
    run(1);
    frames.input_level = 0.0F;
    run(100);
  }

  const Counters& counters() { return station->snapshot()->counters; }
  test::FrameLog frames;

 private:
  static double still(std::int64_t /*exchange*/, int /*slice*/) { return 0.005; }
};

TEST(AudioInputTest, SampleThatIsNoNumberIsSilenceAndIsCounted) {
  for (const float sample : {kNone, kInfinity, -kInfinity}) {
    Played spoilt;
    Played quiet;
    spoilt.hear(sample);
    quiet.hear(0.0F);
    EXPECT_EQ(spoilt.frames.samples, quiet.frames.samples) << sample;
    EXPECT_EQ(spoilt.log.forces, quiet.log.forces) << sample;
    EXPECT_EQ(test::count(spoilt.events(), Event::Type::kFault), 0) << sample;
    EXPECT_EQ(spoilt.counters().bad_input_samples, spoilt.station->config().rates.ratio);
    EXPECT_EQ(quiet.counters().bad_input_samples, 0);
  }
}

TEST(AudioInputTest, HugeSampleIsAtWorstAFaultThatRecoverEnds) {
  const auto recover = [](Played& played) {
    played.command(Command::Type::kRecover);
    played.run(3000);
    played.engage();
    return played.log.forces[0];
  };
  Played quiet;
  quiet.hear(0.0F);
  const double usual = recover(quiet);
  for (const float sample : {1e6F, 1e12F, 1e20F, 1e30F, -1e30F, 3e38F, 1e-40F}) {
    Played spoilt;
    spoilt.hear(sample);
    EXPECT_TRUE(std::all_of(spoilt.frames.samples.begin(), spoilt.frames.samples.end(),
                            [](float heard) { return std::isfinite(heard); }));
    EXPECT_TRUE(std::isfinite(spoilt.log.forces[0])) << sample;
    const Event fault = test::firstOf(spoilt.events(), Event::Type::kFault);
    EXPECT_EQ(fault.tick >= 0, spoilt.log.forces[0] == 0.0) << sample;
    EXPECT_NEAR(recover(spoilt), usual, 0.01) << sample;
    EXPECT_EQ(test::count(spoilt.events(), Event::Type::kFault), 0) << sample;
    EXPECT_EQ(spoilt.counters().bad_input_samples, 0);
  }
}

}  // namespace
}  // namespace ergotic::station
