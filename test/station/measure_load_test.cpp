// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/measure_load.hpp"

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

/// Of so many modules, of which none is moved.
scene::Scene plate(int rows, const std::string& edges = "fixed") {
  const std::string size = std::to_string(rows);
  return scene::readYaml(
      "ergotic: 1\nname: plate\nsections:\n  plate: {rate: audio}\ngenerators:\n"
      "  - {type: mesh, name: plate, section: plate, rows: " +
          size + ", columns: " + size +
          ", spacing: 0.01, mass: 1.0e-4, stiffness: 2000, damping: 1.0e-3, edges: " + edges +
          "}\n",
      "plate.yaml");
}

std::unique_ptr<Performer> performerOfPlate(int rows, double max_load = 0.0) {
  PerformerPolicy policy;
  policy.max_load = max_load;
  return makePerformer(plate(rows), {44100.0, 14}, {}, policy);
}

TEST(MeasureLoadTest, GrowsWithTheModel) {
  const double small = measureLoad(*performerOfPlate(20));
  const double large = measureLoad(*performerOfPlate(100));
  EXPECT_GT(small, 0.0);
  EXPECT_GT(large, 4.0 * small);
}

TEST(MeasureLoadTest, LeavesThePerformerAsItWasMade) {
  const auto performer = performerOfPlate(20);
  measureLoad(*performer);
  std::vector<unsigned char> state(performer->instrument->stateSize());
  performer->instrument->saveState(state.data());
  EXPECT_EQ(state, performer->initial);
  EXPECT_EQ(performer->ticks, 0);
}

TEST(MeasureLoadTest, RefusesWhatIsTooHeavyAndSaysByHowMuchAndWhatWouldHelp) {
  EXPECT_NO_THROW(performerOfPlate(20, 100.0));
  try {
    performerOfPlate(100, 1e-4);
    FAIL() << "it is too heavy";
  } catch (const Exception& refusal) {
    EXPECT_THAT(refusal.what(),
                AllOf(HasSubstr("plate.yaml: error: "), HasSubstr("max_load = 0.0001"),
                      HasSubstr("times less"), HasSubstr("energies: false")));
  }
}

/// A plate that nothing holds needs double precision, one that is held does not.
TEST(MeasureLoadTest, AdvisesSinglePrecisionOnlyToWhatIsTrueInIt) {
  const auto refusalIn = [](const std::string& edges) {
    PerformerPolicy policy;
    policy.max_load = 1e-6;
    return complaintOf<Exception>([&] {
      makePerformer(plate(20, edges), {44100.0, 14}, physics::Precision::kDouble, policy);
    });
  };
  EXPECT_THAT(refusalIn("fixed"), HasSubstr("precision: float"));
  EXPECT_THAT(refusalIn("free"), AllOf(HasSubstr("too heavy"), Not(HasSubstr("precision: float"))));
}

}  // namespace
}  // namespace ergotic::station
