// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_touch.hpp"

#include <gtest/gtest.h>

#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

TEST(ModelTouchTest, LawsTouchAsTheirNamesSay) {
  StructureMaker maker;
  const std::uint32_t first = maker.row(8, 0.0F);
  ASSERT_EQ(first, 0U);
  ModelStructure& structure = maker.structure;
  structure.law_names = {"spring-damper", "contact", "power-law contact", "felt",
                         "pluck",         "bow",     "friction"};
  structure.link_types = {0, 1, 2, 3, 4, 5, 6};
  EXPECT_EQ(touchesOf(structure),
            (std::vector<Touch>{Touch::kNone, Touch::kPress, Touch::kStrike, Touch::kStrike,
                                Touch::kPluck, Touch::kRub, Touch::kRub}));
}

TEST(ModelTouchTest, ALinkWithoutALawTouchesNothing) {
  StructureMaker maker;
  maker.row(3, 0.0F);
  maker.structure.law_names = {"felt"};
  maker.structure.link_types = {7};
  EXPECT_EQ(touchesOf(maker.structure), (std::vector<Touch>{Touch::kNone, Touch::kNone}));
}

}  // namespace
}  // namespace ergotic::panel
