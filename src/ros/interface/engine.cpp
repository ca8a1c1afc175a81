// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/engine.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <sstream>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

// The presence switch says that it is held at least this often.
constexpr double kPresenceS = 0.2;
constexpr int kMaxPriority = 99;
constexpr double kPeriodsOfSilence = 3.0;
constexpr double kMaxWatchdogS = 1.0;
constexpr std::int64_t kGuardianRetryNs = 1'000'000'000;
constexpr double kPeriodsOfHang = 2.0;  // of the watchdog, which beats for the guardian
constexpr int kWatchdogAboveTick = 5;   // it must not wait for a tick that never ends

station::StationConfig stationConfig(const Parameters& parameters, const physics::Rates& rates) {
  station::StationConfig config;
  config.rates = rates;
  config.safety = parameters.safety;
  config.max_stall_s = parameters.max_stall.value();
  config.max_stalls = parameters.max_stalls.value();
  config.presence_s = parameters.presence ? kPresenceS : 0.0;
  config.allow_fault_injection = parameters.allow_fault_injection;
  return config;
}

station::TimerOptions timerOptions(const Parameters& parameters) {
  station::TimerOptions options;
  const bool realtime = parameters.realtime != Realtime::kOff;
  options.priority = realtime ? parameters.priority : 0;
  options.lock_memory = realtime;
  options.cpu = parameters.cpu;
  return options;
}

/// Watchdog period as requested, or longer if the device's ticks come in bursts.
double watchdogPeriod(double asked_s, tgr::Driver& driver) {
  const tgr::DeviceClock* const clock = driver.clock();
  const double least_s =
      clock == nullptr ? 0.0 : std::min(kPeriodsOfSilence * clock->periodS(), kMaxWatchdogS);
  return std::max(asked_s, least_s);
}

int watchdogPriority(const Parameters& parameters) {
  return parameters.realtime != Realtime::kOff
             ? std::min(kMaxPriority, parameters.priority + kWatchdogAboveTick)
             : 0;
}

/// Hears of the server's rate, plays nothing.
class RateProbe : public rt::AudioProcessor {
 public:
  void audioStarted(double sample_rate_hz, std::uint32_t /*period_frames*/) override {
    const std::lock_guard lock(mutex_);
    rate_ = sample_rate_hz;
    heard_.notify_all();
  }
  void audioStopped() noexcept override {}
  void process(const rt::Period& /*period*/) noexcept override {}
  void xrun() noexcept override {}

  std::optional<double> wait(double seconds) {
    std::unique_lock lock(mutex_);
    heard_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !!rate_; });
    return rate_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable heard_;
  std::optional<double> rate_;
};

}  // namespace

Engine::Engine(const Parameters& parameters,
               std::unique_ptr<Hands> hands,
               std::unique_ptr<station::Performer> performer,
               std::shared_ptr<station::Interlock> interlock)
    : parameters_(parameters), hands_(std::move(hands)) {
  const physics::Rates rates = performer->instrument->rates();
  const station::StationConfig config = stationConfig(parameters, rates);
  station_ = std::make_unique<station::Station>(config, hands_->takeDriver(), std::move(performer),
                                                std::move(interlock));
  if (parameters.jack) {
    station::AudioBridgeConfig bridge;
    bridge.rates = rates;
    bridge.output_channels = config.output_channels;
    bridge.input_channels = config.input_channels;
    bridge.latency_frames = parameters.ring_depth;
    bridge.limited = parameters.limiter;
    bridge_ = std::make_unique<station::AudioBridge>(bridge);
    station_->setFramePort(bridge_.get());
  }
  if (const std::string problem = startGuardian(); !problem.empty()) {
    warnings_.push_back(problem + ": there will be no force until another can be started");
  }
  source_ = station::startTicks(*station_, bridge_.get(), timerOptions(parameters));
  warnings_.insert(warnings_.end(), source_->warnings().begin(), source_->warnings().end());
  startWatchdog();
  if (parameters.realtime == Realtime::kRequire && !warnings_.empty()) {
    source_->stop();
    throw DeviceError("realtime:=require, but " + warnings_.front());
  }
  if (watchdog_s_ > parameters.watchdog.value()) {
    std::ostringstream raised;
    raised << "watchdog is " << parameters.watchdog.value() << " s, which is raised to "
           << watchdog_s_ << " s, three periods of the device, whose ticks come in bursts";
    warnings_.push_back(raised.str());
  }
  if (parameters.jack) {
    audio::JackConfig jack;
    jack.name = parameters.jack_name;
    jack.inputs = config.input_channels;
    jack.outputs = config.output_channels;
    jack.connect = parameters.jack_connect;
    jack.midi = true;
    jack.midi_connect = parameters.midi_connect;
    jack.latency_frames = static_cast<std::uint32_t>(bridge_->latencyFrames());
    jack_ = std::make_unique<audio::JackHost>(jack, *bridge_);
  }
}

Engine::~Engine() {
  watchdog_->disarm();
  station_->makeSafe();
  master_watch_.reset();
  source_->stop();
  watchdog_->stop();
  // The device is given back before its guardian, and before JACK, which may take its time.
  station_.reset();
}

void Engine::startWatchdog() {
  watchdog_ = std::make_unique<tgr::Watchdog>(station_->heartbeat(), [this](std::int64_t) {
    station_->makeSafe(tgr::FaultReason::kWatchdog);
    silent_at_ = station_->heartbeat().load();
  });
  watchdog_s_ = watchdogPeriod(parameters_.watchdog.value(), station_->driver());
  tgr::WatchdogOptions options;
  options.period_s = watchdog_s_;
  options.priority = watchdogPriority(parameters_);
  options.beat = [this] { watchGuardian(); };
  watchdog_->start(options);
  if (!watchdog_->warning().empty()) {
    warnings_.push_back(watchdog_->warning());
  }
  watchdog_->arm();
}

/// Starts a guardian, in place of an earlier one. Without a guardian there is no force.
/// \return reason if it does not start
std::string Engine::startGuardian() {
  const std::vector<tgr::Guard> guards = station_->driver().guards();
  std::unique_ptr<tgr::Guardian> next;
  std::string problem;
  try {
    if (!guards.empty()) {
      tgr::GuardianOptions options;
      options.silence_s =
          kPeriodsOfHang * watchdogPeriod(parameters_.watchdog.value(), station_->driver());
      options.priority = watchdogPriority(parameters_);
      next = std::make_unique<tgr::Guardian>(guards, options);
    }
  } catch (const DeviceError& refusal) {
    problem = refusal.what();
    guardian_retry_ns_ = rt::monotonicNs() + kGuardianRetryNs;
    station_->makeSafe(tgr::FaultReason::kGuardianLost);
  }
  // All at once: the watchdog must not take the loss of the old one for that of the new.
  const std::lock_guard lock(guardian_mutex_);
  guardian_lost_ = !problem.empty();
  guards_ = guards;
  guardian_.swap(next);
  return problem;
}

/// Replaces a lost guardian as soon as another one can be started. Force waits for a recover.
void Engine::keepGuardian() {
  if (!guardian_lost_ || rt::monotonicNs() < guardian_retry_ns_) {
    return;
  }
  const bool is_first_try = guardian_retry_ns_ == 0;
  if (const std::string problem = startGuardian(); problem.empty()) {
    guardian_retry_ns_ = 0;
    warnings_.emplace_back(
        "there is a guardian of the devices again: recover and engage bring the force back");
  } else if (is_first_try) {
    warnings_.push_back(problem + ": there is no force until another can be started");
  }
}

/// Tells the guardian that this process lives, and sees that the guardian does: without one that
/// looks, a device that needs one gets no force. Thread: the watchdog's
void Engine::watchGuardian() {
  const std::lock_guard lock(guardian_mutex_);
  if (guardian_ && guardian_->isWatching()) {
    guardian_->beat();
  } else if (!guards_.empty() && !guardian_lost_.exchange(true)) {
    station_->makeSafe(tgr::FaultReason::kGuardianLost);
  }
}

void Engine::watchMaster(const std::vector<std::string>& services,
                         const std::vector<std::string>& topics) {
  master_watch_ = std::make_unique<MasterWatch>(
      services, topics, [this] { station_->makeSafe(tgr::FaultReason::kMasterLost); });
}

void Engine::recover() {
  station_->driver().reconnect();  // may take its time
  if (guardian_lost_ || !(station_->driver().guards() == guards_)) {
    if (const std::string problem = startGuardian(); !problem.empty()) {
      throw Exception(problem + ": without a guardian this device gets no force");
    }
    guardian_retry_ns_ = 0;
  }
  if (master_watch_ && master_watch_->isMissing()) {
    throw Exception(
        "the ROS master does not answer, or does not know this station, or leads to another node "
        "that took its services' names: nobody could find stop and emergency_stop. If it does not "
        "come back, start the station again under a new one");
  }
  watchdog_->arm();
}

void Engine::requireJack() const {
  if (!jack_) {
    throw Exception("there is no sound to lose: jack is none");
  }
}

std::optional<audio::JackStatus> Engine::jackStatus() const {
  return jack_ ? std::optional(jack_->status()) : std::nullopt;
}

std::vector<std::string> Engine::takeWarnings() {
  keepGuardian();
  std::vector<std::string> warnings = std::exchange(warnings_, {});
  if (bridge_) {
    for (std::string& warning : bridge_->takeWarnings()) {
      warnings.push_back(std::move(warning));
    }
  }
  return warnings;
}

std::optional<double> findJackRate(const std::string& name, double wait_s) {
  RateProbe probe;
  audio::JackConfig config;
  config.name = name + "_probe";  // the station's own name stays free
  const audio::JackHost host(config, probe);
  return probe.wait(wait_s);
}

}  // namespace ergotic::node
