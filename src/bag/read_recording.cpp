// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Hold.h>
#include <ergotic/Keyframe.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bag/message_bytes.hpp"
#include "bag/open_bag.hpp"
#include "bag/recorded_message.hpp"
#include "ergotic/exception.hpp"
#include "files/read_file.hpp"

namespace ergotic::bag {
namespace {

/// Name of a message for error texts, as `a.bag: the keyframe of tick 5`.
std::string named(const std::string& path, const char* kind, std::int64_t tick) {
  return path + ": the " + kind + " of tick " + std::to_string(tick);
}

std::string textOf(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// False for what is not a number, too.
void requireWithin(const std::string& message,
                   const std::string& what,
                   double value,
                   double lowest,
                   double highest) {
  if (!(value >= lowest && value <= highest)) {
    throw Exception(message + ": " + what + " is " + textOf(value) +
                    ", allowed: " + textOf(lowest) + "..." + textOf(highest));
  }
}

constexpr double kLastTick = 1e15;

void requireTick(const std::string& message, std::int64_t tick) {
  requireWithin(message, "its tick", static_cast<double>(tick), 0.0, kLastTick);
}

void requireFinite(const std::string& message,
                   const char* what,
                   const std::vector<double>& values,
                   std::size_t per_row) {
  const auto bad = std::find_if_not(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad != values.end()) {
    const auto index = static_cast<std::size_t>(bad - values.begin());
    throw Exception(message + ": " + what + ' ' + std::to_string(index % per_row) + " at its row " +
                    std::to_string(index / per_row) + " is " + textOf(*bad) +
                    ", allowed: finite numbers");
  }
}

void check(const ergotic::Keyframe& message, const std::string& path) {
  const std::string name = named(path, "keyframe", message.tick);
  requireTick(name, message.tick);
  requireWithin(name, "its number of threads", message.threads, 1, physics::kMaxThreads);
  requireWithin(name, "its audio rate (Hz)", message.audio_rate, 8000.0, 192000.0);
  requireWithin(name, "its number of frames per tick", message.ratio, 1, physics::kMaxRatio);
  requireWithin(name, "its number of slices", message.slices, 0, tgr::kMaxSlices);
  requireFinite(name, "parameter", message.parameter_values, message.parameter_values.size());
}

void check(const GestureBlock& message, const std::string& path) {
  const std::string name = named(path, "gesture block", message.first_tick);
  requireTick(name, message.first_tick);
  const auto requireRows = [&](const std::vector<double>& values, std::size_t per_row,
                               const char* of) {
    if (values.size() != std::size_t{message.ticks} * per_row) {
      throw Exception(name + " has " + std::to_string(values.size()) + " positions for " +
                      std::to_string(message.ticks) + " ticks of " + std::to_string(per_row) + of);
    }
  };
  requireRows(message.positions, message.slices, " slices");
  requireRows(message.port_positions, message.ports, " ports");
  if (message.flags.size() != message.ticks) {
    throw Exception(name + " has " + std::to_string(message.flags.size()) + " flags for " +
                    std::to_string(message.ticks) + " ticks");
  }
  requireFinite(name, "the position of slice", message.positions, message.slices);
  requireFinite(name, "the position of port", message.port_positions, message.ports);
}

void check(const ergotic::Event& message, const std::string& path) {
  const std::string name = named(path, "event", message.tick);
  requireTick(name, message.tick);
  requireWithin(name, "its index", static_cast<double>(message.index), -kLastTick, kLastTick);
  requireFinite(name, "value", {message.value}, 1);
}

void check(const ergotic::Hold& message, const std::string& path) {
  const std::string name = named(path, "hold", message.tick);
  constexpr double kMax = 1e12;
  requireTick(name, message.tick);
  requireWithin(name, "its hand", message.hand, 0, physics::kMaxTouches - 1);
  requireWithin(name, "its module", message.module, physics::Touch::kNothing, 1e9);
  requireWithin(name, "its ticks_left", message.ticks_left, 0, station::kMaxHoldTicks);
  requireWithin(name, "its stiffness", message.stiffness, 0.0, kMax);
  requireWithin(name, "its damping", message.damping, 0.0, kMax);
  requireWithin(name, "its most_force", message.most_force, 0.0, kMax);
  requireFinite(name, "coordinate", {message.at.begin(), message.at.end()}, message.at.size());
  requireFinite(name, "coordinate of the goal", {message.goal.begin(), message.goal.end()},
                message.goal.size());
}

Keyframe fromMessage(const ergotic::Keyframe& message, const std::string& path) {
  check(message, path);
  Keyframe keyframe;
  keyframe.tick = message.tick;
  keyframe.scene_name = message.scene_name;
  keyframe.scene_text = message.scene;
  keyframe.build = message.build;
  keyframe.station_config = message.station_config;
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
  check(message, path);
  return {message.first_tick,
          message.slices,
          message.ports,
          message.flags,
          message.positions,
          message.port_positions,
          0};
}

station::Event fromMessage(const ergotic::Event& message, const std::string& path) {
  check(message, path);
  station::Event event;
  event.type = static_cast<station::Event::Type>(message.type);
  event.tick = message.tick;
  event.frame = message.frame;
  event.index = message.index;
  event.value = message.value;
  return event;
}

station::Event fromMessage(const ergotic::Hold& message, const std::string& path) {
  check(message, path);
  station::Event event;
  event.type = station::Event::Type::kHold;
  event.tick = message.tick;
  event.index = message.hand;
  event.hold.mat = message.module;
  event.hold.takes_hold = message.takes_hold != 0U;
  std::copy(message.at.begin(), message.at.end(), event.hold.at.begin());
  std::copy(message.goal.begin(), message.goal.end(), event.hold.goal.begin());
  event.hold.ticks_left = message.ticks_left;
  event.hold.stiffness = message.stiffness;
  event.hold.damping = message.damping;
  event.hold.most_force = message.most_force;
  return event;
}

/// The message of this type in a recorded one, if it is one.
template <class T>
std::optional<T> as(RecordedMessage& message, const std::string& path) {
  if (message.type != ros::message_traits::DataType<T>::value()) {
    return std::nullopt;
  }
  if (message.md5 != ros::message_traits::MD5Sum<T>::value()) {
    throw Exception(path + ": " + message.type +
                    " was recorded with another definition of the message; play it with the "
                    "version of Ergotic that recorded it");
  }
  const auto size = static_cast<std::uint32_t>(message.data.size());
  message.data.resize(size + std::size_t{1});  // never nowhere
  MessageBytes bytes(message.data.data(), size);
  T read;
  try {
    bytes.next(read);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw Exception(path + ": a " + message.type + " in it is cut short");
  }
  return read;
}

/// Ticks that never ran are played, too.
void requireNoLongGap(const std::vector<Stretch>& stretches, const std::string& path) {
  constexpr double kLongestGap = 1e8;  // hours
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const auto gap = static_cast<double>(stretches[i].first_tick - stretches[i - 1].endTick());
    requireWithin(named(path, "gesture block", stretches[i].first_tick),
                  "the number of ticks between it and the one before", std::max(gap, 0.0), 0.0,
                  kLongestGap);
  }
}

RecordedMessage bytesOf(const rosbag::MessageInstance& message) {
  const std::uint32_t size = message.size();  // read from the file each time
  std::vector<std::uint8_t> data(size);
  ros::serialization::OStream out(data.data(), size);
  message.write(out);
  return {message.getDataType(), message.getMD5Sum(), std::move(data)};
}

/// Explains why a bag cannot be read, and names the command that makes it readable.
Exception unreadable(const std::string& path, const rosbag::BagException& error) {
  const std::string mend =
      ". `rosbag reindex " + path + "` keeps what is whole of it, if anything is";
  if (dynamic_cast<const rosbag::BagUnindexedException*>(&error) != nullptr) {
    return Exception(
        path + ": has no index, as if its recorder was killed before it closed the file" + mend);
  }
  if (dynamic_cast<const rosbag::BagIOException*>(&error) != nullptr) {
    return Exception(path + ": ends too soon, as if the disk was full (" + error.what() + ")" +
                     mend);
  }
  return Exception(path + ": is damaged or no bag of ROS 1 (" + error.what() + ")" + mend);
}

/// Positions of a recording in its bag.
struct Blocks {
  explicit Blocks(const std::string& path) : bag(openToRead(path)) {}

  /// Loads a stretch; refuses a file that was changed since it was read, or overwritten.
  void load(Stretch& stretch, const std::string& path) const {
    try {
      RecordedMessage message = bytesOf(messages[stretch.block]);
      std::optional<GestureBlock> block = as<GestureBlock>(message, path);
      Stretch whole = block ? fromMessage(*block, path) : Stretch();
      if (whole.first_tick != stretch.first_tick || whole.flags.size() != stretch.flags.size() ||
          whole.slices != stretch.slices || whole.ports != stretch.ports) {
        throw Exception(named(path, "gesture block", stretch.first_tick) +
                        " was changed while it is played");
      }
      stretch.positions = std::move(whole.positions);
      stretch.ports_at = std::move(whole.ports_at);
    } catch (const rosbag::BagException& error) {
      throw unreadable(path, error);
    }
  }

  BagPointer bag;
  std::vector<rosbag::MessageInstance> messages;
};

/// `station` of `/station/gesture`.
std::string stationOf(const rosbag::ConnectionInfo& connection) {
  const std::size_t first = connection.topic.find_first_not_of('/');
  const std::size_t last = connection.topic.rfind('/');
  return last == std::string::npos || first > last ? ""
                                                   : connection.topic.substr(first, last - first);
}

bool isOurs(const rosbag::ConnectionInfo& connection) {
  return connection.datatype.rfind("ergotic/", 0) == 0;
}

/// Filter for the messages of one station.
std::function<bool(const rosbag::ConnectionInfo*)> ofStation(const rosbag::Bag& bag,
                                                             const std::string& wanted,
                                                             const std::string& path) {
  std::set<std::string> stations;
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
    if (connection->datatype == ros::message_traits::DataType<GestureBlock>::value()) {
      stations.insert(stationOf(*connection));
    }
  }
  std::string list;
  for (const std::string& station : stations) {
    list += (list.empty() ? "/" : ", /") + station;
  }
  const std::string name = wanted.substr(std::min(wanted.find_first_not_of('/'), wanted.size()));
  if (wanted.empty() && stations.size() > 1) {
    throw Exception(path + ": gestures of several stations, say which: " + list);
  }
  if (!wanted.empty() && stations.count(name) == 0) {
    throw Exception(path + ": no gesture of a station " + wanted + " in this bag" +
                    (list.empty() ? "" : ", allowed: " + list));
  }
  if (stations.empty()) {
    return [](const rosbag::ConnectionInfo* connection) { return isOurs(*connection); };
  }
  const std::string station = wanted.empty() ? *stations.begin() : name;
  return [station](const rosbag::ConnectionInfo* connection) {
    return isOurs(*connection) && stationOf(*connection) == station;
  };
}

}  // namespace

void add(Recording& recording, RecordedMessage& message, const std::string& path) {
  if (const auto block = as<GestureBlock>(message, path)) {
    recording.stretches.push_back(fromMessage(*block, path));
  } else if (const auto keyframe = as<ergotic::Keyframe>(message, path)) {
    recording.keyframes.push_back(fromMessage(*keyframe, path));
  } else if (const auto told = as<ergotic::Event>(message, path)) {
    recording.events.push_back(fromMessage(*told, path));
  } else if (const auto hold = as<ergotic::Hold>(message, path)) {
    recording.events.push_back(fromMessage(*hold, path));
  }
}

void finish(Recording& recording, const std::string& path) {
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
  requireNoLongGap(recording.stretches, path);
}

Recording readRecording(const std::string& path, const std::string& station) {
  files::requireFile(path);
  Recording recording;
  try {
    const auto blocks = std::make_shared<Blocks>(path);
    rosbag::View view(*blocks->bag, ofStation(*blocks->bag, station, path));
    for (const rosbag::MessageInstance& instance : view) {
      RecordedMessage message = bytesOf(instance);
      const std::size_t before = recording.stretches.size();
      add(recording, message, path);
      if (recording.stretches.size() > before) {
        recording.stretches.back().block = blocks->messages.size();
        recording.stretches.back().forgetPositions();
        blocks->messages.push_back(instance);
      }
    }
    recording.load = [blocks, path](Stretch& stretch) { blocks->load(stretch, path); };
  } catch (const rosbag::BagException& error) {
    throw unreadable(path, error);
  }
  finish(recording, path);
  return recording;
}

}  // namespace ergotic::bag
