// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/process_faults.hpp"

#include <unistd.h>

#include <sys/wait.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// A process that stops itself, then waits until `finish`.
class StoppingProcess {
 public:
  explicit StoppingProcess(double seconds) {
    if (::pipe(pipe_.data()) != 0) {
      return;
    }
    process_ = ::fork();
    if (process_ == 0) {
      constexpr unsigned kLongS = 60;
      ::alarm(kLongS);  // should it never be told to end
      ::close(pipe_[1]);
      stopThisProcess(seconds);
      char end = 0;
      ::_exit(::read(pipe_[0], &end, 1) == 0 ? 0 : 1);
    }
    ::close(pipe_[0]);
  }
  ~StoppingProcess() { finish(); }
  StoppingProcess(const StoppingProcess&) = delete;
  StoppingProcess& operator=(const StoppingProcess&) = delete;

  int nextStatus(int options) const {
    int status = 0;
    return ::waitpid(process_, &status, options) == process_ ? status : -1;
  }
  void finish() {
    if (pipe_[1] >= 0) {
      ::close(pipe_[1]);
      pipe_[1] = -1;
    }
  }

 private:
  std::array<int, 2> pipe_{-1, -1};
  pid_t process_ = -1;
};

// Only a process that was stopped is told of as continued.
TEST(ProcessFaultsTest, StopAndWakeTheProcessThatPlaysOn) {
  StoppingProcess process(0.5);
  const int continued = process.nextStatus(WCONTINUED);
  EXPECT_TRUE(WIFCONTINUED(continued)) << continued;
  process.finish();
  const int ended = process.nextStatus(0);
  EXPECT_TRUE(WIFEXITED(ended) && WEXITSTATUS(ended) == 0) << ended;
}

}  // namespace
}  // namespace ergotic::node
