// SPDX-License-Identifier: BSD-3-Clause
// What the instruments that come along claim of themselves, as they are shipped.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/places.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

/// The scenes in models/ that say what is true of them.
std::vector<std::string> scenesWithTruths() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(test::repository("models"))) {
    if (entry.path().extension() == ".yaml" &&
        test::textOf(entry.path()).find("\ntruths:") != std::string::npos) {
      names.push_back(entry.path().stem());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedTruthsTest : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedTruthsTest, Hold) {
  const std::string file = "models/" + GetParam() + ".yaml";
  const test::Outcome outcome = test::run("check", test::repository(file) + " --truths");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

INSTANTIATE_TEST_SUITE_P(Models,
                         ShippedTruthsTest,
                         ::testing::ValuesIn(scenesWithTruths()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace ergotic::tools
