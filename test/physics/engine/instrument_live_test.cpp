// SPDX-License-Identifier: BSD-3-Clause

#include "ergotic/physics/engine/instrument.hpp"

#include <cstring>
#include <thread>

#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/rt/clock.hpp"
#include "physics/engine/instrument_of.hpp"
#include "physics/engine/orchestra.hpp"
#include "support/physics.hpp"
#include "support/random_scene.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

constexpr std::int64_t kTickPatienceNs = 60'000'000'000;

std::unique_ptr<Instrument> compileFor(const scene::Scene& scene,
                                       const Rates& rates,
                                       Precision precision,
                                       int threads,
                                       std::int64_t wait_limit_ns = kTickPatienceNs) {
  CompileOptions options(precision);
  options.threads = threads;
  options.wait_limit_ns = wait_limit_ns;
  return compile(settle(scene, rates).scene, rates, options);
}

/// Bit for bit.
bool isSame(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// All that can be told of an instrument from outside.
struct Heard {
  std::vector<double> forces;
  std::vector<double> outputs;
  std::vector<std::byte> state;
  bool operator==(const Heard& o) const {
    return isSame(forces, o.forces) && isSame(outputs, o.outputs) && state == o.state;
  }
};

/// Plays with hands and inputs that never stand still.
class ThreadedPlaying {
 public:
  explicit ThreadedPlaying(std::unique_ptr<Instrument> made)
      : instrument(std::move(made)),
        positions_(at(instrument->ports())),
        inputs_(at(instrument->rates().ratio * instrument->inputChannels())) {
    heard.forces.resize(positions_.size());
    heard.outputs.resize(at(instrument->rates().ratio * instrument->outputChannels()));
    heard.state.resize(instrument->stateSize());
  }

  void tick() {
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      positions_[p] = 1e-3 * std::sin(0.01 * static_cast<double>((p + 1) * now_));
    }
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      inputs_[i] = std::sin(0.3 * static_cast<double>(now_ * inputs_.size() + i));
    }
    ++now_;
    instrument->tick(
        {positions_.data(), heard.forces.data(), inputs_.data(), heard.outputs.data()});
  }

  const Heard& hear() {
    instrument->saveState(heard.state.data());
    return heard;
  }

  std::unique_ptr<Instrument> instrument;
  Heard heard;

 private:
  std::vector<double> positions_;
  std::vector<double> inputs_;
  std::size_t now_ = 0;
};

/// Plays with 1, 2 and 3 threads, and compares all bits after every tick.
void expectSameBits(const scene::Scene& scene, const Rates& rates, Precision precision, int ticks) {
  ThreadedPlaying one(compileFor(scene, rates, precision, 1));
  ThreadedPlaying two(compileFor(scene, rates, precision, 2));
  ThreadedPlaying three(compileFor(scene, rates, precision, 3));
  for (int n = 0; n < ticks; ++n) {
    for (ThreadedPlaying* playing : {&one, &two, &three}) {
      playing->tick();
    }
    one.hear();
    ASSERT_TRUE(two.hear() == one.heard) << "2 threads, tick " << n;
    ASSERT_TRUE(three.hear() == one.heard) << "3 threads, tick " << n;
  }
  EXPECT_EQ(two.instrument->stalledTicks() + three.instrument->stalledTicks(), 0);
}

#ifdef ERGOTIC_SANITIZED  // under which threads that wait for each other take a hundred times as
                          // long
constexpr int kCompared = 200;
#else
constexpr int kCompared = 3000;
#endif

TEST(InstrumentThreadsTest, EveryNumberOfThreadsGivesTheSameBits) {
  for (const int ratio : {1, 4, 14}) {
    for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
      SCOPED_TRACE(ratio);
      Orchestra orchestra(6);
      orchestra.addFollower();
      expectSameBits(orchestra.scene(), {kRate, ratio}, precision, kCompared);
    }
  }
}

/// Several scenes beside each other.
class Merged {
 public:
  void add(scene::Scene from) {
    const int mats = static_cast<int>(scene.mats.size());
    const int sections = static_cast<int>(scene.sections.size());
    const int grids = static_cast<int>(scene.grids.size());
    const std::string suffix = "_" + std::to_string(sections);
    for (scene::Section& section : from.sections) {
      section.name += suffix;
      scene.sections.push_back(section);
    }
    for (scene::Mat& mat : from.mats) {
      mat.section += sections;
      mat.name = mat.name + suffix;
      scene.mats.push_back(mat);
    }
    for (scene::Lia& lia : from.lias) {
      lia.a += mats;
      lia.b += mats;
      lia.name = lia.name + suffix;
      scene.lias.push_back(lia);
    }
    for (scene::Grid& grid : from.grids) {
      grid.first += mats;
      grid.name += suffix;
      scene.grids.push_back(grid);
    }
    for (scene::Connection& connection : from.connections) {
      connection.mat += mats;
      connection.grid += grids;
      connection.along.guide += connection.along.guide < 0 ? 0 : mats;
      scene.connections.push_back(connection);
    }
    for (scene::Tap& tap : from.taps) {
      tap.mat += mats;
      for (scene::Tap::Share& share : tap.shares) {
        share.mat += mats;
      }
      scene.taps.push_back(tap);
    }
    scene::Output output;
    output.name = "out" + suffix;
    output.point.mat = mats + 1;
    output.channel = sections % 3;
    scene.outputs.push_back(output);
  }

  scene::Scene scene;
};

TEST(InstrumentThreadsTest, RandomScenesSideBySidePlayTheSameBits) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Merged merged;
    merged.scene.name = "merged";
    merged.scene.file = "merged.yaml";
    for (unsigned part = 0; part < 4; ++part) {
      merged.add(ergotic::test::randomScene(100 * part + seed).scene);
    }
    const int ratios[3] = {1, 4, 14};
    expectSameBits(merged.scene, {kRate, ratios[seed % 3]},
                   seed % 2 == 0 ? Precision::kFloat : Precision::kDouble, 300);
  }
}

TEST(InstrumentThreadsTest, EnergyBalancesAcrossGroups) {
  const scene::Scene scene = Orchestra(6).scene();
  for (const int ratio : {1, 4, 14}) {
    SCOPED_TRACE(ratio);
    ThreadedPlaying playing(compileFor(scene, {kRate, ratio}, Precision::kDouble, 2));
    Energies energies = playing.instrument->makeEnergies();
    double moved = 0.0;
    for (int n = 0; n < 3000; ++n) {
      playing.tick();
      playing.instrument->readEnergies(energies);
      double through = energies.stored;
      for (const SectionEnergy& section : energies.sections) {
        through += section.dissipated;
      }
      moved = std::max(moved, through);
      ASSERT_NEAR(energies.residual / moved, 0.0, 1e-12) << "tick " << n;
    }
    EXPECT_GT(moved, 1e-3);
  }
}

/// Free sections that nothing outside moves, with a slow mass that all of them are attached to.
scene::Scene heavyPair() {
  SceneBuilder b;
  const int slow = b.mass(0.5, 0.0, 0.1, SceneBuilder::kGestural);
  for (int s = 0; s < 2; ++s) {
    scene::Section section = b.scene.sections[0];
    section.name = "s" + std::to_string(s);
    b.scene.sections.push_back(section);
    const int first = b.chain(20000, 1e-3, 2e4, 1e-3);
    for (std::size_t m = at(first); m < b.scene.mats.size(); ++m) {
      b.scene.mats[m].section = s + 2;
    }
    b.scene.mats[at(first + 3)].push.edit().velocity.x() = 1.0;
    b.spring(slow, first + 9, 100.0);
    b.hear(first + 5);
  }
  return b.scene;
}

/// Audio frames since the start.
std::int64_t framesOf(ThreadedPlaying& playing) {
  playing.hear();
  for (const StateEntry& entry : playing.instrument->stateEntries()) {
    if (entry.name == "frame") {
      std::int64_t frames = 0;
      std::memcpy(&frames, playing.heard.state.data() + entry.offset, sizeof frames);
      return frames;
    }
  }
  return -1;
}

TEST(InstrumentThreadsTest, AStalledTickIsSilentCountedAndGoesOnWhole) {
  const Rates rates{kRate, 14};
  ThreadedPlaying hasty(compileFor(heavyPair(), rates, Precision::kDouble, 2, 0));
  if (hasty.instrument->describe().back().find("threads: 2") == std::string::npos) {
    GTEST_SKIP() << "one processor";
  }
  ThreadedPlaying reference(compileFor(heavyPair(), rates, Precision::kDouble, 1));
  std::int64_t ticks = 0;
  while (ticks < 100000 && hasty.instrument->stalledTicks() < 20) {
    const std::int64_t stalled = hasty.instrument->stalledTicks();
    hasty.tick();
    ++ticks;
    ASSERT_EQ(hasty.instrument->stalledTicks() > stalled, hasty.instrument->isUnderWay());
    if (hasty.instrument->isUnderWay()) {
      EXPECT_EQ(hasty.heard.outputs, std::vector<double>(hasty.heard.outputs.size(), 0.0));
      EXPECT_TRUE(hasty.instrument->isFinite());
    }
  }
  EXPECT_GT(hasty.instrument->stalledTicks(), 0) << "nobody was ever waited for";
  do {
    hasty.tick();
    ++ticks;
  } while (hasty.instrument->isUnderWay());
  const std::int64_t played = framesOf(hasty) / rates.ratio;
  EXPECT_LE(played, ticks);
  EXPECT_GE(played, ticks - hasty.instrument->stalledTicks());
  for (std::int64_t n = 0; n < played; ++n) {
    reference.tick();
  }
  EXPECT_EQ(hasty.hear().state, reference.hear().state);
}

TEST(InstrumentThreadsTest, WaitsForOneTickWhereAHandWaits) {
  EXPECT_EQ(waitLimitNs(CompileOptions(), {44100.0, 14}), CompileOptions().wait_limit_ns);
  CompileOptions live;
  live.wait_limit_ns = kOneTick;
  EXPECT_EQ(waitLimitNs(live, {44100.0, 14}), 317460);
  EXPECT_EQ(waitLimitNs(live, {44100.0, 1}), 22676);
}

}  // namespace
}  // namespace ergotic::physics
