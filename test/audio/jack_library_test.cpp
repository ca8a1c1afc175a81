// SPDX-License-Identifier: BSD-3-Clause
#include "audio/jack_library.hpp"

#include <future>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "audio/jack_session.hpp"
#include "ergotic/exception.hpp"
#include "support/block_probe.hpp"

namespace ergotic::audio {
namespace {

TEST(JackLibraryTest, ACallThatComesBackIsWaitedFor) {
  bool called = false;
  EXPECT_TRUE(jack_library::callPatiently([&called] { called = true; }));
  EXPECT_TRUE(called);
  EXPECT_FALSE(jack_library::isStuck());
}

TEST(JackLibraryTest, ACallThatHangsBlocksNobodyAndNoClientIsOpenedMeanwhile) {
  auto release = std::make_shared<std::promise<void>>();
  EXPECT_FALSE(jack_library::callPatiently([release] { release->get_future().wait(); }));
  EXPECT_TRUE(jack_library::isStuck());
  try {
    const JackSession session("", "stuck", std::make_shared<Semaphore>());
    FAIL() << "a client was opened";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("has not come back"), std::string::npos);
  }
  release->set_value();
  EXPECT_TRUE(test::eventually([] { return !jack_library::isStuck(); }));
}

}  // namespace
}  // namespace ergotic::audio
