// SPDX-License-Identifier: BSD-3-Clause
// How well blocks keep energy and precision, and what becomes of very small numbers.
#include <cstdio>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "support/nets.hpp"
#include "support/one_by_one.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::Nets;

struct Kind {
  const char* name;
  std::function<void(Nets&)> add;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"chains in lanes",
       [](Nets& nets) {
         for (int n = 0; n < 16; ++n) {
           nets.string(60);
         }
       }},
      {"row", [](Nets& nets) { nets.string(300); }},
      {"plate", [](Nets& nets) { nets.plate(30, 40, true, true); }},
      {"plate of many coefficients",
       [](Nets& nets) {
         nets.scatter = 0.3;
         nets.plate(30, 40, true, false);
       }},
      {"irregular net", [](Nets& nets) { nets.triangles(25); }},
      {"stretched irregular net",
       [](Nets& nets) {
         nets.rest_length = 1e-3;
         nets.triangles(25);
       }},
      {"springs and dampers side by side, each with its own length at rest",
       [](Nets& nets) {
         nets.rest_length = 1e-3;
         const int first = nets.string(300);
         for (int i = 0; i < 300; i += 2) {
           nets.join(first + i, first + i + 1);
           nets.to.spring(first + i, first + i + 1, 0.0, 0.1);
         }
       }},
  };
  return all;
}

TEST(BlockEnergyTest, DampedBlocksBalanceOnEveryLevel) {
  for (const Kind& kind : kinds()) {
    for (const bool has_one_ratio : {true, false}) {
      SceneBuilder b;
      Nets nets(b);
      nets.has_one_ratio = has_one_ratio;
      kind.add(nets);
      ASSERT_FALSE(findBlocks(b.scene).empty());
      for (const rt::Isa isa : rt::isas()) {
        CompileOptions options(Precision::kDouble);
        options.isa = isa;
        Player player(compile(b.scene, {kRate, 14}, options));
        player.tick();
        const double stored = energiesOf(player).stored;
        EXPECT_LT(imbalanceOf(player, 99), 1e-12) << kind.name;
        EXPECT_LT(energiesOf(player).stored, 0.5 * stored) << kind.name;
      }
    }
  }
}

/// `count` lossless strings of 100 masses at 109 Hz, plucked at a fifth, heard at a third. Float
/// holds their coefficients exactly: any others put them out of tune by up to 1e-4 cents, which
/// would hide what the steps round.
SceneBuilder plucked(int count) {
  constexpr int kMasses = 100;
  constexpr double kScale = 1 << 20;
  SceneBuilder b;
  for (int n = 0; n < count; ++n) {
    const int first = b.chain(kMasses, kScale / (kRate * kRate), 0.25 * kScale);
    for (int i = 1; i <= kMasses; ++i) {
      b.scene.mats[at(first + i)].position.x() = 1e-3 * std::min(i / 20.0, (101 - i) / 81.0);
    }
    b.hear(first + 33);
  }
  return b;
}

TEST(BlockPrecisionTest, FloatFollowsDoubleFor10Seconds) {
  constexpr int kSeconds = 10;
  for (const int count : {1, 16}) {
    const SceneBuilder b = plucked(count);
    const Rates rates{kRate, 14};
    Player in_float(b.scene, rates, Precision::kFloat);
    Player in_double(b.scene, rates, Precision::kDouble);
    double signal = 0.0;
    double noise = 0.0;
    for (int second = 0; second < kSeconds; ++second) {
      in_float.heard[0].clear();
      in_double.heard[0].clear();
      in_float.ticks(3150);
      in_double.ticks(3150);
    }
    for (std::size_t n = 0; n < in_float.heard[0].size(); ++n) {
      const double y = in_double.heard[0][n];
      signal += y * y;
      noise += (in_float.heard[0][n] - y) * (in_float.heard[0][n] - y);
    }
    const double snr_db = 10.0 * std::log10(signal / noise);
    EXPECT_GT(snr_db, 95.0) << count << " strings";
    std::printf("%d strings in the tenth second: %.1f dB\n", count, snr_db);
  }
}

int denormalsIn(const Player& player) {
  int denormals = 0;
  for (const char* name : {"x", "d", "f"}) {
    const std::vector<float> numbers = test::numbersOf<float>(*player.instrument, name);
    denormals += static_cast<int>(std::count_if(numbers.begin(), numbers.end(), [](float v) {
      return std::fpclassify(v) == FP_SUBNORMAL;
    }));
  }
  return denormals;
}

/// One block of a kind that fades, and starts close to the smallest normal number.
scene::Scene fading(const Kind& kind) {
  SceneBuilder b;
  Nets nets(b);
  nets.zeta = 0.05;
  kind.add(nets);
  for (scene::Mat& mat : b.scene.mats) {
    mat.position *= 1e-33;  // from some 1e-3 m
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length *= 1e-33;
  }
  return b.scene;
}

TEST(BlockDenormalsTest, FadingLeavesNoDenormalNumbers) {
  for (const Kind& kind : kinds()) {
    Player player(fading(kind), {kRate, 14}, Precision::kFloat);
    float smallest = 1.0F;
    for (int n = 0; n < 500; ++n) {
      player.tick();
      ASSERT_EQ(denormalsIn(player), 0) << kind.name << " tick " << n;
      for (const float d : test::numbersOf<float>(*player.instrument, "d")) {
        smallest = d != 0.0F ? std::min(smallest, std::abs(d)) : smallest;
      }
    }
    // It came close enough for some to be flushed.
    EXPECT_LT(smallest, 4.0F * std::numeric_limits<float>::min()) << kind.name;
  }
}

#if defined(__x86_64__)
TEST(BlockDenormalsTest, TicksFlushWhateverTheCallerDoesAndLeaveThatAlone) {
  const unsigned before = _mm_getcsr();
  constexpr unsigned kFlushes = 0x8040U;  // FTZ and DAZ
  constexpr unsigned kFlags = 0x3fU;
  for (const Kind& kind : kinds()) {
    std::vector<std::vector<float>> played;
    for (const unsigned mode : {before & ~kFlushes, before | kFlushes}) {
      Player player(fading(kind), {kRate, 14}, Precision::kFloat);
      _mm_setcsr(mode);
      for (int n = 0; n < 200; ++n) {
        player.instrument->tick({});
      }
      EXPECT_EQ(_mm_getcsr() & ~kFlags, mode & ~kFlags) << kind.name;
      _mm_setcsr(before);
      played.push_back(test::numbersOf<float>(*player.instrument, "x"));
    }
    EXPECT_EQ(played[0], played[1]) << kind.name;
  }
}
#endif

}  // namespace
}  // namespace ergotic::physics
