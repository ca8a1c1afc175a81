// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include "ros/display/newest.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

/// Acts on the first news until it may go on.
class NewestThreadsTest : public ::testing::Test {
 protected:
  using Numbers = std::vector<int>;

  void tell(int number) {
    newest_->tell([number](Numbers& waiting) { waiting.push_back(number); });
  }
  void act(Numbers& numbers) {
    if (acted_.empty()) {
      began_.set_value();
      may_go_on_.get_future().wait();
    }
    acted_.push_back(std::exchange(numbers, {}));
    if (acted_.size() == 2) {
      twice_.set_value();
    }
  }

  std::promise<void> began_;
  std::promise<void> may_go_on_;
  std::promise<void> twice_;
  std::vector<Numbers> acted_;
  std::unique_ptr<Newest<Numbers>> newest_ =
      std::make_unique<Newest<Numbers>>([this](Numbers& numbers) { act(numbers); });
};

TEST_F(NewestThreadsTest, PutsTogetherWhatComesWhileItActs) {
  tell(1);
  began_.get_future().wait();
  for (const int number : {2, 3, 4}) {
    tell(number);  // would never come back if it waited
  }
  may_go_on_.set_value();
  ASSERT_EQ(twice_.get_future().wait_for(10s), std::future_status::ready);
  newest_.reset();
  EXPECT_EQ(acted_, (std::vector<Numbers>{{1}, {2, 3, 4}}));
}

TEST_F(NewestThreadsTest, EndsAfterWhatItActsOn) {
  tell(1);
  began_.get_future().wait();
  auto ending = std::async(std::launch::async, [this] { newest_.reset(); });
  EXPECT_EQ(ending.wait_for(50ms), std::future_status::timeout) << "it still acts";
  may_go_on_.set_value();
  ending.get();
  EXPECT_EQ(acted_, (std::vector<Numbers>{{1}}));
}

TEST_F(NewestThreadsTest, EndsWithoutNews) {
  newest_.reset();
  EXPECT_TRUE(acted_.empty());
}

}  // namespace
}  // namespace ergotic::node
