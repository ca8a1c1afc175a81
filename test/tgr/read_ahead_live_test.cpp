// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <future>
#include <thread>

#include "ergotic/tgr/gesture.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kAhead = 64;

/// Two slices that say which tick it is. Before one of them it may have to wait.
class CountedTicks : public GestureSource {
 public:
  CountedTicks(int ticks, int slow_at, std::shared_future<void> may_go_on)
      : ticks_(ticks), slow_at_(slow_at), may_go_on_(std::move(may_go_on)) {}
  int slices() const noexcept override { return 2; }
  bool next(double* positions) noexcept override {
    if (tick_ == slow_at_) {
      may_go_on_.wait();
    }
    if (tick_ == ticks_) {
      return false;
    }
    positions[0] = tick_;
    positions[1] = -tick_;
    ++tick_;
    return true;
  }

 private:
  int ticks_;
  int slow_at_;
  std::shared_future<void> may_go_on_;
  int tick_ = 0;
};

class ReadAheadThreadsTest : public ::testing::Test {
 protected:
  void read(int ticks, int slow_at = -1) {
    source_ = readAhead(
        std::make_unique<CountedTicks>(ticks, slow_at, may_go_on_.get_future().share()), kAhead);
  }
  /// \return whether the next tick is there; it is the one of its time then
  bool next() {
    std::array<double, 2> x{-1.0, -1.0};
    const bool is_there = source_->next(x.data());
    const double tick = asked_++;
    EXPECT_EQ(x, is_there ? (std::array<double, 2>{tick, -tick}) : (std::array<double, 2>{-1, -1}));
    return is_there;
  }

  std::promise<void> may_go_on_;
  std::unique_ptr<GestureSource> source_;
  int asked_ = 0;
};

TEST_F(ReadAheadThreadsTest, GivesWhatThereIsAndThenNothing) {
  read(3);
  EXPECT_EQ(source_->slices(), 2);
  for (const bool is_there : {true, true, true, false, false}) {
    EXPECT_EQ(next(), is_there);
  }
}

TEST_F(ReadAheadThreadsTest, GivesFarMoreThanItHolds) {
  constexpr int kTicks = 1000;
  read(kTicks);
  int there = 0;
  while (asked_ < kTicks) {
    there += next() ? 1 : 0;
    if (asked_ % 32 == 0) {
      std::this_thread::sleep_for(25ms);
    }
  }
  EXPECT_GT(there, 4 * static_cast<int>(kAhead)) << "the rest came late";
  EXPECT_FALSE(next());
}

TEST_F(ReadAheadThreadsTest, LeavesOutWhatComesTooLate) {
  read(1'000'000, 2 * static_cast<int>(kAhead));
  while (asked_ < 4 * static_cast<int>(kAhead)) {
    next();
    std::this_thread::sleep_for(1ms);
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(next()) << "it waits for its file";
  }
  may_go_on_.set_value();
  bool comes_back = false;
  for (int i = 0; i < 10'000 && !comes_back; ++i) {
    comes_back = next();
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(comes_back);
}

TEST_F(ReadAheadThreadsTest, EndsWhileThereIsMore) {
  read(1'000'000);
  EXPECT_TRUE(next());
  source_.reset();
}

}  // namespace
}  // namespace ergotic::tgr
