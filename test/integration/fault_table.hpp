// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "integration/fault_cases.hpp"

namespace ergotic::test {

/// What one fault did.
struct Outcome {
  std::uint8_t reason = Status::FAULT_NONE;
  std::string says;          ///< the state, in words
  double released_ms = 0.0;  ///< from its start to force below 1 % at the device, for good
  double recovered_s = 0.0;  ///< from the request to its answer
  double largest_n = 0.0;    ///< at the device
};

/// The table of faults in docs/safety.md.
class FaultTable {
 public:
  void add(const FaultCase& fault, const Outcome& outcome);

  /// Puts all rows in place of those that are there.
  /// \throws std::runtime_error if one of `faultCases` is missing, or the page has no place for
  /// them
  void write() const;

 private:
  std::map<std::string, std::string> rows_;  // by name
};

}  // namespace ergotic::test
