// SPDX-License-Identifier: BSD-3-Clause
#include "gamepads/evdev_pad.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace ergotic::gamepads {
namespace {

[[noreturn]] void throwSystemError(int number, const std::string& what) {
  throw std::system_error(number, std::generic_category(), what);
}

class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : number_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (number_ < 0) {
      throwSystemError(errno, path);
    }
  }
  ~OpenFile() { close(number_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

class EvdevPad : public PadDevice {
 public:
  explicit EvdevPad(const std::string& path) : file_(path) {
    libevdev* device = nullptr;
    if (const int error = libevdev_new_from_fd(file_.number(), &device); error < 0) {
      throwSystemError(-error, path);
    }
    device_.reset(device);
    traits_ = traitsOf(device);
  }

  int file() const override { return file_.number(); }
  const PadTraits& traits() const override { return traits_; }

  /// Returns the next event. After events that the kernel had to drop, libevdev reports the
  /// changes.
  std::optional<PadEvent> next() override {
    input_event event{};
    const int wanted = is_dropped_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL;
    const int status = libevdev_next_event(device_.get(), static_cast<unsigned>(wanted), &event);
    if (status == -EAGAIN && is_dropped_) {
      is_dropped_ = false;
      return next();
    }
    if (status == -EAGAIN || status == -EINTR) {
      return std::nullopt;
    }
    if (status < 0) {
      throwSystemError(-status, traits_.name);
    }
    is_dropped_ = status == LIBEVDEV_READ_STATUS_SYNC;
    return PadEvent{event.type, event.code, event.value};
  }

 private:
  struct Free {
    void operator()(libevdev* device) const { libevdev_free(device); }
  };
  OpenFile file_;
  std::unique_ptr<libevdev, Free> device_;
  PadTraits traits_;
  bool is_dropped_ = false;
};

}  // namespace

PadTraits traitsOf(const libevdev* device) {
  PadTraits traits;
  traits.name = libevdev_get_name(device);
  for (unsigned code = 0; code <= ABS_MAX; ++code) {
    if (const input_absinfo* const range = libevdev_get_abs_info(device, code)) {
      traits.axes[static_cast<int>(code)] = {range->minimum, range->maximum, range->flat};
    }
  }
  return traits;
}

std::unique_ptr<PadDevice> openByEvdev(const std::string& path) {
  return std::make_unique<EvdevPad>(path);
}

}  // namespace ergotic::gamepads
