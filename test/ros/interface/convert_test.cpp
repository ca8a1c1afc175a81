// SPDX-License-Identifier: BSD-3-Clause

#include "ros/interface/convert.hpp"

#include <ros/serialization.h>

#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ros/interface/gesture_blocks.hpp"
#include "ros/interface/model_loader.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

const char kScene[] = R"(ergotic: 1
name: two
sections:
  s: {rate: audio, pose: {position: [0, 0, 1]}}
mats:
  a: {type: ground, section: s, at: [0.1, 0.2], x: 0.3}
  b: {type: mass, section: s, mass: 0.01, at: [0.4, 0.5]}
lias:
  l: {type: spring, between: [a, b], stiffness: 10}
)";

template <class Message>
Message sentAndReceived(const Message& message) {
  const ::ros::SerializedMessage wire = ::ros::serialization::serializeMessage(message);
  Message received;
  ::ros::serialization::deserializeMessage(wire, received);
  return received;
}

TEST(ConvertTest, StructureHoldsPlacesInFrameModel) {
  const scene::Scene scene = scene::readYaml(kScene, "two.yaml");
  const ModelStructure structure = sentAndReceived(toModelStructure(scene, physics::Rates()));
  EXPECT_EQ(structure.module_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(structure.rest_positions, (std::vector<float>{0.3F, 0.1F, 1.2F, 0.0F, 0.4F, 1.5F}));
  EXPECT_EQ(structure.links, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(structure.section_poses.size(), 1U);
  EXPECT_EQ(structure.section_poses[0].position.z, 1.0);
  EXPECT_EQ(structure.section_poses[0].orientation.w, 1.0);
  EXPECT_EQ(structure.section_dimensions, std::vector<std::uint8_t>{1});
  EXPECT_EQ(structure.section_rates, std::vector<double>{44100.0});
}

TEST(ConvertTest, StructureHasTheCameraOfItsScene) {
  const std::string rest = "sections: {s: {}}\nmats: {a: {type: mass, section: s, mass: 1}}\n";
  const std::string about = "about: {picture: {from: [1, 2, 3], at: [0, 0.5, 0]}}\n";
  for (const bool has_camera : {false, true}) {
    const scene::Scene scene =
        scene::readYaml("ergotic: 1\n" + (has_camera ? about : "") + rest, "a.yaml");
    const ModelStructure structure = sentAndReceived(toModelStructure(scene, physics::Rates()));
    ASSERT_EQ(structure.camera.size(), has_camera ? 2U : 0U);
    if (has_camera) {
      EXPECT_EQ(structure.camera[0].z, 3.0);
      EXPECT_EQ(structure.camera[1].y, 0.5);
    }
  }
}

TEST(ConvertTest, StructureSaysHowManyCoordinatesOfASectionMove) {
  const scene::Scene scene = scene::readYaml(R"(ergotic: 1
name: net
sections:
  up: {rate: audio}
  net: {rate: audio, geometry: space, pose: {rotation: [0, 0, 1.5707963267948966]}}
mats:
  a: {type: mass, section: up, mass: 1}
  finger: {type: point, along: n, at: [0.25, 0.5]}
generators:
  - {type: mesh, name: n, section: net, rows: 3, columns: 3, spacing: 0.1, mass: 1, stiffness: 1,
     rest_length_ratio: 0.5}
)",
                                             "net.yaml");
  const ModelStructure structure = sentAndReceived(toModelStructure(scene, physics::Rates()));
  EXPECT_EQ(structure.section_dimensions, (std::vector<std::uint8_t>{1, 3}));
  EXPECT_NEAR(structure.section_poses[1].orientation.z, std::sqrt(0.5), 1e-12);
  const auto finger = static_cast<std::size_t>(
      std::find(structure.module_names.begin(), structure.module_names.end(), "finger") -
      structure.module_names.begin());
  EXPECT_EQ(structure.module_types.at(finger), ModelStructure::POINT);
  // 0.05 m along x and 0.1 m along y of the net, which is turned by a quarter about z.
  EXPECT_NEAR(structure.rest_positions.at(3 * finger), -0.1F, 1e-6F);
  EXPECT_NEAR(structure.rest_positions.at(3 * finger + 1), 0.05F, 1e-6F);
  int coordinates = 0;
  for (const std::uint32_t section : structure.module_sections) {
    coordinates += structure.section_dimensions.at(section);
  }
  EXPECT_EQ(coordinates, scene.coordinates());
}

TEST(ConvertTest, ParametersHaveRangesUnitsAndTheirPresentValues) {
  const scene::Scene scene = scene::readYaml(R"(ergotic: 1
name: two
parameters:
  pull: {value: 2, range: [1, 30], unit: N}
  volume: {value: 0.5, range: [0, 1]}
sections:
  s: {rate: audio}
mats:
  a: {type: mass, section: s, mass: 0.01}
)",
                                             "two.yaml");
  const ParametersMessage parameters = sentAndReceived(toParameters(scene, {3.0, 0.25}));
  EXPECT_EQ(parameters.names, (std::vector<std::string>{"pull", "volume"}));
  EXPECT_EQ(parameters.values, (std::vector<double>{3.0, 0.25}));
  EXPECT_EQ(parameters.lows, (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(parameters.highs, (std::vector<double>{30.0, 1.0}));
  EXPECT_EQ(parameters.defaults, (std::vector<double>{2.0, 0.5}));
  EXPECT_EQ(parameters.units, (std::vector<std::string>{"N", ""}));
}

TEST(ConvertTest, JointsAreNamedAfterTheirSlices) {
  station::Snapshot snapshot;
  snapshot.slices = 2;
  snapshot.slice_position[1] = 0.01;
  snapshot.slice_velocity[1] = -0.2;
  snapshot.slice_force[1] = 3.0;
  const auto joints = toJointState(snapshot);
  EXPECT_EQ(joints.name, (std::vector<std::string>{"slice_0", "slice_1"}));
  EXPECT_EQ(joints.position, (std::vector<double>{0.0, 0.01}));
  EXPECT_EQ(joints.velocity, (std::vector<double>{0.0, -0.2}));
  EXPECT_EQ(joints.effort, (std::vector<double>{0.0, 3.0}));
}

TEST(ConvertTest, EveryEventHasWordsOfItsOwn) {
  std::vector<std::string> texts;
  for (std::uint8_t type = Event::ENGAGED; type <= Event::INJECTED; ++type) {
    station::Event event;
    event.type = static_cast<station::Event::Type>(type);
    const Event message = toEvent(event, nullptr);
    EXPECT_EQ(message.type, type);
    EXPECT_FALSE(message.text.empty());
    EXPECT_EQ(std::count(texts.begin(), texts.end(), message.text), 0) << message.text;
    texts.push_back(message.text);
  }
}

TEST(ConvertTest, ParameterEventsNameTheParameter) {
  scene::Scene scene;
  scene.parameters.resize(2);
  scene.parameters[1].name = "tension";
  station::Event event;
  event.type = station::Event::Type::kParameter;
  event.index = 1;
  event.value = 0.5;
  EXPECT_EQ(toEvent(event, &scene).text, "tension = 0.5");
  EXPECT_EQ(toEvent(event, nullptr).text, "parameter 1 = 0.5");
  event.frame = -1;
  EXPECT_EQ(toEvent(event, &scene).text, "parameter 1 of the model that comes next = 0.5");
  EXPECT_EQ(toEvent(event, &scene).frame, -1) << "so that a replay knows it";
}

TEST(ConvertTest, StatusSaysWhyForceIsGone) {
  station::Snapshot snapshot;
  snapshot.state = station::ForceState::kFault;
  snapshot.fault = station::FaultReason::kStall;
  snapshot.stall_s = 0.0631;
  snapshot.counters.underruns = 7;
  snapshot.counters.bad_input_samples = 3;
  snapshot.counters.peak_force_n = 20.0;
  snapshot.counters.peak_raw_force_n = 60.0;
  Status status;
  fillStatus(snapshot, status);
  status = sentAndReceived(status);
  EXPECT_EQ(status.state, Status::FAULT);
  EXPECT_EQ(status.fault, Status::FAULT_STALL);
  EXPECT_EQ(status.underruns, 7);
  EXPECT_EQ(status.bad_input_samples, 3);
  EXPECT_EQ(status.peak_force, 20.0);
  EXPECT_EQ(status.peak_raw_force, 60.0);
  EXPECT_THAT(
      status.state_text,
      HasSubstr("the real-time thread stood still for 63.1 ms, longer than max_stall allows"));
  snapshot.stalls_borne = 3;
  fillStatus(snapshot, status);
  EXPECT_THAT(
      status.state_text,
      HasSubstr("more often than max_stalls allows (3 in a second), the last time for 63.1 ms"));
}

TEST(ConvertTest, StatusListsSlicesWithoutCalibration) {
  Status status;
  fillStatus(std::uint64_t{1} << 63U | 5U, status);
  EXPECT_EQ(status.uncalibrated, (std::vector<std::uint32_t>{0, 2, 63}));
  fillStatus(std::uint64_t{0}, status);
  EXPECT_TRUE(status.uncalibrated.empty());
}

TEST(ConvertTest, EnergyKeepsSectionsAndCouplingsApart) {
  station::MotionFrame motion;
  motion.tick = 5;
  motion.energies.sections = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}};
  motion.energies.couplings = {{0, 1, 13, 14, 15}};
  motion.energies.stored = 31;
  motion.energies.from_parameters = 16;
  motion.energies.residual = 1e-12;
  const ModelEnergy energy = sentAndReceived(toModelEnergy(motion));
  EXPECT_EQ(energy.tick, 5);
  EXPECT_EQ(energy.kinetic, (std::vector<double>{1, 7}));
  EXPECT_EQ(energy.potential, (std::vector<double>{2, 8}));
  EXPECT_EQ(energy.dissipated, (std::vector<double>{3, 9}));
  EXPECT_EQ(energy.from_device, (std::vector<double>{4, 10}));
  EXPECT_EQ(energy.from_inputs, (std::vector<double>{5, 11}));
  EXPECT_EQ(energy.from_links, (std::vector<double>{6, 12}));
  EXPECT_EQ(energy.couplings, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(energy.coupling_stored, std::vector<double>{13});
  EXPECT_EQ(energy.coupling_dissipated, std::vector<double>{14});
  EXPECT_EQ(energy.coupling_made, std::vector<double>{15});
  EXPECT_EQ(energy.stored, 31);
  EXPECT_EQ(energy.from_parameters, 16);
  EXPECT_EQ(energy.residual, 1e-12);
}

TEST(ConvertTest, StatusNamesAEnergyStableLinkAsLongAsItIsCutTooOften) {
  const scene::Scene scene = scene::readYaml(kScene, "two.yaml");
  station::MotionFrame motion;
  motion.energies.stored = 2.0;
  motion.energies.residual = 1e-9;
  motion.tanks = {{0, 1000, 100}};
  Status status;
  fillStatus(motion, scene, status);
  EXPECT_EQ(status.stored_energy, 2.0);
  EXPECT_EQ(status.energy_residual, 0.5e-9);
  EXPECT_THAT(status.guard_warning, HasSubstr("two.yaml:9:"));
  EXPECT_THAT(status.guard_warning, HasSubstr("'l'"));
  motion.tanks = {{0, 10000, 100}};
  fillStatus(motion, scene, status);
  EXPECT_EQ(status.guard_warning, "");
}

TEST(ConvertTest, CutsNameTheLinksThatWereCutThoseCutMostFirst) {
  const scene::Scene scene = scene::readYaml(std::string(kScene) + R"(
  m: {type: spring, between: [a, b], stiffness: 10}
  n: {type: spring, between: [a, b], stiffness: 10}
)",
                                             "two.yaml");
  station::MotionFrame motion;
  motion.tanks = {{0, 1000, 3}, {1, 1000, 0}, {2, 12345678901, 7}};
  const Cuts cuts = sentAndReceived(toCuts(motion, scene));
  EXPECT_EQ(cuts.links, (std::vector<std::string>{"n", "l"}));
  EXPECT_EQ(cuts.active, (std::vector<std::int64_t>{12345678901, 1000}));
  EXPECT_EQ(cuts.cut, (std::vector<std::int64_t>{7, 3}));
}

TEST(ConvertTest, CutsAreAtMostAHundredThoseCutMostOften) {
  const scene::Scene scene = scene::readYaml(kScene, "two.yaml");
  station::MotionFrame motion;
  for (std::int64_t n = 1; n <= 150; ++n) {
    motion.tanks.push_back({0, 1000, n});
  }
  const Cuts cuts = toCuts(motion, scene);
  ASSERT_EQ(cuts.links.size(), 100U);
  EXPECT_EQ(cuts.active.size(), 100U);
  ASSERT_EQ(cuts.cut.size(), 100U);
  EXPECT_EQ(cuts.cut.front(), 150);
  EXPECT_EQ(cuts.cut.back(), 51);
}

TEST(ConvertTest, KeyframeSurvivesTheWireBitForBit) {
  const scene::Scene scene = scene::readYaml(kScene, "two.yaml");
  physics::CompileOptions options(physics::Precision::kDouble);
  options.isa = rt::Isa::kBaseline;
  options.threads = 2;
  options.metered = false;
  const auto instrument = physics::compile(physics::settle(scene, {}).scene, {}, options);
  station::Keyframe keyframe;
  keyframe.tick = 123456789012;
  keyframe.state.resize(instrument->stateSize());
  instrument->saveState(keyframe.state.data());
  const Keyframe received = sentAndReceived(toKeyframe(keyframe, *instrument, 12));
  EXPECT_EQ(received.tick, keyframe.tick);
  EXPECT_EQ(received.state, keyframe.state);
  EXPECT_EQ(received.scene, kScene);
  EXPECT_EQ(received.scene_hash, textHash(kScene));
  EXPECT_EQ(received.precision, "double");
  EXPECT_EQ(received.isa, "baseline");
  EXPECT_EQ(received.threads, 2U);
  EXPECT_FALSE(received.metered);
  EXPECT_EQ(received.slices, 12U);
}

TEST(ConvertTest, StatusSaysHowTheModelWasCompiled) {
  const scene::Scene scene = physics::settle(scene::readYaml(kScene, "two.yaml"), {}).scene;
  Status status;
  fillStatus(*physics::compile(scene, {}, {}), status);
  EXPECT_EQ(status.precision, "float");
  EXPECT_EQ(status.isa, nameOf(rt::bestIsa()));
  EXPECT_EQ(status.threads, 1U);
  EXPECT_TRUE(status.metered);
}

TEST(ConvertTest, TextHashIsFnv1a) {
  // Reference values of the authors of the hash.
  EXPECT_EQ(textHash(""), "cbf29ce484222325");
  EXPECT_EQ(textHash("foobar"), "85944171f73967e8");
}

station::GestureTick tickAt(std::int64_t number) {
  station::GestureTick tick;
  tick.tick = number;
  tick.slices = 2;
  tick.flags = number % 2 == 0 ? 0U : std::uint32_t{station::GestureTick::kHeld};
  tick.position[0] = 1.0 / static_cast<double>(number + 1);
  tick.position[1] = -tick.position[0];
  tick.force[1] = static_cast<float>(number);
  tick.ports = 1;
  tick.port[0] = 3.0 * tick.position[0];
  return tick;
}

TEST(GestureBlocksTest, HoldAtMostSixtyFourTicksAndTwentyMilliseconds) {
  EXPECT_EQ(GestureBlocks(3150.0).ticksPerBlock(), 63U);
  EXPECT_EQ(GestureBlocks(44100.0).ticksPerBlock(), 64U);
  EXPECT_EQ(GestureBlocks(200.0).ticksPerBlock(), 4U);
  EXPECT_EQ(GestureBlocks(10.0).ticksPerBlock(), 1U);
}

TEST(GestureBlocksTest, KeepEveryTickInOrderBitForBit) {
  GestureBlocks blocks(3150.0);
  std::int64_t next = 5;
  for (std::int64_t n = 5; n < 5 + 10 * 63; ++n) {
    const auto block = blocks.add(tickAt(n));
    ASSERT_EQ(block.has_value(), (n - 4) % 63 == 0);
    if (!block) {
      continue;
    }
    GestureBlock received;
    ::ros::serialization::deserializeMessage(::ros::serialization::serializeMessage(*block),
                                             received);
    EXPECT_EQ(received.first_tick, next);
    EXPECT_EQ(received.tick_rate_hz, 3150.0);
    ASSERT_EQ(received.ticks, 63U);
    for (std::size_t i = 0; i < received.ticks; ++i, ++next) {
      const station::GestureTick tick = tickAt(next);
      EXPECT_EQ(received.flags[i], tick.flags);
      EXPECT_EQ(received.positions[2 * i], tick.position[0]);
      EXPECT_EQ(received.positions[2 * i + 1], tick.position[1]);
      EXPECT_EQ(received.forces[2 * i + 1], tick.force[1]);
      EXPECT_EQ(received.port_positions[i], tick.port[0]);
    }
  }
}

TEST(GestureBlocksTest, BreakOffAtAGap) {
  GestureBlocks blocks(3150.0);
  EXPECT_FALSE(blocks.add(tickAt(0)));
  EXPECT_FALSE(blocks.add(tickAt(1)));
  const auto before = blocks.add(tickAt(7));
  ASSERT_TRUE(before);
  EXPECT_EQ(before->first_tick, 0);
  EXPECT_EQ(before->ticks, 2U);
  for (std::int64_t n = 8; n < 7 + 62; ++n) {
    EXPECT_FALSE(blocks.add(tickAt(n)));
  }
  const auto after = blocks.add(tickAt(7 + 62));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->first_tick, 7);
  EXPECT_EQ(after->ticks, 63U);
}

TEST(GestureBlocksTest, LoseNothingWhenAGapMeetsBlocksOfOneTick) {
  GestureBlocks blocks(10.0);
  EXPECT_EQ(blocks.add(tickAt(0))->first_tick, 0);
  EXPECT_EQ(blocks.add(tickAt(5))->first_tick, 5);
}

}  // namespace
}  // namespace ergotic::node
