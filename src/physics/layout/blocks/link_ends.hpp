// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Both ends of a link: slots of their x coordinate.
struct LinkEnds {
  int a = 0;
  int b = 0;
};

/// Links that follow one another, as do their ends: those of link `first + i` are a + i and b + i.
/// Where the ends do not, all are in `ends`, and a is -1.
struct LinkSpan {
  int first = 0;
  int count = 0;
  int a = -1;
  int b = -1;
};

}  // namespace ergotic::physics
