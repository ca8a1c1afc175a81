// SPDX-License-Identifier: BSD-3-Clause
// What the hands hold, how it is calibrated, and what may go wrong with it on purpose.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/station/judge_hands.hpp"
#include "ergotic/tgr/faulty_driver.hpp"
#include "ros/device/process_faults.hpp"
#include "ros/display/handles.hpp"
#include "ros/interface/station_controller.hpp"

namespace ergotic::node {
namespace {

using CommandType = station::Command::Type;
using station::InjectedModelFault;

const char kNotAllowed[] = "faults can be injected only with the parameter allow_fault_injection";
constexpr std::int64_t kMaxTicks = 1'000'000;
constexpr double kPushOfLimit = 0.1;  // a push is at most that part of the force limit

const std::map<std::string, InjectedModelFault> kModelFaults = {
    {"model_not_a_number", InjectedModelFault::kNotANumber},
    {"model_blow_up", InjectedModelFault::kBlowUp},
    {"model_active", InjectedModelFault::kActive}};

struct ProgramFault {
  void (*check)(const Engine&, double amount);  // throws what is not allowed
  void (*act)(Engine&, double amount);
};
const auto kAnyAmount = [](const Engine& /*engine*/, double /*amount*/) {};
const std::map<std::string, ProgramFault> kProgramFaults = {
    {"signal", {kAnyAmount, [](Engine& engine, double) { engine.station().makeSafe(); }}},
    {"stopped",
     {[](const Engine&, double amount) { requireStop(amount); },
      [](Engine&, double amount) { stopThisProcess(amount); }}},
    {"killed", {kAnyAmount, [](Engine&, double) { killThisProcess(); }}},
    {"jack_lost",
     {[](const Engine& engine, double) { engine.requireJack(); },
      [](Engine& engine, double) { engine.dropJack(); }}}};

/// \throws Exception naming all that can be injected
tgr::InjectedFault deviceFaultNamed(const std::string& name) {
  std::vector<std::string> others;
  for (const auto& [other, unused] : kModelFaults) {
    others.push_back(other);
  }
  for (const auto& [other, unused] : kProgramFaults) {
    others.push_back(other);
  }
  return tgr::faultNamed(name, others);
}

}  // namespace

const tgr::EndEffectors& StationController::endEffectors() const {
  return configurations_.empty() ? engine_->hands().config().end_effectors
                                 : configurations_.back().end_effectors;
}

/// Refuses while another model is coming with end-effectors of its own, as the newest are unknown
/// then.
void StationController::requireNoneComing() const {
  const auto brings = [](const Incoming& incoming) {
    return incoming.with.end_effectors.has_value();
  };
  if (std::any_of(incoming_.begin(), incoming_.end(), brings)) {
    throw Exception("another model is coming with other end-effectors: ask again after that");
  }
}

void StationController::place(const tgr::EndEffectors& end_effectors) {
  engine_->hands().setEndEffectors(end_effectors);
  {
    const std::lock_guard lock(keyboard_mutex_);
    keyboard_.forgetHands();  // its hands let go with all others
  }
  move(players_.configure(end_effectors));
  publishers_.show(end_effectors);
}

void StationController::configure(const tgr::EndEffectors& end_effectors, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  try {
    requireNoneComing();
    const Hands& hands = engine_->hands();
    auto fitted = station::fitHands(*submitted_, end_effectors, hands.slices(), hands.traits());
    station::Command configure;
    configure.type = CommandType::kConfigure;
    configure.rig = fitted.rig.get();
    if (!engine_->station().submit(configure)) {
      return answer(promise, false,
                    "too many changes of end-effectors are still waiting for the real-time thread: "
                    "try again");
    }
    static_cast<void>(fitted.rig.release());  // the old one comes back with its event
    configurations_.push_back({end_effectors, std::move(fitted.warnings), promise});
  } catch (const Exception& refusal) {
    answer(promise, false, refusal.what());
  }
}

void StationController::takeConfigured(const station::Event& event) {
  const std::unique_ptr<tgr::Rig> old(event.rig);
  const Configuration done = configurations_.front();
  configurations_.pop_front();
  place(done.end_effectors);
  showHandles();
  findPlayMap(playing_->instrument->scene(), true);
  std::string message = std::to_string(done.end_effectors.list.size()) + " end-effectors in place";
  for (const std::string& warning : done.warnings) {
    ROS_WARN_STREAM(warning);
    message += "\n" + warning;
  }
  answer(done.promise, true, message);
}

void StationController::calibrate(const Calibrate::Request& request,
                                  const Arrival& arrival,
                                  const std::shared_ptr<Calibrate::Response>& measured,
                                  const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  try {
    switch (request.action) {
      case Calibrate::Request::BEGIN:
        begin(static_cast<int>(request.slice));
        return answer(promise, true, "hold the slice at a known place, then SAMPLE");
      case Calibrate::Request::SAMPLE:
        guide_.sample(request.position);
        measured_ = measured;
        sampled_ = promise;
        return;  // pollCalibration answers
      case Calibrate::Request::FINISH:
        return answer(promise, true, finish(request, *measured));
      case Calibrate::Request::CHECK:
        return check(request, arrival, promise);  // pollCheck answers
      case Calibrate::Request::ABORT:
        guide_.abort();
        for (Promise* waiting : {&sampled_, &check_.promise}) {
          if (*waiting) {
            answer(std::exchange(*waiting, nullptr), false, "the calibration was aborted");
          }
        }
        return answer(promise, true, "nothing has changed");
      default:
        throw Exception("action is " + std::to_string(request.action) + ", allowed: 0..." +
                        std::to_string(Calibrate::Request::CHECK));
    }
  } catch (const Exception& refusal) {
    answer(promise, false, refusal.what());
  }
}

void StationController::begin(int slice) {
  if (interlock_->read().isOpen()) {
    throw Exception("force is on: stop first");
  }
  const Hands& hands = engine_->hands();
  guide_.begin(hands.rawParts(), hands.slices(), slice);
  interlock_->stop();  // an engage may be on its way; later ones are refused
}

/// Starts a push to check a calibration. As a push is a force, it needs the right to engage, and
/// ends when force is taken away.
void StationController::check(const Calibrate::Request& request,
                              const Arrival& arrival,
                              const Promise& promise) {
  if (const auto breach = own_host_.breach()) {
    throw Exception(*breach);
  }
  const station::Interlock::Reading now = interlock_->read();
  if (now.isLatched()) {
    throw Exception("force is latched at zero: recover first");
  }
  if (now.ticket != arrival.ticket) {
    throw Exception("force was taken away since this was asked for");
  }
  begin(static_cast<int>(request.slice));
  guide_.push(std::min(tgr::kPushN, kPushOfLimit * engine_->parameters().safety.force_limit_n));
  check_ = {arrival.ticket + 1, request.file, promise};  // after the stop of `begin`
}

std::string StationController::finish(const Calibrate::Request& request,
                                      Calibrate::Response& measured) {
  const tgr::SliceCalibration fitted = guide_.finish(
      request.max_residual > 0.0 ? request.max_residual : CalibrationGuide::kUsualResidualM,
      request.volts_per_newton);
  measured.gain = fitted.metres_per_volt;
  measured.rest = fitted.rest_volts;
  measured.residual = fitted.residual_m;
  measured.noise = fitted.noise_m / std::abs(fitted.metres_per_volt);
  return keep(request.file);
}

/// Saves a calibration that is in use. \return the result, in words
std::string StationController::keep(const std::string& file) {
  if (file.empty()) {
    return "in use; no file was asked for";
  }
  try {
    return "in use, and written to " + engine_->hands().save(file);
  } catch (const Exception& failure) {
    return std::string("in use, but not kept: ") + failure.what();
  }
}

void StationController::pollCheck() {
  if (!guide_.isPushing()) {
    return;
  }
  try {
    if (interlock_->ticket() != check_.ticket) {
      guide_.abort();
      throw Exception("force was taken away: the push has ended before it told anything");
    }
    if (const auto force = guide_.pollPush(engine_->hands().traits().mass)) {
      std::ostringstream told;
      told << "the slice was moved as by " << *force << " N; ";
      answer(std::exchange(check_.promise, nullptr), true, told.str() + keep(check_.file));
    }
  } catch (const Exception& failure) {
    answer(std::exchange(check_.promise, nullptr), false, failure.what());
  }
}

void StationController::pollCalibration() {
  pollCheck();
  const auto point = guide_.poll();
  if (!point) {
    return;
  }
  measured_->volts = point->mean_volts;
  measured_->noise = point->rms_volts;
  answer(std::exchange(sampled_, nullptr), true,
         std::to_string(guide_.samples()) + (guide_.samples() < 2
                                                 ? " sample: at least one more at another place"
                                                 : " samples: more, or FINISH"));
}

/// Told before it is made, so that the record never shows an effect before its cause; and only what
/// nothing refuses any more.
void StationController::tellInjected(int index, std::int64_t ticks) {
  if (!command(CommandType::kInject, index, static_cast<double>(ticks))) {
    throw Exception("too many requests wait for the real-time thread");
  }
}

void StationController::inject(const InjectFault::Request& request, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  if (engine_->hands().faulty() == nullptr) {
    return answer(promise, false, kNotAllowed);
  }
  try {
    const std::int64_t ticks = request.ticks == 0 ? 1 : request.ticks;
    if (ticks < 1 || ticks > kMaxTicks) {
      throw Exception("ticks is " + std::to_string(ticks) + ", allowed: 0...1000000");
    }
    const auto model_fault = kModelFaults.find(request.kind);
    const auto program_fault = kProgramFaults.find(request.kind);
    if (program_fault != kProgramFaults.end()) {
      program_fault->second.check(*engine_, request.amount);
      tellInjected(-1, ticks);
      program_fault->second.act(*engine_, request.amount);
    } else if (model_fault != kModelFaults.end()) {
      tellInjected(static_cast<int>(model_fault->second), ticks);
    } else {
      const tgr::FaultOrder order{deviceFaultNamed(request.kind), request.slice, ticks,
                                  request.amount};
      engine_->hands().faulty()->check(order);
      tellInjected(static_cast<int>(order.kind), ticks);
      engine_->hands().faulty()->inject(order);
    }
    answer(promise, true, "");
  } catch (const Exception& refusal) {
    answer(promise, false, refusal.what());
  }
}

}  // namespace ergotic::node
