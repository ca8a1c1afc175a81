// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/jack_client.hpp"

#include <atomic>
#include <mutex>
#include <thread>

#include "audio/jack_session.hpp"
#include "audio/jack_wires.hpp"
#include "audio/midi_sources.hpp"
#include "audio/semaphore.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"

namespace ergotic::audio {

namespace {

constexpr std::int64_t kRetryNs = 1'000'000'000;
constexpr std::int64_t kStillNs = 1'000'000'000;  // many times the longest period
constexpr std::size_t kMaxNameLength = 60;  // JACK's 64 less its terminator and the number it adds

void requirePorts(int count, const char* what) {
  if (count < 0 || count > kMaxPorts) {
    throw Exception(std::string("JACK ") + what + ": " + std::to_string(count) +
                    " ports, allowed: 0..." + std::to_string(kMaxPorts));
  }
}

void requireOneEach(const std::vector<std::string>& words, int ports, const char* what) {
  if (!words.empty() && words.size() != static_cast<std::size_t>(ports)) {
    throw Exception(std::string("JACK ") + what + ": " + std::to_string(words.size()) + " for " +
                    std::to_string(ports) + " ports, allowed: none or one each");
  }
}

void validate(const JackConfig& config) {
  requirePorts(config.inputs, "inputs");
  requirePorts(config.outputs, "outputs");
  requireOneEach(config.input_names, config.inputs, "names of inputs");
  requireOneEach(config.output_names, config.outputs, "names of outputs");
  requireOneEach(config.input_peers, config.inputs, "peers of inputs");
  requireOneEach(config.output_peers, config.outputs, "peers of outputs");
  if (config.name.empty() || config.name.size() > kMaxNameLength ||
      config.name.find(':') != std::string::npos) {
    throw Exception("JACK client name `" + config.name + "`, allowed: 1..." +
                    std::to_string(kMaxNameLength) + " characters, no colon");
  }
  const MidiSources checked(config.midi_connect);
}

}  // namespace

struct JackHost::Impl {
  Impl(const JackConfig& host_config, rt::AudioProcessor& audio_processor)
      : config(host_config), processor(audio_processor), sinks(host_config.output_peers) {
    supervisor = std::thread([this] { supervise(); });
  }
  ~Impl() {
    quit = true;
    wake->post();
    supervisor.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void supervise();
  void step();
  void start();
  void follow();
  void mendWires();
  void updateStatus();
  void say(const std::string& message);

  const JackConfig config;
  rt::AudioProcessor& processor;
  const ReservedSinks sinks;
  std::shared_ptr<Semaphore> wake = std::make_shared<Semaphore>();
  std::atomic<bool> quit{false};
  std::atomic<bool> drop{false};
  std::atomic<bool> look_asked{false};   // and not begun yet: looks do not pile up
  std::unique_ptr<JackSession> session;  // the supervisor's
  bool complained_of_wires = false;      // so is this
  mutable std::mutex mutex;              // of what follows
  JackStatus status;
  std::shared_ptr<const std::atomic<std::int64_t>> last_period_ns;
  std::thread supervisor;
};

void JackHost::Impl::supervise() {
  while (!quit) {
    look_asked = false;
    try {
      step();
    } catch (const std::exception& error) {
      session.reset();
      say(error.what());
      wake->forget();  // what the ended session posted
      look_asked = false;
    }
    updateStatus();
    if (!quit) {
      wake->waitFor(kRetryNs);
    }
  }
  session.reset();
}

/// Looks at the server once. An exception ends the session; the next look tries again.
void JackHost::Impl::step() {
  const bool dropped = drop.exchange(false);
  if (!session) {
    start();
  } else if (dropped) {
    throw DeviceError("the JACK client was ended on purpose; it comes back");
  } else if (session->isLost()) {
    throw DeviceError("the JACK server went away; waiting for it to come back");
  } else if (session->takeChange()) {
    follow();
  }
  mendWires();
  session->connectMidi();
}

void JackHost::Impl::start() {
  session = std::make_unique<JackSession>(config.server, config.name, wake);
  session->activate(config, processor);
  follow();
  if (config.connect) {
    try {
      session->connectToPlayback();
    } catch (const DeviceError& error) {
      say(error.what());  // it can still be connected by hand
    }
  }
}

/// Begins anew with the period that the server has now, or waits while it freewheels.
void JackHost::Impl::follow() {
  session->pause();
  if (session->isFreewheeling()) {
    say("the JACK server freewheels; silent until it is back in real time");
    return;
  }
  session->resume();
  say("");
  const std::lock_guard<std::mutex> lock(mutex);
  ++status.starts;
}

/// A peer that is not there yet, or not any more, ends nothing.
void JackHost::Impl::mendWires() {
  try {
    session->mendWires();
    if (complained_of_wires) {
      complained_of_wires = false;
      say("");
    }
  } catch (const DeviceError& error) {
    complained_of_wires = true;
    say(error.what());
  }
}

void JackHost::Impl::updateStatus() {
  const std::lock_guard<std::mutex> lock(mutex);
  ++status.looks;
  status.running = session && session->isFlowing();
  last_period_ns = session ? session->lastPeriodNs() : nullptr;
  status.freewheeling = session && session->isFreewheeling();
  status.client = session ? session->clientName() : "";
  status.wired = session && session->isWired();
  if (session) {
    // In this order: JACK tells everybody of inputs before it tells anybody of outputs.
    status.output_latency_frames = session->outputLatency();
    status.input_latency_frames = session->inputLatency();
    status.xruns += session->takeXruns();
    status.sample_rate_hz = session->sampleRate();
    status.period_frames = session->periodFrames();
  }
}

void JackHost::Impl::say(const std::string& message) {
  const std::lock_guard<std::mutex> lock(mutex);
  status.message = message;
}

JackHost::JackHost(const JackConfig& config, rt::AudioProcessor& processor) {
  validate(config);
  impl_ = std::make_unique<Impl>(config, processor);
}

JackHost::~JackHost() = default;

JackStatus JackHost::status() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  JackStatus status = impl_->status;
  // Not the supervisor's to see: what it asks of a stopped server is not answered.
  if (status.running && rt::monotonicNs() - *impl_->last_period_ns > kStillNs) {
    status.running = false;
    status.message = "the JACK server stands still: it is stopped, or too busy";
  }
  return status;
}

void JackHost::look() {
  if (!impl_->look_asked.exchange(true)) {
    impl_->wake->post();
  }
}

void JackHost::drop() {
  impl_->drop = true;
  look();
}

}  // namespace ergotic::audio
