// SPDX-License-Identifier: BSD-3-Clause
// Two faults at once, in every pair that can meet, while a hand is pushed.
#include <cstdlib>
#include <iostream>
#include <random>
#include <thread>

#include <ergotic/Status.h>

#include "ergotic/rt/clock.hpp"
#include "integration/fault_cases.hpp"
#include "integration/fault_injection.hpp"
#include "integration/safety_world.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

constexpr double kReleasedN = 0.15;
constexpr int kUsual = 12;                        // pairs, where not all are asked for
constexpr std::int64_t kTicksNs = 1'000'000;      // from an answer to the tick that is spoilt
constexpr double kBetweenS = 0.004;               // at most, from one fault to the other
constexpr std::chrono::milliseconds kAsOld{510};  // a recover after an emergency stop

struct Pair {
  FaultCase first;
  FaultCase second;
};

bool isOneOf(const std::string& kind, const std::vector<std::string>& kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}
bool isOfModel(const FaultCase& fault) {
  return fault.kind.rfind("model_", 0) == 0;
}
bool isOutside(const FaultCase& fault) {
  return isOneOf(fault.kind, {"reach", "process_stopped", "signal", "emergency_service",
                              "emergency_topic", "presence_released", "presence_silent"});
}
/// Lets no tick run: only what is outside of it acts.
bool stopsTicks(const FaultCase& fault) {
  return isOneOf(fault.kind, {"slow", "process_stopped"});
}
/// One order at a time spoils the device, and one the model. What takes a moving hand comes when it
/// does, and who is stopped hears of nothing else.
bool canMeet(const FaultCase& first, const FaultCase& second) {
  const bool same_order =
      isOfModel(first) == isOfModel(second) && !isOutside(first) && !isOutside(second);
  return first.name != second.name && !same_order && first.start != Start::kReach &&
         first.start != Start::kEnergy && first.kind != "process_stopped";
}

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (const FaultCase& first : faultCases()) {
    for (const FaultCase& second : faultCases()) {
      if (canMeet(first, second)) {
        all.push_back({first, second});
      }
    }
  }
  const char* const asked = std::getenv("ERGOTIC_PAIRS");
  if (asked == nullptr || std::string(asked) != "all") {
    std::shuffle(all.begin(), all.end(), std::mt19937(20));
    all.resize(kUsual);
  }
  return all;
}

std::int64_t nsOf(double ms) {
  return static_cast<std::int64_t>(1e6 * ms);
}

class PairsTest : public ::testing::Test {
 protected:
  /// When a fault has to have taken the force at the latest. Injected ones begin with a tick after
  /// the answer.
  std::int64_t limitNs(const FaultCase& fault, std::int64_t asked_ns, std::int64_t answered_ns) {
    const std::int64_t start_ns = fault.start == Start::kLastMessage ? world_.presence.spokeNs()
                                  : fault.start == Start::kRequest   ? asked_ns
                                                                     : answered_ns + kTicksNs;
    return start_ns + nsOf(fault.limit_ms);
  }

  /// \return when the last force was felt before `recover`
  std::int64_t releasedNs() {
    const std::vector<ForceRecord>& forces = world_.log->read();
    const auto last = std::find_if(forces.rbegin(), forces.rend(), [](const ForceRecord& at) {
      return std::abs(at.force_n) >= kReleasedN;
    });
    return last == forces.rbegin() ? Trials::kNever : last.base()->time_ns;
  }

  /// Both, one within milliseconds of the other.
  void release(const Pair& pair, double between_s, Trials& trials) {
    const std::string name = pair.first.name + " + " + pair.second.name;
    const std::int64_t asked_ns = begin(world_, pair.first);
    const std::int64_t answered_ns = rt::monotonicNs();
    std::this_thread::sleep_for(std::chrono::duration<double>(between_s));
    const std::int64_t second_ns = begin(world_, pair.second);
    std::int64_t limit_ns = limitNs(pair.first, asked_ns, answered_ns);
    if (stopsTicks(pair.second)) {
      limit_ns = std::max(limit_ns, limitNs(pair.second, second_ns, second_ns + kTicksNs));
    }
    EXPECT_TRUE(world_.stateBecomes(Status::FAULT)) << name;
    const double ticks = static_cast<double>(std::max(pair.first.ticks, pair.second.ticks));
    std::this_thread::sleep_for(
        std::chrono::duration<double>(0.1 + ticks / world_.status.latest().gestural_rate));
    const std::int64_t released_ns = releasedNs();
    const bool on_time = trials.judge({asked_ns, limit_ns}, released_ns, name + ": its release") ==
                         Trials::Verdict::kOnTime;
    expectReason(pair, on_time);
    worst_ms_ =
        std::max(worst_ms_, on_time ? 1e-6 * static_cast<double>(released_ns - asked_ns) : 0.0);
  }

  void expectReason(const Pair& pair, bool on_time) {
    const std::uint8_t reason = world_.status.latest().fault;
    const bool of_stall = reason == Status::FAULT_STALL || reason == Status::FAULT_WATCHDOG ||
                          reason == Status::FAULT_MADE_SAFE;
    EXPECT_TRUE(reason == pair.first.reason || reason == pair.second.reason ||
                (of_stall && (!on_time || stopsTicks(pair.first) || stopsTicks(pair.second))))
        << pair.first.name << " + " << pair.second.name << ": "
        << world_.status.latest().state_text;
  }

  /// Nothing but `recover` and then `engage` brings force back.
  void recover(const Pair& pair) {
    world_.presence.hold();
    world_.moveHand(1, 0.0);
    EXPECT_TRUE(eventually([this] { return world_.isNear(1, 0.0); }));
    std::this_thread::sleep_for(kAsOld);
    EXPECT_FALSE(call("engage").success) << pair.first.name << " + " << pair.second.name;
    EXPECT_TRUE(eventually([] { return call("recover").success != 0U; }))
        << pair.first.name << " + " << pair.second.name;
    EXPECT_TRUE(world_.stateBecomes(Status::READY));
    EXPECT_EQ(world_.log->read().back().force_n, 0.0) << "force came back by itself";
  }

  SafetyWorld world_;
  double worst_ms_ = 0.0;
};

TEST_F(PairsTest, TakeTheForceAsSoonAsTheFirstOfThemWould) {
  ASSERT_TRUE(eventually([this] { return world_.status.latest().model == "wall"; }));
  ASSERT_TRUE(eventually([this] { return world_.handIsConnected(); }));
  const std::vector<Pair> all = pairs();
  Trials trials(world_.ordinary, static_cast<int>(all.size()));
  std::mt19937 random(20);
  std::uniform_real_distribution<double> between_s(0.0, kBetweenS);
  while (trials.goOn()) {
    const Pair& pair = all[static_cast<std::size_t>(trials.tries())];
    world_.setDeviceWatchdog(std::min(pair.first.watchdog_ms, pair.second.watchdog_ms));
    const std::int64_t from_ns = rt::monotonicNs();
    const bool pushed = world_.push();
    if (trials.judgeThat(pushed, {from_ns, rt::monotonicNs()}, "15 N") !=
        Trials::Verdict::kOnTime) {
      continue;
    }
    release(pair, between_s(random), trials);
    recover(pair);
    ASSERT_TRUE(world_.station->isRunning()) << pair.first.name << " + " << pair.second.name;
  }
  std::cout << all.size() << " pairs of faults, force gone after " << worst_ms_
            << " ms at the latest\n";
}

}  // namespace
}  // namespace ergotic::test
