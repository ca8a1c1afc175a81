// SPDX-License-Identifier: BSD-3-Clause
// What is attached to a slice and is not worked out, or not all: that is said.

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

Certificate judged(const scene::Scene& scene) {
  return certify(settle(scene, kRates).scene, kRates);
}

/// So many masses, 0.1 kg in all, that move nearly as one, and lose; on a link.
scene::Scene bodyOn(int masses, LiaType type, double loss = 0.0) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int ground = b.ground();
  const int first = b.mass(0.1 / masses, 0.0);
  for (int i = 1; i < masses; ++i) {
    b.spring(b.mass(0.1 / masses, 0.0), first + i - 1, 1e5);
  }
  b.spring(first, ground, 0.0, loss);
  b.link(type, slice, first, 2000.0);
  b.scene.lias.back().scheme =
      type == LiaType::kContact ? Scheme::kEnergyStable : Scheme::kExplicit;
  return b.scene;
}

TEST(LeftOutSlicesTest, MoreThanAHundredMasses) {
  EXPECT_THAT(judged(bodyOn(100, LiaType::kSpringDamper)).findings,
              ElementsAre(HasSubstr("begins to swing with what is attached to link 'l100'")));
  const Certificate certificate = judged(bodyOn(101, LiaType::kSpringDamper));
  EXPECT_THAT(certificate.findings,
              ElementsAre(HasSubstr("the analysis leaves out so many masses")));
  EXPECT_EQ(certificate.ports.at(0).level, HandLevel::kWarned);
  EXPECT_EQ(certificate.ports[0].finding, certificate.findings[0]);
}

TEST(LeftOutSlicesTest, MoreThanFiftyMassesBehindATable) {
  scene::Scene scene = bodyOn(51, LiaType::kTable, 1.0);
  scene.lias.back().stiffness = {};
  scene.lias.back().law.edit().table.points = {{-0.1, -200.0}, {0.1, 200.0}};
  scene.lias.back().scheme = Scheme::kEnergyStable;
  EXPECT_THAT(judged(scene).findings,
              ElementsAre(HasSubstr("the analysis leaves out so many masses")));
}

/// Of what may let go the nearest masses tell enough.
TEST(LeftOutSlicesTest, ManyMassesBehindAContactAreNoAlarm) {
  EXPECT_THAT(judged(bodyOn(101, LiaType::kSpringDamper, 1.0)).findings, testing::SizeIs(1));
  EXPECT_TRUE(judged(bodyOn(101, LiaType::kContact, 1.0)).findings.empty());
  EXPECT_THAT(judged(bodyOn(101, LiaType::kContact)).findings,
              ElementsAre(HasSubstr("begins to swing with")));
}

scene::Scene massOfSection(int section, double stiffness) {
  SceneBuilder b;
  b.spring(b.mass(0.1, 0.0, 0.0, section), b.slice(0), stiffness);
  return b.scene;
}

TEST(LeftOutSlicesTest, SectionsThatAreSlower) {
  scene::Scene scene = massOfSection(SceneBuilder::kAudio, 2000.0);
  scene.sections.at(SceneBuilder::kAudio).divisor = 28;
  EXPECT_THAT(judged(scene).findings, ElementsAre(HasSubstr("slower than the slice")));
}

/// A mass on a line that is turned by 60 degrees moves against a slice like four times its weight.
TEST(LeftOutSlicesTest, LinesThatAreTurned) {
  scene::Scene scene = massOfSection(SceneBuilder::kAudio, 500.0);
  scene::Section& section = scene.sections.at(SceneBuilder::kAudio);
  section.geometry = Geometry::kLine;
  EXPECT_TRUE(judged(scene).findings.empty());
  section.pose.rotate(Eigen::AngleAxisd(kPi / 3.0, Eigen::Vector3d::UnitZ()));
  EXPECT_THAT(judged(scene).findings, ElementsAre(HasSubstr("other axes than their links")));
}

/// Three modes of seven give way less than the seven masses do: set in motion, it never rests.
TEST(LeftOutSlicesTest, ASectionThatIsPlayedByFewerModes) {
  const auto string = [](int modes) {
    SceneBuilder b;
    int last = b.ground();
    for (int i = 0; i < 7; ++i) {
      const int next = b.mass(0.0367, 0.0);
      b.spring(next, last, 655.0, 0.52);
      last = next;
    }
    b.spring(b.slice(0), last, 9092.0);
    b.scene.sections[0].medium = {0.0035};
    b.scene.sections[0].modes = modes;
    return judged(b.scene);
  };
  EXPECT_EQ(string(scene::kAllModes).ports.at(0).level, HandLevel::kSilent);
  EXPECT_NE(string(3).ports.at(0).level, HandLevel::kSilent);
}

/// The place under a link moves as its hand does, and so does what the link pulls at.
TEST(LeftOutSlicesTest, APointThatItMovesAndPullsAt) {
  const auto guided = [](double scale, double height) {
    SceneBuilder b;
    const int hand = b.slice(0);
    const int wall = b.ground();
    const int first = b.mass(0.01, 0.0);
    b.mass(0.01, 0.0);
    b.scene.mats.at(at(first + 1)).position.x() = height;
    b.spring(wall, first, 1e6, 100.0);
    b.spring(wall, first + 1, 1e6, 100.0);
    b.spring(hand, b.point(b.grid(first, 2), 0.5), 200.0);
    b.scene.connections.at(0).along.guide = hand;
    b.scene.connections[0].along.scale = scale;
    return judged(b.scene);
  };
  EXPECT_THAT(guided(200.0, 0.0).findings,
              Contains(HasSubstr("a point that it moves and pulls at")));
  EXPECT_THAT(guided(-2.0, 0.1).findings,
              Contains(HasSubstr("a point that it moves and pulls at")));
  EXPECT_EQ(guided(2.0, 0.0).ports.at(0).level, HandLevel::kSilent);
}

/// Two masses on stiff springs, a spring from a slice to the place between them.
struct Slope {
  int hand;
  int point;
};
Slope slopeOf(SceneBuilder& b, int slice) {
  const int hand = b.slice(slice);
  const int wall = b.ground();
  const int first = b.mass(0.01, 0.0);
  b.mass(0.01, 0.0);
  b.scene.mats.at(at(first + 1)).position.x() = 0.05;
  b.spring(wall, first, 1e6, 100.0);
  b.spring(wall, first + 1, 1e6, 100.0);
  const Slope slope{hand, b.point(b.grid(first, 2), 0.5)};
  b.spring(hand, slope.point, 200.0);
  return slope;
}

/// A mass that goes with the slice moves the point, and is pushed by nothing of that.
TEST(LeftOutSlicesTest, APointThatAMassOnItMoves) {
  SceneBuilder b;
  const Slope slope = slopeOf(b, 0);
  const int mass = b.mass(1e-5, 0.0);
  b.spring(slope.hand, mass, 1500.0, 0.1);
  EXPECT_EQ(judged(b.scene).ports.at(0).level, HandLevel::kSilent);
  b.scene.connections.at(0).along.guide = mass;
  b.scene.connections[0].along.scale = -200.0;
  EXPECT_THAT(judged(b.scene).findings, Contains(HasSubstr("a point that it moves and pulls at")));
}

/// Each of two slices moves the point that the other one pulls at.
TEST(LeftOutSlicesTest, APointThatItMovesByAnotherSlice) {
  SceneBuilder b;
  const Slope left = slopeOf(b, 0);
  const Slope right = slopeOf(b, 1);
  for (scene::Connection& connection : b.scene.connections) {
    connection.along.guide = connection.mat == left.point ? right.hand : left.hand;
    connection.along.scale = -200.0;
  }
  const Certificate certificate = judged(b.scene);
  EXPECT_NE(certificate.ports.at(0).level, HandLevel::kSilent);
  EXPECT_NE(certificate.ports.at(1).level, HandLevel::kSilent);
  b.scene.connections.at(0).along.guide = -1;  // one way is no loop
  EXPECT_EQ(judged(b.scene).ports.at(0).level, HandLevel::kSilent);
}

}  // namespace
}  // namespace ergotic::physics
