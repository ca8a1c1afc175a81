// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::node {

/// Faults of the whole process, made on purpose. Nothing in it runs meanwhile, a watchdog neither:
/// only one of the device can act.

/// \throws Exception if it is not within 0.001...10
void requireStop(double seconds);
/// As SIGSTOP would, and SIGCONT after `seconds`, which another process sends. Blocks as long.
/// \throws DeviceError if that process does not start
void stopThisProcess(double seconds);

/// As SIGKILL would. Does not return.
[[noreturn]] void killThisProcess();

}  // namespace ergotic::node
