// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Every number of an instrument that parameters can change; made outside, switched by pointer.
class Coefficients {
 public:
  virtual ~Coefficients() = default;
};

}  // namespace ergotic::physics
