// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>

#include <ergotic/Preset.h>

#include "ros/interface/command_thread.hpp"
#include "ros/interface/preset_file.hpp"

namespace ergotic::node {

/// The service `preset`: reads and writes files, which may take time, in the caller's thread, and
/// leaves the rest to the command thread.
/// Thread: any, but never the command thread itself
class PresetKeeper {
 public:
  explicit PresetKeeper(CommandThread& command_thread);

  Preset::Response serve(const Preset::Request& request);

 private:
  /// \throws Exception why it cannot be done
  Answer act(const Preset::Request& request, std::string& path);
  Answer keep(const std::string& name, std::string& path);
  Answer recall(const std::string& name, double seconds);
  Answer forget(const std::string& name);
  Answer save(const std::string& name, std::string& path);
  PresetFile fileOf(const ParametersNow& now) const;

  CommandThread& command_thread_;
  std::string folder_;
  std::mutex mutex_;  // of the files
};

}  // namespace ergotic::node
