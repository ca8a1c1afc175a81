// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/grips.hpp"

#include <gtest/gtest.h>

#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::panel {
namespace {

TEST(GripsTest, TheToolShowsTheForceThatTheHandGives) {
  for (const Grip& grip : kGrips) {
    const tgr::HandHold hold = tgr::holdOf(static_cast<tgr::HandGrip>(grip.number), {});
    EXPECT_EQ(grip.stiffness, hold.stiffness) << grip.name;
    EXPECT_EQ(grip.most_n, hold.max_force) << grip.name;
  }
}

}  // namespace
}  // namespace ergotic::panel
