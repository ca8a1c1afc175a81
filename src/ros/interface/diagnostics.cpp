// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/diagnostics.hpp"

#include "ergotic/rt/clock.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000'000;
constexpr double kHighLoad = 0.8;

using Level = diagnostic_msgs::DiagnosticStatus;

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

Diagnostics::Diagnostics(const ::ros::NodeHandle& node,
                         const ::ros::NodeHandle& private_node,
                         const std::string& name)
    : updater_(node, private_node, name) {
  updater_.setHardwareID("tgr");
  updater_.add("force", this, &Diagnostics::reportForce);
  updater_.add("real time", this, &Diagnostics::reportRealtime);
  updater_.add("sound", this, &Diagnostics::reportSound);
  updater_.add("model", this, &Diagnostics::reportModel);
}

bool Diagnostics::isDue(const Status& status) {
  const std::int64_t now_ns = rt::monotonicNs();
  if (now_ns < due_ns_ && status.state == status_.state) {
    return false;
  }
  due_ns_ = now_ns + kPeriodNs;
  return true;
}

void Diagnostics::refresh(const Status& status, const Engine* engine) {
  if (!isDue(status)) {
    return;
  }
  last_ = status_;
  status_ = status;
  jack_ = engine != nullptr ? engine->jackStatus() : std::nullopt;
  limited_before_ = loudness_.limited_frames;
  loudness_ = engine != nullptr ? engine->loudness() : station::Loudness{};
  watchdog_ = engine != nullptr ? engine->watchdogReading() : tgr::WatchdogReading{};
  updater_.force_update();
}

void Diagnostics::reportForce(Report& report) {
  switch (status_.state) {
    case Status::FAULT:
      report.summary(Level::ERROR, status_.state_text);
      break;
    case Status::DISCONNECTED:
      report.summary(Level::ERROR, status_.message);
      break;
    case Status::UNCALIBRATED:
      report.summary(Level::WARN, status_.state_text);
      break;
    default:
      report.summary(Level::OK, status_.state_text);
  }
  for (const std::string& device : status_.devices) {
    report.add("device", device);
  }
  report.add("slices", status_.slices);
  report.add("delay (ticks)", status_.delay_ticks);
  report.add("slices without calibration", status_.uncalibrated.size());
  for (const EndEffector& end_effector : status_.end_effectors) {
    report.add("end-effector", end_effector.name);
  }
  report.add("peak force (N)", status_.peak_force);
  report.add("peak force that the model asked for (N)", status_.peak_raw_force);
  report.add(
      "least energy left at the port of a slice (J; below 0: the hand got more than it gave)",
      status_.port_energy_min);
  report.add("ticks in which the energy clamp acted", status_.clamped_ticks);
  report.add("ticks in which a still sensor muted its slice", status_.muted_ticks);
}

void Diagnostics::reportRealtime(Report& report) {
  const auto late = [](const Status& s) { return s.late_wake_up + s.late_device + s.late_compute; };
  if (status_.stalls > last_.stalls || status_.lost_ticks > last_.lost_ticks) {
    report.summary(Level::WARN, "ticks had to be caught up in the last second");
  } else if (late(status_) > late(last_)) {
    report.summary(Level::WARN, "late ticks in the last second");
  } else if (status_.load_mean > kHighLoad) {
    report.summary(Level::WARN,
                   "the model needs more than 80 % of each tick: make it smaller, use more threads "
                   "or lower its rates");
  } else {
    report.summary(Level::OK, "on time");
  }
  report.add("gestural rate (Hz)", status_.gestural_rate);
  report.add("ticks", status_.ticks);
  report.add("late: woken late", status_.late_wake_up);
  report.add("latest wake-up (s)", status_.late_worst);
  report.add("late: slow device", status_.late_device);
  report.add("late: long computation", status_.late_compute);
  report.add("stalls", status_.stalls);
  report.add("ticks caught up", status_.catch_up_ticks);
  report.add("ticks lost", status_.lost_ticks);
  report.add("records dropped", status_.dropped_records);
  report.add("load, mean", status_.load_mean);
  report.add("load, peak", status_.load_peak);
  report.add("watchdog: times it acted", watchdog_.bites);
  report.add("watchdog: silence when it acted last (s)", seconds(watchdog_.silence_ns));
  report.add("stalls of the whole machine", watchdog_.machine_stalls);
  report.add("longest of these (s)", seconds(watchdog_.longest_stall_ns));
}

void Diagnostics::reportSound(Report& report) {
  if (!jack_) {
    report.summary(Level::OK, "no sound: no JACK client");
  } else if (!jack_->message.empty()) {
    report.summary(Level::WARN, jack_->message);
  } else if (!jack_->running) {
    report.summary(Level::WARN, "no JACK server");
  } else if (status_.underrun_frames > last_.underrun_frames || status_.xruns > last_.xruns) {
    report.summary(Level::WARN, "sound was interrupted in the last second");
  } else if (loudness_.limited_frames > limited_before_) {
    report.summary(Level::WARN, "the sound is too loud, and the limiter turns it down");
  } else if (status_.bad_input_samples > last_.bad_input_samples) {
    report.summary(Level::WARN, "an audio input gave samples that are no finite numbers");
  } else {
    report.summary(Level::OK, "playing");
  }
  report.add("audio rate (Hz)", status_.audio_rate);
  report.add("clock locked", status_.clock_locked != 0U);
  report.add("underruns", status_.underruns);
  report.add("frames of silence", status_.underrun_frames);
  report.add("xruns of JACK", status_.xruns);
  report.add("samples of inputs that were not finite", status_.bad_input_samples);
  report.add("largest sample (of full scale)", loudness_.peak);
  report.add("frames that the limiter turned down", loudness_.limited_frames);
  if (jack_) {
    report.add("JACK client", jack_->client);
    report.add("period (frames)", jack_->period_frames);
    report.add("starts", jack_->starts);
  }
}

void Diagnostics::reportModel(Report& report) {
  if (!status_.guard_warning.empty()) {
    report.summary(Level::WARN, status_.guard_warning);
  } else if (status_.model.empty()) {
    report.summary(Level::OK, "no model");
  } else {
    report.summary(Level::OK, status_.verdict);
  }
  report.add("model", status_.model);
  report.add("verdict", status_.verdict);
  report.add("precision", status_.precision);
  report.add("instruction set", status_.isa);
  report.add("threads", status_.threads);
  report.add("stored energy (J)", status_.stored_energy);
  if (status_.metered != 0U) {
    report.add("residual of the energy balance (share)", status_.energy_residual);
  }
}

}  // namespace ergotic::node
