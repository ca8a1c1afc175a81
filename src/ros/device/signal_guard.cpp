// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/signal_guard.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <thread>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::node {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned char kQuit = 0;   // no signal has this number
constexpr int kHelperPriority = 80;  // above the tick's: zero force is more urgent than sound
std::atomic<int> handler_fd{-1};

extern "C" void ergoticOnSignal(int signal) {
  const int saved = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const auto written = write(handler_fd.load(), &byte, 1);
  errno = saved;
}

}  // namespace

/// The pipe, the helper thread and the earlier handlers: one of each per process.
class SignalGuard::Pipe {
 public:
  Pipe() {
    if (pipe2(fds_.data(), O_CLOEXEC) != 0) {
      throw DeviceError("no pipe left for the signal guard: raise the limit of open files");
    }
    handler_fd = fds_[1];
    thread_ = std::thread([this] { run(); });
    struct sigaction ours = {};
    ours.sa_handler = &ergoticOnSignal;
    ours.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      sigaction(kSignals[i], &ours, &earlier_[i]);
    }
  }

  ~Pipe() {
    restore();
    const unsigned char byte = kQuit;
    [[maybe_unused]] const auto written = write(fds_[1], &byte, 1);
    thread_.join();
    handler_fd = -1;
    close(fds_[0]);
    close(fds_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void add(SignalGuard* guard) {
    const std::lock_guard lock(mutex_);
    guards_.push_back(guard);
  }

  void remove(SignalGuard* guard) {
    const std::lock_guard lock(mutex_);
    guards_.erase(std::remove(guards_.begin(), guards_.end(), guard), guards_.end());
  }

  static std::shared_ptr<Pipe> ofProcess() {
    static std::mutex mutex;
    static std::weak_ptr<Pipe> shared;
    const std::lock_guard lock(mutex);
    auto pipe = shared.lock();
    if (!pipe) {
      pipe = std::make_shared<Pipe>();
      shared = pipe;
    }
    return pipe;
  }

 private:
  /// Puts the earlier handlers back where ours still are.
  void restore() noexcept {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      struct sigaction now = {};
      sigaction(kSignals[i], nullptr, &now);
      if (now.sa_handler == &ergoticOnSignal) {
        sigaction(kSignals[i], &earlier_[i], nullptr);
      }
    }
  }

  void run() {
    // Refused without the right to it; then the helper is as fast as any other thread.
    rt::makeRealtime(kHelperPriority);
    unsigned char signal = kQuit;
    while (read(fds_[0], &signal, 1) == 1 && signal != kQuit) {
      {
        const std::lock_guard lock(mutex_);
        for (SignalGuard* guard : guards_) {
          guard->make_safe_();
        }
        for (SignalGuard* guard : guards_) {
          guard->close_();
        }
        guards_.clear();
      }
      restore();
      kill(getpid(), signal);
    }
  }

  std::array<int, 2> fds_{-1, -1};
  std::array<struct sigaction, kSignals.size()> earlier_{};
  std::mutex mutex_;
  std::vector<SignalGuard*> guards_;
  std::thread thread_;
};

SignalGuard::SignalGuard(std::function<void()> make_safe, std::function<void()> close)
    : make_safe_(std::move(make_safe)), close_(std::move(close)), pipe_(Pipe::ofProcess()) {
  pipe_->add(this);
}

SignalGuard::~SignalGuard() {
  pipe_->remove(this);
}

}  // namespace ergotic::node
