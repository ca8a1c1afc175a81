// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <ergotic/Event.h>
#include <ergotic/InjectFault.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "ergotic/rt/clock.hpp"
#include "integration/fault_cases.hpp"
#include "integration/fault_injection.hpp"
#include "integration/fault_table.hpp"
#include "integration/gesture_record.hpp"
#include "integration/listener.hpp"
#include "integration/safety_world.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr double kReleased = 0.01;
constexpr std::int64_t kUncertainNs = 500'000;
constexpr std::int64_t kToldNs = 10'000'000;
constexpr std::int64_t kNoticedNs = 5'000'000;  // of a stall: the device waits for 10 ms
constexpr std::int64_t kRecoveryNs = 1'000'000'000;
// A call to recover that soon after an emergency stop is taken to be the older of the two.
constexpr std::chrono::milliseconds kAsOld{510};
constexpr double kActiveNPerM = 1e4;   // of model_active
constexpr double kEnergyLimitJ = 0.3;  // the station's default

std::unique_ptr<SafetyWorld> the_world;  // of all tests, from the first one on

/// What there was before a fault.
struct Mark {
  std::int64_t pushed_ns = 0;
  std::size_t events = 0;
  std::int64_t tick = 0;  ///< the newest
  std::int64_t request_ns = 0;
};

/// What a stall of the machine latches. A device that comes late while the hand moves shows all of
/// its way at once, and a model that pushes it on answers with a leap of the force.
bool isOfStall(const FaultCase& fault, std::uint8_t reason) {
  return reason == Status::FAULT_STALL || reason == Status::FAULT_WATCHDOG ||
         reason == Status::FAULT_MADE_SAFE ||
         (fault.start == Start::kEnergy &&
          (reason == Status::FAULT_JUMP || reason == Status::FAULT_MODEL_BLOW_UP));
}

class SafetyTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (the_world == nullptr) {
      the_world = std::make_unique<SafetyWorld>();
    }
    ASSERT_TRUE(eventually([] { return the_world->status.latest().model == "wall"; }));
    ASSERT_TRUE(eventually([] { return the_world->handIsConnected(); }));
    record_ = std::make_unique<GestureRecord>(the_world->node);
    ASSERT_TRUE(eventually([this] { return record_->count() > 0; }));
  }
  static bool stateBecomes(std::uint8_t state) { return the_world->stateBecomes(state); }

  static bool push(Trials& trials);
  static std::optional<Event> firstEvent(std::size_t from, std::uint8_t type);
  std::int64_t injectedTick(std::size_t first_event) const;
  std::int64_t energyTick(std::int64_t from) const;
  std::int64_t startNs(const FaultCase& fault, const Mark& mark) const;
  bool release(const FaultCase& fault, Trials& trials, Outcome& outcome) const;
  std::string wayTo(std::int64_t tick) const;
  void waitUntilOver(const FaultCase& fault) const;
  static void measure(const FaultCase& fault,
                      const Mark& mark,
                      std::int64_t start_ns,
                      Trials& trials,
                      Outcome& outcome);
  static void recover(const FaultCase& fault, Trials& trials, Outcome& outcome);

  std::unique_ptr<GestureRecord> record_;  // of one test
};

bool SafetyTest::push(Trials& trials) {
  const std::int64_t from_ns = rt::monotonicNs();
  const bool pushed = the_world->push();
  return trials.judgeThat(pushed, {from_ns, rt::monotonicNs(), kNoticedNs},
                          "15 N, " + the_world->status.latest().state_text + ',') ==
         Trials::Verdict::kOnTime;
}

std::optional<Event> SafetyTest::firstEvent(std::size_t from, std::uint8_t type) {
  const auto events = the_world->events.messages();
  const auto found = std::find_if(events.begin() + static_cast<std::ptrdiff_t>(from), events.end(),
                                  [type](const Event& event) { return event.type == type; });
  return found == events.end() ? std::nullopt : std::optional(*found);
}

std::int64_t SafetyTest::injectedTick(std::size_t first_event) const {
  EXPECT_TRUE(eventually([=] { return firstEvent(first_event, Event::INJECTED).has_value(); }));
  return firstEvent(first_event, Event::INJECTED).value_or(Event()).tick;
}

/// The tick by which `model_active` had given out what the wall had stored, which is no more than
/// anybody's spring would do, and the limit on top of it.
std::int64_t SafetyTest::energyTick(std::int64_t from) const {
  const auto ticks = record_->from(from);
  const double origin = ticks.at(0).positions[0];
  double left = 0.5 * kWallNPerM * origin * origin + kEnergyLimitJ;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const double x = ticks[i - 1].positions[0];
    const double force = kActiveNPerM * (x - origin) - kWallNPerM * x;
    left -= std::clamp(force, -kForceLimitN, kForceLimitN) * (ticks[i].positions[0] - x);
    if (left < 0.0) {
      return ticks[i].tick;
    }
  }
  ADD_FAILURE() << "the hand did not move far enough";
  return from;
}

std::int64_t SafetyTest::startNs(const FaultCase& fault, const Mark& mark) const {
  switch (fault.start) {
    case Start::kTick:
      return record_->dueNs(injectedTick(mark.events));
    case Start::kRequest:
      return mark.request_ns;
    case Start::kLastMessage:
      return the_world->presence.spokeNs();
    case Start::kEnergy:
      return record_->dueNs(energyTick(injectedTick(mark.events)));
    case Start::kReach: {
      const auto ticks = record_->from(mark.tick);
      const auto beyond = std::find_if(ticks.begin(), ticks.end(),
                                       [](const auto& at) { return at.positions[1] >= kReachM; });
      EXPECT_NE(beyond, ticks.end()) << "the hand did not move far enough";
      return record_->dueNs(beyond == ticks.end() ? 0 : beyond->tick);
    }
  }
  return mark.request_ns;
}

/// Of the pushed slice in the last ticks, for a reason that is not understood.
std::string SafetyTest::wayTo(std::int64_t tick) const {
  constexpr std::int64_t kTicks = 12;
  std::ostringstream way;
  for (const GestureRecord::Tick& each : record_->from(tick - kTicks)) {
    if (each.tick <= tick) {
      way << ' ' << each.positions[0];
    }
  }
  return way.str();
}

/// \pre 15 N are applied. \return false if another fault came before, of a stall
bool SafetyTest::release(const FaultCase& fault, Trials& trials, Outcome& outcome) const {
  Mark mark{rt::monotonicNs(), the_world->events.count(), record_->newest(), 0};
  mark.request_ns = begin(*the_world, fault);
  EXPECT_TRUE(stateBecomes(Status::FAULT)) << fault.name;
  outcome.reason = the_world->status.latest().fault;
  outcome.says = the_world->status.latest().state_text;
  if (trials.onTime() == 0) {  // they come once a second
    expectDiagnosticsError(the_world->diagnostics, the_world->status);
  }
  EXPECT_EQ(the_world->status.latest().state, Status::FAULT) << "it is latched";
  waitUntilOver(fault);
  const std::int64_t fault_tick = firstEvent(mark.events, Event::FAULT).value_or(Event()).tick;
  EXPECT_TRUE(eventually([=] { return record_->newest() > fault_tick; }));
  const std::int64_t told_ns = record_->dueNs(fault_tick);
  const Trials::Window until_told{
      mark.pushed_ns, std::max(told_ns, mark.request_ns) + kToldNs,
      fault.start == Start::kEnergy ? ReferenceThreads::kMinNs : kNoticedNs};
  if (trials.judgeThat(outcome.reason == fault.reason, until_told,
                       "the reason, but `" + outcome.says + "` after" + wayTo(fault_tick) +
                           " m,") != Trials::Verdict::kOnTime) {
    EXPECT_TRUE(isOfStall(fault, outcome.reason)) << outcome.says;
    return false;
  }
  measure(fault, mark, startNs(fault, mark), trials, outcome);
  return true;
}

void SafetyTest::waitUntilOver(const FaultCase& fault) const {
  const double rate = the_world->status.latest().gestural_rate;
  std::this_thread::sleep_for(
      std::chrono::duration<double>(static_cast<double>(fault.ticks) / rate));
  EXPECT_TRUE(eventually([] { return the_world->log->read().back().force_n == 0.0; }))
      << "force was never released";
}

/// What the device felt.
void SafetyTest::measure(const FaultCase& fault,
                         const Mark& mark,
                         std::int64_t start_ns,
                         Trials& trials,
                         Outcome& outcome) {
  const std::vector<ForceRecord>& forces = the_world->log->read();
  const auto last = std::find_if(forces.rbegin(), forces.rend(), [](const ForceRecord& at) {
    return std::abs(at.force_n) >= kReleased * kForceN;
  });
  ASSERT_NE(last, forces.rbegin()) << "force was never released";
  const std::int64_t released_ns = last.base()->time_ns;  // of the record after it
  outcome.released_ms =
      1e-6 * static_cast<double>(std::max(released_ns - start_ns, std::int64_t{0}));
  for (const ForceRecord& at : forces) {
    outcome.largest_n = std::max(outcome.largest_n, std::abs(at.force_n));
  }
  // A port that gives out energy has lost its force before that is a fault. When a tick was due is
  // known to a part of its period.
  const std::int64_t pushed_ns =
      (fault.start == Start::kEnergy ? mark.request_ns : start_ns) - kUncertainNs;
  trials.judgeThat(forceAt(forces, pushed_ns) < -0.95 * kForceN, mutedBefore(pushed_ns),
                   "all of the force");
  const std::int64_t limit_ns = start_ns + static_cast<std::int64_t>(1e6 * fault.limit_ms);
  trials.judge({start_ns - kUncertainNs, limit_ns}, released_ns, "its release");
}

void SafetyTest::recover(const FaultCase& fault, Trials& trials, Outcome& outcome) {
  if (fault.start == Start::kReach) {
    the_world->moveHand(1, 0.0);
    EXPECT_TRUE(eventually([] { return the_world->isNear(1, 0.0); }));
  }
  if (outcome.reason == Status::FAULT_EMERGENCY_STOP) {
    std::this_thread::sleep_for(kAsOld);
  }
  const std::int64_t asked_ns = rt::monotonicNs();
  const auto answer = call("recover");
  const std::int64_t answered_ns = rt::monotonicNs();
  outcome.recovered_s = 1e-9 * static_cast<double>(answered_ns - asked_ns);
  EXPECT_TRUE(answer.success) << answer.message;
  trials.judge({asked_ns, asked_ns + kRecoveryNs, kRecoveryNs / 2}, answered_ns, "the recovery");
  // A stall of the machine soon after may be a fault of its own.
  const bool is_ready = stateBecomes(Status::READY);
  if (trials.judgeThat(is_ready, {asked_ns, asked_ns + kRecoveryNs, kNoticedNs},
                       "READY, " + the_world->status.latest().state_text + ',') ==
      Trials::Verdict::kExcused) {
    EXPECT_TRUE(call("recover").success);
    EXPECT_TRUE(stateBecomes(Status::READY));
  }
  EXPECT_TRUE(eventually([] { return the_world->effort() == 0.0; })) << "force came back by itself";
}

class FaultTest : public SafetyTest, public ::testing::WithParamInterface<FaultCase> {
 protected:
  /// Of what somebody asks for by ROS the answer goes through ordinary threads.
  static const ReferenceThreads& referenceFor(const FaultCase& fault) {
    const bool by_ros = fault.start == Start::kRequest || fault.start == Start::kLastMessage;
    return by_ros ? the_world->ordinary : the_world->reference;
  }
};

TEST_P(FaultTest, TakesTheForceFromTheHandAndComesBackOnRequestOnly) {
  const FaultCase& fault = GetParam();
  the_world->setDeviceWatchdog(fault.watchdog_ms);
  Trials trials(referenceFor(fault));
  Outcome worst;
  while (trials.goOn()) {
    if (!push(trials)) {
      continue;
    }
    Outcome outcome;
    const bool released = release(fault, trials, outcome);
    recover(fault, trials, outcome);
    ASSERT_TRUE(the_world->station->isRunning());
    EXPECT_LE(outcome.largest_n, kForceLimitN);
    std::cout << fault.name << ": force gone after " << outcome.released_ms << " ms, recovered in "
              << outcome.recovered_s << " s\n";
    if (released && outcome.released_ms >= worst.released_ms) {
      worst = outcome;
    }
  }
  if (!HasFailure()) {
    the_world->table.add(fault, worst);
  }
}

std::string nameOf(const ::testing::TestParamInfo<FaultCase>& tested) {
  std::string name = tested.param.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Every, FaultTest, ::testing::ValuesIn(faultCases()), &nameOf);

/// Faults too small to take the instrument away from its player.
class HarmlessFaultTest : public FaultTest {};

TEST_P(HarmlessFaultTest, LeavesTheForceWhereItWas) {
  constexpr std::int64_t kTicks = 300;
  the_world->setDeviceWatchdog(GetParam().watchdog_ms);
  Trials trials(the_world->reference);
  while (trials.goOn()) {
    if (!push(trials)) {
      continue;
    }
    const std::size_t first_event = the_world->events.count();
    const std::int64_t from_ns = begin(*the_world, GetParam());
    const std::int64_t end_tick = injectedTick(first_event) + kTicks;
    ASSERT_TRUE(eventually([=] { return !record_->from(end_tick).empty(); }));
    // The watchdog of the device acts if the machine stands still.
    const std::uint8_t state = the_world->status.latest().state;
    if (trials.judgeThat(state == Status::PLAYING, {from_ns, record_->dueNs(end_tick), kNoticedNs},
                         "playing on") == Trials::Verdict::kOnTime) {
      EXPECT_TRUE(eventually([] { return the_world->effort() < -0.9 * kForceN; }));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Every, HarmlessFaultTest, ::testing::ValuesIn(harmlessCases()), &nameOf);

TEST_F(SafetyTest, RefusesToEngageBeforeItRecovered) {
  EXPECT_TRUE(call("emergency_stop").success);
  ASSERT_TRUE(stateBecomes(Status::FAULT));
  const auto refused = call("engage");
  EXPECT_FALSE(refused.success);
  EXPECT_THAT(refused.message, HasSubstr("recover"));
  // One that comes within half a second of the stop counts as asked for before it.
  EXPECT_FALSE(call("recover").success);
  std::this_thread::sleep_for(kAsOld);
  EXPECT_TRUE(call("recover").success);
}

// The watchdog of the station has taken the force; that of the device waits for longer.
TEST_F(SafetyTest, RecoverLetsNothingOutWhileNoTickRuns) {
  the_world->setDeviceWatchdog(10'000.0);
  ASSERT_TRUE(the_world->push());
  InjectFault slow;
  slow.request.kind = "slow";
  slow.request.amount = 3.0;  // s, longer than `recover` waits for its tick
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", slow));
  ASSERT_TRUE(slow.response.success) << slow.response.message;
  ASSERT_TRUE(stateBecomes(Status::FAULT));
  ASSERT_TRUE(eventually([] { return the_world->log->read().back().force_n == 0.0; }));
  const std::int64_t asked_ns = rt::monotonicNs();
  EXPECT_FALSE(call("recover").success);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  for (const ForceRecord& felt : the_world->log->read()) {
    ASSERT_TRUE(felt.time_ns < asked_ns || felt.force_n == 0.0) << felt.force_n << " N";
  }
  EXPECT_TRUE(eventually([] { return call("recover").success != 0U; }));
}

TEST_F(SafetyTest, RefusesFaultsThatDoNotExist) {
  InjectFault inject;
  inject.request.kind = "gremlins";
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", inject));
  EXPECT_FALSE(inject.response.success);
  EXPECT_EQ(inject.response.message,
            "fault 'gremlins' is not known, allowed: not_a_number, infinite, jump, frozen, rail, "
            "missing, slow, write_fails, unplugged, noise, model_active, model_blow_up, "
            "model_not_a_number, jack_lost, killed, signal, stopped");
}

/// Ends the world, and writes the table if that is asked for.
class World : public ::testing::Environment {
 public:
  void TearDown() override {
    if (std::getenv("ERGOTIC_WRITE_FAULTS") != nullptr) {
      writeTable();
    }
    the_world.reset();
  }

 private:
  static void writeTable() {
    ASSERT_FALSE(::testing::UnitTest::GetInstance()->Failed()) << "the table is not written";
    ASSERT_NE(the_world, nullptr) << "the table is not written: nothing was tested";
    ASSERT_NO_THROW(the_world->table.write());
  }
};
const auto* const kWorld = ::testing::AddGlobalTestEnvironment(new World);

}  // namespace
}  // namespace ergotic::test
