// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <cstdio>

#include "comedi/comedi_rig.hpp"
#include "support/period_probe.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

/// A program that knows of libcomedi only, with the stand-in preloaded by its environment.

namespace ergotic::test {
namespace {

std::string outputOf(const std::string& environment, const std::string& arguments) {
  // The runtime of AddressSanitizer wants to come first, and comes with the stand-in.
  const std::string command = "env ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 " +
                              environment + " " COMEDI_PROBE " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), got);
  }
  pclose(pipe);
  return text;
}

const std::string kPreload = "LD_PRELOAD=" COMEDI_STANDIN " ";
const std::string kOneSlice = "'{ai_channels: [0], ao_channels: [0]}' ";

TEST(ComediPreloadTest, TakesThePlaceOfLibcomedi) {
  std::istringstream lines(
      outputOf(kPreload + "COMEDI_STANDIN_RATE_HZ=2000", kOneSlice + "0.5 2000"));
  unsigned flags = 1;
  double volts = 0.0;
  int ticks = 0;
  while (lines >> flags >> volts) {
    EXPECT_EQ(flags, 0U);
    ++ticks;
  }
  EXPECT_EQ(ticks, 2000);
  // 10 N against a hand of 500 N/m, settled as far as 0.1 N of friction lets it.
  EXPECT_NEAR(volts * kMetresPerVolt, 10.0 / 500.0, 0.1 / 500.0 + 1e-5);
}

TEST(ComediPreloadTest, MeetsTheFaultsOfTheEnvironment) {
  const std::string text =
      outputOf(kPreload + "COMEDI_STANDIN_FAULTS=eio:0:2:1,unplug:0:4", kOneSlice + "0 6");
  std::istringstream lines(text);
  std::vector<unsigned> all;
  unsigned flags = 0;
  double volts = 0.0;
  while (lines >> flags >> volts) {
    all.push_back(flags);
  }
  const unsigned failed = tgr::kMissingSample | tgr::kWriteFailed;
  // The first list is the one of open.
  EXPECT_THAT(all,
              ElementsAre(0U, failed, 0U, tgr::kDeviceLost, tgr::kDeviceLost, tgr::kDeviceLost))
      << text;
}

double voltsAtTerminals(const std::string& path) {
  double volts = std::nan("");
  std::ifstream(path).read(reinterpret_cast<char*>(&volts), sizeof volts);
  return volts;
}

class ComediGuardianTest : public ::testing::TestWithParam<int> {};

TEST_P(ComediGuardianTest, TakesTheVoltsOffABoardWhoseProgramDies) {
  const ScratchFile terminals;
  const std::string environment =
      kPreload + "COMEDI_STANDIN_TERMINALS=" + terminals.path() + " timeout -s KILL 1";
  const std::string text =
      outputOf(environment, kOneSlice + "0.75 20 " + std::to_string(GetParam()));
  EXPECT_GE(std::count(text.begin(), text.end(), '\n'), 20) << text;
  EXPECT_TRUE(eventually([&] { return std::abs(voltsAtTerminals(terminals.path())) < 0.001; }))
      << voltsAtTerminals(terminals.path()) << " V";
}
INSTANTIATE_TEST_SUITE_P(Ended,
                         ComediGuardianTest,
                         ::testing::Values(SIGKILL, SIGSEGV, SIGABRT, SIGSTOP));

TEST(ComediPreloadTest, WithoutItTheSameProgramAsksTheRealLibrary) {
  EXPECT_THAT(outputOf("", "'{board: /dev/no_comedi, ai_channels: [0], ao_channels: [0]}' 0 1"),
              AllOf(HasSubstr("comedi board /dev/no_comedi"), HasSubstr("No such file")));
}

}  // namespace
}  // namespace ergotic::test
