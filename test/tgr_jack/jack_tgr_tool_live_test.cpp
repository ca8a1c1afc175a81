// SPDX-License-Identifier: BSD-3-Clause
// `rosrun ergotic jack_tgr` as another process, at the other side of a driver.
#include <future>

#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::Outcome;

/// Force is what a spring of -1 V/V gives, and a constant.
class SpringTarget : public test::TickCounter {
 public:
  SpringTarget(Driver& driver, double constant) : TickCounter(driver), constant_(constant) {}

 protected:
  void computeForces(std::int64_t /*tick*/) noexcept override {
    for (std::size_t i = 0; i < test::kJackSlices; ++i) {
      forces_[i] = constant_ - positions_[i];
    }
  }

 private:
  double constant_;
};

class JackTgrToolTest : public ::testing::Test {
 protected:
  JackTgrToolTest() { server_.start(); }

  /// The tool with these arguments, driven until it ends.
  Outcome outcomeOf(const std::string& arguments, double constant) {
    const std::string words = "--server " + server_.name() + " --client device --slices 3 ";
    auto tool =
        std::async(std::launch::async, [&] { return test::run("jack_tgr", words + arguments); });
    JackDriver driver(test::jackDriver(server_));
    driver.open(3000.0);
    SpringTarget spring(driver, constant);
    driver.clock()->start(spring);
    const Outcome outcome = tool.get();
    driver.clock()->stop();
    return outcome;
  }

  test::JackServer server_{"tool", test::serverSettings(48000, 64)};
};

TEST_F(JackTgrToolTest, MeasuresALatencyThatNobodyDeclared) {
  const Outcome outcome =
      outcomeOf("--measure 20 --slice 1 --latency-frames 37 --undeclared --seconds 60", 0.0);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              HasSubstr("\"round_trip_frames\":101,\"tick_frames\":16,\"declared_frames\":64}"));
}

TEST_F(JackTgrToolTest, LogsWhatItFeelsAndIsLeftWithoutForce) {
  const test::ScratchFile log;
  const Outcome outcome = outcomeOf("--seconds 3 --log " + log.path(), 0.05);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  std::ifstream file(log.path());
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "time_ns,slice,force_n");
  std::array<double, test::kJackSlices> last{};
  std::array<double, test::kJackSlices> largest{};
  for (std::int64_t before_ns = 0; std::getline(file, line);) {
    std::int64_t time_ns = 0;
    std::size_t slice = 0;
    char comma = 0;
    double force = 0.0;
    std::istringstream(line) >> time_ns >> comma >> slice >> comma >> force;
    ASSERT_GE(time_ns, before_ns) << line;
    ASSERT_LT(slice, last.size()) << line;
    before_ns = time_ns;
    last[slice] = force;
    largest[slice] = std::max(largest[slice], force);
  }
  for (std::size_t i = 0; i < last.size(); ++i) {
    EXPECT_GT(largest[i], 5.0);
    EXPECT_EQ(last[i], 0.0);
  }
}

TEST_F(JackTgrToolTest, SaysThatNothingAnswered) {
  const Outcome outcome =
      test::run("jack_tgr", "--server " + server_.name() + " --measure 2 --slices 1");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("\"answered\":0"));
}

TEST_F(JackTgrToolTest, RefusesASliceThatItDoesNotHave) {
  const Outcome outcome = test::run("jack_tgr", "--measure 2 --slices 2 --slice 2");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("slice: 2 , allowed 0...1"));
}

}  // namespace
}  // namespace ergotic::tgr
