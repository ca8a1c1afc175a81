// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "scene/bad_text.hpp"

namespace ergotic::scene {
namespace {

#define TWO "@a mass 1 0 0\n@b mass 1 0 0\n"

const BadText kLines[] = {
    {"<!>@ mass 1 0 0\n", "a '@' without a name"},
    {"  <!>@a\n", "element '@a' has no keyword"},
    {"@a <!>mas 1 0 0\n", "unknown keyword 'mas'; did you mean 'mass'?"},
    {"@a <!>string 10 1 1 1 0 0\n", "macro 'string' is not supported yet"},
    {"@a <!>closedMesh 3 3 1 1 1 0 0\n", "macro 'closedMesh' is not supported yet"},
    {"@p audioParam <!>in1\n", "'in1' is not a channel, allowed for audioParam: @in1 ... @in64"},
    {"@p audioParam <!>@in65\n", "allowed: 1...64"},
    {"@p <!>audioParam\n", "0 arguments, allowed: audioParam @inK"},
    {"@p param 1\n<!>@p audioParam @in1\n", "'p' is a param and an audioParam"},
    {"@p audioParam @in1\n@m mass <!>p 0 0\n", "audioParam 'p' stands here"},
    {"@p audioParam @in1\n@m mass 1 0 0\n@g ground 0\n@s spring @m @g <!>p*p\n",
     "a constant times it"},
    {"@p audioParam @in1\n@m mass 1 0 0\n@g ground 0\n@s spring @m @g <!>1-p\n",
     "a constant times it"},
    {"@p audioParam @in1\n@q audioParam @in2\n@m mass 1 0 0\n@g ground 0\n"
     "@s spring @m @g p*<!>q\n",
     "two audioParams in one number"},
    {"@p audioParam @in1\n@m mass 1 0 0\n@g ground 0\n@s nlPluck @m @g 1 <!>p\n",
     "audioParam 'p' stands here"},
    {TWO "@s spring @a [<!>@str 0.3] 1\n", "a point of a macro is not supported yet"},
    {"@a <!>mass 1 0\n", "'mass' has 2 arguments, allowed: mass M [g] pos vel"},
    {"@a mass 1 2 3 4 <!>5\n", "'mass' has 5 arguments"},
    {"@a <!>osc 1 1 1 0\n", "allowed: osc M K Z [g] pos vel"},
    {"@g ground 1 <!>2\n", "'ground' has 2 arguments"},
    {TWO "@s spring @a @b 1 <!>2\n", "allowed: spring @m1 @m2 K"},
    {TWO "@s <!>nlBow @a @b 1\n", "allowed: nlBow @m1 @m2 Z vscale [smooth]"},
    {TWO "@s nlBow @a @b 1 2 1 <!>2\n", "'nlBow' has 6 arguments"},
    {"@a mass <!>-1 0 0\n", "mass of '@a' = -1 is out of range, allowed: > 0"},
    {"@a osc 1 <!>-1 0 0 0\n", "stiffness of '@a' = -1 is out of range, allowed: >= 0"},
    {TWO "@s nlPluck @a @b 1 <!>0\n", "width of '@s' = 0 is out of range, allowed: > 0"},
    {TWO "@s nlContact @a @b 1 <!>-2 3 4\n", "nonlinearity of '@s' = -2 is out of range"},
    {TWO "<!>@s nlContact @a @b 1 1e-320 3 4\n", "tipping_point of link 's' = inf"},
    {TWO "@s spring @a @b <!>1e999\n", "not a finite number"},
    {TWO "@s spring @a <!>b 1\n", "'b' is not a module, allowed: @name"},
    {TWO "@s spring @a <!>@c 1\n", "unknown module 'c'"},
    {TWO "@s spring @a <!>@a 1\n", "joins module '@a' to itself"},
    {TWO "@s spring @a @b <!>@a\n", "'@a' is a module, allowed here: a number"},
    {TWO "<!>@b mass 1 0 0\n", "module 'b' is defined twice, first in line 2"},
    {TWO "@s spring @a @b 1\n<!>@s damper @a @b 1\n", "link 's' is defined twice, first in line 3"},
    {"@p param 1\n<!>@p param 2\n", "param 'p' is defined twice, first in line 1"},
    {"<!>@p param\n", "param 'p' has 0 arguments"},
    {"<!>@gestural_rate param 1\n", "is reserved"},
    {"<!>@x posInput 0\n", "'@x' is not a channel, allowed for posInput: @in1 ... @in64"},
    {TWO "<!>@in1 posOutput @a\n", "allowed for posOutput: @out1 ... @out64"},
    {TWO "<!>@in0 frcInput @a\n", "allowed: 1...64"},
    {TWO "<!>@out65 posOutput @a\n", "allowed: 1...64"},
    {TWO "@out1 posOutput @a\n<!>@out1 posOutput @b\n", "output 'out1' is defined twice"},
    {"@a mass 1 [<!>1 2] 0\n", "is not a vector of 3 finite numbers"},
    {"@a mass 1 [<!>1 2 1e999] 0\n", "is not a vector of 3 finite numbers"},
    {"@a mass 1 [<!>1 2 3 4] 0\n", "is not a vector of 3 finite numbers"},
    {"@a mass 1 <!>[1 2 3 0\n", "missing ] for this ["},
    {"@a mass 1 <!>'1 0\n", "missing ' for this '"},
    {"@a mass 1 [1 <!>[2] 3] 0\n", "brackets in brackets"},
    {"@a mass 1<!>+1 0 0\n", "a '+' outside brackets"},
    {"@a mass 1 0 0\n@\xC3\xA9 mass 1 0 0\n@c<!>\xE9 mass 1 0 0\n", "not UTF-8"},
    {"@a mass 1 0 <!>\x01\n", "control character 0x01"},
};
TEST(MdlErrorsTest, OfElementsAreRefusedAtTheirPlace) {
  for (const BadText& bad : kLines) {
    expectRefused(bad, "bad.mdl");
  }
}

const BadText kExpressions[] = {
    {"@a mass <!>k 0 0\n", "unknown param 'k'"},
    {"@kk param 1\n@a mass [1 + <!>k] 0 0\n", "unknown param 'k'; did you mean 'kk'?"},
    {"@a mass 1<!>/0 0 0\n", "division by zero"},
    {"@a mass <!>sqrt(-1) 0 0\n", "has no finite value"},
    {"@a mass <!>log(0) 0 0\n", "has no finite value"},
    {"@a mass 1e300<!>*1e300 0 0\n", "has no finite value"},
    {"@a mass (1<!> 0 0\n", "missing ')'"},
    {"@a mass 2*<!> 0 0\n", "ends too early"},
    {"@a mass 2<!>x 0 0\n", "unexpected 'x'"},
    {"@a mass pow(2<!>) 0 0\n", "pow takes two arguments"},
    {"@a mass <!>sqr(2) 0 0\n", "unknown function 'sqr'; did you mean 'sqrt'?"},
    {"@a mass [<!>] 0 0\n", "ends too early"},
    {"@a mass 1<!>;2 0 0\n", "unexpected"},
    {"@p param q\n@q param <!>p\n", "param 'p' is defined by itself"},
    {"@p param 2*<!>p\n", "param 'p' is defined by itself"},
};

TEST(MdlErrorsTest, OfNumbersAreRefusedAtTheirPlace) {
  for (const BadText& bad : kExpressions) {
    expectRefused(bad, "bad.mdl");
  }
}

TEST(MdlErrorsTest, UnusedParamsAreEvaluatedToo) {
  expectRefused({"@p param 1<!>/0\n", "division by zero"}, "bad.mdl");
}

TEST(MdlErrorsTest, DeepExpressionsAndLongChainsAreErrorsNotCrashes) {
  std::string deep = "@a mass ";
  deep += std::string(100000, '(') + "1" + std::string(100000, ')') + " 0 0\n";
  EXPECT_THROW(readMdl(deep, "deep.mdl"), TextError);
  EXPECT_THROW(readMdl("@a mass " + std::string(100000, '-') + "1 0 0\n", "minus.mdl"), TextError);
  std::string chain;
  for (int i = 0; i < 100000; ++i) {
    chain += "@p" + std::to_string(i) + " param p" + std::to_string(i + 1) + "\n";
  }
  EXPECT_THROW(readMdl(chain + "@p100000 param 1\n", "chain.mdl"), TextError);
}

TEST(MdlErrorsTest, DeepestExpressionsInTheLongestChainAreStillRead) {
  std::string text = "@m mass p0 0 0\n";
  for (int i = 0; i < 63; ++i) {
    text += "@p" + std::to_string(i) + " param " + std::string(31, '(') + "p" +
            std::to_string(i + 1) + std::string(31, ')') + "\n";
  }
  EXPECT_EQ(readMdl(text + "@p63 param 2\n", "chain.mdl").mats.at(0).mass.factor, 2.0);
}

}  // namespace
}  // namespace ergotic::scene
