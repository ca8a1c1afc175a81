// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/timer_source.hpp"

#include <pthread.h>
#include <sched.h>

#include <cstring>
#include <future>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::station {
namespace {

/// \return why the calling thread could not be bound to `cpu`, empty if it was
std::string bindTo(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<unsigned>(cpu), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
  return error == 0 ? std::string{}
                    : "cannot run on cpu " + std::to_string(cpu) + ": " + std::strerror(error);
}

}  // namespace

void TimerSource::start(const TimerOptions& options) {
  if (isRunning()) {
    throw Exception("the timer is already running");
  }
  if (options.priority < 0 || options.priority > 99) {
    throw Exception("real-time priority is " + std::to_string(options.priority) +
                    ", allowed 0...99");
  }
  if (options.cpu < -1 || options.cpu >= CPU_SETSIZE) {
    throw Exception("cpu is " + std::to_string(options.cpu) + ", allowed -1..." +
                    std::to_string(CPU_SETSIZE - 1));
  }
  warnings_.clear();
  stopping_.store(false, std::memory_order_relaxed);
  std::promise<void> ready;
  thread_ = std::thread([this, &ready, options] {
    setUpThread(options);
    ready.set_value();
    run();
  });
  ready.get_future().wait();
}

void TimerSource::stop() noexcept {
  stopping_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) {
    thread_.join();
  }
}

void TimerSource::setUpThread(const TimerOptions& options) {
  const auto warn = [this](const std::string& message) {
    if (!message.empty()) {
      warnings_.push_back(message);
    }
  };
  if (options.lock_memory) {
    warn(rt::lockMemory().message);
  }
  if (options.cpu >= 0) {
    warn(bindTo(options.cpu));
  }
  if (options.priority > 0) {
    warn(rt::makeRealtime(options.priority).message);
  }
  rt::prefaultStack();
}

void TimerSource::run() noexcept {
  const rt::FlushDenormals flush_denormals;
  const double period_ns = 1e9 / station_.config().rates.gesturalHz();
  TickSchedule schedule(period_ns, rt::monotonicNs() + static_cast<std::int64_t>(period_ns));
  follow(schedule);
  while (!stopping_.load(std::memory_order_relaxed)) {
    const TickSchedule::Step step = schedule.at(rt::monotonicNs());
    switch (step.kind) {
      case TickSchedule::Step::Kind::kWait:
        rt::sleepUntilNs(schedule.dueNs());
        continue;
      case TickSchedule::Step::Kind::kRun:
        station_.cycle({step.late_ns, false});
        break;
      case TickSchedule::Step::Kind::kCatchUp:
        station_.catchUp(step.ticks, step.late_ns);
        break;
    }
    schedule.advance(step.ticks);
    follow(schedule);
  }
  station_.rest();
  if (bridge_ != nullptr) {
    bridge_->disconnect();
  }
}

void TimerSource::follow(TickSchedule& schedule) noexcept {
  if (bridge_ == nullptr) {
    return;
  }
  bridge_->track(station_.nextTick(), schedule.dueNs());
  if (bridge_->isMaster()) {
    schedule.follow(bridge_->dueNs(station_.nextTick()));
  }
}

}  // namespace ergotic::station
