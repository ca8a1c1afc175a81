// SPDX-License-Identifier: BSD-3-Clause
#include "files/read_file.hpp"

#include <array>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>

#include <sys/stat.h>

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

/// Before it is opened: to open a pipe is to wait for whoever writes it.
/// \return its bytes
std::size_t requireRegular(const std::string& path) {
  struct stat info {};
  if (path.find('\0') != std::string::npos) {
    refuse(path, ENOENT);  // the system would look for what is before it
  }
  if (stat(path.c_str(), &info) != 0) {
    refuse(path, errno);
  }
  if (S_ISDIR(info.st_mode)) {
    refuse(path, EISDIR);
  }
  if (!S_ISREG(info.st_mode)) {
    refuse(path, "it is a pipe, a device or a socket, allowed: files");
  }
  return static_cast<std::size_t>(info.st_size);
}

}  // namespace

bool isBelow(const std::string& path, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path way = fs::proximate(path, folder, error);
  return !error && *way.begin() != "..";
}

void requireFile(const std::string& path) {
  requireRegular(path);
}

std::ifstream openFile(const std::string& path, std::size_t most) {
  if (const std::size_t size = requireRegular(path); size > most) {
    refuse(path,
           "it has " + std::to_string(size) + " bytes, allowed: at most " + std::to_string(most));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    refuse(path, errno);
  }
  return file;
}

std::string readFile(const std::string& path, std::size_t most) {
  std::ifstream file = openFile(path, most);
  std::string text;
  std::array<char, 1U << 16U> chunk;
  while (file.good() && text.size() <= most) {  // it may grow, and some of /proc tell no size
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
