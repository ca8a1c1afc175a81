// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/watchdog.hpp"

#include <future>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/tgr/safety/tick_watch.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {

Watchdog::Watchdog(const std::atomic<std::int64_t>& ticks, Bite bite)
    : ticks_(ticks), bite_(std::move(bite)) {}

void Watchdog::start(const WatchdogOptions& options) {
  if (isRunning()) {
    throw Exception("the watchdog is already running");
  }
  requireWithin("watchdog", options.period_s, 0.004, 1.0, "s");
  requireWithin("watchdog priority", options.priority, 0, 99, "");
  warning_.clear();
  stopping_ = false;
  wanted_ = false;
  std::promise<void> ready;
  thread_ = std::thread([this, &ready, options] {
    setUpThread(options.priority);
    ready.set_value();
    run(options);
  });
  ready.get_future().wait();
}

void Watchdog::stop() noexcept {
  stopping_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Watchdog::setUpThread(int priority) {
  if (priority > 0) {
    warning_ = rt::makeRealtime(priority).message;
  }
  rt::prefaultStack();
}

void Watchdog::run(const WatchdogOptions& options) noexcept {
  const auto period_ns = static_cast<std::int64_t>(1e9 * options.period_s);
  const std::int64_t interval_ns = period_ns / 4;
  TickWatch watch(period_ns, interval_ns);
  std::int64_t now_ns = rt::monotonicNs();
  while (!stopping_) {
    options.beat();
    if (!wanted_) {
      watch.disarm();
    } else if (!watch.isArmed()) {
      watch.arm();
    }
    const bool stopped = watch.look(now_ns, ticks_);
    machine_stalls_ = watch.machineStalls();
    longest_stall_ns_ = watch.longestStallNs();
    if (stopped && wanted_.exchange(false)) {
      silence_ns_ = watch.silenceNs();
      bite_(watch.silenceNs());
      ++bites_;
    }
    rt::sleepUntilNs(now_ns + interval_ns);
    now_ns = rt::monotonicNs();
  }
}

}  // namespace ergotic::tgr
