// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/key_rows.hpp"

#include <gtest/gtest.h>

namespace ergotic::panel {
namespace {

TEST(KeyRowsTest, TwoRowsAreTwoOctavesOfAPiano) {
  const int lower[] = {48, 50, 52, 53, 55, 57, 59, 60, 62, 64};
  const int upper[] = {60, 62, 64, 65, 67, 69, 71, 72, 74, 76};
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(noteOfKey(52 + i), lower[i]);
    EXPECT_EQ(noteOfKey(24 + i), upper[i]);
  }
}

TEST(KeyRowsTest, BlackKeysAreInTheRowsAbove) {
  EXPECT_EQ(noteOfKey(39), 49);  // S
  EXPECT_EQ(noteOfKey(40), 51);  // D
  EXPECT_EQ(noteOfKey(41), std::nullopt) << "there is none between E and F";
  EXPECT_EQ(noteOfKey(42), 54);  // G
  EXPECT_EQ(noteOfKey(11), 61);  // 2
  EXPECT_EQ(noteOfKey(13), std::nullopt);
  EXPECT_EQ(noteOfKey(19), 75);  // 0
  EXPECT_EQ(noteOfKey(10), std::nullopt);
  EXPECT_EQ(noteOfKey(9), std::nullopt) << "Escape leaves the tool";
}

TEST(KeyRowsTest, AKeyThatIsDownDoesNotBeginAgain) {
  KeyRows keys;
  EXPECT_EQ(keys.press(24), 60);
  EXPECT_EQ(keys.press(24), std::nullopt);
  EXPECT_EQ(keys.release(24), 60);
  EXPECT_EQ(keys.release(24), std::nullopt);
}

TEST(KeyRowsTest, AllThatAreDownEndTogether) {
  KeyRows keys;
  keys.press(24);
  keys.press(52);
  EXPECT_EQ(keys.releaseAll(), (std::vector<int>{60, 48}));
  EXPECT_TRUE(keys.releaseAll().empty());
}

TEST(KeyRowsTest, ThePedalKeepsNotesWhoseKeysAreReleased) {
  KeyRows keys;
  keys.press(24);
  keys.press(25);
  EXPECT_TRUE(keys.setPedal(true).empty());
  EXPECT_EQ(keys.release(24), std::nullopt);
  EXPECT_EQ(keys.down(), (std::vector<int>{60, 62}));
  EXPECT_EQ(keys.press(24), 60) << "a note that only the pedal keeps begins again";
  EXPECT_EQ(keys.release(24), std::nullopt);
  EXPECT_EQ(keys.setPedal(false), std::vector<int>{60}) << "the key of 62 is still down";
  EXPECT_EQ(keys.release(25), 62);
}

TEST(KeyRowsTest, APedalThatAllWasReleasedUnderIsUp) {
  KeyRows keys;
  keys.setPedal(true);
  keys.releaseAll();
  keys.press(24);
  EXPECT_EQ(keys.release(24), 60);
}

TEST(KeyRowsTest, OctavesMoveBothRowsButNoNoteThatIsHeld) {
  KeyRows keys;
  keys.press(24);
  keys.shift(-1);
  EXPECT_EQ(keys.lowest(), 36);
  EXPECT_EQ(keys.press(52), 36);
  EXPECT_EQ(keys.press(25), 50);
  EXPECT_EQ(keys.release(24), 60) << "as it began";
  EXPECT_EQ(keys.down(), (std::vector<int>{36, 50}));
}

TEST(KeyRowsTest, OctavesStayWithinTheNotesOfMidi) {
  KeyRows keys;
  for (int i = 0; i < 9; ++i) {
    keys.shift(-1);
  }
  EXPECT_EQ(keys.press(52), 0);
  for (int i = 0; i < 20; ++i) {
    keys.shift(1);
  }
  EXPECT_EQ(keys.press(33), 124);  // P
}

TEST(KeyRowsTest, OfTwoKeysOfOneNoteTheFirstCounts) {
  KeyRows keys;
  EXPECT_EQ(keys.press(59), 60);  // the comma
  EXPECT_EQ(keys.press(24), std::nullopt);
  EXPECT_EQ(keys.release(24), std::nullopt);
  EXPECT_EQ(keys.release(59), 60);
}

}  // namespace
}  // namespace ergotic::panel
