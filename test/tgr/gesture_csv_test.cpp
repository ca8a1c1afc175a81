// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "ergotic/tgr/replay_driver.hpp"
#include "support/scratch_file.hpp"

namespace ergotic::tgr {
namespace {

using test::ScratchFile;
using Pair = std::array<double, 2>;

std::string errorOf(const std::string& text) {
  const ScratchFile file(text);
  try {
    readPositionsCsv(file.path());
  } catch (const TextError& error) {
    return std::string(error.what()).substr(file.path().size());
  }
  return "accepted";
}

TEST(PositionsCsvTest, GivesEveryDoubleBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  const std::array<Pair, 4> written{{{0.1, -1.0 / 3.0},
                                     {Limits::denorm_min(), -0.0},
                                     {Limits::max(), Limits::min()},
                                     {0.1 + Limits::epsilon(), 1e-17}}};
  const ScratchFile file;
  {
    const auto sink = writePositionsCsv(file.path(), 2);
    for (std::size_t n = 0; n < written.size(); ++n) {
      sink->write(static_cast<std::int64_t>(n) + 700, written[n].data());
    }
  }
  const auto source = readPositionsCsv(file.path());
  ASSERT_EQ(source->slices(), 2);
  for (const Pair& expected : written) {
    Pair read{};
    ASSERT_TRUE(source->next(read.data()));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(read[i], expected[i]);
      EXPECT_EQ(std::signbit(read[i]), std::signbit(expected[i]));
    }
  }
  Pair untouched{5.0, 6.0};
  EXPECT_FALSE(source->next(untouched.data()));
  EXPECT_FALSE(source->next(untouched.data()));
  EXPECT_EQ(untouched, (Pair{5.0, 6.0}));
}

TEST(PositionsCsvTest, SaysWhereTheFileIsWrong) {
  EXPECT_EQ(errorOf(""), ":1:1: error: no header line, expected tick,x0,...");
  EXPECT_EQ(errorOf("0,0.1\n"), ":1:1: error: header '0', expected 'tick'");
  EXPECT_EQ(errorOf("tick\n"), ":1:1: error: 1 columns, expected 2");
  EXPECT_EQ(errorOf("tick,x1\n"), ":1:6: error: header 'x1', expected 'x0'");
  EXPECT_EQ(errorOf("tick,x0\n5,0\n7,0\n"), ":3:1: error: tick '7', allowed 6...6");
  EXPECT_EQ(errorOf("tick,x0\n-1,0\n").substr(0, 22), ":2:1: error: tick '-1'");
  EXPECT_EQ(errorOf("tick,x0\n0,nan\n").substr(0, 27), ":2:3: error: position 'nan'");
  EXPECT_EQ(errorOf("tick,x0,x1\n0,0\n"), ":2:3: error: 2 columns, expected 3");
}

TEST(PositionsCsvTest, RefusesPathsThatCannotBeUsed) {
  EXPECT_THROW(readPositionsCsv("/nowhere/x.csv"), Exception);
  EXPECT_THROW(writePositionsCsv("/nowhere/x.csv", 2), Exception);
  EXPECT_THROW(writePositionsCsv("/dev/full", 2), Exception);
}

TEST(GestureKindTest, IsToldByTheFirstLineThatIsNotAComment) {
  EXPECT_EQ(gestureKindOf(ScratchFile("# x\ntick,x0\n").path()), GestureKind::kPositions);
  EXPECT_EQ(gestureKindOf(ScratchFile("time_s,slice,target_m\n").path()), GestureKind::kTargets);
  EXPECT_EQ(gestureKindOf(ScratchFile("0,0,0.01\n").path()), GestureKind::kTargets);
}

TEST(ReplayDriverTest, PlaysTheRecordedPositionsThenHoldsTheLastAndSaysSo) {
  const ScratchFile file("tick,x0,x1\n3,0.01,0.02\n4,0.03,0.04\n");
  const auto driver = makeReplayDriver(readPositionsCsv(file.path()));
  EXPECT_EQ(driver->slices(), 2);
  driver->open(1000.0);
  const Pair forces{7.0, 7.0};
  Pair x{};
  EXPECT_EQ(driver->exchange(forces.data(), x.data()), kExchangeOk);
  EXPECT_EQ(x, (Pair{0.01, 0.02}));
  EXPECT_EQ(driver->exchange(forces.data(), x.data()), kExchangeOk);
  EXPECT_EQ(x, (Pair{0.03, 0.04}));
  for (int n = 0; n < 3; ++n) {
    x = {};
    EXPECT_EQ(driver->exchange(forces.data(), x.data()), kMissingSample);
    EXPECT_EQ(x, (Pair{0.03, 0.04}));
  }
}

}  // namespace
}  // namespace ergotic::tgr
