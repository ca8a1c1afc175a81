// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::test {

/// As the last of six arguments it lets a system call pass a RealtimeScope. Calls of six arguments
/// that a thread makes between its ticks do not read it: futex without a mask, mmap without a file,
/// for which it has to be a multiple of a page.
constexpr std::uint64_t kPassingCall = 0x5afe'0000;

}  // namespace ergotic::test
