// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/latency.hpp"

#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

std::string textOf(const Json& report) {
  std::ostringstream text;
  printJson(report, text);
  return text.str();
}

TEST(LatencyTest, GivesQuantilesInMicrosecondsAndAsSharesOfThePeriod) {
  station::TickHistogram histogram;
  for (int n = 0; n < 99; ++n) {
    histogram.add(16);
  }
  histogram.add(50'000);
  const std::string text = textOf(histogramReport(histogram, 100.0, true));
  EXPECT_THAT(text, HasSubstr("\"count\": 100"));
  EXPECT_THAT(text, HasSubstr("\"p50\": 0.016"));
  EXPECT_THAT(text, HasSubstr("\"p50\": 0.00016"));
  EXPECT_THAT(text, HasSubstr("\"max\": 50"));
  EXPECT_THAT(text, HasSubstr("\"max\": 0.5"));
  EXPECT_THAT(text, HasSubstr("counts"));
  EXPECT_THAT(textOf(histogramReport(histogram, 100.0, false)), Not(HasSubstr("counts")));
}

/// Whatever the machine does meanwhile, every tick is in the histograms or was caught up.
TEST(LatencyTest, CountsEveryTickThatItPlayed) {
  const test::ScratchFile json;
  const test::Outcome outcome = test::run(
      "latency", "--modules 100 --ratio 14 --seconds 0.5 --priority 0 --json " + json.path());
  EXPECT_THAT(outcome.text, HasSubstr("slices: 12"));
  FILE* pipe = popen(("/usr/bin/python3 -c \"import json; r = json.load(open('" + json.path() +
                      "')); t = r['ticks'];"
                      "cycles = r['tick']['count'];"
                      "print(r['wake_up']['count'] - t['stalls'] - cycles >= 0,"
                      "cycles + t['caught_up'] >= t['ticks'] > 100,"
                      "all(sum(r[k]['counts']) == r[k]['count'] for k in ('wake_up', 'exchange', "
                      "'compute', 'tick')))\"")
                         .c_str(),
                     "r");
  char said[64] = "";
  EXPECT_NE(fgets(said, sizeof said, pipe), nullptr);
  pclose(pipe);
  EXPECT_STREQ(said, "True True True\n") << outcome.text;
}

/// The plate nearest to 1000 modules has 995.
TEST(LatencyTest, PlaysNoFewerModulesThanAskedFor) {
  const test::Outcome outcome = test::run("latency", "--modules 1000 --seconds 0.1 --priority 0");
  const std::string key = "  modules: ";
  const std::size_t found = outcome.text.find(key);
  ASSERT_NE(found, std::string::npos) << outcome.text;
  EXPECT_GE(std::stoi(outcome.text.substr(found + key.size())), 1000);
}

TEST(LatencyTest, RefusesWhatItCannotDo) {
  EXPECT_EQ(test::run("latency", "--ratio 0").code, kUsage);
  EXPECT_EQ(test::run("latency", "--modules 3").code, kUsage);
  EXPECT_EQ(test::run("latency", "/nowhere.yaml").code, kFailure);
  EXPECT_THAT(test::run("latency", "--modules 100 --seconds 0.1 --json /nowhere/a.json").text,
              HasSubstr("/nowhere/a.json: cannot be written"));
}

}  // namespace
}  // namespace ergotic::tools
