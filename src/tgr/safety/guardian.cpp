// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/guardian.hpp"

#include <dlfcn.h>
#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <new>
#include <string>
#include <system_error>

#include <sys/wait.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/thread.hpp"
#include "tgr/require.hpp"
#include "tgr/safety/guardian_page.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kPatienceMs = 5000;  // to begin, and to end
constexpr std::int64_t kMsNs = 1'000'000;

[[noreturn]] void refuse(const std::string& what) {
  throw DeviceError("guardian of the devices: " + what);
}

/// Beside the library that this is in, in the devel space as in an install space.
std::string program() {
  Dl_info info{};
  ::dladdr(reinterpret_cast<void*>(&refuse), &info);
  const std::filesystem::path folder = std::filesystem::path(info.dli_fname).parent_path();
  const std::filesystem::path installed = folder / "ergotic" / "guardian";
  return std::filesystem::exists(installed) ? installed : folder / "guardian";
}

std::vector<std::string> wordsFor(const std::vector<Guard>& guards,
                                  const GuardianOptions& options,
                                  int page) {
  std::vector<std::string> words = {program(), std::to_string(page),
                                    std::to_string(std::lround(1e3 * options.silence_s)),
                                    std::to_string(options.priority)};
  for (const Guard& guard : guards) {
    words.push_back(std::to_string(guard.words.size()));
    words.push_back(std::to_string(guard.file));
    words.insert(words.end(), guard.words.begin(), guard.words.end());
  }
  return words;
}

/// Starts a program that gets the files, keeps none of our signal masks, and has no terminal.
pid_t spawn(std::vector<std::string> words, const std::vector<int>& files) {
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int file : files) {
    ::posix_spawn_file_actions_adddup2(&actions, file, file);  // stays open there
  }
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t none;
  ::sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  pid_t pid = -1;
  const int error =
      ::posix_spawn(&pid, arguments.front(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    refuse(words.front() + ": " + std::generic_category().message(error));
  }
  return pid;
}

/// Signals the guardians of this process on a fatal signal that may leave a core file: the kernel
/// would report its end only when it has stopped all threads, and written the file.
class FaultTeller {
 public:
  static void add(pid_t guardian) {
    const std::lock_guard lock(mutex);
    if (count++ == 0) {
      struct sigaction ours = {};
      ours.sa_handler = &FaultTeller::onFault;
      for (std::size_t i = 0; i < kFaults.size(); ++i) {
        ::sigaction(kFaults[i], &ours, &earlier[i]);
        if (earlier[i].sa_handler != SIG_DFL && i >= kOfThreads) {  // it may live on
          ::sigaction(kFaults[i], &earlier[i], nullptr);
        }
      }
    }
    replace(0, guardian);
  }
  static void remove(pid_t guardian) {
    const std::lock_guard lock(mutex);
    replace(guardian, 0);
    if (--count == 0) {
      std::for_each(kFaults.begin(), kFaults.end(), restore);
    }
  }

 private:
  static constexpr std::array<int, 10> kFaults = {SIGSEGV, SIGBUS,  SIGILL, SIGFPE,  SIGABRT,
                                                  SIGQUIT, SIGTRAP, SIGSYS, SIGXCPU, SIGXFSZ};
  static constexpr std::size_t kOfThreads = 5;  // which nobody survives
  static constexpr std::size_t kMax = 16;       // more are told by the kernel

  /// Handler of fatal signals: notifies the guardians, then the signal takes its usual course.
  static void onFault(int signal) {
    for (const std::atomic<pid_t>& guardian : guardians) {
      if (const pid_t pid = guardian; pid != 0) {
        ::kill(pid, kGuardianAct);
      }
    }
    restore(signal);
    ::raise(signal);
  }
  /// Restores the earlier handler of a signal, if ours is still installed.
  static void restore(int signal) {
    const auto at = std::find(kFaults.begin(), kFaults.end(), signal) - kFaults.begin();
    struct sigaction now = {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == &FaultTeller::onFault) {
      ::sigaction(signal, &earlier[static_cast<std::size_t>(at)], nullptr);
    }
  }
  static void replace(pid_t from, pid_t to) {
    const auto found = std::find(guardians.begin(), guardians.end(), from);
    if (found != guardians.end()) {
      *found = to;
    }
  }

  static inline std::mutex mutex;
  static inline int count = 0;
  static inline std::array<struct sigaction, kFaults.size()> earlier{};
  static inline std::array<std::atomic<pid_t>, kMax> guardians{};
};

/// A page of memory without a name, and its file, which is open as long as this is.
class PageFile {
 public:
  PageFile() : number_(::memfd_create("ergotic_guardian", MFD_CLOEXEC)) {
    if (number_ >= 0 && ::ftruncate(number_, sizeof(GuardianPage)) == 0) {
      page_ = mapGuardianPage(number_);
    }
    if (page_ == nullptr) {
      const std::string why = std::generic_category().message(errno);
      close();
      refuse(why);
    }
  }
  ~PageFile() { close(); }
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;
  int number() const { return number_; }
  void* page() const { return page_; }  ///< outlives this

 private:
  void close() const {
    if (number_ >= 0) {
      ::close(number_);
    }
  }

  int number_;
  void* page_ = nullptr;
};

void makeRobust(pthread_mutex_t& mutex) {
  pthread_mutexattr_t attributes;
  ::pthread_mutexattr_init(&attributes);
  ::pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  ::pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
  ::pthread_mutex_init(&mutex, &attributes);
  ::pthread_mutexattr_destroy(&attributes);
}

bool hasEnded(pid_t pid) noexcept {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
         info.si_pid != 0;
}

}  // namespace

Guardian::Guardian(const std::vector<Guard>& guards, const GuardianOptions& options) {
  requireWithin("silence", options.silence_s, 0.008, 2.0, "s");
  requireWithin("guardian priority", options.priority, 0, 99, "");
  const PageFile file;
  page_ = new (file.page()) GuardianPage;
  makeRobust(page_->life);
  std::vector<int> files = {file.number()};
  for (const Guard& guard : guards) {
    if (guard.file >= 0) {
      files.push_back(guard.file);
    }
  }
  try {
    hold(options.priority);
    std::vector<std::string> words = wordsFor(guards, options, file.number());
    const std::string program = words.front();
    pid_ = spawn(std::move(words), files);
    waitForAnswer(program);
    FaultTeller::add(pid_);
    is_told_ = true;
  } catch (const std::exception& error) {
    end();
    if (dynamic_cast<const DeviceError*>(&error) != nullptr) {
      throw;
    }
    refuse(error.what());  // no thread, no memory
  }
}

Guardian::~Guardian() {
  end();
}

/// Holds the robust mutex in a dedicated thread, which has to live as long as the process.
void Guardian::hold(int priority) {
  std::promise<void> held;
  holder_ = std::thread([this, &held, priority] {
    if (priority > 0) {
      rt::makeRealtime(priority);  // it is to die at once; refused: as fast as any other thread
    }
    ::pthread_mutex_lock(&page_->life);
    held.set_value();
    done_.get_future().wait();
    ::pthread_mutex_unlock(&page_->life);
  });
  held.get_future().wait();
}

void Guardian::waitForAnswer(const std::string& program) {
  for (int i = 0; !page_->answered; ++i) {
    if (i == kPatienceMs || hasEnded(pid_)) {
      refuse(program + " does not begin");
    }
    rt::sleepUntilNs(rt::monotonicNs() + kMsNs);
  }
  if (page_->refusal[0] != '\0') {
    refuse(page_->refusal);
  }
}

void Guardian::end() noexcept {
  if (is_told_) {
    FaultTeller::remove(pid_);
  }
  page_->quit = true;
  done_.set_value();
  if (holder_.joinable()) {
    holder_.join();
  }
  for (int i = 0; pid_ > 0 && ::waitpid(pid_, nullptr, WNOHANG) == 0; ++i) {
    if (i == kPatienceMs) {
      ::kill(pid_, SIGKILL);
    }
    rt::sleepUntilNs(rt::monotonicNs() + kMsNs);
  }
  ::munmap(page_, sizeof(GuardianPage));
}

ERGOTIC_REALTIME void Guardian::beat() noexcept {
  page_->beats.fetch_add(1, std::memory_order_relaxed);
}

bool Guardian::isWatching() noexcept {
  constexpr int kMaxAsked = 8;
  const std::int64_t looks = page_->looks;
  asked_ = looks == looks_ ? asked_ + 1 : 0;
  looks_ = looks;
  if (asked_ >= kMaxAsked) {
    ::kill(pid_, SIGKILL);
    return false;
  }
  return !hasEnded(pid_);
}

}  // namespace ergotic::tgr
