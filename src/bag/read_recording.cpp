// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "ergotic/bag/recording.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::bag {
namespace {

Keyframe fromMessage(const ergotic::Keyframe& message, const std::string& path) {
  if (message.threads < 1 || message.threads > physics::kMaxThreads) {
    throw Exception(path + ": the keyframe of tick " + std::to_string(message.tick) + " has " +
                    std::to_string(message.threads) + " threads, allowed: 1..." +
                    std::to_string(physics::kMaxThreads));
  }
  Keyframe keyframe;
  keyframe.tick = message.tick;
  keyframe.scene_name = message.scene_name;
  keyframe.scene_text = message.scene;
  keyframe.build = message.build;
  keyframe.rates = {message.audio_rate, static_cast<int>(message.ratio)};
  keyframe.precision = physics::precisionNamed(message.precision);
  keyframe.isa = message.isa;
  keyframe.threads = static_cast<int>(message.threads);
  keyframe.metered = message.metered != 0U;
  keyframe.slices = static_cast<int>(message.slices);
  keyframe.state = message.state;
  keyframe.parameters = message.parameter_values;
  return keyframe;
}

Stretch fromMessage(const GestureBlock& message, const std::string& path) {
  if (message.flags.size() != message.ticks ||
      message.positions.size() != std::size_t{message.ticks} * message.slices) {
    throw Exception(path + ": the gesture block of tick " + std::to_string(message.first_tick) +
                    " has " + std::to_string(message.positions.size()) + " positions for " +
                    std::to_string(message.ticks) + " ticks of " + std::to_string(message.slices) +
                    " slices");
  }
  if (message.port_positions.size() != std::size_t{message.ticks} * message.ports) {
    throw Exception(path + ": the gesture block of tick " + std::to_string(message.first_tick) +
                    " has " + std::to_string(message.port_positions.size()) + " positions for " +
                    std::to_string(message.ticks) + " ticks of " + std::to_string(message.ports) +
                    " ports");
  }
  return {message.first_tick, message.slices,    message.ports,
          message.flags,      message.positions, message.port_positions};
}

/// The message of this type in a recorded message, or null if it is another one.
template <class T>
boost::shared_ptr<T> as(const rosbag::MessageInstance& message, const std::string& path) {
  if (message.getDataType() != ros::message_traits::DataType<T>::value()) {
    return nullptr;
  }
  const auto read = message.instantiate<T>();
  if (read == nullptr) {
    throw Exception(path + ": " + message.getDataType() +
                    " was recorded with another definition of the message; play it with the "
                    "version of Ergotic that recorded it");
  }
  return read;
}

void add(Recording& recording, const rosbag::MessageInstance& message, const std::string& path) {
  if (const auto block = as<GestureBlock>(message, path)) {
    recording.stretches.push_back(fromMessage(*block, path));
  } else if (const auto keyframe = as<ergotic::Keyframe>(message, path)) {
    recording.keyframes.push_back(fromMessage(*keyframe, path));
  } else if (const auto told = as<ergotic::Event>(message, path)) {
    station::Event event;
    event.type = static_cast<station::Event::Type>(told->type);
    event.tick = told->tick;
    event.frame = told->frame;
    event.index = told->index;
    event.value = told->value;
    recording.events.push_back(event);
  }
}

void readAll(const rosbag::Bag& bag, const std::string& path, Recording& recording) {
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) {
    add(recording, message, path);
  }
}

}  // namespace

Recording readRecording(const std::string& path) {
  Recording recording;
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    readAll(bag, path, recording);
  } catch (const rosbag::BagException& error) {
    throw Exception(path + ": " + error.what());
  }
  if (recording.keyframes.empty() || recording.stretches.empty()) {
    throw Exception(path + ": no " + (recording.keyframes.empty() ? "keyframe" : "gesture") +
                    " of a station in this bag");
  }
  // Messages of different topics reach a recorder in any order.
  const auto by_tick = [](const auto& a, const auto& b) { return a.tick < b.tick; };
  std::stable_sort(recording.keyframes.begin(), recording.keyframes.end(), by_tick);
  std::stable_sort(recording.events.begin(), recording.events.end(), by_tick);
  std::stable_sort(recording.stretches.begin(), recording.stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.first_tick < b.first_tick; });
  return recording;
}

}  // namespace ergotic::bag
