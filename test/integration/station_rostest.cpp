// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <filesystem>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/Cuts.h>
#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/HandTargets.h>
#include <ergotic/InjectFault.h>
#include <ergotic/Keyframe.h>
#include <ergotic/LoadModel.h>
#include <ergotic/ModelEnergy.h>
#include <ergotic/ModelState.h>
#include <ergotic/ModelStructure.h>
#include <ergotic/SetParameter.h>
#include <ergotic/Status.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include "ergotic/audio/capture.hpp"
#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/isa.hpp"
#include "integration/station_services.hpp"
#include "support/jack_server.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

constexpr double kSilence = 3.2e-5;  // -90 dBFS
constexpr double kHeard = 1e-3;
const std::string kModel = repository("test/integration/plucked_string.yaml");

/// A JACK server, a nodelet manager and the station in it, once for all tests: what they do builds
/// on one another no more than the order in which a player does it.
class StationTest : public ::testing::Test {
 protected:
  struct World {
    World() : jack("rostest") {
      jack.start();
      manager = std::make_unique<ChildProcess>(
          std::vector<std::string>{"/usr/lib/nodelet/nodelet", "manager", "__name:=manager"},
          std::map<std::string, std::string>{{"JACK_DEFAULT_SERVER", jack.name()}});
      node.setParam("/station/model", kModel);
      node.setParam("/station/ramp", 0.1);
      allowStalls(node);
      node.setParam("/station/jack_wait", 30.0);
      node.setParam("/station/jack_connect", false);
      node.setParam("/station/allow_fault_injection", true);
      load_nodelet();
    }
    void load_nodelet() {
      nodelet::NodeletLoad load;
      load.request.name = "/station";
      load.request.type = "ergotic/Station";
      if (!::ros::service::waitForService("/manager/load_nodelet", 30000) ||
          !::ros::service::call("/manager/load_nodelet", load) || load.response.success == 0U) {
        throw std::runtime_error("the manager does not load ergotic/Station");
      }
    }

    void unload_nodelet() const {
      nodelet::NodeletUnload unload;
      unload.request.name = "/station";
      EXPECT_TRUE(::ros::service::call("/manager/unload_nodelet", unload));
      EXPECT_TRUE(unload.response.success);
    }

    ::ros::NodeHandle node;
    Listener<Status> status{node, "/station/status"};
    Listener<Cuts> cuts{node, "/station/cuts"};
    Listener<Event> events{node, "/station/events"};
    Listener<GestureBlock> gesture{node, "/station/gesture"};
    Listener<Keyframe> keyframes{node, "/station/keyframe"};
    Listener<ModelEnergy> energy{node, "/station/model_energy"};
    Listener<ModelState> model_state{node, "/station/model_state"};
    Listener<ModelStructure> structure{node, "/station/model_structure"};
    Listener<sensor_msgs::JointState> joints{node, "/station/joint_states"};
    Listener<visualization_msgs::MarkerArray> markers{node, "/station/markers"};
    Listener<diagnostic_msgs::DiagnosticArray> diagnostics{node, "/diagnostics"};
    ::ros::Publisher hand = node.advertise<HandTargets>("/station/hand_targets", 10);
    JackServer jack;
    std::unique_ptr<ChildProcess> manager;
  };

  /// In the first test, so that a failure here is a failure of a test.
  void SetUp() override {
    if (world_ == nullptr) {
      world_ = std::make_unique<World>();
    }
    ASSERT_TRUE(eventually([] { return world_->status.latest().model == "plucked string"; }));
    ASSERT_TRUE(eventually([] { return world_->status.latest().audio_running != 0U; }));
    ASSERT_TRUE(eventually([] { return world_->hand.getNumSubscribers() > 0; }));
  }
  static void TearDownTestSuite() { world_.reset(); }

  static LoadModel::Response load(const std::string& model) {
    LoadModel load;
    load.request.model = model;
    EXPECT_TRUE(::ros::service::call("/station/load_model", load));
    return load.response;
  }
  static void moveHand(double target) { test::moveHand(world_->hand, 0, target); }
  static bool eventually(const std::function<bool()>& condition) {
    return test::eventually(condition);
  }
  static bool isAdvertised(const std::string& topic) {
    ::ros::master::V_TopicInfo topics;
    ::ros::master::getTopics(topics);
    return std::any_of(topics.begin(), topics.end(),
                       [&topic](const auto& info) { return info.name == topic; });
  }
  static double sliceEffort() {
    const auto joints = world_->joints.latest();
    return joints.effort.empty() ? 0.0 : joints.effort.front();
  }

  static std::unique_ptr<World> world_;
};
std::unique_ptr<StationTest::World> StationTest::world_;

/// Root mean square of what the station's first port sends while `action` runs and after.
double heardDuring(const JackServer& jack, const std::function<void()>& action) {
  const auto path = std::filesystem::temp_directory_path() / (jack.name() + ".wav");
  audio::CaptureConfig config;
  config.path = path.string();
  config.ports = {"ergotic:out_1"};
  config.server = jack.name();
  config.seconds = 2.0;
  audio::capture(config, std::atomic<bool>(false), [&](const auto&) { action(); });
  const std::vector<double> samples = audio::WavReader(path.string()).readAll();
  std::filesystem::remove(path);
  double sum = 0.0;
  for (const double sample : samples) {
    sum += sample * sample;
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

TEST_F(StationTest, DescribesItsModel) {
  const ModelStructure structure = world_->structure.latest();
  const Status status = world_->status.latest();
  EXPECT_EQ(structure.module_names.size(), status.modules);
  EXPECT_EQ(structure.rest_positions.size(), 3 * structure.module_names.size());
  EXPECT_EQ(structure.links.size(), 2 * status.links);
  ASSERT_EQ(structure.string_names, std::vector<std::string>{"string"});
  EXPECT_EQ(structure.string_count.front(), 22U);
  EXPECT_EQ(status.audio_rate, 44100.0);
  EXPECT_EQ(status.gestural_rate, 44100.0 / status.ratio);
  EXPECT_EQ(status.precision, "float");
  EXPECT_EQ(status.isa, rt::nameOf(rt::bestIsa()));
  EXPECT_EQ(status.threads, 1U);
}

TEST_F(StationTest, IsSilentAndWithoutForceBeforeTheFirstTouch) {
  EXPECT_EQ(world_->status.latest().state, Status::READY);
  EXPECT_LT(heardDuring(world_->jack, [] {}), kSilence);
  for (const auto& block : world_->gesture.messages()) {
    EXPECT_TRUE(
        std::all_of(block.forces.begin(), block.forces.end(), [](float f) { return f == 0.0F; }));
  }
}

TEST_F(StationTest, PlaysWhatTheHandPlucks) {
  const auto engaged = call("engage");
  ASSERT_TRUE(engaged.success) << engaged.message;
  ASSERT_TRUE(eventually([] { return world_->status.latest().state == Status::PLAYING; }));
  const double heard = heardDuring(world_->jack, [] { moveHand(0.02); });
  EXPECT_GT(heard, kHeard);

  // The hand got there, through the string; the picture and the record saw it.
  EXPECT_TRUE(eventually([] {
    const auto joints = world_->joints.latest();
    return !joints.position.empty() && joints.position.front() > 0.015;
  }));
  EXPECT_EQ(world_->joints.latest().name.at(3), "slice_3");
  const auto states = world_->model_state.messages();
  EXPECT_TRUE(std::any_of(states.begin(), states.end(), [](const ModelState& state) {
    return std::any_of(state.displacement.begin() + 1, state.displacement.end(),
                       [](float d) { return std::abs(d) > 1e-4F; });
  }));
  const auto blocks = world_->gesture.messages();
  EXPECT_TRUE(std::any_of(blocks.begin(), blocks.end(), [](const GestureBlock& block) {
    return std::any_of(block.forces.begin(), block.forces.end(),
                       [](float f) { return f < -0.05F; });
  }));
  moveHand(0.0);
}

TEST_F(StationTest, TellsWhereTheEnergyOfThePluckWent) {
  EXPECT_TRUE(eventually([] {
    const ModelEnergy energy = world_->energy.latest();
    return std::any_of(energy.from_device.begin(), energy.from_device.end(),
                       [](double joule) { return std::abs(joule) > 1e-6; });
  }));
  const ModelEnergy energy = world_->energy.latest();
  EXPECT_EQ(energy.kinetic.size(), world_->structure.latest().section_names.size());
  EXPECT_EQ(energy.couplings.size(), 2 * energy.coupling_stored.size());
  double dissipated = 0.0;
  for (const double joule : energy.dissipated) {
    dissipated += joule;
  }
  EXPECT_GT(dissipated, 1e-6);
  // Single precision. Double precision is held to 1e-10 by the tests of physics.
  EXPECT_LT(std::abs(energy.residual), 1e-4 * dissipated);
}

TEST_F(StationTest, RecordsEveryTickOnceAndBeginsWithAKeyframe) {
  const auto blocks = world_->gesture.messages();
  ASSERT_GT(blocks.size(), 10U);
  std::int64_t next = blocks.front().first_tick;
  for (const GestureBlock& block : blocks) {
    ASSERT_EQ(block.first_tick, next);
    ASSERT_EQ(block.flags.size(), block.ticks);
    ASSERT_EQ(block.positions.size(), std::size_t{block.ticks} * block.slices);
    ASSERT_EQ(block.forces.size(), block.positions.size());
    next += block.ticks;
  }
  const Keyframe keyframe = world_->keyframes.latest();
  EXPECT_LE(blocks.front().first_tick, keyframe.tick);
  EXPECT_LT(keyframe.tick, next);
  EXPECT_EQ(keyframe.slices, blocks.front().slices);
  EXPECT_FALSE(keyframe.state.empty());
  EXPECT_THAT(keyframe.scene, HasSubstr("plucked string"));
  EXPECT_EQ(keyframe.scene_hash, world_->structure.latest().scene_hash);
}

TEST_F(StationTest, KeepsPlayingWhenAModelIsBroken) {
  const std::int64_t before = world_->status.latest().ticks;
  const auto answer = load(
      "ergotic: 1\nname: broken\nsections:\n  s: {rate: audio}\nmats:\n"
      "  a: {type: mass, section: s, mass: -1}\n");
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.message.rfind("inline.yaml:6:", 0), 0U) << answer.message;
  EXPECT_THAT(answer.message, HasSubstr(": error: "));
  const auto nosy = load("ergotic: 1\nsections: {s: {rate: audio}}\ninclude: [etc/passwd]\n");
  EXPECT_THAT(nosy.message, HasSubstr("this text is no file and has no folder"));
  EXPECT_TRUE(eventually([before] { return world_->status.latest().ticks > before + 3000; }));
  EXPECT_EQ(world_->status.latest().model, "plucked string");
  EXPECT_EQ(world_->status.latest().state, Status::PLAYING);
}

TEST_F(StationTest, SwapsModelsAndTellsWhichOnePlays) {
  const auto answer = load(
      "ergotic: 1\nname: one mass\nsections:\n  s: {rate: audio}\nmats:\n"
      "  a: {type: cell, section: s, mass: 0.01, stiffness: 100}\n");
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.verdict, "passive");
  EXPECT_THAT(answer.message, StartsWith("plays 'one mass'"));
  EXPECT_TRUE(eventually([] { return world_->structure.latest().name == "one mass"; }));
  EXPECT_TRUE(eventually([] { return world_->model_state.latest().displacement.size() == 1; }));
  ASSERT_TRUE(load(kModel).success);
  EXPECT_TRUE(eventually([] { return world_->status.latest().model == "plucked string"; }));
}

TEST_F(StationTest, NamesTheContactThatIsTooStiffAsLongAsItsModelPlays) {
  ASSERT_TRUE(load("ergotic: 1\nname: hard\nsections:\n  s: {rate: audio, gravity: -9.81}\nmats:\n"
                   "  floor: {type: ground, section: s}\n"
                   "  ball: {type: mass, section: s, mass: 1 g, x: 1 mm}\nlias:\n"
                   "  touch: {type: contact, between: [floor, ball], stiffness: 1e9, damping: 0}\n")
                  .success);
  EXPECT_TRUE(
      eventually([] { return world_->cuts.latest().links == std::vector<std::string>{"touch"}; }));
  const Cuts cuts = world_->cuts.latest();
  ASSERT_EQ(cuts.cut.size(), 1U);
  ASSERT_EQ(cuts.active.size(), 1U);
  EXPECT_GT(cuts.cut.front(), 0);
  EXPECT_LE(cuts.cut.front(), cuts.active.front());
  ASSERT_TRUE(load(kModel).success);
  EXPECT_TRUE(eventually([] {
    const auto links = world_->cuts.latest().links;
    return std::find(links.begin(), links.end(), "touch") == links.end();
  }));
}

TEST_F(StationTest, SetsParametersWithinTheirRange) {
  SetParameter set;
  set.request.name = "loss";
  set.request.value = 1e-4;
  ASSERT_TRUE(::ros::service::call("/station/set_parameter", set));
  EXPECT_TRUE(set.response.success) << set.response.message;
  set.request.value = 1e4;
  ASSERT_TRUE(::ros::service::call("/station/set_parameter", set));
  EXPECT_FALSE(set.response.success);
  EXPECT_THAT(set.response.message, HasSubstr("loss"));
  set.request.name = "los";
  ASSERT_TRUE(::ros::service::call("/station/set_parameter", set));
  EXPECT_FALSE(set.response.success);
  EXPECT_THAT(set.response.message, HasSubstr("has no parameter 'los', it has: loss = "));
  const auto events = world_->events.messages();
  EXPECT_TRUE(eventually([] {
    const auto seen = world_->events.messages();
    return std::any_of(seen.begin(), seen.end(), [](const Event& event) {
      return event.type == Event::PARAMETER && event.value == 1e-4;
    });
  }));
}

TEST_F(StationTest, DrawsItsModelInFrameModel) {
  ASSERT_TRUE(eventually([] { return world_->markers.latest().markers.size() > 1; }));
  const auto markers = world_->markers.latest().markers;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    EXPECT_EQ(markers[i].header.frame_id, "model");
    if (markers[i].action == visualization_msgs::Marker::DELETEALL) {
      EXPECT_EQ(i, 0U) << "what was there is erased before anything is drawn";
    } else {
      EXPECT_FALSE(markers[i].points.empty());
    }
  }
}

TEST_F(StationTest, ReportsDiagnostics) {
  EXPECT_TRUE(eventually([] {
    const auto seen = world_->diagnostics.messages();
    return std::any_of(seen.begin(), seen.end(), [](const auto& array) {
      return array.status.size() == 4 && array.status.front().level == 0 &&
             array.status.front().message == world_->status.latest().state_text;
    });
  }));
}

TEST_F(StationTest, KeepsItsForceWhileSoundIsLostAndComesBack) {
  ASSERT_TRUE(eventually([] { return world_->status.latest().state == Status::PLAYING; }));
  const std::size_t before = world_->events.count();
  InjectFault inject;
  inject.request.kind = "jack_lost";
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", inject));
  ASSERT_TRUE(inject.response.success) << inject.response.message;
  const auto told = [before](std::uint8_t type) {
    const auto events = world_->events.messages();
    return std::any_of(events.begin() + static_cast<std::ptrdiff_t>(before), events.end(),
                       [type](const Event& event) { return event.type == type; });
  };
  EXPECT_TRUE(eventually([&] { return told(Event::AUDIO_STOPPED); }));
  EXPECT_TRUE(eventually([&] { return told(Event::AUDIO_STARTED); }));
  EXPECT_FALSE(told(Event::STOPPED));
  EXPECT_EQ(world_->status.latest().state, Status::PLAYING) << "playing on";
}

TEST_F(StationTest, StopsForceOnRequest) {
  const auto stopped = call("stop");
  EXPECT_TRUE(stopped.success) << stopped.message;
  EXPECT_TRUE(eventually([] { return world_->status.latest().state == Status::READY; }));
  EXPECT_TRUE(eventually([] { return sliceEffort() == 0.0; }));
}

TEST_F(StationTest, CanBeUnloadedAndLoadedAgain) {
  const std::int64_t before = world_->status.latest().ticks;
  world_->unload_nodelet();
  EXPECT_FALSE(::ros::service::exists("/station/engage", false));
  world_->load_nodelet();
  EXPECT_TRUE(::ros::service::waitForService("/station/engage", 30000));
  EXPECT_TRUE(eventually([before] {
    const Status status = world_->status.latest();
    return status.state == Status::READY && status.ticks < before;
  }));
}

TEST_F(StationTest, CompilesAsItsParametersSayAndSaysWhatIsWrongInThem) {
  EXPECT_TRUE(isAdvertised("/station/model_energy"));
  world_->unload_nodelet();
  world_->node.setParam("/station/precision", "double");
  world_->node.setParam("/station/isa", "avx4096");
  world_->node.setParam("/station/threads", 9);
  world_->node.setParam("/station/energies", false);
  world_->load_nodelet();
  const auto saysOf = [](const std::string& name, const std::string& refusal) {
    return eventually([&] {
      return world_->status.latest().message.find("/station/" + name + " is " + refusal) == 10;
    });
  };
  EXPECT_TRUE(saysOf("isa", "avx4096, allowed: ")) << world_->status.latest().message;
  world_->node.setParam("/station/isa", "baseline");
  EXPECT_FALSE(load(kModel).success);
  EXPECT_TRUE(saysOf("threads", "9, allowed: 1...8")) << world_->status.latest().message;
  world_->node.setParam("/station/threads", 2);
  world_->node.setParam("/station/force_limt", 5);
  EXPECT_EQ(load(kModel).message,
            "parameter /station/force_limt is not known; did you mean 'force_limit'?");
  world_->node.deleteParam("/station/force_limt");
  ASSERT_TRUE(load(kModel).success);
  EXPECT_TRUE(eventually([] { return world_->status.latest().precision == "double"; }));
  EXPECT_EQ(world_->status.latest().isa, "baseline");
  EXPECT_EQ(world_->status.latest().threads, 2U);
  EXPECT_FALSE(world_->status.latest().metered);
  EXPECT_FALSE(isAdvertised("/station/model_energy"));
}

}  // namespace
}  // namespace ergotic::test
