// SPDX-License-Identifier: BSD-3-Clause
#include "support/realtime_scope.hpp"

#include <execinfo.h>
#include <fcntl.h>
#include <seccomp.h>
#include <signal.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>

#include "support/passing_call.hpp"

namespace ergotic::test {
namespace {

constexpr int kCalls = 512;  // more than there are
constexpr int kMaxTold = 20;

thread_local bool is_watched = false;
thread_local bool has_filter = false;
thread_local std::int64_t system_calls = 0;

using Name = std::array<char, 32>;
std::array<Name, kCalls> names;  // before a handler asks for them

int reportFile() noexcept {
  static const int file = [] {
    const char* const path = std::getenv(kRealtimeReport);
    return path == nullptr ? STDERR_FILENO
                           : open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }();
  return file;
}

/// With the calls that led there. What it does itself is not seen.
void tell(const char* kind, const char* name) noexcept {
  static std::atomic<int> told{0};
  const bool was_watched = std::exchange(is_watched, false);
  if (told++ < kMaxTold) {
    std::array<char, 80> line{};
    std::strncat(line.data(), kind, 30);
    std::strncat(line.data(), name, 30);
    report(line.data());
    std::array<void*, 32> frames{};
    backtrace_symbols_fd(frames.data(), backtrace(frames.data(), frames.size()), reportFile());
  }
  is_watched = was_watched;
}

void tellHeapCall(const char* name) noexcept {
  tell("heap call ", name);
}

/// Registers of a thread that made a system call.
struct Call {
  explicit Call(void* context) noexcept
      : registers(static_cast<ucontext_t*>(context)->uc_mcontext) {}
#if defined(__x86_64__)
  long argument(int i) const noexcept {
    constexpr std::array<int, 5> kWhere = {REG_RDI, REG_RSI, REG_RDX, REG_R10, REG_R8};
    return registers.gregs[kWhere[static_cast<std::size_t>(i)]];
  }
  void answer(long result) noexcept {
    registers.gregs[REG_RAX] = result;
  }
#elif defined(__aarch64__)
  long argument(int i) const noexcept {
    return static_cast<long>(registers.regs[i]);
  }
  void answer(long result) noexcept {
    registers.regs[0] = static_cast<unsigned long long>(result);
  }
#else
#error "Call: say where this processor has the arguments of a system call"
#endif
  mcontext_t& registers;
};

void onTrap(int, siginfo_t* info, void* context) {
  const int error = errno;
  if (is_watched) {
    ++system_calls;
    tell("system call ", names[static_cast<std::size_t>(info->si_syscall)].data());
  }
  Call call(context);
  const long result = syscall(info->si_syscall, call.argument(0), call.argument(1),
                              call.argument(2), call.argument(3), call.argument(4), kPassingCall);
  call.answer(result == -1 ? -errno : result);
  errno = error;
}

void require(bool is_so, const char* what) {
  if (!is_so) {
    throw std::runtime_error(std::string("seccomp: ") + what);
  }
}

using Filter = std::unique_ptr<void, decltype(&seccomp_release)>;

Filter makeFilter() {
  Filter filter(seccomp_init(SCMP_ACT_TRAP), &seccomp_release);
  require(filter != nullptr, "no filter can be made");
  const auto allow = [&filter](int call, std::initializer_list<scmp_arg_cmp> arguments) {
    require(seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call,
                                   static_cast<unsigned>(arguments.size()), arguments.begin()) == 0,
            "a rule is refused");
  };
  allow(SCMP_SYS(clock_nanosleep),
        {SCMP_A0_64(SCMP_CMP_EQ, CLOCK_MONOTONIC, 0), SCMP_A1_64(SCMP_CMP_EQ, TIMER_ABSTIME, 0)});
  allow(SCMP_SYS(clock_gettime), {});
  allow(SCMP_SYS(rt_sigreturn), {});
  for (int call = 0; call < kCalls; ++call) {
    const std::unique_ptr<char, decltype(&std::free)> name(
        seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, call), &std::free);
    if (name != nullptr && call != SCMP_SYS(clock_gettime) && call != SCMP_SYS(rt_sigreturn)) {
      std::strncpy(names[static_cast<std::size_t>(call)].data(), name.get(), 31);
      allow(call, {SCMP_A5_64(SCMP_CMP_EQ, kPassingCall, 0)});
    }
  }
  return filter;
}

/// Of the process.
Filter& filterAndHandler() {
  static Filter filter = [] {
    std::array<void*, 1> frames{};
    backtrace(frames.data(), frames.size());  // the first one loads what it needs
    reportFile();
    struct sigaction action = {};
    action.sa_sigaction = &onTrap;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigaction(SIGSYS, &action, nullptr);
    return makeFilter();
  }();
  return filter;
}

void filterThread() {
  sigset_t trap;
  sigemptyset(&trap);
  sigaddset(&trap, SIGSYS);
  pthread_sigmask(SIG_UNBLOCK, &trap, nullptr);  // threads of JACK take no signals
  require(seccomp_load(filterAndHandler().get()) == 0, "the system takes no filter");
  has_filter = true;
}

}  // namespace

void report(const char* line) noexcept {
  std::array<char, 100> text{};
  std::strncat(text.data(), line, text.size() - 2);
  std::strcat(text.data(), "\n");
  if (write(reportFile(), text.data(), std::strlen(text.data())) < 0) {
    std::abort();
  }
}

RealtimeScope::RealtimeScope() {
  if (!isAvailable()) {
    return;
  }
  if (!has_filter) {
    filterThread();
  }
  heap_.emplace(&tellHeapCall);
  system_calls = 0;
  is_watched = true;
}

RealtimeScope::~RealtimeScope() {
  is_watched = false;
}

std::int64_t RealtimeScope::systemCalls() const noexcept {
  return system_calls;
}

}  // namespace ergotic::test
