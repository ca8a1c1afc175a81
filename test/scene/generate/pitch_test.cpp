// SPDX-License-Identifier: BSD-3-Clause

#include "ergotic/scene/generate/pitch.hpp"

#include <Eigen/Core>

#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/cut_string.hpp"
#include "ergotic/scene/grid.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

using Places = std::vector<Eigen::Vector3d>;

Scene stringScene(const std::string& fields, const std::string& section = "") {
  return readYaml("ergotic: 1\nparameters: {p: {value: 2, range: [1, 3]}}\nsections: {a: {" +
                      section + "}}\ngenerators: [{type: string, name: s, to: [1, 0], " + fields +
                      "}]\n",
                  "string.yaml");
}

/// Forces of all links on all modules, written out from the laws.
Places linkForces(const Scene& scene, const Places& x, const Places& before, double h) {
  const bool scalar = scene.sections[0].geometry == Geometry::kScalar;
  Places forces(x.size(), Eigen::Vector3d::Zero());
  for (const Lia& lia : scene.lias) {
    const auto a = static_cast<std::size_t>(lia.a);
    const auto b = static_cast<std::size_t>(lia.b);
    const Eigen::Vector3d apart = x[a] - x[b];
    const Eigen::Vector3d apart_before = before[a] - before[b];
    const double length = scalar ? apart.x() : apart.norm();
    const double slip = length - (scalar ? apart_before.x() : apart_before.norm());
    const double force = scene.valueOf(lia.stiffness) * (length - lia.rest_length) +
                         scene.valueOf(lia.damping) / h * slip;
    const Eigen::Vector3d along = scalar ? Eigen::Vector3d(1.0, 0.0, 0.0) : apart / length;
    forces[a] -= force * along;
    forces[b] += force * along;
  }
  return forces;
}

/// Steps the string from the shape of its first mode, across it where it can move so; the pitch
/// from x[n-1], x[n], x[n+1] and x[n+2] of one mass, which obey x[n+1] = p x[n] - q x[n-1] when one
/// mode moves alone.
double steppedPitchHz(const Scene& scene, const StringInfo& s, double rate_hz) {
  const double h = 1.0 / (rate_hz * scene.time_unit_s);
  const double m = scene.valueOf(s.mass);
  const double y = scene.valueOf(s.loss) + scene.valueOf(scene.sections[0].medium);
  const bool first_order = scene.mats[1].type == MatType::kCell && !scene.mats[1].matched;
  const double keep = first_order ? 1.0 - y * h / m : std::exp(-y * h / m);
  const int axis = dimensionsOf(scene.sections[0].geometry) > 1 ? 1 : 0;
  const auto count = static_cast<std::size_t>(s.count);
  Places x;
  for (std::size_t i = 0; i < count; ++i) {
    x.push_back(scene.mats[i].position);
    x.back()[axis] +=
        1e-5 * std::sin(M_PI * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  Places before = x;
  std::vector<double> seen;
  for (int n = 0; n < 4; ++n) {
    seen.push_back(x[count / 2][axis] - scene.mats[count / 2].position[axis]);
    const Places forces = linkForces(scene, x, before, h);
    Places next = x;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      next[i] += keep * (x[i] - before[i]) + h * h / m * forces[i];
    }
    before = x;
    x = next;
  }
  const double determinant = seen[1] * seen[1] - seen[0] * seen[2];
  const double p = (seen[1] * seen[2] - seen[0] * seen[3]) / determinant;
  const double q = (seen[2] * seen[2] - seen[1] * seen[3]) / determinant;
  return std::acos(p / (2.0 * std::sqrt(q))) / (2.0 * M_PI) * rate_hz;
}

void expectSteppedPitch(const Scene& scene, double rate_hz) {
  const double stepped = steppedPitchHz(scene, scene.strings[0], rate_hz);
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], rate_hz), stepped, 1e-6 * stepped)
      << scene.text;
}

TEST(StringPitchTest, OneUndampedMassMovesAsTheClosedFormOfTheOscillator) {
  const Scene scene = stringScene("masses: 1, mass: 0.5, stiffness: 1000");
  const double h = 1.0 / 3000.0;
  // One mass on two springs: x[n+1] = (2 - 2 k h^2 / m) x[n] - x[n-1].
  const double expected = std::acos(1.0 - 1000.0 * h * h / 0.5) / (2.0 * M_PI * h);
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 3000.0), expected, 1e-9 * expected);
}

TEST(StringPitchTest, EqualsThePitchOfASteppedString) {
  for (const char* fields : {"masses: 5, mass: 1e-3, stiffness: 2000",
                             "masses: 12, mass: 2e-4, frequency: 440, damping: 2e-3, loss: 0.3",
                             "masses: 3, mass: 1e-3*$p, stiffness: 500*$p, loss: 0.1*$p"}) {
    for (const char* section : {"", "medium: 0.1*$p"}) {
      Scene scene = stringScene(fields, section);
      expectSteppedPitch(scene, 20000.0);
      expectSteppedPitch(scene, 44100.0);
      for (Mat& mat : scene.mats) {
        mat.matched = false;
      }
      expectSteppedPitch(scene, 20000.0);
    }
  }
}

TEST(StringPitchTest, EqualsThePitchAcrossASteppedStringInAPlaneAndInSpace) {
  for (const char* section : {"geometry: plane", "geometry: space, medium: 0.1"}) {
    for (const char* ratio : {"0", "0.5", "0.9"}) {
      std::string to = section[10] == 's' ? ", from: [0, 0, 0], to: [1, 0, 0]" : ", to: [1, 0]";
      const Scene scene = readYaml(
          "ergotic: 1\nsections: {a: {" + std::string(section) +
              "}}\ngenerators: [{type: string, name: s, masses: 7, mass: 1e-3, stiffness: 2e5, "
              "damping: 0.01, loss: 0.02, rest_length_ratio: " +
              ratio + to + "}]\n",
          "string.yaml");
      expectSteppedPitch(scene, 20000.0);
    }
  }
}

TEST(StringPitchTest, EqualsThePitchAlongASteppedLine) {
  const Scene scene = readYaml(
      "ergotic: 1\nsections: {a: {geometry: line}}\ngenerators: [{type: string, name: s, masses: "
      "7, "
      "mass: 1e-3, stiffness: 2000, damping: 0.01, rest_length_ratio: 0.9, from: [0], to: [1]}]\n",
      "string.yaml");
  expectSteppedPitch(scene, 44100.0);
}

TEST(StringPitchTest, FrequencyOfAStringInAPlaneIsThatAcrossIt) {
  const Scene scene = stringScene("masses: 40, mass: 1e-4, frequency: 110, rest_length_ratio: 0.75",
                                  "geometry: plane");
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6), 110.0, 1e-5);
}

TEST(StringPitchTest, ComesCloseToTheFrequencyAskedForAtAHighRate) {
  const Scene scene = stringScene("masses: 80, mass: 1e-4, frequency: 110");
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6), 110.0, 1e-5);
  EXPECT_GT(stringPitchHz(scene, scene.strings[0], 44100.0), 110.0);
}

TEST(StringPitchTest, CountsInTheTimeUnitOfTheScene) {
  Scene scene = stringScene("masses: 5, mass: 1e-3, stiffness: 2000, damping: 1e-2, loss: 1e-2");
  const double seconds = stringPitchHz(scene, scene.strings[0], 48000.0);
  scene.time_unit_s = 1.0 / 44100.0;
  scene.strings[0].stiffness.factor /= 44100.0 * 44100.0;
  scene.strings[0].damping.factor /= 44100.0;
  scene.strings[0].loss.factor /= 44100.0;
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 48000.0), seconds, 1e-9 * seconds);
}

TEST(StringPitchTest, FollowsTheParameterAsItIsNow) {
  Scene scene = stringScene("masses: 9, mass: 1e-3, stiffness: 500*$p");
  const double two = stringPitchHz(scene, scene.strings[0], 1e6);
  scene.parameters[0].value = 3.0;
  EXPECT_NEAR(stringPitchHz(scene, scene.strings[0], 1e6) / two, std::sqrt(1.5), 1e-5);
}

TEST(StringPitchTest, IsNoNumberWhereNothingOscillates) {
  const Scene damped = stringScene("masses: 3, mass: 1e-3, stiffness: 10, loss: 1");
  EXPECT_TRUE(std::isnan(stringPitchHz(damped, damped.strings[0], 44100.0)));
  const Scene unstable = stringScene("masses: 1, mass: 1e-3, stiffness: 1e7");
  EXPECT_TRUE(std::isnan(stringPitchHz(unstable, unstable.strings[0], 44100.0)));
  const Scene slack =
      stringScene("masses: 3, mass: 1e-3, stiffness: 10, rest_length_ratio: 1", "geometry: plane");
  EXPECT_TRUE(std::isnan(stringPitchHz(slack, slack.strings[0], 44100.0)));
}

TEST(StringPitchTest, IsNoNumberBeforeACoarseStringIsFitted) {
  const Scene coarse = stringScene("masses: 20, mass: 1e-3, frequency: 110, coarse: true");
  EXPECT_TRUE(std::isnan(stringPitchHz(coarse, coarse.strings[0], 44100.0)));
}

/// A string between other things, touched at a module, at a place and by a hand.
Scene played(const std::string& more = "", const std::string& medium = "0") {
  return readYaml(
      "ergotic: 1\n"
      "parameters: {weight: {value: 1e-4, range: [5e-5, 2e-4]}}\n"
      "sections: {s: {medium: " +
          medium +
          "}, h: {rate: gestural}}\n"
          "mats:\n"
          "  key: {type: slice, section: h}\n"
          "  before: {type: mass, section: s, mass: 0.1}\n"
          "generators:\n"
          "  - {type: string, name: a, section: s, masses: 39, mass: $weight, frequency: 110,\n"
          "     damping: 1e-3, loss: 1e-5, to: [0.65, 0], pluck: {at: 0.25, height: 0.002}}\n"
          "  - {type: string, name: b, section: s, masses: 5, mass: 1e-3, frequency: 220,\n"
          "     to: [0.65, 0]}\n"
          "lias:\n"
          "  hold: {type: spring, between: [before, b.2], stiffness: 100}\n"
          "  touch: {type: contact, between: [key, a.8], stiffness: 10}\n"
          "  nut: {type: spring, between: [a.0, a.1], stiffness: 10}\n"
          "ports: {k: {mat: key, slice: 0}}\n"
          "inputs: {i: {mat: a.20, quantity: force, channel: 1}}\n"
          "outputs:\n"
          "  o: {at: a@0.3, quantity: velocity, channel: 1}\n"
          "  last: {at: a.40, quantity: position, channel: 2}\n"
          "  other: {at: b.3, quantity: position, channel: 3}\n" +
          more,
      "cut.yaml");
}

const Mat& matAt(const Scene& scene, int index) {
  return scene.mats[static_cast<std::size_t>(index)];
}
const Lia& liaNamed(const Scene& scene, const std::string& name) {
  return *std::find_if(scene.lias.begin(), scene.lias.end(),
                       [&](const Lia& lia) { return lia.name == name; });
}

/// Where along string `a` a module or point is.
double alongOf(const Scene& scene, int mat) {
  for (const Connection& connection : scene.connections) {
    if (connection.mat == mat) {
      return connection.along.at.factor;
    }
  }
  const StringInfo& a = scene.strings[0];
  return (mat - a.first) / (a.count - 1.0);
}

TEST(CutStringTest, KeepsMassPitchLossAndShapeOfTheWhole) {
  const Scene before = played();
  for (const int masses : {9, 20, 79, 160}) {
    const Scene after = cutString(before, 0, {masses, false});
    ASSERT_NO_THROW(validate(after));
    const StringInfo& a = after.strings[0];
    EXPECT_EQ(a.count, masses + 2);
    EXPECT_NEAR(idealPitchHz(after, a), 110.0, 1e-9);
    EXPECT_NEAR(after.valueOf(a.mass) * (masses + 1), 1e-4 * 40, 1e-15);
    EXPECT_NEAR(after.valueOf(a.loss) * (masses + 1), 1e-5 * 40, 1e-16);
    EXPECT_NEAR(after.valueOf(a.damping) / (masses + 1), 1e-3 / 40, 1e-16);
    EXPECT_EQ(a.mass.parameter, 0);
    EXPECT_EQ(a.stiffness.parameter, 0);
    const Grid& grid = after.grids[0];
    const GridPlace peak = placeOn(grid, 0.25, 0.0);
    double height = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      height += peak.weights[i] * matAt(after, peak.mats[i]).position.x();
    }
    EXPECT_NEAR(height, 0.002, 0.002 * 2.0 / masses) << masses;
  }
}

TEST(CutStringTest, LeavesEverythingElseWhereItWas) {
  const Scene before = played();
  for (const StringCut cut : {StringCut{9, false}, StringCut{24, true}, StringCut{160, false}}) {
    const Scene after = cutString(before, 0, cut);
    ASSERT_NO_THROW(validate(after));
    EXPECT_NEAR(alongOf(after, liaNamed(after, "touch").b), 8.0 / 40.0, 1e-12);
    EXPECT_NEAR(alongOf(after, after.inputs[0].mat), 20.0 / 40.0, 1e-12);
    EXPECT_EQ(matAt(after, liaNamed(after, "nut").a).name, "a.0");
    EXPECT_EQ(matAt(after, liaNamed(after, "hold").a).name, "before");
    EXPECT_EQ(matAt(after, liaNamed(after, "hold").b).name, "b.2");
    const Point& heard = after.outputs[0].point;
    EXPECT_NEAR(alongOf(after, heard.mat) + heard.fraction / (cut.masses + 1), 0.3, 1e-12);
    EXPECT_EQ(matAt(after, after.outputs[1].point.mat).name, "a." + std::to_string(cut.masses + 1));
    EXPECT_EQ(matAt(after, after.outputs[2].point.mat).name, "b.3");
    EXPECT_EQ(matAt(after, after.ports[0].mat).name, "key");
    EXPECT_EQ(matAt(after, after.strings[1].first).name, "b.0");
    EXPECT_EQ(after.lias[static_cast<std::size_t>(after.strings[1].first_lia)].name, "b.link.0");
  }
}

TEST(CutStringTest, ThereAndBackAgainIsTheSameString) {
  const Scene before = played();
  const Scene after = cutString(cutString(before, 0, {24, true}), 0, {39, false});
  const StringInfo& a = after.strings[0];
  EXPECT_EQ(a.frequency_hz, before.strings[0].frequency_hz);
  EXPECT_FALSE(a.coarse);
  for (const Value StringInfo::*value :
       {&StringInfo::mass, &StringInfo::stiffness, &StringInfo::damping, &StringInfo::loss}) {
    const double was = (before.strings[0].*value).factor;
    EXPECT_NEAR((a.*value).factor, was, 1e-12 * was);
  }
  EXPECT_NEAR(stringPitchHz(after, a, 44100.0), stringPitchHz(before, before.strings[0], 44100.0),
              1e-9);
}

TEST(CutStringTest, CoarseOneHasTheLinksThatTheStationFits) {
  const Scene after = cutString(played(), 0, {24, true});
  const StringInfo& a = after.strings[0];
  EXPECT_NEAR(a.frequency_hz, 110.0, 1e-9);
  EXPECT_TRUE(a.coarse);
  for (int i = 0; i < coarseLinks(24); ++i) {
    const Lia& lia = after.lias[static_cast<std::size_t>(a.first_lia + i)];
    EXPECT_EQ(lia.name, "a.link." + std::to_string(i));
    EXPECT_EQ(lia.a, a.first + coarseLink(24, i).a);
    EXPECT_EQ(lia.b, a.first + coarseLink(24, i).b);
  }
}

TEST(CutStringTest, SaysWhatIsAgainstIt) {
  using testing::HasSubstr;
  EXPECT_EQ(reasonAgainstCutting(played(), 0), "");
  EXPECT_THAT(reasonAgainstCutting(played("", "0.01"), 0), HasSubstr("medium of section 's'"));
  const std::string force = "  f: {at: a.7, quantity: force, channel: 4}\n";
  EXPECT_THAT(reasonAgainstCutting(played(force), 0), HasSubstr("output 'f'"));
  EXPECT_EQ(reasonAgainstCutting(played(force), 1), "");
}

/// Stiffness matrix of the moving masses with the given springs.
Eigen::MatrixXd stiffnessOf(int masses, const std::array<double, 3>& k) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(masses + 2, masses + 2);
  for (int i = 0; i < coarseLinks(masses); ++i) {
    const CoarseLink link = coarseLink(masses, i);
    const double stiffness = link.stiffness(k);
    whole(link.a, link.a) += stiffness;
    whole(link.b, link.b) += stiffness;
    whole(link.a, link.b) -= stiffness;
    whole(link.b, link.a) -= stiffness;
  }
  return whole.block(1, 1, masses, masses);
}

TEST(CoarseStringTest, ModesAreSinesWithTheStiffnessOfTheClosedForm) {
  const std::array<double, 3> k{0.9, -0.2, 0.07};
  for (const int masses : {3, 4, 5, 20}) {
    const Eigen::MatrixXd stiffness = stiffnessOf(masses, k);
    for (int mode = 1; mode <= masses; ++mode) {
      const double t = mode * M_PI / (masses + 1);
      Eigen::VectorXd shape(masses);
      double expected = 0.0;
      for (int i = 0; i < masses; ++i) {
        shape[i] = std::sin(t * (i + 1));
      }
      for (int reach = 1; reach <= 3; ++reach) {
        expected +=
            4.0 * k[static_cast<std::size_t>(reach - 1)] * std::pow(std::sin(0.5 * reach * t), 2);
      }
      EXPECT_LT((stiffness * shape - expected * shape).norm(), 1e-13) << masses << " " << mode;
    }
  }
}

TEST(CoarseStringTest, GeneratorMakesTheLinksInTheirOrderStartingAsAnOrdinaryString) {
  const Scene scene = readYaml(
      "ergotic: 1\nsections: {a: {}}\nmats: {m: {type: mass, mass: 1}}\ngenerators:\n"
      "  - {type: string, name: t, masses: 2, mass: 1, stiffness: 1, to: [1, 0]}\n"
      "  - {type: string, name: s, masses: 5, mass: 0.001, frequency: 110, damping: 0.01,\n"
      "     coarse: true, to: [1, 0]}\n",
      "coarse.yaml");
  const StringInfo& string = scene.strings[1];
  EXPECT_EQ(string.frequency_hz, 110.0);
  EXPECT_TRUE(string.coarse);
  EXPECT_EQ(string.first_lia, 3);
  ASSERT_EQ(scene.lias.size(), 3U + static_cast<std::size_t>(coarseLinks(5)));
  for (int i = 0; i < coarseLinks(5); ++i) {
    const Lia& lia = scene.lias[static_cast<std::size_t>(string.first_lia + i)];
    const CoarseLink link = coarseLink(5, i);
    EXPECT_EQ(lia.a, string.first + link.a);
    EXPECT_EQ(lia.b, string.first + link.b);
    EXPECT_EQ(lia.stiffness.factor, i < 6 ? string.stiffness.factor : 0.0) << i;
    EXPECT_EQ(lia.damping.factor, i < 6 ? 0.01 : 0.0) << i;
    EXPECT_EQ(link.weights[0], i < 6 ? 1.0 : 0.0) << i;
  }
}

}  // namespace
}  // namespace ergotic::scene
