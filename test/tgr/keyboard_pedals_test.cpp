// SPDX-License-Identifier: BSD-3-Clause
// Pedals, and who holds a key.
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "ergotic/tgr/keyboard.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

constexpr std::uint8_t kSustainPedal = 64;
constexpr std::uint8_t kSostenutoPedal = 66;
constexpr std::uint8_t kSoftPedal = 67;

class PedalsTest : public ::testing::Test {
 protected:
  PedalsTest() {
    keyboard_.use(readPlayMap("keys:\n"
                              "  - {notes: [40, 59], slices: [0, 1, 2, 3, 4], from: 2 mm,\n"
                              "     to: 12 mm, speed: [0.1, 1], back: 0.5}\n",
                              "map.yaml"),
                  0.0);
  }
  Strokes send(std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    const std::array<std::uint8_t, 3> bytes{status, first, second};
    now_s_ += 1.0;
    return keyboard_.play(bytes.data(), 3, now_s_).strokes;
  }
  Strokes pedal(std::uint8_t number, std::uint8_t value) { return send(0xb0, number, value); }
  /// Where the last of some strokes ends.
  static double endOf(const Strokes& strokes) {
    return strokes.empty() ? std::nan("") : strokes.back().target_m;
  }
  Keyboard keyboard_;
  double now_s_ = 0.0;
};

TEST_F(PedalsTest, AHalfPedalLetsKeysComeBackAsFarAsItIs) {
  send(0x90, 40, 100);
  pedal(kSustainPedal, 127);
  EXPECT_TRUE(send(0x80, 40, 0).empty());
  EXPECT_TRUE(pedal(kSustainPedal, 96).empty()) << "from three quarters on it is down";
  for (const int value : {95, 64, 33, 50, 95}) {
    const double depth = 2.0 * value / 127.0 - 0.5;
    EXPECT_NEAR(endOf(pedal(kSustainPedal, static_cast<std::uint8_t>(value))), 0.002 + depth * 0.01,
                1e-15)
        << value;
  }
  EXPECT_EQ(endOf(pedal(kSustainPedal, 31)), 0.002) << "up to a quarter it keeps nothing";
  EXPECT_TRUE(pedal(kSustainPedal, 127).empty()) << "what has come back stays";
}

TEST_F(PedalsTest, AKeyThatIsReleasedStaysWhereAHalfPedalKeepsIt) {
  pedal(kSustainPedal, 64);
  send(0x90, 40, 100);
  const Strokes back = send(0x80, 40, 0);
  ASSERT_EQ(back.size(), 1U);
  const double depth = 2.0 * 64 / 127.0 - 0.5;
  EXPECT_NEAR(back[0].target_m, 0.002 + depth * 0.01, 1e-15);
  EXPECT_NEAR(back[0].glide_s, 1.875 * (1.0 - depth) * 0.01 / 0.5, 1e-12);
}

TEST_F(PedalsTest, AHalfPedalLeavesKeysThatAreHeldDown) {
  send(0x90, 40, 100);
  pedal(kSustainPedal, 127);
  EXPECT_TRUE(pedal(kSustainPedal, 64).empty());
  EXPECT_TRUE(pedal(kSustainPedal, 0).empty());
  EXPECT_EQ(endOf(send(0x80, 40, 0)), 0.002);
}

TEST_F(PedalsTest, AKeyThatAHalfPedalKeepsComesUpBeforeItIsPressedAgain) {
  send(0x90, 40, 100);
  pedal(kSustainPedal, 64);
  send(0x80, 40, 0);
  const Strokes again = send(0x90, 40, 100);
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].target_m, 0.002);
  EXPECT_EQ(again[1].target_m, 0.012);
}

TEST_F(PedalsTest, SostenutoKeepsOnlyKeysThatWereDown) {
  send(0x90, 40, 100);
  pedal(kSostenutoPedal, 64);
  send(0x90, 41, 100);
  EXPECT_TRUE(send(0x80, 40, 0).empty());
  EXPECT_EQ(endOf(send(0x80, 41, 0)), 0.002);
  EXPECT_TRUE(pedal(kSostenutoPedal, 100).empty()) << "it is down already";
  const Strokes back = pedal(kSostenutoPedal, 63);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].index, 0);
  EXPECT_EQ(back[0].target_m, 0.002);
}

TEST_F(PedalsTest, SostenutoDoesNotCatchWhatTheSustainPedalKeeps) {
  pedal(kSustainPedal, 127);
  send(0x90, 40, 100);
  send(0x80, 40, 0);
  pedal(kSostenutoPedal, 127);
  EXPECT_EQ(endOf(pedal(kSustainPedal, 0)), 0.002);
}

TEST_F(PedalsTest, TheSustainPedalKeepsWhatSostenutoLetsGo) {
  send(0x90, 40, 100);
  pedal(kSostenutoPedal, 127);
  send(0x80, 40, 0);
  pedal(kSustainPedal, 127);
  EXPECT_TRUE(pedal(kSostenutoPedal, 0).empty());
  EXPECT_EQ(endOf(pedal(kSustainPedal, 0)), 0.002);
}

TEST_F(PedalsTest, TheSoftPedalTakesAThirdOfTheVelocity) {
  const auto speed = [&](std::uint8_t pressed) {
    pedal(kSoftPedal, pressed);
    const Strokes strokes = send(0x90, 40, 93);
    send(0x80, 40, 0);
    return 1.875 * 0.01 / strokes.at(0).glide_s;
  };
  EXPECT_NEAR(speed(0), 0.1 * std::pow(10.0, 92.0 / 126.0), 1e-12);
  EXPECT_NEAR(speed(127), 0.1 * std::pow(10.0, 61.0 / 126.0), 1e-12);
  pedal(kSoftPedal, 127);
  EXPECT_NEAR(1.875 * 0.01 / send(0x90, 41, 1).at(0).glide_s, 0.1, 1e-12) << "no slower than 1";
}

TEST_F(PedalsTest, AKeyIsDownAsLongAsItIsOnAnyChannel) {
  send(0x90, 40, 100);
  EXPECT_EQ(send(0x95, 40, 100).size(), 2U);
  EXPECT_TRUE(send(0x80, 40, 0).empty());
  EXPECT_TRUE(send(0x80, 40, 0).empty());
  EXPECT_EQ(endOf(send(0x85, 40, 0)), 0.002);
}

TEST_F(PedalsTest, SomebodyWithoutAChannelHoldsAKeyAsWell) {
  send(0x90, 40, 100);
  keyboard_.note(40, 100, now_s_);
  EXPECT_TRUE(send(0x80, 40, 0).empty());
  EXPECT_EQ(endOf(keyboard_.note(40, 0, now_s_)), 0.002);
}

TEST_F(PedalsTest, ANoteThatBeginsTwiceEndsOnce) {
  send(0x90, 40, 100);
  send(0x90, 40, 100);
  EXPECT_EQ(endOf(send(0x80, 40, 0)), 0.002);
  EXPECT_TRUE(send(0x80, 40, 0).empty());
}

TEST_F(PedalsTest, PanicReleasesWhatAnyPedalKeeps) {
  for (const std::uint8_t mode : std::array<std::uint8_t, 6>{120, 123, 124, 125, 126, 127}) {
    send(0x90, 40, 100);
    pedal(kSostenutoPedal, 127);
    send(0x93, 41, 100);
    pedal(kSustainPedal, 64);
    send(0x83, 41, 0);
    send(0x90, 42, 100);
    const Strokes back = pedal(mode, 0);
    ASSERT_EQ(back.size(), 3U) << int{mode};
    for (const Stroke& stroke : back) {
      EXPECT_EQ(stroke.target_m, 0.002);
    }
    EXPECT_TRUE(pedal(kSostenutoPedal, 0).empty());
  }
}

TEST(KeyboardSearchTest, NoNoteHangsAfterAnythingAndAPanic) {
  Keyboard keyboard;
  keyboard.use(readPlayMap("keys:\n"
                           "  - {notes: [60, 67], slices: [0, 1, 2], to: 10 mm,\n"
                           "     pressure_to: 12 mm, bend: {slices: 5, from: -2 mm, to: 3 mm}}\n"
                           "  - {notes: [68, 69], slices: [2, 3], from: 1 mm, to: 5 mm}\n"
                           "  - {notes: [70, 70], slices: 3, to: 5 mm, legato: turns, with: [\n"
                           "     {slices: 4, to: 3 mm, legato: glides, after: 0.1}]}\n",
                           "map.yaml"),
               0.0);
  const std::array<std::uint8_t, 8> controllers{64, 66, 67, 74, 6, 100, 101, 121};
  std::map<int, double> told;
  double now_s = 0.0;
  const auto play = [&](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    const std::array<std::uint8_t, 3> bytes{status, first, second};
    for (const Stroke& stroke : keyboard.play(bytes.data(), 3, now_s).strokes) {
      told[stroke.index] = stroke.target_m;
      ASSERT_TRUE(stroke.after_s >= 0.0 && stroke.after_s < 2.0) << stroke.after_s;
      ASSERT_TRUE(stroke.target_m >= -0.002 && stroke.target_m <= 0.012) << stroke.target_m;
    }
  };
  std::mt19937 dice(7);
  for (int round = 0; round < 400; ++round) {
    for (int i = 0; i < 60; ++i) {
      now_s += 1e-3 * static_cast<double>(dice() % 100);
      const auto channel = static_cast<std::uint8_t>(dice() % 3);
      const auto kind = static_cast<std::uint8_t>(0x80 + 0x10 * (dice() % 7));
      const auto datum = static_cast<std::uint8_t>(dice() % 128);
      const auto note = static_cast<std::uint8_t>(60 + dice() % 11);
      const bool is_controller = kind == 0xb0;
      const std::uint8_t first = is_controller ? controllers[dice() % 8] : note;
      play(kind | channel, first, is_controller && first > 99 ? datum % 7 : datum);
    }
    play(0xb0, round % 2 == 0 ? 120 : 123, 0);
    for (const auto& [slice, rest] : std::map<int, double>{{0, 0.0}, {1, 0.0}, {4, 0.0}}) {
      EXPECT_EQ(told[slice], rest) << slice << " in round " << round;
    }
    EXPECT_THAT(told[3], ::testing::AnyOf(0.0, 0.001)) << "0: it was told nothing yet";
  }
}

TEST_F(PedalsTest, ResetOfControllersLetsPedalsComeUp) {
  send(0x90, 40, 100);
  pedal(kSostenutoPedal, 127);
  pedal(kSustainPedal, 127);
  pedal(kSoftPedal, 127);
  send(0x90, 41, 127);
  send(0x80, 40, 0);
  send(0x80, 41, 0);
  EXPECT_EQ(pedal(121, 0).size(), 2U);
  EXPECT_NEAR(1.875 * 0.01 / send(0x90, 42, 127).at(0).glide_s, 1.0, 1e-12);
}

TEST_F(PedalsTest, LocalControlMeansNothing) {
  send(0x90, 40, 100);
  EXPECT_TRUE(pedal(122, 0).empty());
}

TEST_F(PedalsTest, ClocksAndActiveSensingArePassedOver) {
  send(0x90, 40, 100);
  for (int status = 0xf0; status <= 0xff; ++status) {
    EXPECT_TRUE(send(static_cast<std::uint8_t>(status), 40, 0).empty());
    const auto byte = static_cast<std::uint8_t>(status);
    EXPECT_TRUE(keyboard_.play(&byte, 1, now_s_).strokes.empty());
  }
  EXPECT_EQ(send(0x80, 40, 0).size(), 1U);
}

}  // namespace
}  // namespace ergotic::tgr
