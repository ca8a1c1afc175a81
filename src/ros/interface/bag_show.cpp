// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/bag_show.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <ergotic/Handles.h>
#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "files/printable.hpp"
#include "ros/device/parameters.hpp"
#include "ros/display/handles.hpp"
#include "ros/interface/convert.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kLookForOnlookersNs = 50'000'000;
constexpr std::int64_t kBetweenShowsNs = 1'000'000'000;  // before it begins again
constexpr bool kShowIsLatched = true;

/// Accepts every model: a model that has been played may be shown, whatever its certificate.
station::PerformerPolicy policyOfShows() {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  policy.allow_unstable = true;
  return policy;
}

}  // namespace

BagShow::BagShow(const ::ros::NodeHandle& node, const Settings& settings)
    : settings_(settings),
      names_(settings.tf_prefix),
      node_(node),
      status_topic_(node_.advertise<Status>("status", 1, kShowIsLatched)),
      handles_(node_.advertise<Handles>("handles", 1, kShowIsLatched)),
      description_(node),
      display_(node, names_) {
  static_transforms_.sendTransform(modelFrame(names_, ::ros::Time::now()));
  thread_ = std::thread([this] { run(); });
}

BagShow::~BagShow() {
  {
    const std::lock_guard lock(mutex_);
    quits_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

/// \return false if it shall end
bool BagShow::sleepUntilNs(std::int64_t time_ns) {
  std::unique_lock lock(mutex_);
  const std::chrono::nanoseconds left(time_ns - rt::monotonicNs());
  return !woken_.wait_for(lock, left, [this] { return quits_; });
}

void BagShow::run() {
  try {
    do {
      playOnce();
    } while (settings_.loop && sleepUntilNs(rt::monotonicNs() + kBetweenShowsNs));
  } catch (const std::exception& failure) {
    status_.message = files::printableLines(failure.what());
    ROS_ERROR_STREAM(status_.message);
    status_topic_.publish(status_);
  }
}

void BagShow::playOnce() {
  bag::Recording recording = bag::readRecording(settings_.bag, settings_.station);
  end_effectors_ = recordedEndEffectors(recording.keyframes.front().station_config);
  replay::Replay replay(std::move(recording), policyOfShows());
  length_s_ = static_cast<double>(replay.ticksLeft()) / replay.rates().gesturalHz();
  showDevice(static_cast<int>(replay.slices().size()));
  showModel(replay.instrument());
  tell(0.0);
  if (waitForOnlookers()) {
    play(replay);
  }
  for (const std::string& flaw : replay.flaws()) {
    ROS_WARN_STREAM(settings_.bag << ": " << flaw);
  }
}

/// \return false if it shall end
bool BagShow::waitForOnlookers() {
  while (!display_.isWatched()) {
    if (!sleepUntilNs(rt::monotonicNs() + kLookForOnlookersNs)) {
      return false;
    }
  }
  return true;
}

void BagShow::play(replay::Replay& replay) {
  const double tick_s = 1.0 / replay.rates().gesturalHz();
  std::vector<double> frames(static_cast<std::size_t>(replay.rates().ratio) *
                             static_cast<std::size_t>(replay.outputChannels()));
  const std::int64_t start_ns = rt::monotonicNs();
  const physics::Instrument* shown = &replay.instrument();
  double told_s = 0.0;
  for (std::int64_t tick = 1; replay.next(frames.data()); ++tick) {
    if (shown != &replay.instrument()) {
      shown = &replay.instrument();
      showModel(*shown);
    }
    const station::MotionFrame* const motion = replay.motion();
    if (motion == nullptr) {
      continue;
    }
    const double now_s = static_cast<double>(tick) * tick_s;
    if (!sleepUntilNs(start_ns + std::llround(1e9 * now_s))) {
      return;
    }
    display_.show(*motion);
    showSlices(replay.slices());
    if (now_s > told_s + 1.0) {
      told_s = now_s;
      tell(now_s);
    }
  }
  tell(length_s_);
}

void BagShow::showModel(const physics::Instrument& instrument) {
  status_.model = instrument.scene().name;
  display_.show(toPicture(instrument, settings_.display_zoom));
  Handles handles = handlesOf(instrument.scene(), end_effectors_);
  handles.header.stamp = ::ros::Time::now();
  handles.header.frame_id = names_("model");
  handles.display_zoom = settings_.display_zoom;
  handles_.publish(handles);
}

void BagShow::showDevice(int slices) {
  status_.slices = static_cast<std::uint32_t>(slices);
  slice_frames_ = SliceFrames(slices, names_);
  frames_ = EndEffectorFrames(end_effectors_, names_);
  display_.show(end_effectors_);
  description_.show(end_effectors_, slices);
}

void BagShow::showSlices(const std::vector<double>& positions) {
  station::Snapshot snapshot;
  snapshot.slices = static_cast<int>(positions.size());
  std::copy(positions.begin(), positions.end(), snapshot.slice_position.begin());
  const ::ros::Time now = ::ros::Time::now();
  transforms_.sendTransform(slice_frames_.at(snapshot, now));
  if (const auto& transforms = frames_.at(snapshot, now); !transforms.empty()) {
    transforms_.sendTransform(transforms);
  }
}

void BagShow::tell(double seconds) {
  status_.header.stamp = ::ros::Time::now();
  status_.state_text = "a recording is shown";
  status_.message = "shows " + files::printableLines(settings_.bag) + ", " +
                    std::to_string(std::lround(seconds)) + " of " +
                    std::to_string(std::lround(length_s_)) + " s";
  status_topic_.publish(status_);
}

}  // namespace ergotic::node
