// SPDX-License-Identifier: BSD-3-Clause
// Short texts that would become more than any memory or time.
#include <sys/resource.h>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/alloc_count.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kHead = "ergotic: 1\nsections: {s: {}}\n";

struct Bomb {
  std::string text;
  const char* says;
};

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) {
    all += text;
  }
  return all;
}

/// `each` for every step but the first, which is `first`; `#` is its number, `<` the one before.
std::string steps(const std::string& first, const std::string& each, int count) {
  std::string all = first;
  for (int i = 1; i < count; ++i) {
    for (const char c : each) {
      all += c == '#' ? std::to_string(i) : c == '<' ? std::to_string(i - 1) : std::string(1, c);
    }
  }
  return all;
}

std::string listOf(int items) {
  return "[" + repeated("1,", items) + "1]";
}

const Bomb kBombs[] = {
    {"mats:\n  'm{i}': {for: {i: 0..99999999}, type: mass}\n", "a loop of more than 100000"},
    {"mats:\n  'm{i}': {for: {i: 0..999, j: 0..999, k: 0..999}, type: mass}\n",
     "more than 500000 scalars"},
    {"mats:\n  'm{i}': {for: {i: 0..999, j: 0..999, k: 0..999}, when: 0, type: mass}\n",
     "more than 500000 scalars"},
    {"let:\n" + steps("  a0: " + listOf(10) + "\n",
                      "  a#: [=a<, =a<, =a<, =a<, =a<, =a<, =a<, =a<]\n",
                      30),
     "more than 500000 scalars"},
    {"let:\n" + steps("  a0: " + listOf(100'000) + "\n", "  a#: =a0\n", 4000),
     "more than 500000 scalars"},
    {"let:\n" + steps("  a0: word\n", "  a#: '{a<}{a<}{a<}{a<}'\n", 40),
     "becomes more than 4096 bytes"},
    {"let: {n: " + repeated("x", 4000) + "}\nmats:\n  '{n}{i}': {for: {i: 0..99999}, type: mass}\n",
     "bytes of words"},
    {"mats:\n  'm{i}': {for: {i: 0..99999}, type: mass, mass: '=1" + repeated("+sin(1)", 580) +
         "'}\n",
     "words and expressions"},
    {"define:\n" +
         steps("  d0: {mats: {m: {type: mass}}}\n",
               "  d#: {use: [{for: {i: 0..9}, is: d<, as: 'a{i}'}]}\n",
               15) +
         "use: [{is: d14, as: x}]\n",
     "bytes of words"},
    {"define:\n" +
         steps("  d0: {mats: {m: {type: mass}}}\n", "  d#: {use: [{is: d<, as: a}]}\n", 60) +
         "use: [{is: d59, as: x}]\n",
     "more than 16 deep"},
    {"let: {a: '=" + repeated("(", 2000) + "1" + repeated(")", 2000) + "'}\n", "deep"},
    {"let: {a: '=" + repeated("-", 200'000) + "1'}\n", "has 200001 bytes"},
};

std::int64_t mostKb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(BombsTest, AreRefusedBeforeTheyTakeRoom) {
  const std::int64_t before_kb = mostKb();
  for (const Bomb& bomb : kBombs) {
    EXPECT_THAT(complaintOf<TextError>([&] { readYaml(kHead + bomb.text, "bomb.yaml"); }),
                AllOf(StartsWith("bomb.yaml:"), HasSubstr(bomb.says)))
        << bomb.text.substr(0, 300);
  }
  if (test::AllocationScope::isAvailable()) {  // a sanitizer's heap gives nothing back for long
    EXPECT_LT(mostKb() - before_kb, 100'000);
  }
}

}  // namespace
}  // namespace ergotic::scene
