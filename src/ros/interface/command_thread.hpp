// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <ergotic/Calibrate.h>
#include <ergotic/InjectFault.h>

#include "ros/interface/arrivals.hpp"
#include "ros/interface/diagnostics.hpp"
#include "ros/interface/station_controller.hpp"

namespace ergotic::node {

/// The one thread that speaks to the station: it carries requests in and news out.
///
/// ROS callbacks never touch the station; they hand a request over here and wait for its answer.
class CommandThread {
 public:
  CommandThread(const ::ros::NodeHandle& node,
                Publishers& feed,
                Diagnostics& diagnostics,
                const OwnHost& own_host);
  ~CommandThread();  ///< forces to zero, device closed
  CommandThread(const CommandThread&) = delete;
  CommandThread& operator=(const CommandThread&) = delete;

  // Thread: any, but never this thread itself. All wait for their answer, 5 s at most; what was
  // not begun by then never is, and they say so.

  // A picture is of the performer beside it, and not null.

  /// Takes over a running engine and the performer it was made with. A closed command thread
  /// destroys it.
  Answer begin(std::unique_ptr<Engine> engine,
               station::Performer* performer,
               const std::shared_ptr<Picture>& picture);
  /// Plays another model; answers when it plays.
  Answer swap(std::unique_ptr<station::Performer> performer, const StationController::Swap& with);
  /// Lets force ramp in; answers when it does, or why it may not. An answer that does not come
  /// withdraws the request, as `stop` would.
  Answer engage(const ForceRequest& request);
  /// Gets lost devices back and ends a fault; answers when it has ended. Force stays at zero.
  /// Withdrawn as `engage`.
  Answer recover(const ForceRequest& request);
  /// Answers when the tick plays with the new value.
  Answer setParameter(const std::string& name, double value);
  /// \throws Exception if nothing plays, or it does not answer
  ParametersNow parametersNow();
  /// As StationController::recall.
  Answer recall(const PresetValues& values, double seconds);
  Answer undo();
  /// Master volume of the sound at JACK, 0...1.
  Answer setVolume(double volume);
  /// Puts other end-effectors on the slices; answers when that is done, with force at zero.
  Answer configure(const tgr::EndEffectors& end_effectors);
  Calibrate::Response calibrate(const Calibrate::Request& request, const Arrival& arrival);
  Answer inject(const InjectFault::Request& request);
  /// Records the performance; a replay answers when its sound begins.
  Take::Response take(const Take::Request& request);

  /// Properties of the station that a new model must fit.
  struct Terms {
    physics::Rates rates;
    int slices = 0;
    physics::DeviceTraits device;
    tgr::EndEffectors end_effectors;
    Parameters parameters;
    bool can_hurt = true;    ///< see Hands
    std::string scene_file;  ///< scene of the model that plays
  };
  /// \return nothing if no engine runs
  /// \throws Exception if it does not answer
  std::optional<Terms> terms();

  // Thread: any. None of these waits.

  /// Publishes in the status why nothing plays. No effect while a model plays.
  void tell(const std::string& message);
  /// Force to zero at once, latched. \return false if there is no device
  bool makeSafe(tgr::FaultReason reason) { return controller_.makeSafe(reason); }
  /// Force to zero with the next tick, until an `engage` that is asked for later.
  void stop() { interlock_->stop(); }
  /// Sets a parameter soon: of several values for one name, the newest.
  /// \return false if too many names wait
  bool setParameterSoon(const std::string& name, double value);
  /// Tells of the presets, which are others now.
  void showPresets();
  /// Moves hands of a simulated device. \return what is wrong with it, or an empty text
  std::string hold(const HoldTarget& wanted, const std::string& sender) {
    return controller_.hold(wanted, sender);
  }
  void expireHolds() { controller_.expireHolds(); }
  std::string moveHands(const HandTargets& wanted, const std::string& sender) {
    return controller_.moveHands(wanted, sender);
  }
  /// Plays a note by the map of notes.
  void playNote(int note, int velocity) { controller_.playNote(note, velocity); }
  /// Plays the note that moves a hand. \return it, if there is one
  std::optional<int> tap(const std::string& end_effector, int index, int velocity) {
    return controller_.tap(end_effector, index, velocity);
  }
  /// Plays received MIDI messages. \return the program chosen last. Thread: one, any
  std::optional<int> playMidi();
  /// Plays an event of a gamepad. \param pad  number of the gamepad, 0 or more
  void playGamepad(int pad, const tgr::GamepadMove& move);
  /// Unplugs a gamepad; all that it holds is released.
  void unplugGamepad(int pad) { controller_.unplugGamepad(pad); }
  /// Binds the next control that a player moves to this parameter; empty: stops waiting.
  Answer learnControl(const std::string& parameter) { return controller_.learnControl(parameter); }
  /// \param map  map of notes, path or YAML text. \return an error, or an empty text
  std::string usePlayMap(const std::string& map) { return controller_.usePlayMap(map); }
  /// Owner of the state of force.
  const std::shared_ptr<station::Interlock>& interlock() const { return interlock_; }
  /// Reports whether the presence switch is held.
  void tellPresence(bool is_held) { controller_.tellPresence(is_held); }

  /// Sets forces to zero, closes the device, and accepts no engine any more; waits for it, 0.9 s at
  /// most.
  /// Thread: any
  void close();

 private:
  struct Task {
    std::function<void()> run;
    std::int64_t deadline_ns = 0;  ///< a later task is dropped; CLOCK_MONOTONIC
  };
  using Request = std::function<void(const Promise&)>;

  bool post(Task task);
  Answer ask(const Request& request);
  Answer ask(const Request& request, std::int64_t deadline_ns);
  Answer askForForce(const ForceRequest& request, const Request& ask_for);
  void run();
  void runTasks();
  void diagnose();
  void setParameters();
  void grant(const PlayersWishes& wishes);

  Publishers& publishers_;
  Diagnostics& diagnostics_;
  std::shared_ptr<station::Interlock> interlock_ = std::make_shared<station::Interlock>();
  StationController controller_;

  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  std::deque<Task> tasks_;
  std::map<std::string, double> parameters_;  // that shall be set soon
  std::string last_parameter_;                // that was taken out of them
  bool quit_ = false;
  bool closed_ = false;

  std::thread thread_;
};

}  // namespace ergotic::node
