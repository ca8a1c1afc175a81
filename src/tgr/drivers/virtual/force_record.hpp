// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <ostream>

namespace ergotic::tgr {

/// A change of the force that a slice feels.
struct ForceRecord {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC of the mechanics' step
  std::int32_t slice = 0;
  double force_n = 0.0;
};

/// Writes the records that wait as CSV rows `time_ns,slice,force_n`.
/// \param device  has `bool pollForce(ForceRecord&)`
template <class Device>
void drainForces(Device& device, std::ostream& out) {
  out.precision(std::numeric_limits<double>::max_digits10);
  ForceRecord record;
  while (device.pollForce(record)) {
    out << record.time_ns << ',' << record.slice << ',' << record.force_n << '\n';
  }
}

}  // namespace ergotic::tgr
