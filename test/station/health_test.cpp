// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scene_builder.hpp"

namespace ergotic::station {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Three links: l0, l1, l2.
scene::Scene links() {
  test::SceneBuilder b;
  const int mass = b.mass(1.0);
  for (int i = 0; i < 3; ++i) {
    b.spring(mass, b.ground(), 1.0);
  }
  return b.scene;
}

TEST(HealthTest, TellsOfLinksThatAreCutInMoreThanFivePercentOfTheirStepsWorstFirst) {
  EXPECT_THAT(guardWarnings(links(), {{0, 1000, 60}, {1, 1000, 50}, {2, 200, 150}}),
              ElementsAre(AllOf(HasSubstr("built.yaml:"), HasSubstr("warning: link 'l2'"),
                                HasSubstr("75 % of 200 steps"), HasSubstr("raise the rate")),
                          AllOf(HasSubstr("link 'l0'"), HasSubstr("6 % of 1000 steps"))));
}

TEST(HealthTest, KeepsQuietAboutLinksThatHardlyPushed) {
  EXPECT_THAT(guardWarnings(links(), {{0, 199, 199}, {1, 0, 0}}), IsEmpty());
}

TEST(HealthTest, MeasuresTheResidualAgainstAllTheEnergyThatThereWas) {
  physics::Energies energies;
  EXPECT_EQ(relativeResidual(energies), 0.0);
  energies.sections.resize(2);
  energies.couplings.resize(1);
  energies.stored = 1.0;
  energies.residual = -1e-9;
  EXPECT_DOUBLE_EQ(relativeResidual(energies), -1e-9);
  energies.sections[1].dissipated = 2.0;
  energies.couplings[0].dissipated = 1.0;
  EXPECT_DOUBLE_EQ(relativeResidual(energies), -0.25e-9);
}

}  // namespace
}  // namespace ergotic::station
