// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/operator.hpp"

#include <chrono>
#include <utility>

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

constexpr auto kPollPeriod = 5ms;
constexpr auto kAnswerTimeout = 5s;
constexpr auto kCloseTimeout = 900ms;
constexpr std::size_t kMaxTasks = 1024;

}  // namespace

Operator::Operator(Feed& feed, Diagnostics& diagnostics)
    : feed_(feed), diagnostics_(diagnostics), performance_(feed) {
  thread_ = std::thread([this] { run(); });
}

Operator::~Operator() {
  performance_.makeSafe(tgr::FaultReason::kMadeSafe);
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

bool Operator::post(Task task) {
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

Answer Operator::ask(const std::function<void(const Promise&)>& request) {
  auto promise = std::make_shared<std::promise<Answer>>();
  std::future<Answer> future = promise->get_future();
  if (!post([request, promise] { request(promise); })) {
    return {false, "the station is closing, or too busy to take a request"};
  }
  promise.reset();  // whoever drops the request breaks the promise
  if (future.wait_for(kAnswerTimeout) != std::future_status::ready) {
    return {false, "no answer from the real-time thread within 5 s"};
  }
  try {
    return future.get();
  } catch (const std::future_error&) {
    return {false, "the station closed before it could answer"};
  }
}

Answer Operator::begin(std::unique_ptr<Engine> engine, station::Performer* performer) {
  const auto shared = std::make_shared<std::unique_ptr<Engine>>(std::move(engine));
  return ask([this, shared, performer](const Promise& promise) {
    performance_.begin(std::move(*shared), performer);
    promise->set_value({true, feed_.status().message});
  });
}

Answer Operator::swap(std::unique_ptr<station::Performer> performer) {
  const auto shared = std::make_shared<std::unique_ptr<station::Performer>>(std::move(performer));
  return ask(
      [this, shared](const Promise& promise) { performance_.swap(std::move(*shared), promise); });
}

Answer Operator::engage() {
  return ask([this](const Promise& promise) { performance_.engage(promise); });
}

Answer Operator::recover() {
  return ask([this](const Promise& promise) { performance_.recover(promise); });
}

Answer Operator::stop() {
  return ask([this](const Promise& promise) { performance_.stop(promise); });
}

Answer Operator::setParameter(const std::string& name, double value) {
  return ask([=](const Promise& promise) { performance_.setParameter(name, value, promise); });
}

Answer Operator::setTarget(int slice, double target_m) {
  return ask([=](const Promise& promise) { performance_.setTarget(slice, target_m, promise); });
}

Answer Operator::configure(const tgr::EndEffectors& end_effectors) {
  return ask([=](const Promise& promise) { performance_.configure(end_effectors, promise); });
}

Calibrate::Response Operator::calibrate(const Calibrate::Request& request) {
  const auto measured = std::make_shared<Calibrate::Response>();
  const Answer answer =
      ask([=](const Promise& promise) { performance_.calibrate(request, measured, promise); });
  Calibrate::Response response;
  if (answer.ok) {  // otherwise it may still be written
    response = *measured;
  }
  response.success = answer.ok ? 1U : 0U;
  response.message = answer.message;
  return response;
}

Answer Operator::inject(const InjectFault::Request& request) {
  return ask([=](const Promise& promise) { performance_.inject(request, promise); });
}

std::optional<Operator::Terms> Operator::terms() {
  const auto terms = std::make_shared<std::optional<Terms>>();
  ask([this, terms](const Promise& promise) {
    if (Engine* engine = performance_.engine()) {
      const Hands& hands = engine->hands();
      *terms = Terms{engine->station().config().rates, hands.slices(), hands.traits(),
                     hands.config().end_effectors, engine->parameters()};
    }
    promise->set_value({true, ""});
  });
  return *terms;
}

void Operator::tell(const std::string& message) {
  post([this, message] {
    if (performance_.engine() == nullptr) {
      feed_.showSilence(message);
    } else {
      feed_.addMessage(message);
    }
  });
}

void Operator::close() {
  const auto done = std::make_shared<std::promise<void>>();
  const std::future<void> closed = done->get_future();
  {
    const std::lock_guard lock(mutex_);
    if (quit_) {
      return;
    }
    closed_ = true;
    tasks_.push_back([this, done] {
      performance_.close();
      done->set_value();
    });
  }
  woken_.notify_all();
  closed.wait_for(kCloseTimeout);
}

void Operator::run() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      woken_.wait_for(lock, kPollPeriod, [this] { return quit_ || !tasks_.empty(); });
      if (quit_) {
        break;
      }
    }
    runTasks();
    performance_.poll();
    feed_.refresh();
    diagnostics_.refresh(feed_.status(), performance_.engine());
  }
  performance_.close();
  const std::lock_guard lock(mutex_);
  tasks_.clear();
}

void Operator::runTasks() {
  std::deque<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (const Task& task : tasks) {
    task();
  }
}

}  // namespace ergotic::node
