// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <ergotic/Parameters.h>
#include <ergotic/Presets.h>
#include <ergotic/Scope.h>
#include <ergotic/Status.h>
#include <ergotic/Takes.h>

#include "rviz/caller.hpp"
#include "rviz/scenes.hpp"

namespace ergotic::panel {

/// Latest data of a station.
struct News {
  Status status;
  double age_s = -1.0;  ///< age of the status, s; negative: none came yet
  bool has_master = true;
  std::vector<double> forces;       ///< [slices] as sent to the device, N
  std::vector<double> peaks;        ///< [slices] their largest sizes in the last second, N
  double force_limit = 20.0;        ///< N per slice
  std::vector<double> levels;       ///< [outputs] relative to full scale
  std::vector<double> level_peaks;  ///< [outputs] maxima of the last second
  double volume = 1.0;              ///< master volume, 0...1
  bool is_limited = false;          ///< the limiter turned the sound down just now
  bool hears_sound = false;
  Scope::ConstPtr sound;  ///< null: it is not watched, or none came
  Parameters parameters;
  std::size_t parameters_version = 0;
  Takes takes;
  std::size_t takes_version = 0;
  Presets presets;
  std::size_t device_version = 0;  ///< version of its URDF; 0: none came
  std::vector<SceneEntry> scenes;
  std::size_t scenes_version = 0;
  std::string log;
  std::size_t log_version = 0;
  Answer answer;  ///< the last
  std::size_t answers = 0;
};

/// Link to one station, by its messages and services. Threads of its own do all work that may wait
/// for a station or a ROS master. The link reconnects to a station that is started again, also over
/// another master. Thread: the one of the window. Nothing here waits, but the destructor, for some
/// seconds if a master hangs.
class StationLink {
 public:
  /// \param station  its full name
  /// \param models   folder of scenes, if the parameter `~models` names no others
  StationLink(const std::string& station, const std::string& models);
  ~StationLink();
  StationLink(const StationLink&) = delete;
  StationLink& operator=(const StationLink&) = delete;

  const std::string& station() const;

  /// Brings `news` up to date; what has a version only if that is another.
  void refresh(News& news) const;

  void engage();
  /// Stops force, and cancels an Engage that is on its way.
  void stop();
  /// Stops by the service and by the topic, whichever comes first.
  void emergencyStop();
  void recover();
  /// \param model  path, path#variant
  void load(const std::string& model, const std::string& title);
  /// Reloads the scene that plays, from its file.
  void reload();
  /// Sets a parameter by the topic: of several values that come at once, the station takes the
  /// newest.
  void setParameter(const std::string& name, double value);
  /// Binds the next MIDI controller that moves to this parameter.
  void learnController(const std::string& parameter);
  /// \param volume  0...1
  void setVolume(double volume);
  /// Sets whether the station sends the signal of the outputs.
  void watchSound(bool is_wanted);

  void record();
  void finishTake();
  /// \param name  of the take; empty: the newest
  void replay(const std::string& name);
  void haltTake();
  /// \param what    for the answer: "Rename"
  /// \param action  RENAME...DELETE of Take.srv
  void changeTake(const char* what,
                  std::uint8_t action,
                  const std::string& name,
                  const std::string& new_name = "");
  /// \param what    for the answer: "Recall"
  /// \param action  of Preset.srv
  void preset(const char* what,
              std::uint8_t action,
              const std::string& name = "",
              double seconds = 0.0);

  struct Shared;

 private:
  void ask(const char* what, const Take::Request& request);
  void ask(Caller& caller, const char* what, const char* service, bool insists = false);

  std::shared_ptr<Shared> shared_;  // with the thread that listens
  std::unique_ptr<Caller> force_;
  std::unique_ptr<Caller> stop_;
  std::unique_ptr<Caller> emergency_;
  std::unique_ptr<Caller> loading_;
  std::unique_ptr<Caller> takes_;
  std::unique_ptr<Caller> presets_;
  std::unique_ptr<Caller> learning_;
};

}  // namespace ergotic::panel
