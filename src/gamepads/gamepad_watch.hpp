// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "ergotic/tgr/players/gamepad.hpp"
#include "gamepads/pad_decoder.hpp"
#include "gamepads/pad_device.hpp"

namespace ergotic::gamepads {

/// Whether the kernel's list of the keys of a device (`capabilities/key` of sysfs, hexadecimal
/// words, the highest first) has the buttons of a gamepad.
bool hasGamepadButtons(const std::string& keys);

/// Callbacks for gamepads, numbered from 0 on. All are called by the thread of the watch.
struct GamepadListener {
  std::function<void(int pad, const tgr::GamepadMove& move)> moved;
  std::function<void(int pad)> unplugged;
  std::function<void(const std::string& news)> told;
  std::function<void(const std::string& why)> refused;
};

/// Folders in which the kernel lists its devices.
struct GamepadPlaces {
  std::string devices = "/dev/input";
  std::string classes = "/sys/class/input";
};

/// Looks for gamepads each second and passes on their events, in an ordinary thread of its own.
/// Only gamepads are opened, no keyboard or mouse. A device that cannot be opened is reported once,
/// as long as it is there. Thread: the one that makes it
class GamepadWatch {
 public:
  static constexpr std::int64_t kLookNs = 1'000'000'000;

  explicit GamepadWatch(GamepadListener listener,
                        OpenPad open = openByEvdev,
                        const GamepadPlaces& places = GamepadPlaces(),
                        std::int64_t look_ns = kLookNs);
  ~GamepadWatch();
  GamepadWatch(const GamepadWatch&) = delete;
  GamepadWatch& operator=(const GamepadWatch&) = delete;

 private:
  struct Pad {
    std::unique_ptr<PadDevice> device;
    PadDecoder decoder;
    std::string path;
  };

  void run();
  void look();
  void open(const std::string& path);
  void wait();
  void read(int number);
  std::set<std::string> gamepads() const;

  GamepadListener listener_;
  OpenPad open_;
  GamepadPlaces places_;
  std::int64_t look_ns_;
  std::map<int, Pad> pads_;              // by number
  std::map<std::string, int> refusals_;  // paths that could not be opened, and how often
  std::int64_t next_look_ns_ = 0;
  int wake_;  // file that ends a wait
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace ergotic::gamepads
