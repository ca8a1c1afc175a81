// SPDX-License-Identifier: BSD-3-Clause
#include "integration/fault_injection.hpp"

#include <std_srvs/Trigger.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <ergotic/InjectFault.h>

#include "ergotic/rt/clock.hpp"

namespace ergotic::test {
namespace {

/// Connected before time counts.
template <class Service>
std::int64_t request(SafetyWorld& world, const std::string& name, Service& service) {
  constexpr bool kPersistent = true;
  auto client = world.node.serviceClient<Service>("/station/" + name, kPersistent);
  const std::int64_t now_ns = rt::monotonicNs();
  if (!client.call(service) || service.response.success == 0U) {
    throw std::runtime_error(name + ": " + service.response.message);
  }
  return now_ns;
}

std::int64_t inject(SafetyWorld& world, const FaultCase& fault) {
  InjectFault inject;
  inject.request.kind = fault.kind;
  inject.request.slice = 0;
  inject.request.ticks = fault.ticks;
  inject.request.amount = fault.amount;
  const std::int64_t now_ns = request(world, "inject_fault", inject);
  if (fault.start == Start::kEnergy) {
    world.moveHand(0, -kTargetM);  // along the force
  }
  return now_ns;
}

}  // namespace

std::int64_t begin(SafetyWorld& world, const FaultCase& fault) {
  const std::int64_t now_ns = rt::monotonicNs();
  if (fault.kind == "process_stopped") {
    world.station->signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::duration<double>(fault.amount));
    world.station->signal(SIGCONT);
  } else if (fault.kind == "emergency_topic") {
    world.stop.publish(std_msgs::Empty());
  } else if (fault.kind == "presence_released") {
    world.presence.release();
  } else if (fault.kind == "presence_silent") {
    world.presence.fallSilent();
  } else if (fault.kind == "reach") {
    world.moveHand(1, 1.5 * kReachM);
  } else if (fault.kind == "emergency_service") {
    std_srvs::Trigger trigger;
    return request(world, "emergency_stop", trigger);
  } else {
    return inject(world, fault);
  }
  return now_ns;
}

}  // namespace ergotic::test
