// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pthread.h>
#include <signal.h>

#include <atomic>
#include <cstdint>

#include <sys/mman.h>

namespace ergotic::tgr {

/// Tells a guardian to act at once: a thread of the station committed a fault.
constexpr int kGuardianAct = SIGUSR1;

/// Shared memory of a station and its guardian.
struct GuardianPage {
  /// Mutex held by a thread of the station. It is robust: the kernel hands it to the guardian as
  /// soon as that thread is dead, before it frees memory and files of the process, which takes
  /// long.
  pthread_mutex_t life;
  std::atomic<std::int64_t> beats{0};  ///< counted by the station
  std::atomic<std::int64_t> looks{0};  ///< counted by the guardian, four in `silence_s`
  std::atomic<bool> quit{false};       ///< set by the station: the devices were given back
  std::atomic<bool> answered{false};   ///< set by the guardian: `refusal` is what it cannot hold
  char refusal[512] = "";
};

/// \param file  of its size. \return null if it cannot be mapped
inline GuardianPage* mapGuardianPage(int file) noexcept {
  void* const page =
      ::mmap(nullptr, sizeof(GuardianPage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  return page == MAP_FAILED ? nullptr : static_cast<GuardianPage*>(page);
}

}  // namespace ergotic::tgr
