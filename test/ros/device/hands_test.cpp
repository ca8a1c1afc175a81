// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/hands.hpp"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <sys/resource.h>

#include "ros/device/end_effectors.hpp"
#include "ros/display/end_effector_frames.hpp"
#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

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

/// Calibrations are written below a folder of the test.
class HandsTest : public ::testing::Test {
 protected:
  HandsTest() {
    setenv("ROS_HOME", folder_.c_str(), 1);
    fs::create_directories(fs::path(path_).parent_path());
    std::ofstream(path_) << "the old calibration";
  }
  ~HandsTest() override {
    unsetenv("ROS_HOME");
    fs::remove_all(folder_);
  }
  static tgr::StationDevices devices() {
    test::findBuiltPackages();
    return tgr::readDevices("devices:\n- {driver: virtual, settings: {slices: 2}}\n", "d.yaml");
  }
  std::string refusalOf(const std::string& path) {
    return complaintOf([&] { hands_.save(path); });
  }

  Hands hands_{devices(), false};
  const std::string folder_ = "/tmp/ergotic_hands_" + std::to_string(::getpid());
  const std::string path_ = folder_ + "/ergotic/devices.yaml";
};

TEST_F(HandsTest, AreWrittenInPlaceOfTheOldFile) {
  hands_.save(path_);
  EXPECT_EQ(textOf(path_), tgr::toYaml(hands_.config()));
  EXPECT_FALSE(fs::exists(path_ + ".new"));
}

TEST_F(HandsTest, LeaveTheOldFileWhenTheDiskIsFull) {
  std::string refusal;
  {
    const FullDisk disk;
    refusal = refusalOf(path_);
  }
  EXPECT_EQ(refusal, path_ + ": cannot be written: File too large");
  EXPECT_EQ(textOf(path_), "the old calibration");
  EXPECT_FALSE(fs::exists(path_ + ".new"));
}

TEST_F(HandsTest, AreWrittenToWhatALinkPointsTo) {
  const std::string link = path_ + ".link";
  fs::create_symlink(path_, link);
  hands_.save(link);
  EXPECT_TRUE(fs::is_symlink(link));
  fs::remove(link);
  EXPECT_EQ(textOf(path_), tgr::toYaml(hands_.config()));
}

TEST_F(HandsTest, ReplaceNothingButFiles) {
  const std::string folder = folder_ + "/ergotic/folder";
  fs::create_directories(folder);
  EXPECT_EQ(refusalOf(folder), folder + ": cannot be written, allowed: a file");
  EXPECT_TRUE(fs::is_directory(folder));
  EXPECT_THAT(refusalOf("/dev/null"),
              HasSubstr("cannot be written, allowed: files below " + folder_));
}

EndEffector handle() {
  EndEffector message;
  message.name = "handle";
  message.type = EndEffector::HANDLE;
  message.slices = {5, 4, 3, 2, 1, 0};
  message.ports = {"ax", "ay", "az", "bx", "by", "bz", "cx", "", "cz"};
  message.points.resize(3);
  message.points[1].x = 0.02;
  message.points[2].y = 0.03;
  message.position_scale = 2.0;
  message.force_scale = 0.5;
  message.rod = 0.17;
  message.base_radius = 0.09;
  message.platform_radius = 0.04;
  message.pose.position.x = 0.1;
  message.pose.orientation.z = std::sqrt(0.5);
  message.pose.orientation.w = std::sqrt(0.5);
  return message;
}

std::string refusalOfHand(const EndEffector& message) {
  return complaintOf<TextError>([&] { fromMessages({message}); });
}

TEST(EndEffectorsTest, SurviveTheWayThereAndBack) {
  const EndEffector sent = handle();
  const EndEffector back = toMessages(fromMessages({sent})).front();
  EXPECT_EQ(back.name, sent.name);
  EXPECT_EQ(back.type, sent.type);
  EXPECT_EQ(back.slices, sent.slices);
  EXPECT_EQ(back.ports, sent.ports);
  EXPECT_EQ(back.points, sent.points);
  EXPECT_EQ(back.position_scale, sent.position_scale);
  EXPECT_EQ(back.force_scale, sent.force_scale);
  EXPECT_EQ(back.rod, sent.rod);
  EXPECT_EQ(back.base_radius, sent.base_radius);
  EXPECT_EQ(back.platform_radius, sent.platform_radius);
  EXPECT_EQ(back.pose.position.x, sent.pose.position.x);
  EXPECT_NEAR(back.pose.orientation.z, sent.pose.orientation.z, 1e-12);
}

TEST(EndEffectorsTest, TakeTheUsualNumbersForThoseLeftOut) {
  EndEffector message;
  message.name = "key";
  message.slices = {0};
  message.ports = {"hammer"};
  const tgr::EndEffectorConfig config = fromMessages({message}).list.front();
  const tgr::EndEffectorConfig usual;
  EXPECT_EQ(config.position_scale, usual.position_scale);
  EXPECT_EQ(config.force_scale, usual.force_scale);
  EXPECT_EQ(config.lever, usual.lever);
  EXPECT_TRUE(config.pose.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(EndEffectorsTest, AreNoneWhenThereAreNone) {
  EXPECT_TRUE(fromMessages({}).list.empty());
}

TEST(EndEffectorsTest, AreRefusedWithTheirNameForWhatNoYamlMaySay) {
  EndEffector message = handle();
  message.type = 5;
  EXPECT_THAT(refusalOfHand(message), HasSubstr("'handle': type is 5, allowed: 0...4"));
  message = handle();
  message.slices[2] = 64;
  EXPECT_THAT(refusalOfHand(message), HasSubstr("'handle': slice is 64, allowed: 0...63"));
  message = handle();
  message.rod = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusalOfHand(message), HasSubstr("rod"));
  message = handle();
  message.points.pop_back();
  EXPECT_NE(refusalOfHand(message), "");
}

TEST(EndEffectorsTest, AreRefusedWithNumbersThatAreNone) {
  using Damage = void (*)(EndEffector&, double);
  const Damage damages[] = {
      [](EndEffector& e, double v) { e.position_scale = v; },
      [](EndEffector& e, double v) { e.force_scale = v; },
      [](EndEffector& e, double v) { e.rod = v; },
      [](EndEffector& e, double v) { e.base_radius = v; },
      [](EndEffector& e, double v) { e.platform_radius = v; },
      [](EndEffector& e, double v) { e.points[1].y = v; },
      [](EndEffector& e, double v) { e.pose.position.x = v; },
      [](EndEffector& e, double v) { e.pose.orientation.w = v; },
  };
  for (const Damage damage : damages) {
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      EndEffector message = handle();
      damage(message, value);
      EXPECT_THAT(refusalOfHand(message), HasSubstr("allowed: ")) << value;
    }
  }
  EndEffector huge = handle();
  huge.pose.orientation.w = 1e300;
  EXPECT_THAT(refusalOfHand(huge),
              HasSubstr("'handle': the norm of its orientation is inf, allowed: "));
}

TEST(EndEffectorFramesTest, FollowTheirSlicesInTheFrameOfTheDevice) {
  EndEffector bow;
  bow.name = "bow";
  bow.type = EndEffector::BOW;
  bow.slices = {3, 1};
  bow.ports = {"along", "pressure"};
  bow.pose.position.y = 0.5;
  EndEffectorFrames frames(fromMessages({bow}));
  station::Snapshot snapshot;
  snapshot.slices = 4;
  snapshot.slice_position = {0.0, 0.002, 0.0, 0.01};
  const auto transforms = frames.at(snapshot, ::ros::Time(7.0));
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].header.frame_id, "tgr_base");
  EXPECT_EQ(transforms[0].child_frame_id, "bow");
  EXPECT_EQ(transforms[0].header.stamp, ::ros::Time(7.0));
  EXPECT_NEAR(transforms[0].transform.translation.x, 0.01, 1e-12);
  EXPECT_NEAR(transforms[0].transform.translation.y, 0.5, 1e-12);
  EXPECT_NEAR(transforms[0].transform.translation.z, 0.002, 1e-12);
  EXPECT_EQ(transforms[0].transform.rotation.w, 1.0);
}

TEST(EndEffectorFramesTest, StandBehindThePrefixOfTheStation) {
  EndEffectorFrames frames(fromMessages({handle()}), FrameNames("left"));
  const auto transforms = frames.at(station::Snapshot(), ::ros::Time(1.0));
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].header.frame_id, "left/tgr_base");
  EXPECT_EQ(transforms[0].child_frame_id, "left/handle");
  for (const auto& shape : frames.shapes(::ros::Time(1.0)).markers) {
    EXPECT_EQ(shape.header.frame_id, "left/handle");
  }
}

TEST(EndEffectorFramesTest, DrawEachPointOfAHandleInItsOwnFrame) {
  EndEffectorFrames frames(fromMessages({handle()}));
  const auto& shapes = frames.shapes(::ros::Time(1.0)).markers;
  ASSERT_EQ(shapes.size(), 4U);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_EQ(shapes[i].header.frame_id, "handle");
    EXPECT_EQ(shapes[i].id, static_cast<int>(i));
  }
  EXPECT_EQ(shapes[2].pose.position.x, 0.02);
  EXPECT_EQ(shapes[3].pose.position.y, 0.03);
}

}  // namespace
}  // namespace ergotic::node
