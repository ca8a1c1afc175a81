// SPDX-License-Identifier: BSD-3-Clause
#include "files/printable.hpp"

#include "support/test.hpp"

namespace ergotic::files {
namespace {

TEST(PrintableTest, ShowsWhatWouldEndAMessageOrChangeATerminal) {
  EXPECT_EQ(printable(std::string("\0: no\x1B[2J\n", 10), 100), "\\x00: no\\x1B[2J\\x0A");
}

TEST(PrintableTest, KeepsTheLinesOfAMessage) {
  EXPECT_EQ(printableLines("a: no\x1B[2J\n  in b\t"), "a: no\\x1B[2J\n  in b\\x09");
}

TEST(PrintableTest, LeavesOutWhatIsBeyondAndCutsNoCharacter) {
  EXPECT_EQ(printable("caf\xC3\xA9", 5), "caf\xC3\xA9");
  EXPECT_EQ(printable("caf\xC3\xA9", 4), "caf...");
  EXPECT_EQ(printable("caf\xC3\xA9 au lait", 5), "caf\xC3\xA9...");
}

}  // namespace
}  // namespace ergotic::files
