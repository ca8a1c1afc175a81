// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace ergotic::test {

/// What became of a method under a stress.
struct StabilityOutcome {
  std::string verdict;        ///< of the certificate, before anything moved
  std::string findings;       ///< of the certificate
  double growth = 0.0;        ///< largest kinetic energy over all energy at the start
  double energy_error = 0.0;  ///< what the energy balance lacks, of the energy at the start
};

/// One cell of the map: a method that is played against a stress.
struct StabilityCase {
  std::string stress;
  std::string method;
  bool is_safe = false;
  std::string verdict;  ///< that must be foretold; "not offered": no scene can ask for the method
  std::string finding;  ///< part of a finding that must be among those foretold
  std::function<StabilityOutcome()> run;
};

/// All cells, stress by stress. Deterministic.
const std::vector<StabilityCase>& stabilityCases();

}  // namespace ergotic::test
