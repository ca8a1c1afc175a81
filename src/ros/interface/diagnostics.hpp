// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <cstdint>
#include <optional>

#include <ergotic/Status.h>

#include "ros/interface/engine.hpp"

namespace ergotic::node {

/// Publisher of /diagnostics: force, real time, sound, model; once a second, and at once when the
/// state of the force changes.
/// Thread: command thread, all but the constructor
class Diagnostics {
 public:
  Diagnostics(const ::ros::NodeHandle& node,
              const ::ros::NodeHandle& private_node,
              const std::string& name);

  /// Publishes if a second has passed, or the state of the force has changed.
  /// \param engine  used only then; null: nothing plays
  void refresh(const Status& status, const Engine* engine);

 private:
  using Report = diagnostic_updater::DiagnosticStatusWrapper;

  bool isDue(const Status& status);
  void reportForce(Report& report);
  void reportRealtime(Report& report);
  void reportSound(Report& report);
  void reportModel(Report& report);

  diagnostic_updater::Updater updater_;
  Status status_;
  Status last_;  // a second ago
  std::optional<audio::JackStatus> jack_;
  station::Loudness loudness_;
  std::int64_t limited_before_ = 0;  // frames, a second ago
  tgr::WatchdogReading watchdog_;
  std::int64_t due_ns_ = 0;
};

}  // namespace ergotic::node
