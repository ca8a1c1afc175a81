// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/publishers.hpp"

#include <algorithm>
#include <utility>

#include "ergotic/rt/build_id.hpp"
#include "ergotic/rt/clock.hpp"
#include "ros/device/end_effectors.hpp"

namespace ergotic::node {
namespace {

constexpr std::uint32_t kQueue = 100;
// A second of blocks at the highest rate: a recorder that is late loses nothing.
constexpr std::uint32_t kGestureQueue = 1000;
constexpr std::uint32_t kEventQueue = 10000;
constexpr std::int64_t kStatusPeriodNs = 1'000'000'000;
constexpr std::int64_t kCutsPeriodNs = 1'000'000'000;
constexpr bool kLatched = true;

}  // namespace

Publishers::Publishers(const ::ros::NodeHandle& node, const std::string& tf_prefix)
    : node_(node), names_(tf_prefix), display_(node, names_) {
  joint_states_ = node_.advertise<sensor_msgs::JointState>("joint_states", kQueue);
  levels_ = node_.advertise<Levels>("levels", 1);
  scope_ = node_.advertise<Scope>("scope", 1);
  handles_ = node_.advertise<Handles>("handles", 1, kLatched);
  holds_ = node_.advertise<Hold>("holds", kEventQueue);
  keyframe_ = node_.advertise<Keyframe>("keyframe", kQueue, kLatched);
  events_ = node_.advertise<Event>("events", kEventQueue);
  status_topic_ = node_.advertise<Status>("status", 1, kLatched);
  model_parameters_ = node_.advertise<ParametersMessage>("model_parameters", 1, kLatched);
  cuts_topic_ = node_.advertise<Cuts>("cuts", 1, kLatched);
  gesture_ = node_.advertise<GestureBlock>(
      "gesture", kGestureQueue,
      [this](const ::ros::SingleSubscriberPublisher& /*peer*/) { new_listener_ = true; });
  static_transforms_.sendTransform(modelFrame(names_, ::ros::Time::now()));
  showSilence("no model yet");
  sendCuts({});
}

template <class Message>
void Publishers::tell(::ros::Publisher& topic, const Message& message) {
  topic.publish(message);
  if (take_) {
    take_->write(topic.getTopic(), message);
  }
}

void Publishers::record(std::shared_ptr<TakeWriter> take) {
  take_ = std::move(take);
  if (take_) {
    sendStatus();
    sendParameters();
  }
}

void Publishers::configure(const Parameters& parameters, const Hands& hands) {
  station_config_ = toYaml(parameters, hands.config());
  motion_period_ns_ = static_cast<std::int64_t>(1e9 / parameters.display_rate);
  display_zoom_ = parameters.display_zoom;
  status_.devices.clear();
  for (const tgr::DeviceConfig& device : hands.config().devices) {
    status_.devices.push_back(device.driver);
  }
  status_.slices = static_cast<std::uint32_t>(hands.slices());
  slice_frames_ = SliceFrames(hands.slices(), names_);
  status_.delay_ticks = hands.traits().delay_ticks;
  if (parameters.compile.metered) {
    model_energy_ = node_.advertise<ModelEnergy>("model_energy", kQueue);
  }
  blocks_.reset();
}

void Publishers::show(const tgr::EndEffectors& end_effectors) {
  frames_ = EndEffectorFrames(end_effectors, names_);
  status_.end_effectors = toMessages(end_effectors);
  display_.show(end_effectors);
  sendStatus();
}

void Publishers::showModel(const station::Performer& performer,
                           std::shared_ptr<Picture> picture,
                           const std::string& note,
                           const std::vector<double>& parameters) {
  const physics::Instrument& instrument = *performer.instrument;
  fillStatus(instrument, status_);
  status_.verdict = physics::toString(performer.certificate.verdict);
  status_.message = note;
  status_.guard_warning.clear();
  cuts_due_ns_ = 0;  // those of the model before are none of this one
  note_ = note;
  sendStatus();
  parameters_ = toParameters(instrument.scene(), parameters);
  sendParameters();

  display_.show(std::move(picture));
  if (!blocks_) {  // rates hold until the next `configure`
    blocks_.emplace(instrument.rates().gesturalHz());
  }
}

void Publishers::showHandles(Handles handles) {
  handles.header.stamp = ::ros::Time::now();
  handles.header.frame_id = names_("model");
  handles.display_zoom = display_zoom_;
  handles_.publish(handles);
}

void Publishers::show(Levels levels) {
  levels.header.stamp = ::ros::Time::now();
  levels_.publish(levels);
}

void Publishers::show(Scope scope) {
  scope.header.stamp = ::ros::Time::now();
  scope_.publish(scope);
}

void Publishers::showSilence(const std::string& message) {
  status_.state = Status::DISCONNECTED;
  status_.state_text = station::toString(station::ForceState::kDisconnected);
  status_.audio_running = 0U;
  status_.message = message;
  note_ = message;
  display_.show(std::shared_ptr<Picture>());
  sendStatus();
  parameters_ = {};
  sendParameters();
}

void Publishers::addMessage(const std::string& line) {
  status_.message = note_ + (note_.empty() ? "" : "\n") + line;
  sendStatus();
}

Event Publishers::show(const station::Event& event, const scene::Scene* scene) {
  Event message = toEvent(event, scene);
  message.stamp = ::ros::Time::now();
  tell(events_, message);
  return message;
}

void Publishers::showHold(const station::Event& event, const scene::Scene& scene) {
  Hold message = toHold(event, scene);
  message.stamp = ::ros::Time::now();
  tell(holds_, message);
}

void Publishers::show(const station::GestureTick* ticks, std::size_t count) {
  if (count == 0 || !blocks_) {
    return;
  }
  const ::ros::Time now = ::ros::Time::now();
  const std::int64_t newest = ticks[count - 1].tick;
  for (std::size_t i = 0; i < count; ++i) {
    if (auto block = blocks_->add(ticks[i])) {
      const auto age = static_cast<double>(newest - block->first_tick);
      const ::ros::Duration ago(age / block->tick_rate_hz);
      // A clock that is simulated may stand at its beginning.
      block->header.frame_id = names_("tgr_base");
      block->header.stamp = now.toSec() > ago.toSec() ? now - ago : ::ros::Time();
      tell(gesture_, *block);
    }
  }
}

void Publishers::show(const station::Snapshot& snapshot, std::uint64_t uncalibrated) {
  const ::ros::Time now = ::ros::Time::now();
  sensor_msgs::JointState joints = toJointState(snapshot);
  joints.header.frame_id = names_("tgr_base");
  joints.header.stamp = now;
  joint_states_.publish(joints);
  transforms_.sendTransform(slice_frames_.at(snapshot, now));
  if (const auto& transforms = frames_.at(snapshot, now); !transforms.empty()) {
    transforms_.sendTransform(transforms);
  }

  const Status before = status_;
  fillStatus(snapshot, status_);
  fillStatus(uncalibrated, status_);
  if (before.state != status_.state || before.fault != status_.fault ||
      before.audio_running != status_.audio_running ||
      before.uncalibrated != status_.uncalibrated) {
    sendStatus();
  }
}

void Publishers::showStandstill() {
  if (status_.state != Status::FAULT) {
    fillStatus(station::ForceState::kFault, tgr::FaultReason::kWatchdog, status_);
    sendStatus();
  }
}

void Publishers::show(const station::MotionFrame& motion, const scene::Scene& scene) {
  const std::int64_t now_ns = rt::monotonicNs();  // ROS time may jump
  if (now_ns < motion_due_ns_) {
    return;
  }
  motion_due_ns_ = std::max(motion_due_ns_ + motion_period_ns_, now_ns);
  watch(motion, scene);
  if (now_ns >= cuts_due_ns_) {
    showCuts(toCuts(motion, scene));
  }
  display_.show(motion);
  if (model_energy_.getNumSubscribers() > 0) {
    ModelEnergy message = toModelEnergy(motion);
    message.header.stamp = ::ros::Time::now();
    model_energy_.publish(message);
  }
}

/// A link that begins to be cut too often is news, once.
void Publishers::watch(const station::MotionFrame& motion, const scene::Scene& scene) {
  const bool known = !status_.guard_warning.empty();
  fillStatus(motion, scene, status_);
  if (!known && !status_.guard_warning.empty()) {
    addMessage(status_.guard_warning);
  }
}

void Publishers::show(const station::Keyframe& keyframe, const physics::Instrument& instrument) {
  Keyframe message = toKeyframe(keyframe, instrument, status_.slices);
  message.header.stamp = ::ros::Time::now();
  message.build = std::string(ERGOTIC_VERSION " ") + rt::buildId();
  message.station_config = station_config_;
  tell(keyframe_, message);
}

void Publishers::showParameter(std::int64_t index, double value) {
  const auto at = static_cast<std::size_t>(index);
  if (at < parameters_.values.size()) {
    parameters_.values[at] = value;
    parameters_changed_ = true;
  }
}

void Publishers::refresh() {
  const std::int64_t now_ns = rt::monotonicNs();
  if (now_ns >= status_due_ns_) {
    sendStatus();
  }
  if (parameters_changed_ && now_ns >= parameters_due_ns_) {
    sendParameters();
  }
}

void Publishers::sendParameters() {
  parameters_changed_ = false;
  parameters_due_ns_ = rt::monotonicNs() + motion_period_ns_;
  parameters_.header.stamp = ::ros::Time::now();
  tell(model_parameters_, parameters_);
}

/// Sends cuts if they are others than before.
void Publishers::showCuts(Cuts cuts) {
  cuts_due_ns_ = rt::monotonicNs() + kCutsPeriodNs;  // a model may have very many links to look at
  if (cuts.links == cuts_.links && cuts.active == cuts_.active && cuts.cut == cuts_.cut) {
    return;
  }
  sendCuts(std::move(cuts));
}

void Publishers::sendCuts(Cuts cuts) {
  cuts_ = std::move(cuts);
  cuts_.header.stamp = ::ros::Time::now();
  cuts_topic_.publish(cuts_);
}

void Publishers::sendStatus() {
  status_due_ns_ = rt::monotonicNs() + kStatusPeriodNs;
  status_.header.stamp = ::ros::Time::now();
  tell(status_topic_, status_);
}

}  // namespace ergotic::node
