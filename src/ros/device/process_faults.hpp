// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::node {

/// Faults of the whole process, made on purpose. Nothing in it runs meanwhile, a watchdog neither:
/// only one of the device can act.

/// \throws Exception if it is not within 0.001...10
void requireStop(double seconds);
/// Stops this process as SIGSTOP does; another process sends SIGCONT after `seconds`. Blocks as
/// long.
/// \throws DeviceError if that process does not start
void stopThisProcess(double seconds);

/// Kills this process as SIGKILL does. Does not return.
[[noreturn]] void killThisProcess();

}  // namespace ergotic::node
