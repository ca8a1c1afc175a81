// SPDX-License-Identifier: BSD-3-Clause
#include "files/replace_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "ergotic/exception.hpp"
#include "files/printable.hpp"
#include "files/read_file.hpp"

namespace ergotic::files {
namespace {

namespace fs = std::filesystem;

bool writeAll(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) {
      return false;
    }
    done += count < 0 ? 0 : static_cast<std::size_t>(count);
  }
  return true;
}

/// Whole and on the disk before it gets its name, or power that fails leaves an empty file.
/// \param path  becomes a name beside it that no file has
bool writeThrough(std::string& path, const std::string& text) {
  constexpr int kTries = 100;
  const std::string name = path;
  int file = -1;
  for (int i = 0; i < kTries && file < 0 && (i == 0 || errno == EEXIST); ++i) {
    path = name + ".new" + std::to_string(i);
    file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  }
  if (file < 0) {
    path = "";
    return false;
  }
  const bool is_whole = writeAll(file, text) && fsync(file) == 0;
  return close(file) == 0 && is_whole;
}

bool syncFolder(const fs::path& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool is_synced = folder >= 0 && fsync(folder) == 0;
  if (folder >= 0) {
    close(folder);
  }
  return is_synced;
}

}  // namespace

std::string replaceFile(const std::string& folder,
                        const std::string& name,
                        const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw Exception(printable(name, PATH_MAX) + ": cannot be written, allowed: " + why);
  };
  if (name.find('\0') != std::string::npos || !isBelow(fs::path(folder) / name, folder)) {
    refuse("files below " + folder);
  }
  std::error_code error;
  const fs::path path = fs::weakly_canonical(fs::path(folder) / name, error);  // a link stays one
  if (error || (fs::exists(path, error) && !fs::is_regular_file(path, error))) {
    refuse("a file");
  }
  std::string draft = path.string();
  fs::create_directories(path.parent_path(), error);
  if (!writeThrough(draft, text) || std::rename(draft.c_str(), path.c_str()) != 0 ||
      !syncFolder(path.parent_path())) {
    const std::string reason = std::generic_category().message(errno);
    fs::remove(draft, error);
    throw Exception(path.string() + ": cannot be written: " + reason);
  }
  return path;
}

}  // namespace ergotic::files
