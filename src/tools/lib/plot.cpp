// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/plot.hpp"

#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <sys/wait.h>

#include "ergotic/exception.hpp"
#include "tools/lib/shipped.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace ergotic::tools {
namespace {

/// Install space: lib/ergotic; devel space: devel/lib/ergotic of the source tree.
std::string pathOf(const std::string& script) {
  const std::string folder = programFolder();
  for (const std::string& path : {folder + "/" + script, folder + "/../../../scripts/" + script}) {
    if (access(path.c_str(), X_OK) == 0) {
      return path;
    }
  }
  throw Exception("--plot: there is no program " + script + " in " + folder +
                  ", nor in the source tree around it");
}

/// A table that is gone when it was drawn.
class Table {
 public:
  explicit Table(const std::function<void(std::ostream&)>& write) {
    const char* const folder = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe)
    path_ = std::string(folder == nullptr ? "/tmp" : folder) + "/ergotic_plot_XXXXXX";
    const int file = mkstemp(path_.data());
    if (file < 0) {
      throw Exception(path_ + ": " + std::strerror(errno));
    }
    close(file);
    writeTable(path_, write);
  }
  ~Table() { unlink(path_.c_str()); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  std::string& path() { return path_; }

 private:
  std::string path_;
};

}  // namespace

void writeTable(const std::string& path, const std::function<void(std::ostream&)>& write) {
  std::ofstream file(path);
  write(file);
  file.close();
  if (!file) {
    throw Exception(path + ": cannot be written");
  }
}

void plot(const std::string& script,
          const std::string& picture,
          const std::function<void(std::ostream&)>& write) {
  std::string program = pathOf(script);
  Table table(write);
  std::string to = picture;
  std::array<char*, 4> arguments{program.data(), table.path().data(), to.data(), nullptr};
  pid_t child = 0;
  const int error =
      posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error != 0) {
    throw Exception(program + ": " + std::strerror(error));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Exception("--plot: " + program + " failed, " + picture + " is not drawn");
  }
}

}  // namespace ergotic::tools
