// SPDX-License-Identifier: BSD-3-Clause
// Preloaded, it lets a station find pipes for gamepads, in the folder that ERGOTIC_PADS names.
#include <cstdlib>
#include <filesystem>
#include <set>

#include "gamepads/gamepad_watch.hpp"
#include "gamepads/pad_folder.hpp"

namespace ergotic::gamepads {

std::set<std::string> GamepadWatch::gamepads() const {
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(std::getenv("ERGOTIC_PADS"))) {
    found.insert(entry.path());
  }
  return found;
}

std::unique_ptr<PadDevice> openByEvdev(const std::string& path) {
  return std::make_unique<test::PipePad>(path);
}

}  // namespace ergotic::gamepads
