// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace ergotic::test {

/// A program of its own, gone with the object.
class ChildProcess {
 public:
  /// \param command      path and arguments
  /// \param environment  added to ours
  /// \throws std::runtime_error if it cannot be started
  explicit ChildProcess(const std::vector<std::string>& command,
                        const std::map<std::string, std::string>& environment = {});
  ~ChildProcess();  ///< SIGKILL if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  bool isRunning();
  /// \return status as of waitpid, nothing if it still runs after `seconds`
  std::optional<int> wait(double seconds);

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace ergotic::test
