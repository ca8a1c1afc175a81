// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/target_gesture.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"

namespace ergotic::tgr {
namespace {

TargetGesture parse(const std::string& text, int slices = 2) {
  std::istringstream in(text);
  return {in, "g.csv", slices};
}

std::string errorOf(const std::string& text) {
  try {
    parse(text);
  } catch (const TextError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TargetGestureTest, MovesOnStraightLinesBetweenRows) {
  const TargetGesture gesture = parse("time_s,slice,target_m\n1,0,0.01\n3,0,-0.03\n");
  EXPECT_DOUBLE_EQ(gesture.at(0, 1.0).position, 0.01);
  EXPECT_DOUBLE_EQ(gesture.at(0, 1.5).position, 0.0);
  EXPECT_DOUBLE_EQ(gesture.at(0, 1.5).velocity, -0.02);
  EXPECT_DOUBLE_EQ(gesture.at(0, 3.0).position, -0.03);
}

TEST(TargetGestureTest, HoldsTheFirstTargetBeforeAndTheLastAfter) {
  const TargetGesture gesture = parse("1,0,0.01\n3,0,-0.03\n");
  EXPECT_EQ(gesture.at(0, 0.0).position, 0.01);
  EXPECT_EQ(gesture.at(0, 0.0).velocity, 0.0);
  EXPECT_EQ(gesture.at(0, 99.0).position, -0.03);
  EXPECT_EQ(gesture.at(0, 99.0).velocity, 0.0);
}

TEST(TargetGestureTest, LetsSlicesInterleaveAndRestWithoutRows) {
  const TargetGesture gesture = parse("0,2,0.01\n0,0,0.02\n1,2,0.03\n0.5,0,0.04\n", 3);
  EXPECT_DOUBLE_EQ(gesture.at(2, 0.5).position, 0.02);
  EXPECT_DOUBLE_EQ(gesture.at(0, 0.25).position, 0.03);
  EXPECT_EQ(gesture.at(1, 0.5).position, 0.0);
}

TEST(TargetGestureTest, SkipsCommentsBlankLinesSpacesAndCarriageReturns) {
  const TargetGesture gesture =
      parse("# a pluck\r\n\r\n time_s , slice,target_m\r\n 0 , 1 , 0.02 \r\n");
  EXPECT_EQ(gesture.at(1, 0.0).position, 0.02);
}

class Rows final : public GestureSource {
 public:
  explicit Rows(std::vector<std::array<double, 2>> rows) : rows_(std::move(rows)) {}
  int slices() const noexcept override { return 2; }
  bool next(double* positions) noexcept override {
    if (row_ == rows_.size()) {
      return false;
    }
    std::copy_n(rows_[row_++].begin(), 2, positions);
    return true;
  }

 private:
  std::vector<std::array<double, 2>> rows_;
  std::size_t row_ = 0;
};

TEST(TargetGestureTest, MovesOnStraightLinesBetweenRecordedTicks) {
  Rows rows({{0.01, 0.0}, {0.03, -0.02}, {0.03, -0.06}});
  TargetGesture gesture(rows, "p.csv", 3);
  gesture.setTickRate(100.0);
  EXPECT_DOUBLE_EQ(gesture.at(0, 0.0).position, 0.01);
  EXPECT_DOUBLE_EQ(gesture.at(0, 0.005).position, 0.02);
  EXPECT_DOUBLE_EQ(gesture.at(0, 0.005).velocity, 2.0);
  EXPECT_DOUBLE_EQ(gesture.at(1, 0.015).position, -0.04);
  EXPECT_DOUBLE_EQ(gesture.at(1, 0.015).velocity, -4.0);
  EXPECT_EQ(gesture.at(1, 1.0).position, -0.06);
  EXPECT_EQ(gesture.at(1, 1.0).velocity, 0.0);
  EXPECT_EQ(gesture.at(2, 0.01).position, 0.0) << "was not recorded";
}

TEST(TargetGestureTest, RefusesRecordedPositionsThatNoHandCanFollow) {
  Rows far({{0.0, 0.0}, {0.0, 0.11}});
  EXPECT_THROW(TargetGesture(far, "p.csv", 2), Exception);
  Rows many({{0.0, 0.0}});
  EXPECT_THROW(TargetGesture(many, "p.csv", 1), Exception);
}

TEST(TargetGestureTest, SaysWhereARowIsWrong) {
  const std::string ok = "0,0,0\n";
  EXPECT_EQ(errorOf(ok + "0,0,0.01\n"),
            "g.csv:2:1: error: time_s '0' is not after the slice's row before it");
  EXPECT_EQ(errorOf(ok + "1, 2,0\n"), "g.csv:2:4: error: slice '2', allowed 0...1");
  EXPECT_EQ(errorOf(ok + "1,-1,0\n"), "g.csv:2:3: error: slice '-1', allowed 0...1");
  EXPECT_EQ(errorOf(ok + "1,0,0.11\n"), "g.csv:2:5: error: target_m '0.11', allowed -0.1...0.1");
  EXPECT_EQ(errorOf(ok + "1,0,nan\n"), "g.csv:2:5: error: target_m 'nan', allowed -0.1...0.1");
  EXPECT_EQ(errorOf(ok + "inf,0,0\n"), "g.csv:2:1: error: time_s 'inf', allowed 0...1e+06");
  EXPECT_EQ(errorOf(ok + "1,0\n"), "g.csv:2:3: error: 2 columns, expected 3");
  EXPECT_EQ(errorOf(ok + "1,0,0,7\n"), "g.csv:2:7: error: 4 columns, expected 3");
  EXPECT_EQ(errorOf(ok + "1,0,0.01x\n"), "g.csv:2:5: error: target_m '0.01x', allowed -0.1...0.1");
  EXPECT_EQ(errorOf("time_s,slice\n"), "g.csv:1:8: error: 2 columns, expected 3");
  EXPECT_EQ(errorOf("time_s,key,target_m\n"),
            "g.csv:1:8: error: header, expected time_s,slice,target_m");
}

TEST(TargetGestureTest, RefusesAFileThatIsNotThere) {
  EXPECT_THROW(readTargetGesture("/nowhere/g.csv", 1), Exception);
}

}  // namespace
}  // namespace ergotic::tgr
