// SPDX-License-Identifier: BSD-3-Clause
// The process that takes the force off when its station has died or hangs. Started by
// tgr::Guardian alone, with: PAGE SILENCE_MS PRIORITY {COUNT FILE KIND WORD...}...
#include <dirent.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "guardian/hold.hpp"
#include "tgr/safety/guardian_page.hpp"

namespace ergotic::guardian {
namespace {

using Words = std::vector<std::string>;

struct Settings {
  tgr::GuardianPage* page = nullptr;
  int silence_ms = 0;
  int priority = 0;
  std::vector<std::unique_ptr<Hold>> holds;
};

std::unique_ptr<Hold> hold(const std::string& kind, const Words& words, int file) {
  if (kind == "shared_memory") {
    return holdSharedMemory(words);
  }
  if (kind == "comedi") {
    return holdComedi(words, file);
  }
  if (kind == "jack") {
    return holdJack(words);
  }
  throw std::invalid_argument("it knows no devices of the kind " + kind);
}

/// Files of the station that are nothing to us must not stay open for our sake.
void closeAllBut(const std::vector<int>& kept) {
  std::vector<int> others;
  DIR* const folder = ::opendir("/proc/self/fd");
  while (const dirent* const entry = folder != nullptr ? ::readdir(folder) : nullptr) {
    const int file = std::atoi(entry->d_name);
    if (file > STDERR_FILENO && std::find(kept.begin(), kept.end(), file) == kept.end()) {
      others.push_back(file);
    }
  }
  if (folder != nullptr) {
    ::closedir(folder);
  }
  std::for_each(others.begin(), others.end(), ::close);
}

/// Reads the arguments after the page.
void read(const Words& words, int page, Settings& settings) {
  settings.silence_ms = std::stoi(words.at(1));
  settings.priority = std::stoi(words.at(2));
  std::vector<int> files = {page};
  std::vector<Words> guards;
  for (std::size_t i = 3; i < words.size(); i += 2 + guards.back().size()) {
    files.push_back(std::stoi(words.at(i + 1)));
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(i) + 2;
    guards.emplace_back(first, first + std::stoi(words.at(i)));
  }
  closeAllBut(files);
  for (std::size_t i = 0; i < guards.size(); ++i) {
    const Words& guard = guards[i];
    settings.holds.push_back(hold(guard.at(0), {guard.begin() + 1, guard.end()}, files[i + 1]));
  }
}

sigjmp_buf* way_out = nullptr;  // of a device whose memory is gone

/// Handles SIGBUS: truncated shared memory of one device does not keep the others from being made
/// safe.
void onBus(int number) {
  if (way_out != nullptr) {
    ::siglongjmp(*way_out, 1);
  }
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// A function of its own: nothing that it changes is used after a leap.
void makeSafe(Hold& hold) {
  sigjmp_buf here;
  if (sigsetjmp(here, 1) == 0) {
    way_out = &here;
    hold.makeSafe();
  }
}

/// Makes all devices safe, in one thread, which `onAct` may interrupt.
void makeSafe(const Settings& settings) {
  sigjmp_buf* const outer = way_out;
  for (const auto& hold : settings.holds) {
    makeSafe(*hold);
    way_out = outer;
  }
}

const Settings* told = nullptr;  // whose devices a signal makes safe

/// A store, a system call or a post for each device: all that may be done here.
void onAct(int /*signal*/) {
  const int saved = errno;
  makeSafe(*told);
  errno = saved;
}

/// Protects the guardian from everything but signals stronger than the station's own faults.
void outlive(int priority) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
    ::signal(number, SIG_IGN);
  }
  std::ofstream("/proc/self/oom_score_adj") << -1000;  // where we may
  rt::lockMemory();
  if (priority > 0) {
    rt::makeRealtime(priority);
  }
}

enum class Heard { kNothing, kQuit, kEnd };

/// Waits for the mutex `life`, which is free once the station's thread has quit or has died.
Heard listen(tgr::GuardianPage& page, int timeout_ms) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const std::int64_t end_ns = rt::monotonicNs() + timeout_ms * kNsPerMs;
  const timespec end{end_ns / kNsPerS, end_ns % kNsPerS};
  const int error = ::pthread_mutex_clocklock(&page.life, CLOCK_MONOTONIC, &end);
  if (error == ETIMEDOUT) {
    return Heard::kNothing;
  }
  return page.quit ? Heard::kQuit : Heard::kEnd;
}

/// Watches the station. A look that finds no new beat counts as a quarter of the silence, however
/// late it comes: load that delays the looks delays the beats as well.
/// \return true if the station died
bool watch(const Settings& settings) {
  constexpr int kLooks = 4;
  tgr::GuardianPage& page = *settings.page;
  int missed = 0;
  std::int64_t beats = page.beats;
  Heard heard = Heard::kNothing;
  do {
    heard = listen(page, std::max(1, settings.silence_ms / kLooks));
    ++page.looks;
    const std::int64_t now = page.beats;
    missed = now != beats || now == 0 ? 0 : missed + 1;  // from the first one on
    beats = now;
    if (missed >= kLooks) {
      makeSafe(settings);
    }
  } while (heard == Heard::kNothing);
  return heard == Heard::kEnd;
}

/// Makes safe repeatedly, as the kernel may still execute actions of a dying process after the
/// first time.
void bury(const Settings& settings) {
  constexpr int kTimes = 20;
  constexpr std::int64_t kPauseNs = 5'000'000;
  for (int i = 0; i < kTimes; ++i) {
    makeSafe(settings);
    rt::sleepUntilNs(rt::monotonicNs() + kPauseNs);
  }
}

void answer(tgr::GuardianPage& page, const char* refusal) {
  std::strncpy(page.refusal, refusal, sizeof page.refusal - 1);
  page.answered = true;
}

int run(const Words& words) {
  const int file = std::stoi(words.at(0));
  Settings settings;
  settings.page = tgr::mapGuardianPage(file);
  try {
    read(words, file, settings);
    outlive(settings.priority);
  } catch (const std::exception& problem) {
    answer(*settings.page, problem.what());
    return EXIT_FAILURE;
  }
  ::signal(SIGBUS, onBus);
  told = &settings;
  ::signal(tgr::kGuardianAct, onAct);
  answer(*settings.page, "");
  if (watch(settings)) {
    bury(settings);
  }
  constexpr unsigned kPatienceS = 2;
  ::alarm(kPatienceS);  // libjack may hang
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace ergotic::guardian

int main(int argc, char** argv) {
  return ergotic::guardian::run({argv + 1, argv + argc});
}
