// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include <ergotic/LoadModel.h>
#include <ros/node_handle.h>

#include "ros/interface/description.hpp"

namespace ergotic::node {

/// Brings models from text to sound, outside the real-time thread.
///
/// The first model that can be played also starts the engine: device, real-time thread, JACK. As
/// long as there is none, the parameters are read anew each time, so that what was wrong can be put
/// right without starting again.
/// Thread: one, which may take its time
class Loader {
 public:
  Loader(const ::ros::NodeHandle& private_node,
         CommandThread& command_thread,
         Description& description)
      : node_(private_node), command_thread_(command_thread), description_(description) {}

  /// Plays a model. The one that plays keeps playing if this fails.
  /// \param model           path or YAML text
  /// \param allow_unproven  no more than the station itself allows
  /// \param loader          node that asks, by what it says itself
  /// \param end_effectors   that come with it: path or YAML text, `none`, `auto`; empty: no others
  LoadModel::Response load(const std::string& model,
                           bool allow_unproven,
                           const std::string& loader,
                           const std::string& end_effectors = "");

  /// Reads the file of the model that plays again, or while none has played yet of the last one
  /// that was asked for, and plays it with the parameters as they were changed. The one that plays
  /// keeps playing if this fails.
  /// \param loader  as of `load`
  Answer reload(const std::string& loader);

  /// Plays the scene that a MIDI program change means, if the station allows it, as if the station
  /// itself had asked for it.
  /// \param program  0...127
  void loadProgram(int program);

  /// Plays the model that the parameter `model` names, if it names one. While its devices cannot be
  /// opened it tries again for some seconds: a station of this name may be about to end.
  void loadFromParameters();
  /// Ends these attempts. Thread: any
  void giveUp() { gives_up_ = true; }

 private:
  /// Request to play a model.
  struct Wish {
    std::string model;  ///< path or YAML text
    bool allow_unproven = false;
    std::string loader;
    std::string end_effectors;  ///< its end-effectors: path or YAML text, `none`; empty: unchanged
    bool is_again = false;      ///< the model plays already
  };
  LoadModel::Response load(const Wish& wish);
  std::optional<tgr::EndEffectors> endEffectorsFor(const Wish& wish) const;
  bool waitUntilNextTry(std::int64_t end_ns) const;
  Answer play(scene::Scene scene,
              const Wish& wish,
              const std::optional<tgr::EndEffectors>& end_effectors,
              std::string& verdict);
  Answer start(scene::Scene scene,
               bool allow_unproven,
               const std::optional<tgr::EndEffectors>& end_effectors,
               std::string& verdict);

  ::ros::NodeHandle node_;
  CommandThread& command_thread_;
  Description& description_;
  Wish last_;  // that was fulfilled; until one is, that was asked for
  bool has_played_ = false;
  bool is_device_missing_ = false;  // because of that the last load failed
  std::atomic<bool> gives_up_{false};
};

}  // namespace ergotic::node
