// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/shared_device.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include <sys/mman.h>
#include <sys/stat.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

std::string segmentName(const std::string& given) {
  std::string name = given.substr(0, 1) == "/" ? given : "/" + given;
  constexpr std::size_t kLongest = 200;
  if (name.size() < 2 || name.size() > kLongest || name.find('/', 1) != std::string::npos) {
    throw DeviceError("shared memory '" + given + "': the name must be 1...199 characters, no '/'");
  }
  return name;
}

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw DeviceError("virtual device " + name + ": " + what);
}

/// Closes the file when it goes out of scope; a mapping does not need it any more.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const noexcept { return fd_; }

 private:
  int fd_;
};

SharedDevice* map(const File& file, const std::string& name) {
  void* const memory =
      ::mmap(nullptr, sizeof(SharedDevice), PROT_READ | PROT_WRITE, MAP_SHARED, file.fd(), 0);
  if (memory == MAP_FAILED) {
    refuse(name, std::string("cannot be mapped: ") + std::generic_category().message(errno));
  }
  return static_cast<SharedDevice*>(memory);
}

/// Whether a living device holds this segment.
bool isTaken(const std::string& name) {
  try {
    const SharedSegment segment = SharedSegment::attach(name);
    return processLives(segment->device_pid.load());
  } catch (const DeviceError&) {
    return false;  // unfinished, or of another version: nothing that runs now
  }
}

}  // namespace

ERGOTIC_REALTIME bool SharedMoves::push(std::uint32_t session, const HandMove& move) noexcept {
  const std::uint32_t written = written_.load(std::memory_order_relaxed);
  if (written - read_.load(std::memory_order_acquire) >= kCapacity) {
    return false;
  }
  entries_[written % kCapacity] = {session, move};
  written_.store(written + 1, std::memory_order_release);
  return true;
}

/// Takes the next move of a session. Moves of an earlier session are skipped; those of a later one
/// wait until the device has seen that its session began.
ERGOTIC_REALTIME bool SharedMoves::pop(std::uint32_t session, HandMove& move) noexcept {
  const std::uint32_t written = written_.load(std::memory_order_acquire);
  std::uint32_t read = read_.load(std::memory_order_relaxed);
  bool found = false;
  while (!found && read != written && entries_[read % kCapacity].session <= session) {
    const Entry& entry = entries_[read % kCapacity];
    found = entry.session == session;
    move = entry.move;
    ++read;
  }
  read_.store(read, std::memory_order_release);
  return found;
}

ERGOTIC_REALTIME void SharedFrame::write(const double* values, int count) noexcept {
  const std::uint64_t odd = sequence_.load(std::memory_order_relaxed) | 1U;
  sequence_.store(odd, std::memory_order_relaxed);
  for (int i = 0; i < count; ++i) {
    values_[static_cast<std::size_t>(i)].store(values[i], std::memory_order_release);
  }
  sequence_.store(odd + 1, std::memory_order_release);
}

ERGOTIC_REALTIME bool SharedFrame::read(double* values, int count) const noexcept {
  std::array<double, kMaxSlices> copy{};
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const std::uint64_t before = sequence_.load(std::memory_order_acquire);
    for (int i = 0; i < count; ++i) {
      const auto slot = static_cast<std::size_t>(i);
      copy[slot] = values_[slot].load(std::memory_order_acquire);
    }
    if ((before & 1U) == 0 && sequence_.load(std::memory_order_relaxed) == before) {
      std::memcpy(values, copy.data(), static_cast<std::size_t>(count) * sizeof(double));
      return true;
    }
  }
  return false;
}

bool processLives(std::int32_t pid) noexcept {
  return pid > 0 && (::kill(pid, 0) == 0 || errno == EPERM);
}

SharedSegment SharedSegment::create(const std::string& given, const SharedTraits& traits) {
  const std::string name = segmentName(given);
  constexpr int kFlags = O_CREAT | O_EXCL | O_RDWR;
  constexpr mode_t kOwnerOnly = 0600;
  int fd = ::shm_open(name.c_str(), kFlags, kOwnerOnly);
  if (fd < 0 && errno == EEXIST) {
    if (isTaken(name)) {
      refuse(name, "is running already; stop it or choose another name");
    }
    ::shm_unlink(name.c_str());  // left by a device that was killed
    fd = ::shm_open(name.c_str(), kFlags, kOwnerOnly);
  }
  const File file(fd);
  if (fd < 0 || ::ftruncate(fd, sizeof(SharedDevice)) != 0) {
    refuse(name, std::string("cannot be created: ") + std::generic_category().message(errno));
  }
  auto* const device = new (map(file, name)) SharedDevice;
  device->traits = traits;
  device->born_ns = rt::monotonicNs();
  device->device_pid = ::getpid();
  device->magic.store(SharedDevice::kMagic, std::memory_order_release);
  return {device, name};
}

SharedSegment SharedSegment::attach(const std::string& given) {
  const std::string name = segmentName(given);
  const File file(::shm_open(name.c_str(), O_RDWR, 0));
  struct stat status {};
  if (file.fd() < 0 || ::fstat(file.fd(), &status) != 0) {
    refuse(name, std::string(std::generic_category().message(errno)) +
                     "; start it with virtual_tgr --shm");
  }
  if (status.st_size < static_cast<off_t>(sizeof(SharedDevice))) {
    refuse(name, "is not ready, or of another version");
  }
  SharedSegment segment(map(file, name), "");
  if (segment->magic.load(std::memory_order_acquire) != SharedDevice::kMagic ||
      segment->version != SharedDevice::kVersion || segment->size != sizeof(SharedDevice)) {
    refuse(name, "is not ready, or of another version");
  }
  return segment;
}

SharedSegment::SharedSegment(SharedSegment&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      owned_name_(std::exchange(other.owned_name_, {})) {}

SharedSegment::~SharedSegment() {
  if (device_ == nullptr) {
    return;
  }
  if (!owned_name_.empty()) {
    device_->device_pid = 0;
    ::shm_unlink(owned_name_.c_str());
  }
  ::munmap(device_, sizeof(SharedDevice));
}

}  // namespace ergotic::tgr
