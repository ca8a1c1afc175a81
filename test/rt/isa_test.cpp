// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/isa.hpp"

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

std::string refusalOf(const std::string& name) {
  return complaintOf([&] { isaNamed(name); });
}

TEST(IsaTest, EveryProcessorHasTheBaselineAndTheBestIsTheLast) {
  ASSERT_FALSE(isas().empty());
  EXPECT_EQ(isas().front(), Isa::kBaseline);
  EXPECT_EQ(isas().back(), bestIsa());
}

TEST(IsaTest, LevelsGoUp) {
  const std::vector<Isa> here = isas();
  for (std::size_t i = 1; i < here.size(); ++i) {
    EXPECT_LT(here[i - 1], here[i]);
  }
}

TEST(IsaTest, NamesLeadBackToTheirLevels) {
  for (const Isa isa : isas()) {
    EXPECT_EQ(isaNamed(nameOf(isa)), isa);
  }
  EXPECT_STREQ(nameOf(Isa::kBaseline), "baseline");
  EXPECT_STREQ(nameOf(Isa::kAvx2), "avx2");
  EXPECT_STREQ(nameOf(Isa::kAvx512), "avx512");
}

TEST(IsaTest, ANameThatNothingHasIsRefusedWithTheListOfThoseThereAre) {
  for (const char* name : {"sse9", "", "AVX2"}) {
    const std::string refusal = refusalOf(name);
    EXPECT_THAT(refusal, HasSubstr("'" + std::string(name) + "'"));
    for (const Isa isa : isas()) {
      EXPECT_THAT(refusal, HasSubstr(nameOf(isa)));
    }
  }
}

TEST(IsaTest, ALevelThatThisProcessorLacksIsRefusedAndNotListed) {
  const std::vector<Isa> here = isas();
  for (const Isa isa : {Isa::kBaseline, Isa::kAvx2, Isa::kAvx512}) {
    const std::string refusal = refusalOf(nameOf(isa));
    if (std::find(here.begin(), here.end(), isa) != here.end()) {
      EXPECT_EQ(refusal, "");
    } else {
      EXPECT_THAT(refusal, HasSubstr("this processor has"));
      EXPECT_THAT(refusal.substr(refusal.find(": ")), Not(HasSubstr(nameOf(isa))));
    }
  }
}

}  // namespace
}  // namespace ergotic::rt
