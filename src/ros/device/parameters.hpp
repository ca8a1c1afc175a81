// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/messages.hpp"
#include "ergotic/tgr/device.hpp"
#include "ergotic/tgr/safety_chain.hpp"

/// The room `ros`. Its namespace is `node`, for generated messages live in `ergotic` and mean
/// `::ros` when they say `ros`.
namespace ergotic::node {

enum class Realtime {
  kTry,      ///< warn where it is not permitted
  kRequire,  ///< refuse to play where it is not permitted
  kOff,
};

/// Devices at which program changes by MIDI play other models.
enum class MidiPrograms {
  kSimulated,  ///< only devices that are simulated
  kAlways,
  kNever,
};

/// Private parameters of the nodelet, read once; docs/ros.md describes them in more detail.
struct Parameters {
  std::string model;                  ///< path of a scene, or its YAML text; empty: wait for one
  std::string device;                 ///< devices: path of a file, or its YAML text; empty: one,
                                      ///< made of the next three
  std::string driver = "virtual";     ///< name, see DriverPlugins
  std::string driver_settings;        ///< YAML map, of that driver; empty: none
  std::string gesture;                ///< CSV that the virtual hand follows; empty: none
  std::string virtual_shared_memory;  ///< segment of a `virtual_tgr`; empty: device inside
  double audio_rate = 44100.0;        ///< Hz, without a JACK server
  double gestural_rate = 0.0;         ///< Hz; 0: as the model wishes
  std::string end_effectors;          ///< path or YAML text; empty: as the device file says
  physics::CompileOptions compile;    ///< precision, isa, threads, energies (metered)
  bool jack = true;                   ///< false: no sound card, ticks follow the system clock
  std::string jack_name = "ergotic";  ///< name of the JACK client
  double jack_wait = 2.0;             ///< s, for a server to appear before the first model plays
  bool jack_connect = true;           ///< out_i to the i-th physical playback port
  std::string midi_connect = "physical";  ///< see audio::JackConfig
  MidiPrograms midi_programs = MidiPrograms::kSimulated;
  bool gamepads = true;  ///< those at /dev/input play; read when the node starts
  int ring_depth = 768;  ///< audio frames from a tick's due time to its sound
  bool limiter = true;   ///< keeps the sound below full scale
  tgr::SafetyConfig safety;
  std::optional<double> max_stall;  ///< s, longer stalls are a fault; none: see withStallLimits
  std::optional<int> max_stalls;    ///< in a second of force, more are a fault; none: the same
  std::optional<double> watchdog;   ///< s without a tick after which the device is made safe
  bool presence = false;            ///< force needs messages of the presence switch
  bool require_master = true;       ///< force needs a ROS master that knows the station
  bool allow_fault_injection = false;
  int priority = 75;  ///< SCHED_FIFO priority of the tick
  int cpu = -1;       ///< processor of the tick, -1: any
  Realtime realtime = Realtime::kTry;
  bool allow_unproven = false;  ///< play what the certificate cannot prove to be stable
  double max_load = 0.8;        ///< share of a tick's time that the model may need at best
  bool autoengage = false;      ///< engage once the first model plays
  station::SwapForce force_after_swap = station::SwapForce::kCaller;
  bool allow_remote = false;   ///< other hosts may call; read when the node starts
  std::string tf_prefix;       ///< prefix of all frames, empty: none; read when the node starts
  double display_rate = 30.0;  ///< Hz, of model_state and markers
  double display_zoom = 5.0;   ///< magnification of x in markers, about x = 0
};

/// \param node  private
/// \throws Exception naming parameter, value and allowed range; also for an unknown parameter
Parameters readParameters(const ::ros::NodeHandle& node);
/// The same.
/// \param values  a map of them; invalid: there are none
/// \param node    its name, for messages
Parameters readParameters(const XmlRpc::XmlRpcValue& values, const std::string& node);

/// Parameters that are read when the node starts, before a model is loaded.
struct EarlyParameters {
  bool allow_remote = false;
  Realtime realtime = Realtime::kTry;
  int priority = 75;
  bool gamepads = true;
  std::string tf_prefix;
  std::vector<std::string> refusals;  ///< errors of parameters that keep their default
};
EarlyParameters readEarlyParameters(const ::ros::NodeHandle& node);
EarlyParameters readEarlyParameters(const XmlRpc::XmlRpcValue& values, const std::string& node);

/// Sets limits for stalls that were not given. A hand gets a kick when force goes and comes back:
/// 50 ms, 3 in a second, a watchdog of 20 ms. At a device that is only simulated stalls are counted
/// and shown, and force stays: 1 s, 1,000,000 in a second, 1 s.
/// \param can_hurt  see tgr::Driver::canHurt
Parameters withStallLimits(Parameters parameters, bool can_hurt);

/// Reads the devices and end-effectors, as `device`, `end_effectors` and related parameters say.
/// \throws TextError with file:line:col, Exception if a file cannot be read
tgr::StationDevices readDevices(const Parameters& parameters);

/// \param path_or_text  YAML text, if it has more than one line; else a path
/// \throws TextError with file:line:col, Exception if the file cannot be read
tgr::EndEffectors readEndEffectors(const std::string& path_or_text);

/// Writes parameters as YAML, for recordings; `device` is the text of `devices`, whatever its
/// source.
std::string toYaml(const Parameters& parameters, const tgr::StationDevices& devices);

/// End-effectors at the start of a station, from the YAML text that toYaml wrote; none if the text
/// cannot be read.
tgr::EndEffectors recordedEndEffectors(const std::string& yaml);

/// Lists the parameters with other than default values, as `name: value` with commas between; "" if
/// there are none. Model and devices are not included.
std::string unusual(const Parameters& parameters);

}  // namespace ergotic::node
