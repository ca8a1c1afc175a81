// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <ctime>
#include <map>
#include <random>
#include <thread>

#include <sys/resource.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/station/station.hpp"
#include "support/reference_threads.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

/// Other end-effectors while a model plays.

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;

constexpr std::int64_t kGlideTicks = 315;  // 0.1 s at 3150 Hz

/// The port moves by `gain` times the slice.
class Lever : public tgr::Rig {
 public:
  explicit Lever(double gain, int* destroyed = nullptr) : gain_(gain), destroyed_(destroyed) {}
  ~Lever() override {
    if (destroyed_ != nullptr) {
      ++*destroyed_;
    }
  }
  std::uint64_t toModel(const double* slices, double /*time_s*/, double* ports) noexcept override {
    ports[0] = gain_ * slices[0];
    return std::abs(ports[0]) < 1.0 ? 0 : 1;
  }
  void toDevice(const double* ports, double* slices) const noexcept override {
    slices[0] = gain_ * ports[0];
  }
  std::uint64_t slicesInUse() const noexcept override { return 1; }

 private:
  double gain_;
  int* destroyed_;
};

void configure(Bench& bench, double gain, int* destroyed = nullptr) {
  Command command;
  command.type = Command::Type::kConfigure;
  command.rig = new Lever(gain, destroyed);
  ASSERT_TRUE(bench.station->submit(command));
}

TEST(ConfigureTest, TakesTheForceAtOnceAndNeedsEngageAgain) {
  Bench bench;  // the hand is at 0.01 m, the spring has 100 N/m
  bench.engage();
  configure(bench, 2.0);
  bench.run(2);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -4.0) << "twice the way, twice the lever";
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kConfigured).tick, kRampTicks);
}

TEST(ConfigureTest, GlidesThePortsFromWhereTheyWereInAStraightLine) {
  Bench bench;
  bench.run(10);
  configure(bench, 3.0);
  bench.run(kGlideTicks + 10);
  const auto ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), static_cast<std::size_t>(kGlideTicks + 20));
  EXPECT_EQ(ticks[9].ports, 1U);
  EXPECT_EQ(ticks[9].port[0], 0.01);
  for (std::int64_t n = 0; n < kGlideTicks; ++n) {
    const double left = static_cast<double>(kGlideTicks - 1 - n) / kGlideTicks;
    ASSERT_NEAR(ticks[static_cast<std::size_t>(10 + n)].port[0], 0.03 - 0.02 * left, 1e-15);
  }
  EXPECT_EQ(ticks.back().port[0], 0.03);
}

TEST(ConfigureTest, RefusesToEngageWhileItGlides) {
  Bench bench;
  configure(bench, 2.0);
  bench.command(Command::Type::kEngage);
  bench.run(1);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kRefused).index,
            static_cast<int>(Refusal::kBusy));
}

TEST(ConfigureTest, GoesToTheModelThatIsOnItsWayIn) {
  Bench bench;
  bench.engage();
  ASSERT_EQ(bench.log.forces[0], -1.0);
  bench.recorded();
  ASSERT_TRUE(bench.swap(test::makeSpring()));
  configure(bench, 5.0);
  bench.run(200);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "other hands need engage again, whatever model they meet";
  const auto ticks = bench.recorded();
  EXPECT_EQ(ticks.front().port[0], 0.01) << "the old model keeps its hands";
  EXPECT_EQ(ticks.back().port[0], 0.05);
}

TEST(ConfigureTest, GivesBackEveryRigOnce) {
  int destroyed = 0;
  {
    Bench bench;
    for (int i = 0; i < 5; ++i) {
      configure(bench, 1.0, &destroyed);
    }
    bench.run(1);
    bench.events();
    bench.rigs.clear();
    EXPECT_EQ(destroyed, 4) << "the fifth is in use; the first one was the spring's own";
    configure(bench, 1.0, &destroyed);  // never taken
  }
  EXPECT_EQ(destroyed, 6);
}

TEST(ConfigureTest, FaultsBeyondTheWorkspace) {
  Bench bench;
  configure(bench, 1000.0);
  bench.run(2);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kFault).index,
            static_cast<int>(FaultReason::kWorkspace));
}

TEST(ConfigureTest, RefusesARigThatIsNone) {
  Bench bench;
  Command command;
  command.type = Command::Type::kConfigure;
  EXPECT_THROW(bench.station->submit(command), Exception);
}

/// End-effectors of all types in turn, at random places among twelve slices; one of their
/// coordinates moves the port.
class RandomHands {
 public:
  explicit RandomHands(Bench& bench) : bench_(bench) {}

  void configure() {
    Command command;
    command.type = Command::Type::kConfigure;
    const scene::Scene& scene = bench_.instrument->scene();
    command.rig = tgr::makeRig(scene, next(), kSlices).release();
    ASSERT_TRUE(bench_.station->submit(command));
  }

  static constexpr int kSlices = 12;

 private:
  tgr::EndEffectors next() {
    constexpr std::array<std::pair<tgr::EndEffectorType, int>, 6> kTypes = {
        {{tgr::EndEffectorType::kKey, 1},
         {tgr::EndEffectorType::kBow, 2},
         {tgr::EndEffectorType::kStick, 2},
         {tgr::EndEffectorType::kStick, 3},
         {tgr::EndEffectorType::kBall, 3},
         {tgr::EndEffectorType::kHandle, 6}}};
    const auto [type, slices] = kTypes[random_() % kTypes.size()];
    tgr::EndEffectorConfig config;
    config.name = "hand";
    config.type = type;
    const int first = static_cast<int>(random_()) & 1 ? 0 : kSlices - slices;
    for (int i = 0; i < slices; ++i) {
      config.slices.push_back(first + i);
    }
    if (type == tgr::EndEffectorType::kHandle) {
      config.points = {{0.03, 0.0, 0.0}, {-0.02, 0.02, 0.0}, {-0.02, -0.02, 0.01}};
    }
    const int coordinates = type == tgr::EndEffectorType::kHandle ? 9 : slices;
    config.ports.resize(static_cast<std::size_t>(coordinates));
    config.ports[random_() % config.ports.size()] = "hand";
    tgr::EndEffectors all;
    all.list.push_back(config);
    return all;
  }

  Bench& bench_;
  std::mt19937 random_{1};
};

/// Hands that all move, within every workspace.
double swaying(std::int64_t n, int slice) {
  return 0.01 * std::sin(1e-3 * static_cast<double>(n) + slice);
}

/// With the slew limit and the safety chain as they are shipped.
StationConfig asShipped() {
  StationConfig config = Bench::quickConfig();
  config.safety = tgr::SafetyConfig();
  config.safety.ramp_s = 0.1;
  config.glide_s = 0.01;
  return config;
}

/// A thousand times at random, engaged in between: force never grows by more than the slew limit,
/// and falls to zero when hands change.
TEST(ConfigureTest, AThousandChangesAtRandomMakeNoForceStep) {
  Bench bench({}, swaying, asShipped(), RandomHands::kSlices);
  RandomHands hands(bench);
  std::array<double, RandomHands::kSlices> last{};
  double steepest = 0.0;
  std::int64_t moved = 0;
  bench.driver->watch = [&](std::int64_t, const double* forces) {
    for (std::size_t s = 0; s < last.size(); ++s) {
      const bool same_side = forces[s] * last[s] >= 0.0;
      steepest = std::max(steepest, std::abs(forces[s]) - (same_side ? std::abs(last[s]) : 0.0));
      moved += forces[s] != 0.0 ? 1 : 0;
      last[s] = forces[s];
    }
  };
  std::mt19937 random(2);
  int configured = 0;
  for (int i = 0; i < 1000; ++i) {
    hands.configure();
    bench.run(static_cast<std::int64_t>(random() % 400));
    bench.command(Command::Type::kEngage);
    bench.run(static_cast<std::int64_t>(random() % 400));
    const auto events = bench.events();
    configured += test::count(events, Event::Type::kConfigured);
    EXPECT_EQ(test::count(events, Event::Type::kFault), 0);
    bench.recorded();
  }
  EXPECT_EQ(configured, 1000);
  EXPECT_GT(moved, 100'000) << "or the test sees nothing";
  EXPECT_LE(steepest, bench.station->config().safety.slew_n_per_s / 3150.0 + 1e-12);
}

/// Ticks on a thread of their own while the test changes hands on its own, and which of them were
/// slow by their own doing: they took the processor for longer than a tick, or gave it away, which
/// every wait does.
class LiveTicks {
 public:
  explicit LiveTicks(Bench& bench) : bench_(bench), thread_([this] { run(); }) {}

  /// \return ticks that were slow, and in which times they had to be done
  const std::map<std::int64_t, test::Trials::Window>& stop() {
    stopping_.store(true);
    thread_.join();
    return slow_;
  }

 private:
  struct Cost {
    std::int64_t cpu_ns;
    std::int64_t waits;
  };

  static Cost read() {
    timespec cpu{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return {1'000'000'000 * static_cast<std::int64_t>(cpu.tv_sec) + cpu.tv_nsec, usage.ru_nvcsw};
  }

  void run() {
    const auto tick_ns =
        static_cast<std::int64_t>(1e9 / bench_.station->config().rates.gesturalHz());
    auto due = std::chrono::steady_clock::now();
    while (!stopping_.load()) {
      std::this_thread::sleep_until(due += std::chrono::nanoseconds(tick_ns));
      const std::int64_t tick = bench_.station->nextTick();
      const std::int64_t from_ns = rt::monotonicNs();
      const Cost before = read();
      bench_.station->cycle({});
      const Cost after = read();
      if (after.cpu_ns - before.cpu_ns > tick_ns || after.waits > before.waits) {
        slow_[tick] = {from_ns, from_ns + tick_ns, tick_ns / 2};
      }
    }
  }

  Bench& bench_;
  std::atomic<bool> stopping_{false};
  std::map<std::int64_t, test::Trials::Window> slow_;
  std::thread thread_;
};

/// Live and engaged, a tick that takes a configuration is done in time: if a change took longer
/// than a tick, or waited for the thread that sends it, all of them would be slow. (What a
/// hypervisor takes away may count as time on the processor.)
TEST(ConfigureTest, ManyChangesLiveMakeNoTickLate) {
  Bench bench({}, swaying, asShipped(), RandomHands::kSlices);
  const test::ReferenceThreads reference(test::ReferenceThreads::Rank::kAboveAll,
                                         test::ReferenceThreads::kFinePauseNs);
  constexpr int kChanges = 400;
  RandomHands hands(bench);
  LiveTicks live(bench);
  std::vector<std::int64_t> configured;
  int engaged = 0;
  const auto listen = [&] {
    for (const Event& event : bench.events()) {
      EXPECT_NE(event.type, Event::Type::kFault);
      engaged += event.type == Event::Type::kEngaged ? 1 : 0;
      if (event.type == Event::Type::kConfigured) {
        configured.push_back(event.tick);
      }
    }
    bench.recorded();
  };
  for (int i = 0; i < kChanges; ++i) {
    hands.configure();
    std::this_thread::sleep_for(std::chrono::microseconds(i % 4 == 0 ? 12'000 : 1'000));
    bench.command(Command::Type::kEngage);  // refused while the ports glide
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    listen();
  }
  [[maybe_unused]] const auto& slow = live.stop();
  listen();
  EXPECT_EQ(configured.size(), static_cast<std::size_t>(kChanges));
  EXPECT_GT(engaged, kChanges / 10);
#ifndef ERGOTIC_SANITIZED  // which takes the processor, and waits, for purposes of its own
  test::Trials trials(reference);
  for (const std::int64_t tick : configured) {
    const auto found = slow.find(tick);
    trials.next();
    trials.judgeThat(found == slow.end(),
                     found == slow.end() ? test::Trials::Window() : found->second,
                     "tick " + std::to_string(tick));
  }
  trials.expectNineOfTen();
#endif
}

}  // namespace
}  // namespace ergotic::station
