// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <ergotic/Calibrate.h>
#include <ergotic/InjectFault.h>
#include <ergotic/Take.h>

#include "ergotic/tgr/keyboard.hpp"
#include "ros/device/calibration_guide.hpp"
#include "ros/device/own_host.hpp"
#include "ros/interface/answer.hpp"
#include "ros/interface/arrivals.hpp"
#include "ros/interface/disturbances.hpp"
#include "ros/interface/engine.hpp"
#include "ros/interface/holders.hpp"
#include "ros/interface/morph.hpp"
#include "ros/interface/players.hpp"
#include "ros/interface/preset_file.hpp"
#include "ros/interface/preset_topic.hpp"
#include "ros/interface/publishers.hpp"
#include "ros/interface/takes.hpp"
#include "ros/interface/value_history.hpp"

namespace ergotic::node {

/// Requests by MIDI and gamepads other than strokes of hands.
struct PlayersWishes {
  std::vector<std::pair<std::string, double>> parameters;  ///< parameters of the scene, and values
  std::vector<std::string> news;                           ///< messages for the status
  std::optional<int> program;                              ///< newest program, 0...127
};
constexpr const char* kNothingPlays = "nothing plays: load a model first";

/// The parameters of the scene that plays.
struct ParametersNow {
  scene::Scene scene;          ///< its names, file, text and parameters; nothing else of it
  std::vector<double> values;  ///< [parameters]
};

/// Somebody wants force, or the end of a fault.
struct ForceRequest {
  Arrival arrival;
  std::string caller;  ///< node that asks, by what it says itself
};

/// The model that plays and the open requests to it: the command thread's side of the station.
///
/// Requests are answered when the real-time thread has obeyed, or said why not.
/// Thread: command thread, all but `makeSafe`, `tellPresence` and the functions that move hands
class StationController {
 public:
  /// \param interlock  not null
  StationController(const ::ros::NodeHandle& node,
                    Publishers& feed,
                    std::shared_ptr<station::Interlock> interlock,
                    const OwnHost& own_host)
      : publishers_(feed),
        interlock_(std::move(interlock)),
        own_host_(own_host),
        takes_(node, feed),
        preset_topic_(node) {}
  ~StationController() { close(); }
  StationController(const StationController&) = delete;
  StationController& operator=(const StationController&) = delete;

  Engine* engine() { return engine_.get(); }

  // A picture is of the performer beside it, and not null.

  /// Takes over a running engine and the performer it was made with.
  void begin(std::unique_ptr<Engine> engine,
             station::Performer* performer,
             std::shared_ptr<Picture> picture);
  /// Data that come with another model.
  struct Swap {
    std::shared_ptr<Picture> picture;
    std::string loader;  ///< node that asked for it
    std::optional<tgr::EndEffectors>
        end_effectors;      ///< new end-effectors, which take force away; none: unchanged
    bool is_again = false;  ///< the model that plays is read again, and keeps its changes
  };
  void swap(std::unique_ptr<station::Performer> performer,
            const Swap& with,
            const Promise& promise);
  void engage(const ForceRequest& request, const Promise& promise);
  void recover(const ForceRequest& request, const Promise& promise);
  void setParameter(const std::string& name, double value, const Promise& promise);
  /// \return nothing if nothing plays
  std::optional<ParametersNow> parametersNow() const;
  /// Parameters go to other values. Answers at once, or where they go there at once, when the tick
  /// plays with all of them.
  /// \param values   of parameters, within their ranges
  /// \param seconds  0: at once
  void recall(const PresetValues& values, double seconds, const Promise& promise);
  /// The values that were there before the last change; answers when the tick plays with them.
  void undo(const Promise& promise);
  /// Tells of the presets of the scene that plays, which are others now.
  void showPresets();
  void configure(const tgr::EndEffectors& end_effectors, const Promise& promise);
  /// \param measured  written before a promise is kept that says that all went well
  void calibrate(const Calibrate::Request& request,
                 const Arrival& arrival,
                 const std::shared_ptr<Calibrate::Response>& measured,
                 const Promise& promise);
  void inject(const InjectFault::Request& request, const Promise& promise);

  /// Master volume of the sound at JACK. \return what is wrong with it, or an empty text
  std::string setVolume(double volume);

  /// Records what is played, and plays it again. \param path  of the bag, written before a promise
  /// is kept that says that all went well
  void take(const Take::Request& request,
            const std::shared_ptr<std::string>& path,
            const Promise& promise);

  /// Describes what plays, in words, for the node that loaded it. \pre something plays
  std::string whatPlays(bool force_waits) const;

  /// File of the scene that plays. \pre something plays
  const std::string& sceneFile() const { return playing_->instrument->scene().file; }

  /// Publishes the station's events, and answers those who wait for them.
  void poll();

  /// Sets forces to zero, closes the device, and refuses waiting requests.
  void close();

  /// Sets force to zero at once, latched, also if no device is open yet. \return whether one is.
  /// Thread: any
  bool makeSafe(tgr::FaultReason reason);
  /// Moves hands of a simulated device, with the next ticks. \return what is wrong with it, or an
  /// empty text. Thread: any
  std::string moveHands(const HandTargets& wanted, const std::string& sender);
  /// Holds a module of the model wherever that is, or lets go of it. \return what is wrong with it,
  /// or an empty text. Thread: any
  std::string hold(const HoldTarget& wanted, const std::string& sender);
  /// Releases modules whose senders have fallen silent. Thread: any
  void expireHolds();
  /// Plays a note by the map of notes. \pre both 0...127. Thread: any
  void playNote(int note, int velocity);
  /// Plays the note that moves a hand. \param velocity  1...127. \return it, if there is one.
  /// Thread: any
  std::optional<int> tap(const std::string& end_effector, int index, int velocity);
  /// Plays what came in by MIDI. Thread: one, any
  PlayersWishes playMidi();
  /// Plays an event of a gamepad. \param pad  number of the gamepad, 0 or more. Thread: any
  PlayersWishes playGamepad(int pad, const tgr::GamepadMove& move);
  /// Unplugs a gamepad; all that it holds is released. Thread: any
  void unplugGamepad(int pad);
  /// Binds the next control that a player moves to this parameter; empty: stops waiting.
  /// Thread: any
  Answer learnControl(const std::string& parameter);
  /// Releases all keys. Thread: any
  void releaseKeys();
  /// \param map  path or YAML text. \return an error, or an empty text. Thread: any
  std::string usePlayMap(const std::string& map);
  /// Reports whether the presence switch is held. Thread: any
  void tellPresence(bool is_held);

 private:
  /// A model on its way into the station, which owns it.
  struct Incoming {
    station::Performer* performer = nullptr;
    Swap with;
    Promise promise;
    std::string left_out;  ///< values of its players that it did not get, in words
  };
  /// A parameter on its way to the tick, and the caller that waits for its effect.
  struct Change {
    std::string done;  ///< answer when it has taken effect
    Promise promise;   ///< null: no caller waits
  };
  /// End-effectors on their way into the station, whose event brings the old rig back.
  struct Configuration {
    tgr::EndEffectors end_effectors;
    std::vector<std::string> warnings;
    Promise promise;
  };
  /// Somebody waits for the tick to obey.
  struct Waiter {
    std::string caller;
    Promise promise;
    std::int64_t deadline_ns = 0;
  };

  /// A caller that waits for the result of a push.
  struct Check {
    station::Ticket ticket = 0;  ///< ticket of the interlock, valid until force is taken away
    std::string file;
    Promise promise;
  };

  bool change(std::size_t index, double value, Change change);
  bool set(std::size_t index, double value, Change change);
  PresetValues changedValues() const;
  std::string bringBack(const PresetValues& values);
  void pollGestureValues();
  void moveTo(const std::map<std::size_t, double>& values, double seconds, Change change);
  void pollMorph();
  void endMorph();
  void forgetChanges();
  void log(const Event& event);
  bool command(station::Command::Type type, int index = 0, double value = 0.0);
  bool submit(const station::Command& command);
  void request(station::Command::Type type, const ForceRequest& request, const Promise& promise);
  const tgr::EndEffectors& endEffectors() const;
  void requireNoneComing() const;
  void place(const tgr::EndEffectors& end_effectors);
  void begin(int slice);
  void check(const Calibrate::Request& request, const Arrival& arrival, const Promise& promise);
  void pollCheck();
  std::string keep(const std::string& file);
  std::string finish(const Calibrate::Request& request, Calibrate::Response& measured);
  void pollCalibration();
  void tellInjected(int index, std::int64_t ticks);
  void pollGestures();
  void take(const station::Event& event);
  void takeObeyed(const station::Event& event, const std::string& text);
  void takeConfigured(const station::Event& event);
  void takeSwapped(const station::Event& event);
  void takeKeyframe(const station::Event& event);
  void giveUp();
  void pollLevels();
  void pollScope();
  std::set<int> usedChannels() const;
  void play(station::Performer* performer, std::shared_ptr<Picture> picture, bool is_again);
  void reportWarnings();
  void findPlayMap(const scene::Scene& scene, bool keeps_the_players);
  void showHandles();
  std::vector<std::uint8_t> modulesToHold() const;
  std::string hold(const std::vector<Holders::Wish>& wishes);
  std::string move(const std::vector<tgr::HandMove>& moves,
                   double due_tick = station::Station::kAtOnce);
  std::string readPlayMap(const std::string& map);
  void play(const tgr::Strokes& strokes, double due_tick);
  void play(const tgr::Keyboard::Played& played, PlayersWishes& wishes);

  Publishers& publishers_;
  std::shared_ptr<station::Interlock> interlock_;
  const OwnHost& own_host_;
  std::atomic<std::int64_t> emergency_ns_{std::numeric_limits<std::int64_t>::min() / 2};
  const station::Ticket began_ = interlock_->ticket();  // when `autoengage` was asked for
  std::mutex engine_mutex_;  // held while engine_ changes, and by those that any thread may call
  std::unique_ptr<Engine> engine_;
  station::Performer* playing_ = nullptr;    // owned by the station
  station::Performer* submitted_ = nullptr;  // the newest, owned by the station
  std::vector<double> parameters_;           // of submitted_, as submitted
  std::deque<Incoming> incoming_;
  Takes takes_;
  Morph morph_;                                    // of submitted_
  Change morphed_;                                 // what is answered when it is over
  bool is_undoing_ = false;                        // morph_ is
  ValueHistory history_;                           // of submitted_
  std::vector<tgr::GestureValue> gesture_values_;  // of the devices, in order of time
  std::size_t next_value_ = 0;                     // of them
  PresetTopic preset_topic_;
  std::shared_ptr<Picture> picture_;  // of playing_
  Disturbances disturbances_;
  std::int64_t levels_due_ns_ = 0;
  std::int64_t scope_due_ns_ = 0;
  std::int64_t limited_frames_ = 0;  // as told last
  std::deque<Change> changes_;
  std::deque<Configuration> configurations_;
  std::map<std::uint64_t, Waiter> requests_;  // engage and recover, by their numbers
  std::uint64_t last_request_ = 0;
  Holders holders_;
  Players players_;
  std::mutex keyboard_mutex_;  // of what follows
  tgr::Keyboard keyboard_;
  std::string players_map_;  // that somebody asked for while this model plays
  std::map<std::string, tgr::ParameterRange> ranges_;  // of the scene's parameters
  CalibrationGuide guide_;
  std::shared_ptr<Calibrate::Response> measured_;  // of the sample under way
  Promise sampled_;
  Check check_;  // the one under way
  std::vector<station::GestureTick> gestures_;
};

}  // namespace ergotic::node
