// SPDX-License-Identifier: BSD-3-Clause
#include "gamepads/gamepad_watch.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <linux/input-event-codes.h>
#include <sys/eventfd.h>

#include "ergotic/rt/clock.hpp"

namespace ergotic::gamepads {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;
// udev may still be about to say who may open it.
constexpr int kRefusalsBeforeTold = 2;

std::string firstLineOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string refusalOf(const std::string& name,
                      const std::string& path,
                      const std::error_code& why) {
  const bool is_permission = why == std::errc::permission_denied;
  return "the gamepad " + name + " does not play: " + path + ": " + why.message() +
         (is_permission ? "; add yourself to the group `input` (sudo adduser $USER input), and log "
                          "in again"
                        : "");
}

}  // namespace

bool hasGamepadButtons(const std::string& keys) {
  constexpr unsigned kBitsOfWord = 8 * sizeof(long);
  std::istringstream stream(keys);
  std::vector<std::uint64_t> words;
  for (std::uint64_t word = 0; stream >> std::hex >> word;) {
    words.push_back(word);
  }
  const std::size_t index = BTN_GAMEPAD / kBitsOfWord;
  return index < words.size() &&
         (words[words.size() - 1 - index] >> (BTN_GAMEPAD % kBitsOfWord) & 1U) != 0;
}

GamepadWatch::GamepadWatch(GamepadListener listener,
                           OpenPad open,
                           const GamepadPlaces& places,
                           std::int64_t look_ns)
    : listener_(std::move(listener)),
      open_(std::move(open)),
      places_(places),
      look_ns_(look_ns),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  thread_ = std::thread([this] { run(); });
}

GamepadWatch::~GamepadWatch() {
  ends_ = true;
  (void)eventfd_write(wake_, 1);
  thread_.join();
  close(wake_);
}

void GamepadWatch::run() {
  while (!ends_) {
    if (rt::monotonicNs() >= next_look_ns_) {
      look();
      next_look_ns_ = rt::monotonicNs() + look_ns_;
    }
    wait();
  }
}

/// Paths of those that are there.
std::set<std::string> GamepadWatch::gamepads() const {
  std::set<std::string> found;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(places_.devices, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    const auto keys = std::filesystem::path(places_.classes) / name / "device/capabilities/key";
    if (name.rfind("event", 0) == 0 && hasGamepadButtons(firstLineOf(keys))) {
      found.insert(entry->path());
    }
  }
  return found;
}

void GamepadWatch::look() {
  const std::set<std::string> there = gamepads();
  for (auto refusal = refusals_.begin(); refusal != refusals_.end();) {
    refusal = there.count(refusal->first) > 0 ? std::next(refusal) : refusals_.erase(refusal);
  }
  for (const std::string& path : there) {
    const bool is_open = std::any_of(pads_.begin(), pads_.end(),
                                     [&](const auto& pad) { return pad.second.path == path; });
    if (!is_open) {
      open(path);
    }
  }
}

void GamepadWatch::open(const std::string& path) {
  try {
    std::unique_ptr<PadDevice> device = open_(path);
    int number = 0;
    while (pads_.count(number) > 0) {
      ++number;
    }
    listener_.told("the gamepad " + device->traits().name + " plays");
    PadDecoder decoder(device->traits());
    pads_.emplace(number, Pad{std::move(device), std::move(decoder), path});
    refusals_.erase(path);
  } catch (const std::system_error& refusal) {
    if (++refusals_[path] == kRefusalsBeforeTold) {
      const auto folder = std::filesystem::path(places_.classes);
      const std::string event = std::filesystem::path(path).filename();
      listener_.refused(
          refusalOf(firstLineOf(folder / event / "device/name"), path, refusal.code()));
    }
  }
}

void GamepadWatch::wait() {
  std::vector<pollfd> files{{wake_, POLLIN, 0}};
  std::vector<int> numbers;
  for (const auto& [number, pad] : pads_) {
    files.push_back({pad.device->file(), POLLIN, 0});
    numbers.push_back(number);
  }
  const std::int64_t left_ns = std::max<std::int64_t>(next_look_ns_ - rt::monotonicNs(), 0);
  if (poll(files.data(), files.size(), static_cast<int>(left_ns / kNsPerMs + 1)) <= 0) {
    return;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (files[i + 1].revents != 0) {
      read(numbers[i]);
    }
  }
}

void GamepadWatch::read(int number) {
  Pad& pad = pads_.at(number);
  try {
    while (const auto event = pad.device->next()) {
      for (const tgr::GamepadMove& move : pad.decoder.decode(*event)) {
        listener_.moved(number, move);
      }
    }
  } catch (const std::system_error&) {
    const std::string name = pad.device->traits().name;
    pads_.erase(number);
    listener_.unplugged(number);
    listener_.told("the gamepad " + name + " is gone, and lets go of everything");
  }
}

}  // namespace ergotic::gamepads
