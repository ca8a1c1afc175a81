// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks a function of the tick: no heap, lock, system call, log, throw or unbounded loop.
#if defined(__clang__)
#define ERGOTIC_REALTIME __attribute__((annotate("ergotic_realtime")))
#else
#define ERGOTIC_REALTIME
#endif
