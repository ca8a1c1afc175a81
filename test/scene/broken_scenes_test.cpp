// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "scene/bad_text.hpp"
#include "support/places.hpp"

namespace ergotic::scene {
namespace {

/// Every case of a file of test/scene/broken: the name of a head, or `text`, with what follows it,
/// and what the message says. `<!>` marks the place; where the text ends with it, it does so
/// without the end of a line.
int expectAllRefused(const std::filesystem::path& path) {
  const YAML::Node file = YAML::LoadFile(path.string());
  const std::string name = path.stem() == "mdl" ? "bad.mdl" : "bad.yaml";
  int count = 0;
  for (const YAML::Node& node : file["cases"]) {
    const auto head = node.begin();
    const YAML::Node before = file["heads"][head->first.Scalar()];
    std::string text = (before ? before.Scalar() : "") + head->second.Scalar();
    text += text.back() == '\n' || text.back() == '>' ? "" : "\n";
    SCOPED_TRACE(path.string() + ":" + std::to_string(node.Mark().line + 1));
    expectRefused({text.c_str(), node["says"].Scalar().c_str()}, name);
    ++count;
  }
  return count;
}

TEST(BrokenScenesTest, AreRefusedAtTheirPlace) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(repository("test/scene/broken"))) {
    const int cases = expectAllRefused(entry.path());
    EXPECT_GT(cases, 10) << entry.path();
    count += cases;
  }
  EXPECT_GE(count, 1300);
}

}  // namespace
}  // namespace ergotic::scene
