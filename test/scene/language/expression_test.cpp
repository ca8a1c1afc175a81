// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expression.hpp"

#include <cmath>
#include <random>

#include "support/test.hpp"

namespace ergotic::scene {
namespace {

class ExpressionTest : public testing::Test {
 protected:
  ExpressionTest() {
    scope_.set("n", Amount{3.0});
    scope_.set("pitch", std::string("A3"));
    scope_.set("peg", std::string("$peg"));
    Node list(Node::Kind::kList, {1, 1});
    for (const char* const text : {"10", "2 mm", "C4"}) {
      list.add({Node::Kind::kScalar, {1, 1}, text});
    }
    scope_.set("list", constantOf(list));
  }
  double valueOf(const std::string& text) const {
    return std::get<Amount>(evaluate(text, scope_)).value;
  }
  std::string refusal(const std::string& text) const {
    return complaintOf<ExpressionError>([&] { evaluate(text, scope_); });
  }

  Scope scope_;
};

TEST_F(ExpressionTest, CountsAsOneDoes) {
  EXPECT_EQ(valueOf("1 + 2*3"), 7.0);
  EXPECT_EQ(valueOf("(1 + 2)*3"), 9.0);
  EXPECT_EQ(valueOf("10 - 4 - 3"), 3.0);
  EXPECT_EQ(valueOf("8/4/2"), 1.0);
  EXPECT_EQ(valueOf("2^3^2"), 512.0);
  EXPECT_EQ(valueOf("-2^2"), -4.0);
  EXPECT_EQ(valueOf("2^-1"), 0.5);
  EXPECT_EQ(valueOf("--3"), 3.0);
  EXPECT_EQ(valueOf("1e3 + .5"), 1000.5);
  EXPECT_EQ(valueOf("n*n - 1"), 8.0);
  EXPECT_EQ(valueOf("mod(-1, 12)"), 11.0);
  EXPECT_EQ(valueOf("max(2, min(5, 3)) + pow(2, 3) + abs(-1)"), 12.0);
  EXPECT_EQ(valueOf("round(2.5) + floor(-0.5)"), 2.0);
  EXPECT_EQ(valueOf("sqrt(4) + exp(0) + log(1) + sin(0) + cos(0) + tan(0)"), 4.0);
}

TEST_F(ExpressionTest, ComparesAndChooses) {
  EXPECT_EQ(valueOf("1 < 2"), 1.0);
  EXPECT_EQ(valueOf("2 <= 1"), 0.0);
  EXPECT_EQ(valueOf("n == 3 ? 10 : 20"), 10.0);
  EXPECT_EQ(valueOf("n != 3 ? 10 : n >= 3 ? 20 : 30"), 20.0);
  EXPECT_EQ(valueOf("pitch == pitch"), 1.0);
  EXPECT_EQ(valueOf("n > 0 ? 1/n : 1/0"), 1.0 / 3.0) << "what is not chosen need have no value";
}

TEST_F(ExpressionTest, KnowsUnitsNotesAndLists) {
  EXPECT_EQ(valueOf("4 mm"), 0.004);
  EXPECT_EQ(valueOf("650 mm/4 mm"), 162.5);
  EXPECT_EQ(valueOf("20 mm^2"), 2e-5) << "as the plain number";
  EXPECT_EQ(valueOf("(20 mm)^2"), 0.02 * 0.02);
  EXPECT_EQ(valueOf("3 kN/m"), 3000.0);
  EXPECT_EQ(valueOf("9.81 m/s^2*2"), 19.62);
  EXPECT_EQ(valueOf("4 mm/n"), 0.004 / 3.0) << "no unit";
  EXPECT_EQ(valueOf("n*1 N s/m"), 3.0);
  EXPECT_EQ(valueOf("2 mN s/m + 1 N s/m"), 1.002);
  EXPECT_EQ(valueOf("-6 dB"), std::pow(10.0, -6.0 / 20.0)) << "as the plain number";
  EXPECT_EQ(valueOf("2*-20 dB"), 0.2);
  EXPECT_EQ(valueOf("-1200 cents"), 0.5);
  EXPECT_EQ(valueOf("-(6 dB)"), -std::pow(10.0, 6.0 / 20.0));
  EXPECT_EQ(valueOf("--20 dB"), 10.0);
  EXPECT_EQ(valueOf("-3 mm"), -0.003);
  EXPECT_EQ(valueOf("2 kHz + 1"), 2001.0);
  EXPECT_EQ(valueOf("50 %"), 0.5);
  EXPECT_EQ(valueOf("note(A4)"), 440.0);
  EXPECT_EQ(valueOf("note(pitch)*2"), 440.0);
  EXPECT_EQ(valueOf("2*pitch"), 440.0) << "a constant that names a note is its frequency";
  EXPECT_EQ(valueOf("list[2]/pitch"), valueOf("note(C4)/220"));
  EXPECT_EQ(valueOf("2*pi"), 2.0 * 3.14159265358979323846);
  EXPECT_NEAR(valueOf("cents(1200)"), 2.0, 1e-15);
  EXPECT_EQ(valueOf("list[0] + list[1]"), 10.002);
  EXPECT_EQ(std::get<std::string>(evaluate("list[n - 1]", scope_)), "C4");
  EXPECT_EQ(std::get<std::string>(evaluate("peg", scope_)), "$peg");
}

TEST_F(ExpressionTest, AConstantMayBeCalledPi) {
  Scope own;
  own.set("pi", Amount{3.0});
  EXPECT_EQ(std::get<Amount>(evaluate("2*pi", own)).value, 6.0);
}

TEST_F(ExpressionTest, RandomNumbersAreFixed) {
  EXPECT_EQ(valueOf("rand(1, 2)"), valueOf("rand(1, 2)"));
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double value = valueOf("rand(7, " + std::to_string(i) + ")");
    EXPECT_GE(value, 0.0);
    EXPECT_LT(value, 1.0);
    sum += value;
  }
  EXPECT_NEAR(sum / 1000.0, 0.5, 0.03);
}

TEST_F(ExpressionTest, SaysWhatIsWrong) {
  EXPECT_EQ(refusal("1/0"), "division by zero");
  EXPECT_EQ(refusal("sqrt(-1)"), "it is not a finite number");
  EXPECT_EQ(refusal("1e300*1e300"), "it is not a finite number");
  EXPECT_EQ(refusal(""), "it ends too soon");
  EXPECT_EQ(refusal("1 +"), "it ends too soon");
  EXPECT_EQ(refusal("(1"), "')' is missing");
  EXPECT_EQ(refusal("1)"), "')' is not expected here");
  EXPECT_EQ(refusal("1 2"), "'2' is not expected here");
  EXPECT_EQ(refusal("min(1)"), "',' is missing");
  EXPECT_EQ(refusal("m + 1"), "unknown name 'm'; did you mean 'n'?");
  EXPECT_THAT(refusal("sine(1)"), HasSubstr("unknown function 'sine'"));
  EXPECT_EQ(refusal("peg + 1"), "'$peg' is no number");
  EXPECT_THAT(refusal("pitch + 2 mm"), HasSubstr("are of different kinds"));
  EXPECT_EQ(refusal("list*2"), "a list is no number");
  EXPECT_EQ(refusal("list[3]"), "item 3 of a list of 3, allowed: 0...2");
  EXPECT_EQ(refusal("n[0]"), "what is no list has no items");
  EXPECT_EQ(refusal("note(H4)"), "'H4' is no note");
  EXPECT_EQ(refusal(std::string(5000, '1')), "it has 5000 bytes, allowed: at most 4096");
  for (const char* const unit : {"(", "-(", "2^", "1 ? "}) {
    std::string deep;
    for (int i = 0; i < 1000; ++i) {
      deep += unit;
    }
    EXPECT_NE(refusal(deep + "1"), "") << unit;
  }
}

TEST_F(ExpressionTest, AnyTextIsAValueOrRefused) {
  std::mt19937 random(5);
  const std::string signs = "0123456789.eE+-*/^()<>=!?:[], nmlistpitch#%$";
  for (int i = 0; i < 20000; ++i) {
    std::string text(random() % 24, ' ');
    for (char& c : text) {
      c = signs[random() % signs.size()];
    }
    try {
      const Constant value = evaluate(text, scope_);
      const auto* const number = std::get_if<Amount>(&value);
      EXPECT_TRUE(number == nullptr || std::isfinite(number->value)) << text;
    } catch (const ExpressionError& error) {
      EXPECT_LE(error.at(), text.size()) << text;
    }
  }
}

}  // namespace
}  // namespace ergotic::scene
