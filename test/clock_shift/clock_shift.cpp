// SPDX-License-Identifier: BSD-3-Clause
// Preloaded, it shows a program a wall clock that jumps when a test says so. Monotonic clocks, and
// with them what waits for a time span, go on as ever.
#include "clock_shift/clock_shift.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include <sys/mman.h>
#include <sys/time.h>

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr std::int64_t kNsPerUs = 1'000;

using Shift = std::atomic<std::int64_t>;  // ns
static_assert(sizeof(Shift) == sizeof(std::int64_t) && Shift::is_always_lock_free);

const Shift* mapShift() {
  const char* const path = std::getenv(ergotic::test::kClockShiftFile);
  const int file = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return nullptr;
  }
  void* const page = mmap(nullptr, sizeof(Shift), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  return page == MAP_FAILED ? nullptr : static_cast<const Shift*>(page);
}

const Shift* const the_shift = mapShift();

bool isWallClock(clockid_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto real =
      reinterpret_cast<int (*)(clockid_t, timespec*)>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (result == 0 && the_shift != nullptr && isWallClock(clock)) {
    const std::int64_t shifted = time->tv_sec * kNsPerS + time->tv_nsec + the_shift->load();
    time->tv_sec = shifted / kNsPerS;
    time->tv_nsec = shifted % kNsPerS;
  }
  return result;
}

int gettimeofday(timeval* time, void* /*zone*/) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / kNsPerUs;
  return 0;
}

time_t time(time_t* seconds) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (seconds != nullptr) {
    *seconds = now.tv_sec;
  }
  return now.tv_sec;
}

}  // extern "C"
