// SPDX-License-Identifier: BSD-3-Clause
// What blocks play is what their links play one by one, with any kernels and in any order of steps.
#include <cstdio>
#include <map>

#include "support/nets.hpp"
#include "support/one_by_one.hpp"
#include "support/physics.hpp"
#include "support/plain_difference.hpp"
#include "support/random_nets.hpp"

namespace ergotic::physics {
namespace {

using test::Nets;

constexpr int kRatio = 14;
constexpr unsigned kScenes = 200;
constexpr double kDoubleRounding = 1e-11;
// 280 frames that each round positions, steps and forces: some epsilons of the largest each.
constexpr double kFloatRounding = 280 * 8 * 6e-8;

/// Every second scene has two rates.
test::RandomNets thrown(unsigned seed) {
  return test::randomNets(seed, seed % 2 == 0);
}

CompileOptions optionsOf(Precision precision, rt::Isa isa = rt::bestIsa(), bool metered = true) {
  CompileOptions options(precision);
  options.isa = isa;
  options.metered = metered;
  return options;
}

template <class Real>
constexpr Precision kPrecision =
    std::is_same_v<Real, float> ? Precision::kFloat : Precision::kDouble;

/// Kinds of blocks that scenes have.
class Kinds {
 public:
  void count(const scene::Scene& scene, const Rates& rates) {
    for (const Block& block : makeLayout(scene, rates).blocks) {
      const bool uniform = std::any_of(block.segments.begin(), block.segments.end(),
                                       [](const Block::Segment& s) { return s.uniform; });
      ++seen_[block.kind == Block::Kind::kSparse   ? "sparse"
              : block.kind == Block::Kind::kChains ? block.per_lane ? "lanes" : "links in lanes"
              : block.pitch > 0 && uniform         ? "plate"
              : uniform                            ? "uniform"
                                                   : "different"];
      seen_["bias"] += block.has_bias ? 1 : 0;
      seen_["drift"] += block.has_drift ? 1 : 0;
      seen_["cells"] += block.has_cells ? 1 : 0;
      seen_["ratio"] += block.one_ratio ? 1 : 0;
    }
  }
  void expectAll() const {
    for (const char* kind : {"sparse", "lanes", "links in lanes", "plate", "uniform", "different",
                             "bias", "drift", "cells", "ratio"}) {
      EXPECT_TRUE(seen_.count(kind) > 0 && seen_.at(kind) >= 5) << kind;
    }
  }

 private:
  std::map<std::string, int> seen_;
};

TEST(KernelsAgreeTest, RandomScenesPlayAsTheirLinksOneByOne) {
  double in_double = 0.0;
  double in_float = 0.0;
  Kinds kinds;
  const Rates rates{kRate, kRatio};
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    const scene::Scene scene = thrown(seed).scene;
    kinds.count(scene, rates);
    const double d = test::differenceOneByOne(scene, Precision::kDouble, rates, 20);
    const double f = test::differenceOneByOne(scene, Precision::kFloat, rates, 20);
    EXPECT_LT(d, kDoubleRounding) << "seed " << seed;
    EXPECT_LT(f, kFloatRounding) << "seed " << seed;
    in_double = std::max(in_double, d);
    in_float = std::max(in_float, f);
  }
  kinds.expectAll();
  std::printf("largest relative difference: %.2g in double, %.2g in float\n", in_double, in_float);
}

TEST(KernelsAgreeTest, RandomScenesPlayAsThePlainImplementation) {
  int compared = 0;
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    const test::RandomNets nets = thrown(seed);
    if (nets.is_plain) {
      ++compared;
      EXPECT_LT(test::differenceFromPlain(nets.scene, Precision::kDouble, {kRate, kRatio}, 20),
                kDoubleRounding)
          << "seed " << seed;
    }
  }
  EXPECT_GT(compared, 50);
}

/// What plays, bit by bit.
template <class Real>
struct Bits {
  explicit Bits(const Player& player) : sound(player.heard) {
    for (const char* name : {"x", "d", "f"}) {
      numbers.push_back(test::numbersOf<Real>(*player.instrument, name));
    }
  }
  bool operator==(const Bits& other) const {
    const auto same = [](const auto& a, const auto& b) {
      return a.size() == b.size() &&
             std::memcmp(a.data(), b.data(), a.size() * sizeof(a.front())) == 0;
    };
    return std::equal(numbers.begin(), numbers.end(), other.numbers.begin(), same) &&
           std::equal(sound.begin(), sound.end(), other.sound.begin(), same);
  }
  std::vector<std::vector<Real>> numbers;
  std::vector<std::vector<double>> sound;
};

template <class Real>
Bits<Real> play(const scene::Scene& scene, const CompileOptions& options, int ratio, int ticks) {
  Player player(compile(scene, {kRate, ratio}, options));
  std::fill(player.inputs.begin(), player.inputs.end(), 0.01);
  player.ticks(ticks);
  return Bits<Real>(player);
}

template <class Real>
class KernelBitsTest : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(KernelBitsTest, Reals);

TYPED_TEST(KernelBitsTest, AllLevelsGiveTheSameMeteredOrNot) {
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    const scene::Scene scene = thrown(seed).scene;
    const auto expected =
        play<TypeParam>(scene, optionsOf(kPrecision<TypeParam>, rt::Isa::kBaseline), kRatio, 10);
    for (const rt::Isa isa : rt::isas()) {
      for (const bool metered : {true, false}) {
        EXPECT_TRUE(play<TypeParam>(scene, optionsOf(kPrecision<TypeParam>, isa, metered), kRatio,
                                    10) == expected)
            << "seed " << seed << " " << rt::nameOf(isa) << " metered " << metered;
      }
    }
  }
}

TYPED_TEST(KernelBitsTest, RatesOfTicksDoNotMatter) {
  for (unsigned seed = 1; seed < kScenes; seed += 4) {
    const scene::Scene scene = thrown(seed).scene;
    const auto expected = play<TypeParam>(scene, kPrecision<TypeParam>, 1, 280);
    for (const int ratio : {4, 14}) {
      EXPECT_TRUE(play<TypeParam>(scene, kPrecision<TypeParam>, ratio, 280 / ratio) == expected)
          << "seed " << seed << " R = " << ratio;
    }
  }
}

/// Inputs on every block: these then go from frame to frame.
scene::Scene fed(scene::Scene scene) {
  const std::vector<Block> blocks = findBlocks(scene);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    scene::Input input;
    input.name = "feed" + std::to_string(b);
    input.mat = *std::find_if(blocks[b].mats.begin(), blocks[b].mats.end(), [&](int m) {
      return m >= 0 && scene.mats[at(m)].type != scene::MatType::kGround;
    });
    input.gain = {0.0};
    scene.inputs.push_back(input);
  }
  return scene;
}

int loneBlocks(const scene::Scene& scene, const Rates& rates) {
  const auto lines = compile(scene, rates, Precision::kFloat)->describe();
  return static_cast<int>(std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("a tick at a time") != std::string::npos;
  }));
}

/// Equal numbers: a force of 0 may turn -0 into 0.
template <class Real>
void expectEqual(const Bits<Real>& a, const Bits<Real>& b, const std::string& what) {
  EXPECT_TRUE(a.numbers == b.numbers) << what;
  EXPECT_TRUE(a.sound == b.sound) << what;
}

TYPED_TEST(KernelBitsTest, BlocksThatGoThroughATickAlonePlayAsFrameByFrame) {
  int lone = 0;
  for (unsigned seed = 1; seed < kScenes; seed += 4) {
    const scene::Scene scene = thrown(seed).scene;
    const scene::Scene by_frame = fed(scene);
    lone += loneBlocks(scene, {kRate, kRatio});
    EXPECT_EQ(loneBlocks(by_frame, {kRate, kRatio}), 0);
    for (const int ratio : {4, 14}) {
      expectEqual(play<TypeParam>(scene, kPrecision<TypeParam>, ratio, 280 / ratio),
                  play<TypeParam>(by_frame, kPrecision<TypeParam>, ratio, 280 / ratio),
                  "seed " + std::to_string(seed));
    }
  }
  EXPECT_GT(lone, 20);
}

/// More than twice as many bands of 2048 elements as a tick of 14 has steps.
scene::Scene largePlate(double scatter, bool corners) {
  SceneBuilder b;
  Nets nets(b);
  nets.scatter = scatter;
  const int first = nets.plate(250, 250, corners, true);
  b.hear(first + 31000, 0);
  b.hear(first + 20100, 1, scene::Quantity::kVelocity);
  b.hear(first + 60, 2, scene::Quantity::kForce);
  return b.scene;
}

TYPED_TEST(KernelBitsTest, LargePlatesInWavesPlayAsFrameByFrame) {
  for (const double scatter : {0.0, 0.3}) {
    const scene::Scene scene = largePlate(scatter, scatter == 0.0);
    ASSERT_EQ(loneBlocks(scene, {kRate, 4}), 1);
    const auto expected = play<TypeParam>(scene, kPrecision<TypeParam>, 1, 56);
    const auto by_frame = play<TypeParam>(fed(scene), kPrecision<TypeParam>, 14, 4);
    expectEqual(expected, by_frame, "frame by frame");
    for (const int ratio : {4, 14}) {
      EXPECT_TRUE(play<TypeParam>(scene, kPrecision<TypeParam>, ratio, 56 / ratio) == expected)
          << "R = " << ratio;
    }
  }
}

TEST(KernelsAgreeTest, LargePlatesPlayAsThePlainImplementation) {
  EXPECT_LT(test::differenceOneByOne(largePlate(0.0, true), Precision::kDouble, {kRate, 4}, 20),
            kDoubleRounding);
  EXPECT_LT(test::differenceOneByOne(largePlate(0.3, false), Precision::kDouble, {kRate, 4}, 20),
            kDoubleRounding);
}

}  // namespace
}  // namespace ergotic::physics
