// SPDX-License-Identifier: BSD-3-Clause
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/InjectFault.h>
#include <ergotic/SliceTarget.h>
#include <ergotic/Status.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "integration/fault_cases.hpp"
#include "integration/listener.hpp"
#include "integration/safety_world.hpp"

namespace ergotic::test {
namespace {

constexpr double kReleased = 0.01;
constexpr int kAttempts = 5;  // of which each may meet a stall of the machine

struct ForceTick {
  std::int64_t tick = 0;
  double force_n = 0.0;
};

/// What one fault did, by the station's own record.
struct Outcome {
  std::uint8_t reason = Status::FAULT_NONE;
  std::string says;
  double released_ms = 0.0;  // from its tick to the first with force below 1 %
  double recovered_s = 0.0;
  double largest_n = 0.0;
  bool stalled = false;  // the machine, or the process, stood still meanwhile
};

std::unique_ptr<SafetyWorld> the_world;  // of all tests, from the first one on

class SafetyTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (the_world == nullptr) {
      the_world = std::make_unique<SafetyWorld>();
    }
    ASSERT_TRUE(eventually([] { return the_world->status.latest().model == "wall"; }));
    ASSERT_TRUE(eventually([] { return the_world->hand.getNumSubscribers() > 0; }));
    gesture_ = std::make_unique<Listener<GestureBlock>>(the_world->node, "/station/gesture");
    ASSERT_TRUE(eventually([this] { return gesture_->count() > 0; }));
  }
  static std_srvs::Trigger::Response call(const std::string& service) {
    std_srvs::Trigger trigger;
    EXPECT_TRUE(::ros::service::call("/station/" + service, trigger)) << service;
    return trigger.response;
  }
  static bool stateBecomes(std::uint8_t state) {
    return eventually([state] { return the_world->status.latest().state == state; });
  }
  static double effort() {
    const auto joints = the_world->joints.latest();
    return joints.effort.empty() ? 0.0 : joints.effort.front();
  }

  static void moveHand(double target_m) {
    SliceTarget target;
    target.target = target_m;
    the_world->hand.publish(target);
  }

  /// Until the hand meets 15 N. It comes from outside: a wall that appears where the hand already
  /// is may not push it away, for it never got the energy.
  static void push() {
    the_world->presence.hold();
    moveHand(0.0);
    ASSERT_TRUE(eventually([] {
      const auto joints = the_world->joints.latest();
      return !joints.position.empty() && std::abs(joints.position.front()) < 0.001;
    }));
    ASSERT_TRUE(call("recover").success);
    ASSERT_TRUE(eventually([] { return call("engage").success != 0U; }));
    ASSERT_TRUE(stateBecomes(Status::PLAYING));
    moveHand(kTargetM);
    ASSERT_TRUE(eventually([] { return effort() < -0.95 * kForceN; })) << effort();
  }

  static void begin(const FaultCase& fault);
  static std::int64_t startTick(const FaultCase& fault, std::size_t first_event);
  static std::optional<Event> firstEvent(std::size_t from, std::uint8_t type);
  std::vector<ForceTick> forcesFrom(std::int64_t tick) const;
  static bool stalledBetween(std::size_t first_event, std::int64_t from, std::int64_t to);
  Outcome release(const FaultCase& fault) const;
  void recover(const FaultCase& fault, Outcome& outcome) const;
  static void expectDiagnosticsError();
  static void addRow(const FaultCase& fault, const Outcome& outcome);

  std::unique_ptr<Listener<GestureBlock>> gesture_;  // of one test
};

void SafetyTest::begin(const FaultCase& fault) {
  if (fault.kind == "process_stopped") {
    the_world->station->signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::duration<double>(fault.amount));
    the_world->station->signal(SIGCONT);
  } else if (fault.kind == "emergency_service") {
    EXPECT_TRUE(call("emergency_stop").success);
  } else if (fault.kind == "emergency_topic") {
    the_world->stop.publish(std_msgs::Empty());
  } else if (fault.kind == "presence_released") {
    the_world->presence.release();
  } else if (fault.kind == "presence_silent") {
    the_world->presence.fallSilent();
  } else {
    InjectFault inject;
    inject.request.kind = fault.kind;
    inject.request.slice = 0;
    inject.request.ticks = fault.ticks;
    inject.request.amount = fault.amount;
    ASSERT_TRUE(::ros::service::call("/station/inject_fault", inject));
    ASSERT_TRUE(inject.response.success) << inject.response.message;
  }
}

std::optional<Event> SafetyTest::firstEvent(std::size_t from, std::uint8_t type) {
  const auto events = the_world->events.messages();
  const auto found = std::find_if(events.begin() + static_cast<std::ptrdiff_t>(from), events.end(),
                                  [type](const Event& event) { return event.type == type; });
  return found == events.end() ? std::nullopt : std::optional(*found);
}

/// The tick from which on it counts: that of the injection, or that in which the station learnt it.
std::int64_t SafetyTest::startTick(const FaultCase& fault, std::size_t first_event) {
  const std::uint8_t stalled = fault.kind == "process_stopped" ? Event::STALL : Event::FAULT;
  for (const std::uint8_t type : {std::uint8_t{Event::INJECTED}, stalled}) {
    if (const auto event = firstEvent(first_event, type)) {
      return event->tick;
    }
  }
  ADD_FAILURE() << fault.name << " left no trace in the events";
  return 0;
}

std::vector<ForceTick> SafetyTest::forcesFrom(std::int64_t tick) const {
  std::vector<ForceTick> forces;
  for (const GestureBlock& block : gesture_->messages()) {
    for (std::uint32_t i = 0; i < block.ticks; ++i) {
      if (block.first_tick + i >= tick) {
        forces.push_back({block.first_tick + i,
                          static_cast<double>(block.forces[std::size_t{i} * block.slices])});
      }
    }
  }
  return forces;
}

bool SafetyTest::stalledBetween(std::size_t first_event, std::int64_t from, std::int64_t to) {
  const auto events = the_world->events.messages();
  return std::any_of(events.begin() + static_cast<std::ptrdiff_t>(first_event), events.end(),
                     [=](const Event& event) {
                       return event.type == Event::STALL && event.tick >= from && event.tick <= to;
                     });
}

/// \pre 15 N are applied
Outcome SafetyTest::release(const FaultCase& fault) const {
  const std::size_t first_event = the_world->events.count();
  begin(fault);
  Outcome outcome;
  EXPECT_TRUE(stateBecomes(Status::FAULT)) << fault.name;
  outcome.reason = the_world->status.latest().fault;
  outcome.says = the_world->status.latest().state_text;
  expectDiagnosticsError();
  EXPECT_EQ(the_world->status.latest().state, Status::FAULT) << "it is latched";

  const std::int64_t start = startTick(fault, first_event);
  const std::vector<ForceTick> forces = forcesFrom(start);
  const auto last = std::find_if(forces.rbegin(), forces.rend(), [](const ForceTick& at) {
    return std::abs(at.force_n) >= kReleased * kForceN;
  });
  const std::int64_t released = last == forces.rend() ? start : last->tick + 1;
  EXPECT_LT(released, forces.back().tick) << "force was never released";
  const double rate = gesture_->latest().tick_rate_hz;
  outcome.released_ms = 1e3 * static_cast<double>(released - start) / rate;
  for (const ForceTick& at : forces) {
    outcome.largest_n = std::max(outcome.largest_n, std::abs(at.force_n));
  }
  outcome.stalled = fault.kind != "slow" && fault.kind != "process_stopped" &&
                    stalledBetween(first_event, start, released);
  return outcome;
}

void SafetyTest::recover(const FaultCase& fault, Outcome& outcome) const {
  const double rate = gesture_->latest().tick_rate_hz;
  std::this_thread::sleep_for(
      std::chrono::duration<double>(static_cast<double>(fault.ticks) / rate));  // until it is over
  const auto before = std::chrono::steady_clock::now();
  const auto answer = call("recover");
  outcome.recovered_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(stateBecomes(Status::READY));
  EXPECT_TRUE(eventually([] { return effort() == 0.0; })) << "force came back by itself";
}

void SafetyTest::expectDiagnosticsError() {
  const std::size_t before = the_world->diagnostics.count();
  EXPECT_TRUE(eventually([before] {
    const auto seen = the_world->diagnostics.messages();
    return std::any_of(
        seen.begin() + static_cast<std::ptrdiff_t>(before), seen.end(), [](const auto& array) {
          const auto& force = array.status.front();
          return force.level == 2 && force.message == the_world->status.latest().state_text;
        });
  }));
}

void SafetyTest::addRow(const FaultCase& fault, const Outcome& outcome) {
  const std::string prefix = "fault: ";
  std::ostringstream row;
  row << std::fixed << std::setprecision(1) << "| " << fault.name << " | "
      << outcome.says.substr(std::min(prefix.size(), outcome.says.size())) << " | ";
  if (fault.stops_ticks) {
    row << "before the next tick";
  } else {
    row << outcome.released_ms << " ms";
  }
  row << " | " << fault.limit_says << " | " << 1e3 * outcome.recovered_s << " ms |";
  the_world->table.push_back(row.str());
}

/// Puts the rows between the marks in docs/safety.md.
void writeTable(const std::vector<std::string>& rows) {
  const std::string path = ERGOTIC_SOURCE_DIR "/docs/safety.md";
  const std::string begin = "<!-- faults: begin -->\n";
  const std::string end = "<!-- faults: end -->";
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  std::string page = text.str();
  const std::size_t from = page.find(begin);
  const std::size_t to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error(path + " has no place for the table of faults");
  }
  std::string table =
      "| fault | latched as | force below 1 % after | limit | recovered in |\n"
      "| --- | --- | --- | --- | --- |\n";
  for (const std::string& row : rows) {
    table += row + "\n";
  }
  page.replace(from + begin.size(), to - from - begin.size(), table);
  std::ofstream(path) << page;
}

class FaultTest : public SafetyTest, public ::testing::WithParamInterface<FaultCase> {};

TEST_P(FaultTest, TakesTheForceFromTheHandAndComesBackOnRequestOnly) {
  const FaultCase& fault = GetParam();
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    push();
    if (HasFatalFailure()) {
      return;
    }
    const Outcome outcome = [&] {
      Outcome met = release(fault);
      recover(fault, met);
      return met;
    }();
    ASSERT_TRUE(the_world->station->isRunning());
    EXPECT_EQ(std::count(fault.reasons.begin(), fault.reasons.end(), outcome.reason), 1)
        << int{outcome.reason};
    EXPECT_LE(outcome.largest_n, kForceLimitN);
    std::cout << fault.name << ": force gone after " << outcome.released_ms << " ms, recovered in "
              << outcome.recovered_s << " s" << (outcome.stalled ? ", stalled" : "") << '\n';
    if (outcome.stalled) {
      continue;  // the machine stood still: proves nothing, once more
    }
    EXPECT_LE(outcome.released_ms, fault.limit_ms);
    EXPECT_LT(outcome.recovered_s, 1.0);
    addRow(fault, outcome);
    return;
  }
  FAIL() << "the machine stalls too often to be tested on";
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
  push();
  if (HasFatalFailure()) {
    return;
  }
  const std::size_t first_event = the_world->events.count();
  begin(GetParam());
  ASSERT_TRUE(eventually([=] { return firstEvent(first_event, Event::INJECTED).has_value(); }));
  const std::int64_t tick = firstEvent(first_event, Event::INJECTED)->tick;
  ASSERT_TRUE(eventually([=] { return forcesFrom(tick + 300).size() > 300; }));
  EXPECT_EQ(the_world->status.latest().state, Status::PLAYING);
  EXPECT_TRUE(eventually([] { return effort() < -0.9 * kForceN; })) << effort();
}
INSTANTIATE_TEST_SUITE_P(Every, HarmlessFaultTest, ::testing::ValuesIn(harmlessCases()), &nameOf);

TEST_F(SafetyTest, RefusesToEngageBeforeItRecovered) {
  push();
  EXPECT_TRUE(call("emergency_stop").success);
  ASSERT_TRUE(stateBecomes(Status::FAULT));
  const auto refused = call("engage");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("recover"), std::string::npos) << refused.message;
  EXPECT_TRUE(call("recover").success);
}

TEST_F(SafetyTest, RefusesFaultsThatDoNotExist) {
  InjectFault inject;
  inject.request.kind = "gremlins";
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", inject));
  EXPECT_FALSE(inject.response.success);
  EXPECT_NE(inject.response.message.find("unplugged"), std::string::npos)
      << inject.response.message;
}

}  // namespace

void finish() {
  if (the_world != nullptr && std::getenv("ERGOTIC_WRITE_FAULTS") != nullptr) {
    writeTable(the_world->table);
  }
  the_world.reset();
}

}  // namespace ergotic::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ::ros::init(argc, argv, "safety_rostest");
  ::ros::AsyncSpinner spinner(2);
  spinner.start();
  const int result = RUN_ALL_TESTS();
  ergotic::test::finish();
  return result;
}
