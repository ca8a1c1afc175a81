// SPDX-License-Identifier: BSD-3-Clause
#include "files/read_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>

#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include "ergotic/exception.hpp"
#include "files/printable.hpp"

namespace ergotic::files {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw Exception(printable(path, PATH_MAX) + ": cannot be read: " + reason);
}

[[noreturn]] void refuse(const std::string& path, int error) {
  refuse(path, std::generic_category().message(error));
}

/// A reference to a place in the file system that does not follow later changes, and is not opened
/// yet: opening a pipe waits for its writer, and opening some devices has effects.
class Place {
 public:
  explicit Place(const std::string& path) : path_(path) {
    if (path.find('\0') != std::string::npos) {
      refuse(path, ENOENT);  // the system would look for what is before it
    }
    number_ = open(path.c_str(), O_PATH | O_CLOEXEC);
    if (number_ < 0) {
      refuse(path, errno);
    }
  }
  ~Place() { close(number_); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// \return bytes of the regular file that it is
  std::size_t require() const {
    struct stat info {};
    if (fstat(number_, &info) != 0) {
      refuse(path_, errno);
    }
    if (S_ISDIR(info.st_mode)) {
      refuse(path_, EISDIR);
    }
    if (!S_ISREG(info.st_mode)) {
      refuse(path_, "it is a pipe, a device or a socket, allowed: files");
    }
    if (isOfKernel()) {
      refuse(path_, "it is a window into the kernel (/proc, /sys), allowed: files of a disk");
    }
    return static_cast<std::size_t>(info.st_size);
  }

  std::ifstream read() const {
    std::ifstream file("/proc/self/fd/" + std::to_string(number_), std::ios::binary);
    if (!file.is_open()) {
      refuse(path_, errno);
    }
    return file;
  }

 private:
  /// Whether the kernel generates the content: some of it never ends, some (/proc/kmsg) waits for
  /// ever, and some contains secrets of this process.
  bool isOfKernel() const {
    struct statfs system {};
    if (fstatfs(number_, &system) != 0) {
      return false;  // reading says why
    }
    switch (system.f_type) {
      case PROC_SUPER_MAGIC:
      case SYSFS_MAGIC:
      case DEBUGFS_MAGIC:
      case TRACEFS_MAGIC:
        return true;
      default:
        return false;
    }
  }

  const std::string& path_;
  int number_ = -1;
};

}  // namespace

bool isBelow(const std::string& path, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path way = fs::proximate(path, folder, error);
  return !error && *way.begin() != "..";
}

void requireFile(const std::string& path) {
  Place(path).require();
}

std::ifstream openFile(const std::string& path, std::size_t most) {
  const Place place(path);
  if (const std::size_t size = place.require(); size > most) {
    refuse(path,
           "it has " + std::to_string(size) + " bytes, allowed: at most " + std::to_string(most));
  }
  return place.read();
}

std::string readFile(const std::string& path, std::size_t most) {
  std::ifstream file = openFile(path, most);
  std::string text;
  std::array<char, 1U << 16U> chunk;
  while (file.good() && text.size() <= most) {  // it may grow, and some tell no size
    file.read(chunk.data(), chunk.size());
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) {
    refuse(path, EIO);
  }
  if (text.size() > most) {
    refuse(path, "it does not end within " + std::to_string(most) + " bytes");
  }
  return text;
}

}  // namespace ergotic::files
