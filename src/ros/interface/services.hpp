// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_srvs/Trigger.h>

#include <atomic>
#include <map>
#include <memory>

#include <ergotic/Calibrate.h>
#include <ergotic/ConfigureEndEffectors.h>
#include <ergotic/EndEffectors.h>
#include <ergotic/HandTargets.h>
#include <ergotic/HoldTarget.h>
#include <ergotic/InjectFault.h>
#include <ergotic/LearnController.h>
#include <ergotic/LoadModel.h>
#include <ergotic/Note.h>
#include <ergotic/ParameterValue.h>
#include <ergotic/PlayMap.h>
#include <ergotic/Preset.h>
#include <ergotic/SetParameter.h>
#include <ergotic/Tap.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>

#include "gamepads/gamepad_watch.hpp"
#include "ros/interface/arrivals.hpp"
#include "ros/interface/command_thread.hpp"
#include "ros/interface/description.hpp"
#include "ros/interface/loader.hpp"
#include "ros/interface/presence_owner.hpp"
#include "ros/interface/preset_keeper.hpp"
#include "ros/interface/urgent_spinner.hpp"

namespace ergotic::node {

/// Services and subscribers of the station. Most calls come through the queue of `node`, which
/// notes their arrival. Calls that load a model have a queue and a thread of their own, one at a
/// time; so have those that take force away, and the presence switch: nothing may delay them. The
/// moves of players' hands, and MIDI, have a thread of their own, so that they keep their distances
/// in time, and so have gamepads.
class Services {
 public:
  Services(const ::ros::NodeHandle& node, CommandThread& command_thread);
  ~Services();
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

 private:
  using Trigger = std_srvs::Trigger;
  template <class Service>
  using Call = ::ros::ServiceEvent<typename Service::Request, typename Service::Response>;

  bool onLoadModel(Call<LoadModel>& call);
  bool onReload(Call<Trigger>& call);
  void onModel(const ::ros::MessageEvent<const std_msgs::String>& model);
  bool onEngage(Call<Trigger>& call);
  bool onStop(Trigger::Request& request, Trigger::Response& response);
  bool onSetParameter(SetParameter::Request& request, SetParameter::Response& response);
  void onParameter(const ParameterValue& parameter);
  void onHandTargets(const ::ros::MessageEvent<const HandTargets>& targets);
  void onHoldTarget(const ::ros::MessageEvent<const HoldTarget>& target);
  void complainAtTimes(const std::string& whose, const std::string& refusal);
  void onNote(const Note& note);
  void onTap(const Tap& tap);
  void releaseNotes();
  void onVolume(const std_msgs::Float64& volume);
  bool onTake(Take::Request& request, Take::Response& response);
  bool onPreset(Preset::Request& request, Preset::Response& response);
  bool onPlayMap(PlayMap::Request& request, PlayMap::Response& response);
  bool onLearnController(LearnController::Request& request, LearnController::Response& response);
  void playMidi();
  Answer configure(const std::vector<EndEffector>& end_effectors);
  bool onRecover(Call<Trigger>& call);
  bool onConfigure(ConfigureEndEffectors::Request& request,
                   ConfigureEndEffectors::Response& response);
  void onEndEffectors(const EndEffectors& end_effectors);
  bool onCalibrate(Calibrate::Request& request, Calibrate::Response& response);
  bool onInjectFault(InjectFault::Request& request, InjectFault::Response& response);
  bool onEmergencyStop(Trigger::Request& request, Trigger::Response& response);
  void onEmergencyTopic(const std_msgs::Empty& stop);
  void onPresence(const ::ros::MessageEvent<const std_msgs::Bool>& present);
  void followShutdown();
  gamepads::GamepadListener gamepadListener();

  static constexpr int kNoProgram = -1;

  CommandThread& command_thread_;
  PresenceOwner presence_owner_;
  Description description_;
  Loader loader_;
  PresetKeeper presets_;
  ArrivalQueue queue_;  // in front of the usual one
  ::ros::NodeHandle node_;
  std::atomic<int> configurations_{0};  // that are being read
  // Of the thread of hands:
  std::int64_t complained_ns_ = 0;
  std::map<int, std::int64_t> held_notes_;  // until when they count, unless they are held longer
  std::atomic<int> program_{kNoProgram};    // that shall be loaded, by MIDI
  ::ros::CallbackQueue loading_queue_;
  ::ros::NodeHandle loading_node_;
  ::ros::AsyncSpinner loading_spinner_;
  ::ros::CallbackQueue hands_queue_;
  ::ros::NodeHandle hands_node_;
  ::ros::CallbackQueue safety_queue_;
  ::ros::NodeHandle safety_node_;
  ::ros::WallTimer first_load_;
  std::vector<::ros::ServiceServer> servers_;
  std::vector<::ros::Subscriber> subscribers_;
  bool is_shut_down_ = false;  // ROS is, and force is gone for it; of the spinner's thread
  // These end first. Who reads sockets is as urgent as the first of them.
  UrgentSpinner safety_spinner_;
  UrgentSpinner hands_spinner_;
  std::unique_ptr<gamepads::GamepadWatch> gamepads_;  // none if the station has no use for them
};

}  // namespace ergotic::node
