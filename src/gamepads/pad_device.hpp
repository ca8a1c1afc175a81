// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace ergotic::gamepads {

/// As the kernel tells it: EV_KEY or EV_ABS, a code of linux/input-event-codes.h, and the value.
struct PadEvent {
  int type = 0;
  int code = 0;
  int value = 0;
};

/// What a gamepad has beside buttons, by the kernel's codes.
struct PadTraits {
  struct Range {
    int low = 0;
    int high = 0;
    int flat = 0;  ///< about the middle, that means nothing
  };
  std::string name;
  std::map<int, Range> axes;
};

/// An open gamepad. Thread: one
class PadDevice {
 public:
  virtual ~PadDevice() = default;

  /// For poll: readable while events wait.
  virtual int file() const = 0;
  virtual const PadTraits& traits() const = 0;
  /// \return the next event, if one waits. \throws std::system_error if the gamepad is gone
  virtual std::optional<PadEvent> next() = 0;
};

/// Opens what is at a path. \throws std::system_error with what the system says
using OpenPad = std::function<std::unique_ptr<PadDevice>(const std::string& path)>;

/// Opens a gamepad at /dev/input/eventN by libevdev.
std::unique_ptr<PadDevice> openByEvdev(const std::string& path);

}  // namespace ergotic::gamepads
