// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/programs.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "ergotic/exception.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

class ProgramsTest : public ::testing::Test {
 protected:
  ProgramsTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "maps");
    for (const char* const name : {"drum.yaml", "bell.yaml", "harp.mdl", "harp.yaml", "read.me",
                                   "lib_truths.yaml", "maps/aaa.yaml"}) {
      std::ofstream(folder_ / name) << "\n";
    }
  }
  ~ProgramsTest() override { fs::remove_all(folder_); }
  std::string nameOf(int program) const {
    return fs::path(sceneOfProgram(program, (folder_ / "drum.yaml").string())).filename().string();
  }
  const fs::path folder_ = fs::temp_directory_path() / ("programs_" + std::to_string(getpid()));
};

TEST_F(ProgramsTest, AreTheScenesOfTheFolderByTheirNames) {
  EXPECT_EQ(nameOf(0), "bell.yaml");
  EXPECT_EQ(nameOf(1), "drum.yaml");
  EXPECT_EQ(nameOf(2), "harp.yaml");
}

TEST_F(ProgramsTest, SayWhichThereAre) {
  EXPECT_THAT(complaintOf<Exception>([&] { nameOf(3); }),
              HasSubstr("program 3, allowed: 0...2, the scenes in " + folder_.string()));
  EXPECT_THAT(complaintOf<Exception>([] { sceneOfProgram(0, "inline.yaml"); }),
              HasSubstr("came as a text"));
}

TEST(ShippedProgramsTest, AreThoseThatTheListShows) {
  const std::string playing = repository("models/string.yaml");
  EXPECT_EQ(fs::path(sceneOfProgram(0, playing)).stem(), "carillon");
  EXPECT_EQ(fs::path(sceneOfProgram(1, playing)).stem(), "cimbalom");
}

}  // namespace
}  // namespace ergotic::node
