// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <optional>
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

namespace ergotic::test {
namespace {

constexpr double kReleased = 0.01;
constexpr int kAttempts = 10;  // of which each may meet a stall of the machine
constexpr double kPatienceS = 5.0;
constexpr std::int64_t kUncertainNs = 500'000;
constexpr double kActiveNPerM = 1e4;   // of model_active
constexpr double kEnergyLimitJ = 0.3;  // the station's default

std::unique_ptr<SafetyWorld> the_world;  // of all tests, from the first one on

/// What there was before an attempt.
struct Mark {
  std::size_t events = 0;
  std::int64_t tick = 0;  ///< the newest
  std::int64_t request_ns = 0;
};

/// A device that comes late while the hand moves shows all of its way at once, and a model that
/// pushes it on answers with a leap of the force.
bool isLeap(const FaultCase& fault, const Outcome& outcome) {
  return fault.start == Start::kEnergy &&
         (outcome.reason == Status::FAULT_JUMP || outcome.reason == Status::FAULT_MODEL_BLOW_UP);
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
  static bool stateBecomes(std::uint8_t state, double seconds = 30.0) {
    return eventually([state] { return the_world->status.latest().state == state; }, seconds);
  }

  static bool tryPush();
  static void push();
  static std::optional<Event> firstEvent(std::size_t from, std::uint8_t type);
  std::int64_t injectedTick(std::size_t first_event) const;
  std::int64_t energyTick(std::int64_t from) const;
  std::int64_t startNs(const FaultCase& fault, const Mark& mark) const;
  bool stationStalled(std::size_t first_event, std::int64_t from_ns, std::int64_t to_ns) const;
  Outcome release(const FaultCase& fault) const;
  void waitUntilOver(const FaultCase& fault) const;
  static void measure(const FaultCase& fault,
                      std::int64_t request_ns,
                      std::int64_t start_ns,
                      Outcome& outcome);
  static void recover(const FaultCase& fault, Outcome& outcome);
  static void expectReason(const FaultCase& fault, const Outcome& outcome);

  std::unique_ptr<GestureRecord> record_;  // of one test
};

/// It comes from outside: a wall that appears where the hand already is may not push it away, for
/// it never got the energy.
bool SafetyTest::tryPush() {
  the_world->presence.hold();
  if (!eventually([] { return call("recover").success != 0U; }, kPatienceS)) {
    return false;  // a device that was started again is not there yet
  }
  the_world->log->forget();  // long before any fault, for what was felt just before one counts, too
  the_world->moveHand(0, 0.0);
  the_world->moveHand(1, 0.0);
  const bool engaged = eventually([] { return the_world->isNear(0, 0.0); }, kPatienceS) &&
                       call("recover").success != 0U &&
                       eventually([] { return call("engage").success != 0U; }, kPatienceS) &&
                       stateBecomes(Status::PLAYING, kPatienceS);
  the_world->pushHand();
  return engaged && eventually([] { return the_world->isPushed(); }, kPatienceS);
}

/// Until the hand meets 15 N.
void SafetyTest::push() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::int64_t from_ns = rt::monotonicNs();
    if (tryPush()) {
      return;
    }
    ASSERT_TRUE(the_world->reference.sawGap(from_ns, rt::monotonicNs()))
        << the_world->effort() << " N, " << the_world->status.latest().state_text;
  }
  FAIL() << "the machine stalls too often to be tested on";
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

bool SafetyTest::stationStalled(std::size_t first_event,
                                std::int64_t from_ns,
                                std::int64_t to_ns) const {
  const auto events = the_world->events.messages();
  return std::any_of(events.begin() + static_cast<std::ptrdiff_t>(first_event), events.end(),
                     [=](const Event& event) {
                       const std::int64_t due_ns = record_->dueNs(event.tick);
                       return event.type == Event::STALL && due_ns >= from_ns && due_ns <= to_ns;
                     });
}

/// \pre 15 N are applied
Outcome SafetyTest::release(const FaultCase& fault) const {
  Mark mark{the_world->events.count(), record_->newest(), 0};
  mark.request_ns = begin(*the_world, fault);
  Outcome outcome;
  EXPECT_TRUE(stateBecomes(Status::FAULT)) << fault.name;
  outcome.reason = the_world->status.latest().fault;
  outcome.says = the_world->status.latest().state_text;
  expectDiagnosticsError(the_world->diagnostics, the_world->status);
  EXPECT_EQ(the_world->status.latest().state, Status::FAULT) << "it is latched";
  waitUntilOver(fault);
  const std::int64_t fault_tick = firstEvent(mark.events, Event::FAULT).value_or(Event()).tick;
  if (isLeap(fault, outcome) && record_->stoodStill(fault_tick, 0)) {
    outcome.excuse = "the device stood still";
    return outcome;
  }

  const std::int64_t start_ns = startNs(fault, mark);
  measure(fault, mark.request_ns, start_ns, outcome);
  const bool ticks_stop = fault.kind == "slow" || fault.kind == "process_stopped";
  const std::int64_t to_ns = start_ns + static_cast<std::int64_t>(1e6 * outcome.released_ms);
  if (!ticks_stop && stationStalled(mark.events, start_ns - kUncertainNs, to_ns)) {
    outcome.excuse = "the station stood still";
  }
  return outcome;
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
                         std::int64_t request_ns,
                         std::int64_t start_ns,
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
      (fault.start == Start::kEnergy ? request_ns : start_ns) - kUncertainNs;
  const std::int64_t limit_ns = start_ns + static_cast<std::int64_t>(1e6 * fault.limit_ms);
  if (the_world->reference.sawGap(request_ns, std::max(released_ns, limit_ns))) {
    outcome.excuse = "the machine stood still";
  } else if (const double force_n = forceAt(forces, pushed_ns); force_n > -0.95 * kForceN) {
    outcome.excuse = "there were only " + std::to_string(force_n) + " N before";
  }
}

void SafetyTest::recover(const FaultCase& fault, Outcome& outcome) {
  if (fault.start == Start::kReach) {
    the_world->moveHand(1, 0.0);
    EXPECT_TRUE(eventually([] { return the_world->isNear(1, 0.0); }));
  }
  const auto before = std::chrono::steady_clock::now();
  const auto answer = call("recover");
  outcome.recovered_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(stateBecomes(Status::READY));
  EXPECT_TRUE(eventually([] { return the_world->effort() == 0.0; })) << "force came back by itself";
}

/// A stall may come first, and latch what it does.
void SafetyTest::expectReason(const FaultCase& fault, const Outcome& outcome) {
  const bool of_stall = outcome.reason == Status::FAULT_STALL ||
                        outcome.reason == Status::FAULT_WATCHDOG ||
                        outcome.reason == Status::FAULT_MADE_SAFE || isLeap(fault, outcome);
  EXPECT_TRUE(outcome.reason == fault.reason || (!outcome.excuse.empty() && of_stall))
      << outcome.says;
}

class FaultTest : public SafetyTest, public ::testing::WithParamInterface<FaultCase> {};

TEST_P(FaultTest, TakesTheForceFromTheHandAndComesBackOnRequestOnly) {
  const FaultCase& fault = GetParam();
  the_world->setDeviceWatchdog(fault.watchdog_ms);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    push();
    if (HasFatalFailure()) {
      return;
    }
    Outcome outcome = release(fault);
    recover(fault, outcome);
    ASSERT_TRUE(the_world->station->isRunning());
    expectReason(fault, outcome);
    EXPECT_LE(outcome.largest_n, kForceLimitN);
    std::cout << fault.name << ": force gone after " << outcome.released_ms << " ms, recovered in "
              << outcome.recovered_s << " s"
              << (outcome.excuse.empty() ? "" : ", but " + outcome.excuse) << '\n';
    if (!outcome.excuse.empty()) {
      continue;  // proves nothing, once more
    }
    EXPECT_LE(outcome.released_ms, fault.limit_ms);
    EXPECT_LT(outcome.recovered_s, 1.0);
    if (!HasFailure()) {
      the_world->table.add(fault, outcome);
    }
    return;
  }
  FAIL() << "no attempt proved anything: see above";
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
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    push();
    if (HasFatalFailure()) {
      return;
    }
    const std::size_t first_event = the_world->events.count();
    const std::int64_t from_ns = begin(*the_world, GetParam());
    const std::int64_t tick = injectedTick(first_event);
    ASSERT_TRUE(eventually([=] { return !record_->from(tick + kTicks).empty(); }));
    const std::uint8_t state = the_world->status.latest().state;
    if (state == Status::FAULT && the_world->reference.sawGap(from_ns, rt::monotonicNs())) {
      continue;  // the watchdog of the device may have acted: proves nothing, once more
    }
    EXPECT_EQ(state, Status::PLAYING);
    EXPECT_TRUE(eventually([] { return the_world->effort() < -0.9 * kForceN; }));
    return;
  }
  FAIL() << "the machine stalls too often to be tested on";
}
INSTANTIATE_TEST_SUITE_P(Every, HarmlessFaultTest, ::testing::ValuesIn(harmlessCases()), &nameOf);

TEST_F(SafetyTest, RefusesToEngageBeforeItRecovered) {
  push();
  EXPECT_TRUE(call("emergency_stop").success);
  ASSERT_TRUE(stateBecomes(Status::FAULT));
  const auto refused = call("engage");
  EXPECT_FALSE(refused.success);
  EXPECT_THAT(refused.message, HasSubstr("recover"));
  // One that comes within 50 ms of the stop counts as asked for before it.
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_TRUE(call("recover").success);
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
