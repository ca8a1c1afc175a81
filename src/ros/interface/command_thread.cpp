// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/command_thread.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>

#include <ros/console.h>
#include <ros/init.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

constexpr auto kPollPeriod = 5ms;
constexpr std::int64_t kAnswerTimeoutNs = 5'000'000'000;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr auto kCloseTimeout = 900ms;
constexpr std::size_t kMaxTasks = 1024;
constexpr std::size_t kMaxParameters = 1024;  // names that wait
constexpr std::int64_t kParametersNs = 2'000'000;
constexpr std::size_t kParametersPerPoll = 64;  // fewer than the tick takes meanwhile
constexpr double kErrorPeriodS = 1.0;
const char kWasWithdrawn[] = "no answer within 5 s: the request is withdrawn";
const char kWasBegun[] =
    "no answer within 5 s: the request was begun, and what it asks for may still come";

/// State of a request, which is executed or withdrawn, whichever comes first.
enum class Claim : std::uint8_t { kWaits, kBegun, kWithdrawn };

bool settle(std::atomic<Claim>& claim, Claim to) {
  Claim waits = Claim::kWaits;
  return claim.compare_exchange_strong(waits, to);
}

}  // namespace

CommandThread::CommandThread(const ::ros::NodeHandle& node,
                             Publishers& feed,
                             Diagnostics& diagnostics,
                             const OwnHost& own_host)
    : publishers_(feed), diagnostics_(diagnostics), controller_(node, feed, interlock_, own_host) {
  thread_ = std::thread([this] { run(); });
}

CommandThread::~CommandThread() {
  controller_.makeSafe(tgr::FaultReason::kMadeSafe);
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

bool CommandThread::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || quit_ || tasks_.size() >= kMaxTasks) {
      return false;
    }
    tasks_.push_back(std::move(task));
  }
  woken_.notify_all();
  return true;
}

Answer CommandThread::ask(const Request& request) {
  return ask(request, rt::monotonicNs() + kAnswerTimeoutNs);
}

Answer CommandThread::ask(const Request& request, std::int64_t deadline_ns) {
  auto promise = std::make_shared<std::promise<Answer>>();
  std::future<Answer> future = promise->get_future();
  const auto claim = std::make_shared<std::atomic<Claim>>(Claim::kWaits);
  if (!post({[request, promise, claim] {
               if (settle(*claim, Claim::kBegun)) {
                 request(promise);
               }
             },
             deadline_ns})) {
    return {false, "the station is closing, or too busy to take a request"};
  }
  promise.reset();  // whoever drops the request breaks the promise
  const std::chrono::nanoseconds left(deadline_ns - rt::monotonicNs());
  if (future.wait_for(left) != std::future_status::ready) {
    return {false, settle(*claim, Claim::kWithdrawn) ? kWasWithdrawn : kWasBegun};
  }
  try {
    return future.get();
  } catch (const std::future_error&) {
    return {false, "the station closed before it could answer, or it was too late for one"};
  }
}

/// Asks for force; if the caller gets no answer in time, force is stopped, so that none comes
/// later.
Answer CommandThread::askForForce(const ForceRequest& request, const Request& ask_for) {
  Answer answer = ask(ask_for, request.arrival.time_ns + kAnswerTimeoutNs);
  if (answer.message == kWasWithdrawn || answer.message == kWasBegun) {
    interlock_->stop();
  }
  return answer;
}

Answer CommandThread::begin(std::unique_ptr<Engine> engine,
                            station::Performer* performer,
                            const std::shared_ptr<Picture>& picture) {
  const auto shared = std::make_shared<std::unique_ptr<Engine>>(std::move(engine));
  return ask([=](const Promise& promise) {
    controller_.begin(std::move(*shared), performer, picture);
    promise->set_value(
        {true, controller_.whatPlays(!controller_.engine()->parameters().autoengage)});
  });
}

Answer CommandThread::swap(std::unique_ptr<station::Performer> performer,
                           const StationController::Swap& with) {
  const auto shared = std::make_shared<std::unique_ptr<station::Performer>>(std::move(performer));
  return ask([=](const Promise& promise) { controller_.swap(std::move(*shared), with, promise); });
}

Answer CommandThread::engage(const ForceRequest& request) {
  return askForForce(request,
                     [=](const Promise& promise) { controller_.engage(request, promise); });
}

Answer CommandThread::recover(const ForceRequest& request) {
  return askForForce(request,
                     [=](const Promise& promise) { controller_.recover(request, promise); });
}

Answer CommandThread::setParameter(const std::string& name, double value) {
  return ask([=](const Promise& promise) { controller_.setParameter(name, value, promise); });
}

ParametersNow CommandThread::parametersNow() {
  const auto now = std::make_shared<std::optional<ParametersNow>>();
  const Answer answer = ask([this, now](const Promise& promise) {
    *now = controller_.parametersNow();
    promise->set_value({now->has_value(), kNothingPlays});
  });
  if (!answer.ok) {
    throw Exception(answer.message);
  }
  return std::move(**now);
}

Answer CommandThread::recall(const PresetValues& values, double seconds) {
  return ask([=](const Promise& promise) { controller_.recall(values, seconds, promise); });
}

Answer CommandThread::undo() {
  return ask([this](const Promise& promise) { controller_.undo(promise); });
}

void CommandThread::showPresets() {
  post({[this] { controller_.showPresets(); }, kNever});
}

Answer CommandThread::setVolume(double volume) {
  return ask([=](const Promise& promise) {
    const std::string refusal = controller_.setVolume(volume);
    promise->set_value({refusal.empty(), refusal});
  });
}

Answer CommandThread::configure(const tgr::EndEffectors& end_effectors) {
  return ask([=](const Promise& promise) { controller_.configure(end_effectors, promise); });
}

Calibrate::Response CommandThread::calibrate(const Calibrate::Request& request,
                                             const Arrival& arrival) {
  const auto measured = std::make_shared<Calibrate::Response>();
  const Answer answer = ask(
      [=](const Promise& promise) { controller_.calibrate(request, arrival, measured, promise); });
  Calibrate::Response response;
  if (answer.ok) {  // otherwise it may still be written
    response = *measured;
  }
  response.success = answer.ok ? 1U : 0U;
  response.message = answer.message;
  return response;
}

Answer CommandThread::inject(const InjectFault::Request& request) {
  return ask([=](const Promise& promise) { controller_.inject(request, promise); });
}

Take::Response CommandThread::take(const Take::Request& request) {
  const auto path = std::make_shared<std::string>();
  const Answer answer =
      ask([=](const Promise& promise) { controller_.take(request, path, promise); });
  Take::Response response;
  response.success = answer.ok ? 1U : 0U;
  response.message = answer.message;
  response.path = answer.ok ? *path : "";  // otherwise it may still be written
  return response;
}

bool CommandThread::setParameterSoon(const std::string& name, double value) {
  const std::lock_guard lock(mutex_);
  if (parameters_.size() >= kMaxParameters && parameters_.count(name) == 0) {
    return false;
  }
  parameters_[name] = value;
  return true;
}

std::optional<CommandThread::Terms> CommandThread::terms() {
  const auto terms = std::make_shared<std::optional<Terms>>();
  const Answer answer = ask([this, terms](const Promise& promise) {
    if (Engine* engine = controller_.engine()) {
      const Hands& hands = engine->hands();
      *terms = Terms{engine->station().config().rates, hands.slices(),       hands.traits(),
                     hands.config().end_effectors,     engine->parameters(), hands.canHurt(),
                     controller_.sceneFile()};
    }
    promise->set_value({true, ""});
  });
  if (!answer.ok) {
    throw Exception(answer.message);
  }
  return *terms;
}

void CommandThread::tell(const std::string& message) {
  const auto show = [this, message] {
    if (controller_.engine() == nullptr) {
      publishers_.showSilence(message);
    } else {
      publishers_.addMessage(message);
    }
  };
  post({show, kNever});
}

void CommandThread::close() {
  const auto done = std::make_shared<std::promise<void>>();
  const std::future<void> closed = done->get_future();
  {
    const std::lock_guard lock(mutex_);
    if (quit_) {
      return;
    }
    closed_ = true;
    const auto close = [this, done] {
      controller_.close();
      done->set_value();
    };
    tasks_.push_back({close, kNever});
  }
  woken_.notify_all();
  closed.wait_for(kCloseTimeout);
}

void CommandThread::run() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      woken_.wait_for(lock, kPollPeriod, [this] { return quit_ || !tasks_.empty(); });
      if (quit_) {
        break;
      }
    }
    try {
      runTasks();
      setParameters();
      controller_.poll();
      publishers_.refresh();
      diagnose();
    } catch (const std::exception& surprise) {  // it must not end the process with force on
      controller_.makeSafe(tgr::FaultReason::kMadeSafe);
      ROS_ERROR_STREAM_THROTTLE(kErrorPeriodS,
                                "force is latched at zero, for the station could not "
                                "go on as usual: "
                                    << surprise.what());
    }
  }
  controller_.close();
  const std::lock_guard lock(mutex_);
  tasks_.clear();
}

std::optional<int> CommandThread::playMidi() {
  const PlayersWishes wishes = controller_.playMidi();
  grant(wishes);
  return wishes.program;
}

void CommandThread::playGamepad(int pad, const tgr::GamepadMove& move) {
  grant(controller_.playGamepad(pad, move));
}

/// Grants all wishes but that for another program.
void CommandThread::grant(const PlayersWishes& wishes) {
  for (const auto& [parameter, value] : wishes.parameters) {
    setParameterSoon(parameter, value);
  }
  for (const std::string& line : wishes.news) {
    ROS_INFO_STREAM(line);
    tell(line);
  }
}

/// Publishes diagnostics, which may fail without reason to take force away, as when the time of ROS
/// is out of range.
void CommandThread::diagnose() {
  try {
    diagnostics_.refresh(publishers_.status(), controller_.engine());
  } catch (const std::exception& surprise) {
    ROS_ERROR_STREAM_THROTTLE(kErrorPeriodS, "diagnostics: " << surprise.what());
  }
}

void CommandThread::runTasks() {
  std::deque<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (Task& task : tasks) {
    if (rt::monotonicNs() < task.deadline_ns) {
      task.run();
    }
    task.run = nullptr;  // what waits for it hears so now
  }
}

/// Round and round, some at a time: what one costs is a matter of the model, and others wait.
void CommandThread::setParameters() {
  const std::int64_t end_ns = rt::monotonicNs() + kParametersNs;
  std::size_t count = 0;
  do {
    decltype(parameters_)::node_type next;
    {
      const std::lock_guard lock(mutex_);
      if (parameters_.empty()) {
        return;
      }
      const auto after = parameters_.upper_bound(last_parameter_);
      next = parameters_.extract(after != parameters_.end() ? after : parameters_.begin());
    }
    last_parameter_ = next.key();
    const auto promise = std::make_shared<std::promise<Answer>>();
    std::future<Answer> refusal = promise->get_future();
    controller_.setParameter(next.key(), next.mapped(), promise);
    if (refusal.wait_for(0s) == std::future_status::ready) {
      ROS_WARN_STREAM_THROTTLE(kErrorPeriodS, "parameters: " << refusal.get().message);
    }
  } while (++count < kParametersPerPoll && rt::monotonicNs() < end_ns);
}

}  // namespace ergotic::node
