// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/gesture.hpp"
#include "ergotic/tgr/replay_driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/target_gesture.hpp"

namespace ergotic::tgr {
namespace {

using test::ScratchFile;
using Pair = std::array<double, 2>;

std::string positionsError(const std::string& text) {
  const ScratchFile file(text);
  const std::string complaint = complaintOf<TextError>([&] { readPositionsCsv(file.path()); });
  return complaint.substr(std::min(complaint.size(), file.path().size()));
}

TEST(PositionsCsvTest, GivesEveryDoubleBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  const std::array<Pair, 4> written{{{0.1, -1.0 / 3.0},
                                     {Limits::denorm_min(), -0.0},
                                     {-1e30, Limits::min()},
                                     {0.1 + Limits::epsilon(), 1e-17}}};
  const ScratchFile file;
  {
    std::ofstream out(file.path());
    out << "tick,x0,x1\n" << std::setprecision(Limits::max_digits10);
    for (std::size_t n = 0; n < written.size(); ++n) {
      out << n + 700 << ',' << written[n][0] << ',' << written[n][1] << '\n';
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
  EXPECT_EQ(positionsError(""),
            ":1:1: error: no line tick,x0,... above the rows, allowed: positions of every tick");
  EXPECT_THAT(positionsError("# of a hand\n0,0.1\n"), StartsWith(":2:1: error: no line tick,x0"));
  EXPECT_EQ(positionsError("tick\n"), ":1:5: error: column '' of the header, allowed: x0");
  EXPECT_EQ(positionsError("tick,x1\n"), ":1:6: error: column 'x1' of the header, allowed: x0");
  EXPECT_EQ(positionsError("tick,x0\n5,0\n7,0\n"),
            ":3:1: error: tick = 7, allowed: 6, each tick has a row");
  EXPECT_THAT(positionsError("tick,x0\n-1,0\n"), StartsWith(":2:1: error: tick = -1 is out of"));
  EXPECT_THAT(positionsError("tick,x0\n0,nan\n"), StartsWith(":2:3: error: position = 'nan' is"));
  EXPECT_EQ(positionsError("tick,x0,x1\n0,0\n"),
            ":2:4: error: position is missing, allowed: a tick and 2 positions in a line");
  EXPECT_THAT(positionsError("tick,x0\n9223372036854775806,0\n"),
              StartsWith(":2:1: error: tick = 9.22337203685e+18 is out of range"));
}

TEST(PositionsCsvTest, RefusesPathsThatCannotBeUsed) {
  EXPECT_THROW(readPositionsCsv("/nowhere/x.csv"), Exception);
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

TargetGesture parse(const std::string& text, int slices = 2) {
  std::istringstream in(text);
  return {in, "g.csv", slices};
}

std::string targetsError(const std::string& text) {
  return complaintOf<TextError>([&] { parse(text); });
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

TEST(TargetGestureTest, MovesOnStraightLinesBetweenRecordedTicks) {
  TargetGesture gesture = parse("tick,x0,x1\n7,0.01,0\n8,0.03,-0.02\n9,0.03,-0.06\n", /*slices=*/3);
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
  EXPECT_EQ(targetsError("tick,x0,x1\n0,0,0\n1,0,0.11\n"),
            "g.csv:3:5: error: position = 0.11 m is out of range, allowed: -0.1...0.1 m");
  EXPECT_EQ(targetsError("tick,x0,x1,x2\n0,0,0,0\n"),
            "g.csv:1:12: error: columns of more than 2 slices, allowed: at most 2");
}

TEST(TargetGestureTest, SaysWhereARowIsWrong) {
  const std::string ok = "0,0,0\n";
  EXPECT_EQ(targetsError(ok + "0,0,0.01\n"),
            "g.csv:2:1: error: time_s = 0 s is not after the slice's row before it, by 1e-9 s at "
            "least");
  EXPECT_THAT(targetsError(ok + "5e-324,0,0.01\n"),
              StartsWith("g.csv:2:1: error: time_s = 4.94065645841e-324 s is not after"));
  EXPECT_EQ(targetsError(ok + "1, 2,0\n"),
            "g.csv:2:4: error: slice = 2 is out of range, allowed: 0...1");
  EXPECT_EQ(targetsError(ok + "1,-1,0\n"),
            "g.csv:2:3: error: slice = -1 is out of range, allowed: 0...1");
  EXPECT_EQ(targetsError(ok + "1,0.5,0\n"),
            "g.csv:2:3: error: slice = 0.5, allowed: whole numbers");
  EXPECT_EQ(targetsError(ok + "1,0,0.11\n"),
            "g.csv:2:5: error: target_m = 0.11 m is out of range, allowed: -0.1...0.1 m");
  EXPECT_EQ(targetsError(ok + "1,0,nan\n"),
            "g.csv:2:5: error: target_m = 'nan' is not a finite number, allowed: -0.1...0.1 m");
  EXPECT_EQ(targetsError(ok + "inf,0,0\n"),
            "g.csv:2:1: error: time_s = 'inf' is not a finite number, allowed: 0...1000000 s");
  EXPECT_EQ(targetsError(ok + "1,0\n"),
            "g.csv:2:4: error: target_m is missing, allowed: time_s,slice,target_m, or "
            "time_s,$parameter,value");
  EXPECT_EQ(targetsError(ok + "1,0,0,7\n"),
            "g.csv:2:7: error: more than 3 fields in a line, allowed: time_s,slice,target_m, or "
            "time_s,$parameter,value");
  EXPECT_THAT(targetsError(ok + "1,0,0.01x\n"),
              StartsWith("g.csv:2:5: error: target_m = '0.01x' is not a finite number"));
  EXPECT_EQ(targetsError("time_s,slice\n"),
            "g.csv:1:13: error: column '' of the header, allowed: time_s,slice,target_m, or "
            "tick,x0,x1,...");
  EXPECT_THAT(targetsError("time_s,key,target_m\n"),
              StartsWith("g.csv:1:8: error: column 'key' of the header, allowed: time_s,slice"));
}

/// What spreadsheets and scripts write.
TEST(TargetGestureTest, ReadsFilesOfAnyProgram) {
  const std::string header = "time_s,slice,target_m\n";
  for (const std::string& text : std::vector<std::string>{
           "\xEF\xBB\xBFtime_s,slice,target_m\r\n0,1,0.01\r\n1,1,0.03\r\n",
           "time_s,slice,target_m\r0,1,0.01\r1,1,0.03\r",
           header + "+0.0,+1,+0.01\n+1.0e0,1.0,+3.0E-02\n",
           "Time_S,SLICE,Target_m\n0,1,0.01\n1,1,0.03\n",
           "\"time_s\",\"slice\",\"target_m\"\n\"0\",\"1\",\" 0.01\"\n\"1\",1,\"0.03\"\n",
           "sep=,\n" + header + "0,1,0.01,,\n,,,\n1,1,0.03,,\n",
           "\"SEP=,\"\r\n" + header + "# \xFC; 0,5\n0,1,0.01  # start\n1\t1\t0.03\n",
       }) {
    const TargetGesture gesture = parse(text);
    EXPECT_DOUBLE_EQ(gesture.at(1, 0.5).position, 0.02) << text;
    EXPECT_EQ(gesture.at(1, 2.0).position, 0.03) << text;
  }
}

TEST(TargetGestureTest, SaysHowToSaveWhatItCannotRead) {
  EXPECT_EQ(targetsError("time_s;slice;target_m\n0;0;0\n0,5;0;0,02\n"),
            "g.csv:1:7: error: a semicolon separates the fields, as spreadsheets write it where "
            "numbers have commas, allowed: commas between the fields and points in the numbers "
            "(in a spreadsheet, save as CSV with English number formats)");
  EXPECT_THAT(targetsError("0,0,0\n\"0,5\",0,0.02\n"),
              StartsWith("g.csv:2:1: error: time_s = '0,5' has a decimal comma, allowed: commas"));
  EXPECT_THAT(targetsError("0\t0\t0\n0,5\t0\t0,02\n"),
              StartsWith("g.csv:2:2: error: a comma between digits, where blanks separate"));
  EXPECT_THAT(targetsError("sep=;\n0;0;0\n"),
              StartsWith("g.csv:1:1: error: the line names another separator"));
  EXPECT_THAT(targetsError(std::string("\xFF\xFE"
                                       "0\0,\0"
                                       "0\0,\0"
                                       "0\0\n\0",
                                       14)),
              StartsWith("g.csv:1:1: error: the text is UTF-16, which has two bytes for each "
                         "letter, allowed: UTF-8"));
}

TEST(TargetGestureTest, PassesRowsOverThatSetParameters) {
  const TargetGesture gesture = parse("0,0,0.01\n1,$tension,80\n2,0,0.03\n0.5,$loss,1e9\n");
  EXPECT_DOUBLE_EQ(gesture.at(0, 1.0).position, 0.02);
  EXPECT_TRUE(gesture.rangeOf(1).is_empty);
}

std::string valuesError(const std::string& rows) {
  const ScratchFile file(rows);
  const std::string complaint = complaintOf<TextError>([&] { readGestureValues(file.path()); });
  return complaint.substr(std::min(complaint.size(), file.path().size()));
}

TEST(GestureValuesTest, AreRowsThatNameAParameterInOrderOfTime) {
  const ScratchFile file(
      "time_s,slice,target_m\n0,0,0\n2,$loss,1e-5\n1.5, \"$tension\", 80\n1.5,$volume,-2\n");
  const std::vector<GestureValue> values = readGestureValues(file.path());
  ASSERT_EQ(values.size(), 3U);
  EXPECT_EQ(values[0].parameter, "tension");
  EXPECT_EQ(values[0].time_s, 1.5);
  EXPECT_EQ(values[0].value, 80.0);
  EXPECT_EQ(values[0].file, file.path());
  EXPECT_EQ(values[0].name_at.line, 4);
  EXPECT_EQ(values[0].name_at.column, 6);
  EXPECT_EQ(values[0].value_at.column, 18);
  EXPECT_EQ(values[1].value, -2.0);
  EXPECT_EQ(values[2].time_s, 2.0);
  EXPECT_THAT(readGestureValues(""), IsEmpty());
  EXPECT_THAT(readGestureValues(ScratchFile("tick,x0\n0,0\n").path()), IsEmpty());
  EXPECT_THROW(readGestureValues("/nowhere/g.csv"), Exception);
}

TEST(GestureValuesTest, SayWhereARowIsWrong) {
  EXPECT_EQ(valuesError("1,$loss,2\n1,$tension,2\n1,$loss,3\n"),
            ":3:1: error: time_s = 1 s is not after the parameter's row before it, by 1e-9 s at "
            "least");
  EXPECT_EQ(valuesError("1,$loss,nan\n"),
            ":1:9: error: value = 'nan' is not a finite number, allowed: any finite number");
  EXPECT_EQ(valuesError("1,$,2\n"),
            ":1:3: error: the name of a parameter is missing, allowed: time_s,slice,target_m, or "
            "time_s,$parameter,value");
  EXPECT_THAT(valuesError("1,$loss\n"), StartsWith(":1:8: error: value is missing, allowed: time"));
  EXPECT_THAT(valuesError("1,$loss,2,3\n"), StartsWith(":1:11: error: more than 3 fields"));
  EXPECT_THAT(valuesError("-1,$loss,2\n"),
              StartsWith(":1:1: error: time_s = -1 s is out of range"));
}

TEST(GestureValuesTest, FitAScene) {
  scene::Parameter loss;
  loss.name = "loss";
  scene::Parameter tension;
  tension.name = "tension";
  tension.minimum = 10.0;
  tension.maximum = 90.0;
  tension.unit = "N";
  const std::vector<scene::Parameter> parameters{loss, tension};
  GestureValue value{1.5, "tension", 90.0, "g.csv", {4, 6}, {4, 15}};
  EXPECT_EQ(parameterOf(value, parameters), 1U);
  value.value = 90.5;
  EXPECT_EQ(complaintOf<TextError>([&] { parameterOf(value, parameters); }),
            "g.csv:4:15: error: tension = 90.5 N is out of range, allowed: 10...90 N");
  value.parameter = "tensio";
  EXPECT_EQ(complaintOf<TextError>([&] { parameterOf(value, parameters); }),
            "g.csv:4:6: error: the scene has no parameter 'tensio'; did you mean 'tension'?");
  EXPECT_EQ(complaintOf<TextError>([&] { parameterOf(value, {}); }),
            "g.csv:4:6: error: the scene has no parameter 'tensio', and no other");
}

TEST(TargetGestureTest, RefusesAFileThatIsNotThere) {
  EXPECT_THROW(readTargetGesture("/nowhere/g.csv", 1), Exception);
}

/// Of a device of six slices, with ports at the first two.
std::vector<std::string> gestureWarningsOf(const std::string& rows,
                                           double seconds = 4.0,
                                           double late_s = 0.0) {
  const ScratchFile file("time_s,slice,target_m\n" + rows);
  VirtualDriverConfig config;
  config.slices = 6;
  config.gesture_file = file.path();
  config.others[1].stop = 0.1;
  return gestureWarnings(config, 0b11, seconds, late_s);
}

TEST(GestureWarningsTest, SayWhatIsNotPlayedAsItIsWritten) {
  EXPECT_THAT(gestureWarningsOf("0,0,0\n1,0,0.03\n"), testing::IsEmpty());
  EXPECT_THAT(gestureWarningsOf("0,0,0\n1,0,-0.08\n2,0,0.04\n"),
              testing::ElementsAre(HasSubstr("a target of slice 0 is -0.08 m; the slice stops at "
                                             "+-0.03 m")));
  EXPECT_THAT(gestureWarningsOf("0,1,0.08\n"), testing::IsEmpty()) << "it has a longer way";
  EXPECT_THAT(gestureWarningsOf("0,5,0\n0,3,0\n"),
              testing::ElementsAre(HasSubstr("it moves slices 3, 5, which no port")));
  EXPECT_THAT(gestureWarningsOf("0,0,0\n1000,0,0.01\n", 1.0),
              testing::ElementsAre(HasSubstr("the gesture ends 999 s after the render does, at "
                                             "1000 s; times are in seconds")));
  EXPECT_THAT(gestureWarningsOf("0,0,0\n9,0,0.01\n", 1.0, 9.0), testing::IsEmpty());
  EXPECT_THAT(gestureWarningsOf("0,0,0\n1000,0,0.01\n", 1.0, 9.0), testing::SizeIs(1));
  EXPECT_THAT(gestureWarningsOf(""), testing::ElementsAre(HasSubstr("has no rows")));
  EXPECT_THAT(gestureWarningsOf("0,$loss,1\n"), testing::IsEmpty());
  EXPECT_THAT(gestureWarningsOf("0,0,0\n7,$loss,1\n"),
              testing::ElementsAre(HasSubstr("the gesture ends 3 s after the render does")));
}

}  // namespace
}  // namespace ergotic::tgr
