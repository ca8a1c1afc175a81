// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_cache.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "support/mode_cache.hpp"

namespace ergotic::physics {
namespace {

namespace fs = std::filesystem;

class ModalCacheTest : public ::testing::Test {
 protected:
  std::shared_ptr<const Modes> modes() {
    notes_.clear();
    return modesOf(matrix_, notes_);
  }
  std::string bytes() const {
    std::ifstream from(modeCacheFile(matrix_), std::ios::binary);
    return {std::istreambuf_iterator<char>(from), {}};
  }
  void replace(const std::string& bytes) const {
    std::ofstream(modeCacheFile(matrix_), std::ios::binary | std::ios::trunc) << bytes;
  }
  static std::size_t filesIn(const fs::path& folder) {
    return fs::exists(folder) ? static_cast<std::size_t>(std::distance(
                                    fs::directory_iterator(folder), fs::directory_iterator()))
                              : 0;
  }

  test::ModeCache cache_;
  std::vector<std::string> notes_;
  ModalMatrix matrix_{3, {{0, 0, 2.0}, {1, 0, -1.0}, {1, 1, 2.0}, {2, 1, -1.0}, {2, 2, 2.0}}};
};

TEST_F(ModalCacheTest, ModesAreThoseOfTheMatrix) {
  const auto found = modes();
  EXPECT_NEAR(found->values[0], 2.0 - std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(found->values[1], 2.0, 1e-14);
  EXPECT_NEAR(found->values[2], 2.0 + std::sqrt(2.0), 1e-14);
  EXPECT_NEAR((found->vectors.transpose() * found->vectors - Eigen::Matrix3d::Identity()).norm(),
              0.0, 1e-14);
}

TEST_F(ModalCacheTest, SecondTimeTheyComeFromTheFileBitForBit) {
  const auto first = modes();
  std::string changed = bytes();
  ASSERT_EQ(filesIn(cache_.folder()), 1U);
  const auto second = modes();
  EXPECT_EQ(first->values, second->values);
  EXPECT_EQ(first->vectors, second->vectors);
  EXPECT_EQ(bytes(), changed);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(ModalCacheTest, OtherNumbersHaveAnotherFile) {
  const fs::path file = modeCacheFile(matrix_);
  matrix_.entries[3].value = -1.0000000000000002;
  EXPECT_NE(modeCacheFile(matrix_), file);
}

TEST_F(ModalCacheTest, DamagedFilesAreReportedAndReplaced) {
  const auto first = modes();
  const std::string good = bytes();
  std::string flipped = good;
  flipped[good.size() - 5] ^= 1;
  std::string of_another_version = good;
  of_another_version[8] ^= 1;
  for (const std::string& bad : {std::string(), good.substr(0, good.size() - 1), good + "x",
                                 flipped, of_another_version, std::string("no modes at all")}) {
    replace(bad);
    const auto again = modes();
    EXPECT_EQ(again->vectors, first->vectors);
    ASSERT_EQ(notes_.size(), 1U);
    EXPECT_NE(notes_[0].find("warning: damaged"), std::string::npos);
    EXPECT_EQ(bytes(), good);
  }
}

TEST_F(ModalCacheTest, FolderThatCannotBeMadeIsReported) {
  fs::create_directories(cache_.folder().parent_path());
  std::ofstream(cache_.folder()) << "a file where the folder should be";
  EXPECT_EQ(modes()->values.size(), 3);
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("cannot be written"), std::string::npos);
}

TEST_F(ModalCacheTest, NothingIsWrittenWhenTurnedOff) {
  setenv("ERGOTIC_MODE_CACHE", "off", 1);
  EXPECT_EQ(modes()->values.size(), 3);
  EXPECT_EQ(filesIn(cache_.folder()), 0U);
  EXPECT_TRUE(notes_.empty());
}

}  // namespace
}  // namespace ergotic::physics
