// SPDX-License-Identifier: BSD-3-Clause

#include "lab/lib/bench.hpp"

#include <iterator>
#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "lab/lib/plain_network.hpp"
#include "support/places.hpp"
#include "support/plain_difference.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

using physics::Precision;
using scene::Geometry;
using scene::LiaType;
using test::SceneBuilder;

/// Closed form: n x n plate with fixed edges and diagonals.
TEST(BenchTest, CountsTheLeastWorkOfAPlate) {
  const scene::Scene scene = benchKindNamed("plate8").make(4000);
  const double masses = static_cast<double>(modulesOf(scene) - scene.lias.size());
  const double links = static_cast<double>(scene.lias.size());
  const BenchWork work = workOf(scene, benchRates(), physics::Precision::kFloat);
  EXPECT_EQ(work.bytes, 16.0 * masses);
  EXPECT_EQ(work.resident, static_cast<std::size_t>(8.0 * masses));
  EXPECT_EQ(work.operations, 3.0 * masses + 7.0 * links);
}

TEST(BenchTest, CountsCoefficientsAndIndicesWhereElementsDiffer) {
  const scene::Scene scene = benchKindNamed("triangulated").make(4000);
  const double masses = static_cast<double>(modulesOf(scene) - scene.lias.size());
  double between_masses = 0.0;
  for (const scene::Lia& lia : scene.lias) {
    const auto isMass = [&scene](int mat) {
      return scene.mats[static_cast<std::size_t>(mat)].type == scene::MatType::kMass;
    };
    between_masses += isMass(lia.a) && isMass(lia.b) ? 1.0 : 0.0;
  }
  const BenchWork work = workOf(scene, benchRates(), physics::Precision::kDouble);
  EXPECT_EQ(work.bytes, (32.0 + 8.0) * masses + 16.0 * static_cast<double>(scene.lias.size()) +
                            4.0 * between_masses);
}

TEST(BenchTest, TakesTheLimitThatBindsWhereTheSceneFits) {
  MachineLimits limits;
  limits.levels = {{"L1", 1000, 100.0, 0}, {"memory", 0, 10.0, 0}};
  limits.gflops = 50.0;
  const BenchWork small{1000, 2000.0, 100.0};
  const BenchWork large{1001, 2000.0, 100.0};
  const BenchWork busy{1000, 2000.0, 5000.0};
  EXPECT_EQ(small.limitNs(limits), 20.0);
  EXPECT_EQ(large.limitNs(limits), 200.0);
  EXPECT_EQ(busy.limitNs(limits), 100.0);
}

class BenchKindTest : public testing::TestWithParam<BenchKind> {};

TEST_P(BenchKindTest, MakesASceneOfTheSizeAskedFor) {
  for (const int modules : {700, 7000, 20'000}) {
    const auto made = static_cast<double>(modulesOf(GetParam().make(modules)));
    EXPECT_NEAR(made, modules, 0.04 * modules + 100);  // half a string
  }
}

TEST_P(BenchKindTest, MakesTheSameSceneTwice) {
  const scene::Scene one = GetParam().make(1000);
  const scene::Scene two = GetParam().make(1000);
  ASSERT_EQ(one.lias.size(), two.lias.size());
  for (std::size_t l = 0; l < one.lias.size(); ++l) {
    EXPECT_EQ(one.lias[l].b, two.lias[l].b);
    EXPECT_EQ(one.lias[l].stiffness.factor, two.lias[l].stiffness.factor);
  }
}

TEST_P(BenchKindTest, MakesASceneThatIsStable) {
  const scene::Scene scene = GetParam().make(1500);
  const physics::Certificate certificate = physics::certify(scene, benchRates());
  EXPECT_NE(certificate.verdict, physics::Verdict::kUnstable)
      << testing::PrintToString(certificate.findings);
}

TEST_P(BenchKindTest, PlaysItAsThePlainImplementationDoesIfThatCan) {
  const scene::Scene scene = GetParam().make(700);
  if (GetParam().is_plain) {
    const double difference =
        test::differenceFromPlain(scene, physics::Precision::kDouble, benchRates(), 20);
    EXPECT_LT(difference, 1e-10);
  } else {
    EXPECT_THROW(makePlainNetwork(scene, benchRates(), physics::Precision::kDouble), Exception);
  }
}

std::string nameOfKind(const testing::TestParamInfo<BenchKind>& kind) {
  return kind.param.name;
}

INSTANTIATE_TEST_SUITE_P(All, BenchKindTest, testing::ValuesIn(benchKinds()), nameOfKind);

TEST(BenchTest, WritesJsonThatOthersCanRead) {
  const test::ScratchFile file;
  const std::string& path = file.path();
  const test::Outcome outcome = test::run(
      "bench", "--scene chain station7k --size 700 --runs 3 --seconds 0.02 --json " + path);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("| chain |"));
  const std::string read =
      "/usr/bin/python3 -c \"import json, sys; r = json.load(open('" + path +
      "'))['results']; sys.exit([len(x['ns_per_frame_runs']) for x in r] != [3, 3])\"";
  EXPECT_EQ(std::system(read.c_str()), 0) << textOf(path);
  EXPECT_THAT(textOf(path), HasSubstr("\"flags\": \""));
}

TEST(BenchTest, ListsItsScenes) {
  const test::Outcome outcome = test::run("bench", "--list");
  EXPECT_EQ(outcome.code, 0);
  for (const BenchKind& kind : benchKinds()) {
    EXPECT_THAT(outcome.text, HasSubstr(kind.name));
  }
}

TEST(BenchTest, NamesWhatIsAllowedInsteadOfWhatWasAskedFor) {
  const auto complaint = [](const std::string& arguments) {
    const test::Outcome outcome = test::run("bench", arguments);
    EXPECT_NE(outcome.code, 0);
    return outcome.text;
  };
  EXPECT_THAT(complaint("--scene plate5"), HasSubstr("'plate5', allowed: chain, strings"));
  EXPECT_THAT(complaint("--isa mmx"), HasSubstr("baseline"));
  EXPECT_THAT(complaint("--size 12"), HasSubstr("20 to 2000000"));
  EXPECT_THAT(complaint("--threads 0"), HasSubstr("1 to 8"));
  EXPECT_THAT(complaint("--precision half"), HasSubstr("double"));
  EXPECT_THAT(complaint("--scene chain --size 700 --seconds 0.01 --json /nowhere/a.json"),
              HasSubstr("/nowhere/a.json: cannot be written"));
}

const physics::Rates kPlainRates{44100.0, 8};

double differenceFromInstrument(const scene::Scene& scene, int ticks) {
  return test::differenceFromPlain(scene, Precision::kDouble, kPlainRates, ticks);
}

TEST(PlainNetworkTest, MovesAFallingMassByHand) {
  SceneBuilder builder;
  builder.scene.sections[0].gravity.x() = -9.81;
  builder.mass(0.1);
  const auto plain = makePlainNetwork(builder.scene, kPlainRates, Precision::kDouble);
  plain->step(100);
  double moved = 0.0;
  plain->readDisplacements(&moved);
  EXPECT_NEAR(moved, -9.81 * 100 * 101 / (2 * 44100.0 * 44100.0), 1e-15);
}

TEST(PlainNetworkTest, MovesALossyStringAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.chain(40, 0.001, 2e5, 0.02);
  for (int i = 1; i <= 40; ++i) {
    builder.scene.mats[static_cast<std::size_t>(i)].mass = {0.001 + 1e-5 * i};
  }
  builder.scene.mats[7].push.edit().velocity.x() = 1.0;
  builder.scene.lias[3].rest_length = 1e-4;
  builder.scene.mats[20].push.edit().force.x() = 0.3;
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, MovesARandomGraphAsTheInstrumentDoes) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> pick(0, 49);
  std::uniform_real_distribution<double> number(0.5, 1.5);
  SceneBuilder builder;
  for (int i = 0; i < 50; ++i) {
    builder.mass(0.001 * number(random), 0.0, i == 0 ? 1.0 : 0.0);
  }
  for (int l = 0; l < 100; ++l) {
    const int a = pick(random);
    const int b = (a + 1 + pick(random) % 49) % 50;
    builder.spring(a, b, 3e4 * number(random), 0.01 * number(random));
  }
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, MovesAStretchedChainInSpaceAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.scene.sections[0].geometry = Geometry::kSpace;
  builder.scene.sections[1].geometry = Geometry::kSpace;
  builder.chain(10, 0.001, 1e5, 0.05);
  for (std::size_t i = 0; i < builder.scene.mats.size(); ++i) {
    scene::Mat& mat = builder.scene.mats[i];
    mat.rest.x() = 0.01 * static_cast<double>(i);
    mat.position = mat.rest;
  }
  for (scene::Lia& lia : builder.scene.lias) {
    lia.rest_length = 0.009;
  }
  builder.scene.mats[3].push.edit().velocity = {0.1, 1.0, 0.5};
  builder.link(LiaType::kContact, 2, 6, 1e4, 0.1);
  builder.scene.lias.back().law.edit().width = {0.0405};
  EXPECT_LT(differenceFromInstrument(builder.scene, 200), 1e-12);
}

TEST(PlainNetworkTest, HitsWithASlowHammerAsTheInstrumentDoes) {
  SceneBuilder builder;
  builder.chain(20, 0.001, 1e5, 0.02);
  const int hammer = builder.mass(0.01, -1e-3, 2.0, SceneBuilder::kGestural);
  const int hand = builder.ground(0.0, SceneBuilder::kGestural);
  builder.spring(hand, hammer, 50.0, 0.1);
  builder.link(LiaType::kContact, 8, hammer, 5e3, 0.2);
  std::swap(builder.scene.lias.back().a, builder.scene.lias.back().b);
  builder.spring(hammer, 12, 100.0, 0.05);
  EXPECT_LT(differenceFromInstrument(builder.scene, 500), 1e-12);
}

TEST(PlainNetworkTest, SaysWhatItCannotDo) {
  const auto complaint = [](const scene::Scene& scene) -> std::string {
    return complaintOf([&] { makePlainNetwork(scene, kPlainRates, Precision::kFloat); });
  };
  SceneBuilder cells;
  cells.cell(0.001, 10.0, 0.0);
  EXPECT_THAT(complaint(cells.scene), HasSubstr("module like 'm0'"));
  SceneBuilder cubic;
  cubic.link(LiaType::kCubic, cubic.mass(0.1), cubic.ground(), 10.0);
  EXPECT_THAT(complaint(cubic.scene), HasSubstr("link like 'l0'"));
  SceneBuilder mixed;
  mixed.mass(0.1);
  mixed.scene.sections[1].geometry = Geometry::kSpace;
  EXPECT_THAT(complaint(mixed.scene), HasSubstr("'gestural'"));
}

}  // namespace
}  // namespace ergotic::tools
