// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/hands.hpp"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "ergotic/exception.hpp"
#include "support/package_path.hpp"
#include "support/scratch_file.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

/// While it lives no file may become larger, as on a full disk.
class FullDisk {
 public:
  FullDisk() {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit none = before_;
    none.rlim_cur = 0;
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_ = SIG_DFL;
};

class HandsTest : public ::testing::Test {
 protected:
  static tgr::StationDevices devices() {
    test::findBuiltPackages();
    return tgr::readDevices("devices:\n- {driver: virtual, settings: {slices: 2}}\n", "d.yaml");
  }
  std::string refusalOf(const std::string& path) {
    try {
      hands_.save(path);
    } catch (const Exception& refusal) {
      return refusal.what();
    }
    return "";
  }

  Hands hands_{devices(), false};
  test::ScratchFile file_{"the old calibration"};
};

TEST_F(HandsTest, AreWrittenInPlaceOfTheOldFile) {
  hands_.save(file_.path());
  EXPECT_EQ(file_.text(), tgr::toYaml(hands_.config()));
  EXPECT_FALSE(fs::exists(file_.path() + ".new"));
}

TEST_F(HandsTest, LeaveTheOldFileWhenTheDiskIsFull) {
  std::string refusal;
  {
    const FullDisk disk;
    refusal = refusalOf(file_.path());
  }
  EXPECT_EQ(refusal, file_.path() + ": cannot be written");
  EXPECT_EQ(file_.text(), "the old calibration");
  EXPECT_FALSE(fs::exists(file_.path() + ".new"));
}

TEST_F(HandsTest, AreWrittenToWhatALinkPointsTo) {
  const std::string link = file_.path() + ".link";
  fs::create_symlink(file_.path(), link);
  hands_.save(link);
  EXPECT_TRUE(fs::is_symlink(link));
  fs::remove(link);
  EXPECT_EQ(file_.text(), tgr::toYaml(hands_.config()));
}

TEST_F(HandsTest, ReplaceNothingButFiles) {
  EXPECT_EQ(refusalOf("/dev/null"), "/dev/null: cannot be written, allowed: a file");
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
  EXPECT_EQ(refusalOf("/nowhere/devices.yaml"), "/nowhere/devices.yaml: cannot be written");
}

}  // namespace
}  // namespace ergotic::node
