// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "scene/no_numbers.hpp"
#include "scene/yaml/table_csv.hpp"
#include "support/places.hpp"

namespace ergotic::scene {
namespace {

TEST(FiniteNumbersTest, AreAllThatAShippedSceneMaySay) {
  for (const char* name : {"string", "drum", "duet", "fretted_string"}) {
    const std::string path = repository(std::string("models/") + name + ".yaml");
    EXPECT_GT(
        expectFiniteNumbers(textOf(path), [&](const std::string& text) { readYaml(text, path); }),
        20)
        << name;
  }
}

TEST(FiniteNumbersTest, AreAllThatAnMdlFileMaySay) {
  int numbers = 0;
  for (const char* name : {"inertia", "links", "nl_springs", "clipped_springs", "params", "bow",
                           "pluck", "audio_params"}) {
    const std::string path = repository(std::string("test/golden/models/") + name + ".mdl");
    numbers +=
        expectFiniteNumbers(textOf(path), [&](const std::string& text) { readMdl(text, path); });
  }
  EXPECT_GT(numbers, 50);
}

TEST(FiniteNumbersTest, AreAllThatAListOfPointsMaySay) {
  const auto read = [](const std::string& text) { readTableCsv(text, "points.csv"); };
  EXPECT_EQ(expectFiniteNumbers("# x, y\n -1, 2\n 3.5, -4e-3\n 5, 6\n", read), 6);
}

}  // namespace
}  // namespace ergotic::scene
