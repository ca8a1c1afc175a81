// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Both ends of a link: slots of their x coordinate.
struct LinkEnds {
  int a = 0;
  int b = 0;
};

/// Consecutive links whose ends are consecutive, too: link `first + i` joins a + i and b + i. If
/// the ends are not consecutive, a is -1, and `ends` has them.
struct LinkSpan {
  int first = 0;
  int count = 0;
  int a = -1;
  int b = -1;
};

}  // namespace ergotic::physics
