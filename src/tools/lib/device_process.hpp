// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>

#include "tgr/drivers/virtual/force_record.hpp"

/// Common parts of the virtual devices that are processes of their own.
namespace ergotic::tools {

/// Blocks SIGINT and SIGTERM in the thread that makes it and in those that this one starts.
class Signals {
 public:
  Signals();
  /// Calls `each` every 10 ms until it is false, a signal comes, or the time is over.
  /// \param seconds  0: no time limit
  void attend(double seconds, const std::function<bool()>& each) const;

 private:
  sigset_t set_{};
};

/// Says of a gesture file that its rows that set parameters have no effect in a device process.
/// \param process  its name \throws TextError, Exception from the file
void warnOfValues(const std::string& process, const std::string& gesture_file);

/// CSV `time_ns,slice,force_n`: every change of force that a virtual device felt.
class ForceLog {
 public:
  /// \param path  empty: nothing is written
  /// \throws Exception if it cannot be written
  explicit ForceLog(std::string path);

  template <class Device>
  void drain(Device& device) {
    tgr::drainForces(device, file_);
    file_.flush();
  }
  /// Writes the remaining records. \throws Exception if the file does not hold all of them
  template <class Device>
  void finish(Device& device) {
    drain(device);
    requireAll(device.droppedRecords());
  }

 private:
  void requireAll(std::int64_t dropped) const;

  std::string path_;
  std::ofstream file_;
};

}  // namespace ergotic::tools
