// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <linux/input.h>
#include <sys/stat.h>

#include "gamepads/pad_device.hpp"

namespace ergotic::test {

/// A pipe that stands for a gamepad with a stick; it is plugged as long as somebody may write to
/// it.
class PipePad : public gamepads::PadDevice {
 public:
  explicit PipePad(const std::string& path) : file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK)) {}
  ~PipePad() override { ::close(file_); }
  PipePad(const PipePad&) = delete;
  PipePad& operator=(const PipePad&) = delete;

  int file() const override { return file_; }
  const gamepads::PadTraits& traits() const override { return traits_; }
  std::optional<gamepads::PadEvent> next() override {
    input_event event{};
    const ssize_t size = ::read(file_, &event, sizeof(event));
    if (size == 0) {
      throw std::system_error(ENODEV, std::generic_category());
    }
    return size == sizeof(event)
               ? std::optional<gamepads::PadEvent>({event.type, event.code, event.value})
               : std::nullopt;
  }

 private:
  int file_;
  gamepads::PadTraits traits_{"piped pad", {{ABS_X, {-100, 100, 0}}, {ABS_Y, {-100, 100, 0}}}};
};

/// Folders as /dev/input and /sys/class/input, in which pipes stand for devices. Gone with the
/// object.
class PadFolder {
 public:
  static constexpr const char* kPadKeys = "7cdb000000000000 0 0 0 0";
  static constexpr const char* kMouseKeys = "1f0000 0 0 0 0";

  PadFolder() { std::filesystem::create_directories(devices()); }
  ~PadFolder() { std::filesystem::remove_all(folder_); }
  PadFolder(const PadFolder&) = delete;
  PadFolder& operator=(const PadFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path devices() const { return folder_ / "dev"; }
  std::filesystem::path classes() const { return folder_ / "sys"; }

  /// \param keys  as the kernel lists them. \return the end of the pipe that is written to
  int plug(const std::string& event, const char* keys = kPadKeys) const {
    const auto device = classes() / event / "device";
    std::filesystem::create_directories(device / "capabilities");
    std::ofstream(device / "capabilities/key") << keys << "\n";
    std::ofstream(device / "name") << "pad of " << event << "\n";
    const std::string path = devices() / event;
    mkfifo(path.c_str(), 0600);
    return ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  }
  void unplug(const std::string& event, int pipe) const {
    std::filesystem::remove(devices() / event);
    ::close(pipe);
  }
  /// \return whether the pipe took it
  static bool send(int pipe, int type, int code, int value) {
    input_event event{};
    event.type = static_cast<std::uint16_t>(type);
    event.code = static_cast<std::uint16_t>(code);
    event.value = value;
    return ::write(pipe, &event, sizeof(event)) == static_cast<ssize_t>(sizeof(event));
  }

 private:
  static inline int count_ = 0;
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("ergotic_pads_" + std::to_string(getpid()) + "_" + std::to_string(count_++));
};

}  // namespace ergotic::test
