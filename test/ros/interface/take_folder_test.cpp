// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/take_folder.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <ergotic/GestureBlock.h>
#include <ergotic/Status.h>
#include <rosbag/bag.h>

#include "ergotic/exception.hpp"
#include "ros/interface/take_index.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

class TakeFolderTest : public ::testing::Test {
 protected:
  TakeFolderTest() {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~TakeFolderTest() override { fs::remove_all(path_); }
  /// \param age_s  since it was written
  void put(const std::string& file, int age_s) const {
    std::ofstream(path_ / file) << file;
    fs::last_write_time(path_ / file,
                        fs::file_time_type::clock::now() - std::chrono::seconds(age_s));
  }
  std::string textOf(const std::string& path) const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const TakeFile& take : folder_.list()) {
      names.push_back(take.name + (take.is_starred ? " *" : ""));
    }
    return names;
  }
  const fs::path path_ = fs::temp_directory_path() / ("takes_" + std::to_string(getpid()));
  const TakeFolder folder_{path_.string()};
};

TEST_F(TakeFolderTest, ListsTheNewestFirst) {
  put("b.bag", 10);
  put("a+.bag", 5);
  put("c.bag", 20);
  put("d.bag.active", 1);
  put("e.txt", 1);
  EXPECT_THAT(names(), ElementsAre("a *", "b", "c"));
  EXPECT_TRUE(TakeFolder("/no/such/folder").list().empty());
}

TEST_F(TakeFolderTest, KeepsTheStarAndTheContentsUnderAnotherName) {
  put("b.bag", 10);
  EXPECT_EQ(folder_.star("b", true), (path_ / "b+.bag").string());
  EXPECT_EQ(folder_.star("b", true), (path_ / "b+.bag").string());
  EXPECT_EQ(folder_.rename("b", "solo"), (path_ / "solo+.bag").string());
  EXPECT_THAT(names(), ElementsAre("solo *"));
  EXPECT_EQ(textOf(folder_.star("solo", false)), "b.bag");
  EXPECT_THAT(names(), ElementsAre("solo"));
}

TEST_F(TakeFolderTest, RefusesANameThatIsTakenAndChangesNothing) {
  put("a+.bag", 1);
  put("b.bag", 2);
  put("c.bag.active", 3);
  EXPECT_THAT(complaintOf([&] { folder_.rename("b", "a"); }), HasSubstr("is there already"));
  EXPECT_THAT(complaintOf([&] { folder_.placeFor("a"); }), HasSubstr("is there already"));
  EXPECT_THAT(complaintOf([&] { folder_.rename("b", "c"); }), HasSubstr("is being recorded"));
  EXPECT_THAT(complaintOf([&] { folder_.rename("b", "../c"); }), HasSubstr("cannot be named"));
  EXPECT_THAT(complaintOf([&] { folder_.rename("b", "c+"); }), HasSubstr("cannot be named"));
  EXPECT_THAT(complaintOf([&] { folder_.rename("x", "y"); }), HasSubstr("no such take"));
  EXPECT_THAT(complaintOf([&] { folder_.discard(""); }), HasSubstr("cannot be named"));
  EXPECT_THAT(names(), ElementsAre("a *", "b"));
}

TEST_F(TakeFolderTest, MovesToTheTrashWhatIsThrownAwayAndErasesNothing) {
  for (const char* const expected : {"trash/a.bag", "trash/a_2.bag", "trash/a_3.bag"}) {
    put("a.bag", 1);
    const std::string path = folder_.discard("a");
    EXPECT_EQ(path, (path_ / expected).string());
    EXPECT_EQ(textOf(path), "a.bag");
  }
  put("a+.bag", 1);
  EXPECT_EQ(folder_.discard("a"), (path_ / "trash/a_4+.bag").string());
  EXPECT_TRUE(names().empty());
}

TEST_F(TakeFolderTest, BagsTellWhenTheyBeganHowLongTheyAreAndOfWhat) {
  const std::string path = (path_ / "a.bag").string();
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    Status status;
    bag.write("/station/status", ::ros::Time(90.0), status);
    status.model = "harp";
    bag.write("/station/status", ::ros::Time(99.0), status);
    bag.write("/station/gesture", ::ros::Time(100.0), GestureBlock());
    bag.write("/station/gesture", ::ros::Time(102.5), GestureBlock());
    status.model = "gong";
    bag.write("/station/status", ::ros::Time(103.0), status);
  }
  const TakeDetails details = detailsOf(path);
  EXPECT_EQ(details.began_ns, 100'000'000'000);
  EXPECT_DOUBLE_EQ(details.length_s, 2.5);
  EXPECT_EQ(details.instrument, "harp");
}

TEST_F(TakeFolderTest, WhatIsNoBagTellsNothing) {
  put("a.bag", 1);
  for (const std::string& path :
       {(path_ / "a.bag").string(), path_.string(), std::string("/none")}) {
    EXPECT_EQ(detailsOf(path).length_s, 0.0);
    EXPECT_EQ(detailsOf(path).instrument, "");
  }
}

}  // namespace
}  // namespace ergotic::node
