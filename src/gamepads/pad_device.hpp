// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace ergotic::gamepads {

/// Event of the kernel: EV_KEY or EV_ABS, a code of linux/input-event-codes.h, and the value.
struct PadEvent {
  int type = 0;
  int code = 0;
  int value = 0;
};

/// Axes of a gamepad, by the kernel's codes.
struct PadTraits {
  struct Range {
    int low = 0;
    int high = 0;
    int flat = 0;  ///< half width of the dead zone about the middle
  };
  std::string name;
  std::map<int, Range> axes;
};

/// An open gamepad. Thread: one
class PadDevice {
 public:
  virtual ~PadDevice() = default;

  /// File descriptor for poll: readable while events wait.
  virtual int file() const = 0;
  virtual const PadTraits& traits() const = 0;
  /// \return the next event, if one waits. \throws std::system_error if the gamepad is gone
  virtual std::optional<PadEvent> next() = 0;
};

/// Opens the device at a path. \throws std::system_error with the system's message
using OpenPad = std::function<std::unique_ptr<PadDevice>(const std::string& path)>;

/// Opens a gamepad at /dev/input/eventN by libevdev.
std::unique_ptr<PadDevice> openByEvdev(const std::string& path);

}  // namespace ergotic::gamepads
