// SPDX-License-Identifier: BSD-3-Clause
#include "files/replace_file.hpp"

#include <filesystem>
#include <iterator>

#include "files/read_file.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::files {
namespace {

namespace fs = std::filesystem;

class ReplaceFileTest : public testing::Test {
 protected:
  ~ReplaceFileTest() override { fs::remove_all(folder_); }

  std::string textOf(const std::string& path) const { return readFile(path, 1000); }
  std::string complaintAbout(const std::string& name) const {
    return complaintOf<Exception>([&] { replaceFile(folder_, name, "new"); });
  }

  const test::ScratchFile beside_{"kept"};
  const std::string folder_ = beside_.path() + ".folder";
};

TEST_F(ReplaceFileTest, WritesAllOfItBelowItsFolder) {
  const std::string path = replaceFile(folder_, "a/devices.yaml", "old");
  EXPECT_EQ(path, folder_ + "/a/devices.yaml");
  EXPECT_EQ(replaceFile(folder_, path, "new and longer"), path);
  EXPECT_EQ(textOf(path), "new and longer");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ + "/a"), {}), 1) << "no draft is left";
}

TEST_F(ReplaceFileTest, TakesNoFileForItsDraft) {
  const std::string other = replaceFile(folder_, "devices.yaml.new", "of somebody");
  replaceFile(folder_, "devices.yaml", "ours");
  EXPECT_EQ(textOf(other), "of somebody");
}

TEST_F(ReplaceFileTest, ReplacesNothingElsewhere) {
  fs::create_directories(folder_);
  fs::create_symlink(beside_.path(), folder_ + "/link");
  for (const std::string& name :
       {beside_.path(), "../" + fs::path(beside_.path()).filename().string(),
        std::string("link")}) {
    EXPECT_THAT(complaintAbout(name), HasSubstr("allowed: files below " + folder_)) << name;
  }
  EXPECT_EQ(beside_.text(), "kept");
  EXPECT_THAT(complaintAbout("."), HasSubstr("allowed: a file"));
  EXPECT_THAT(complaintAbout(std::string("a\0b", 3)), HasSubstr("a\\x00b: cannot be written"));
}

}  // namespace
}  // namespace ergotic::files
