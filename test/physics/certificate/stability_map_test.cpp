// SPDX-License-Identifier: BSD-3-Clause
// Methods against stresses. With ERGOTIC_STABILITY_MAP=FILE each cell also becomes a line of FILE:
// scripts/plot_stability_map draws it.
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/stability_cases.hpp"

namespace ergotic {
namespace {

using test::StabilityCase;
using test::StabilityOutcome;

constexpr double kDiverged = 1e3;
constexpr double kHeld = 10.0;  // near the limit kinetic energy breathes, see the cases
constexpr double kEnergyError = 1e-11;

class StabilityMapTest : public testing::TestWithParam<StabilityCase> {
 protected:
  static void SetUpTestSuite() {
    if (const char* path = std::getenv("ERGOTIC_STABILITY_MAP")) {
      std::ofstream(path) << "stress,method,safe,verdict,growth,energy_error\n";
    }
  }
  static void write(const StabilityCase& cell, const StabilityOutcome& outcome) {
    if (const char* path = std::getenv("ERGOTIC_STABILITY_MAP")) {
      std::ofstream(path, std::ios::app)
          << '"' << cell.stress << "\",\"" << cell.method << "\"," << cell.is_safe << ','
          << outcome.verdict << ',' << outcome.growth << ',' << outcome.energy_error << '\n';
    }
  }
};

std::string nameOf(const testing::TestParamInfo<StabilityCase>& info) {
  std::string name;
  bool starts = true;
  for (const char c : info.param.stress + " " + info.param.method) {
    const bool is_word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_word) {
      name += starts ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    }
    starts = !is_word;
  }
  return name;
}

TEST_P(StabilityMapTest, BehavesAsForetold) {
  const StabilityCase& cell = GetParam();
  const StabilityOutcome outcome = cell.run();
  write(cell, outcome);
  EXPECT_EQ(outcome.verdict, cell.verdict) << outcome.findings.substr(0, 1000);
  EXPECT_NE(outcome.findings.find(cell.finding), std::string::npos)
      << outcome.findings.substr(0, 1000);
  if (cell.is_safe) {
    EXPECT_LE(outcome.growth, kHeld);
    EXPECT_LE(outcome.energy_error, kEnergyError);
  } else {
    EXPECT_GE(outcome.growth, kDiverged);
  }
}

INSTANTIATE_TEST_SUITE_P(Cells,
                         StabilityMapTest,
                         testing::ValuesIn(test::stabilityCases()),
                         nameOf);

}  // namespace
}  // namespace ergotic
