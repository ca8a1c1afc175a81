// SPDX-License-Identifier: BSD-3-Clause
// Whatever a model does and whatever comes from the device: what leaves the chain is within the
// limit and grows no faster than it may. With ERGOTIC_LONG in the environment over 10^7 ticks.

#include "constants.hpp"
#include "ergotic/tgr/safety_chain.hpp"
#include "support/test.hpp"
#include "tgr/sensor_noise.hpp"
#include "tgr/wall_loop.hpp"

namespace ergotic::tgr {
namespace {

using test::kNan;

constexpr double kRateHz = 3000.0;
constexpr int kSlices = 3;

std::int64_t allTicks() {
  return std::getenv("ERGOTIC_LONG") != nullptr ? 10'000'000 : 100'000;
}

/// Numbers that decide what goes wrong next.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : noise_(seed) {}
  double gauss() { return noise_.next(); }
  /// 0...1, not quite evenly
  double part() { return 0.5 + 0.5 * std::sin(1e3 * noise_.next()); }
  bool oneIn(double n) { return part() * n < 1.0; }
  int below(int n) { return std::min(n - 1, static_cast<int>(part() * n)); }

 private:
  SensorNoise noise_;
};

/// Models that no scene should hold.
class HostileModel {
 public:
  explicit HostileModel(std::uint64_t seed) : chance_(seed) {}

  double operator()(double x, double v) {
    if (chance_.oneIn(200.0)) {
      kind_ = chance_.below(10);
      gain_ = std::pow(10.0, 3.0 * chance_.gauss());
    }
    last_ = next(x, v);
    return last_;
  }

 private:
  double next(double x, double v) {
    switch (kind_) {
      case 0:
        return 5000.0 * x;  // negative stiffness
      case 1:
        return -1e6 * x;  // far beyond the bound
      case 2:
        return 50.0 * v;  // negative damping
      case 3:
        return chance_.oneIn(50.0) ? kNan : 3.0 * chance_.gauss();
      case 4:
        return chance_.oneIn(50.0) ? (chance_.oneIn(2.0) ? kInfinity : -kInfinity) : 1.0;
      case 5:
        return std::isfinite(last_) ? -1.3 * last_ - 1e-3 : 1.0;  // diverges, alternating
      case 6:
        return std::isfinite(last_) ? 1.1 * last_ + 1e-3 : -1.0;  // diverges to one side
      case 7:
        return gain_ * chance_.gauss();
      case 8:
        return chance_.oneIn(2.0) ? 1e308 : -1e308;
      default:
        return -2000.0 * x;  // a friendly one
    }
  }

  Chance chance_;
  int kind_ = 9;
  double gain_ = 1.0;
  double last_ = 0.0;
};

/// What must hold of every force that leaves the chain.
class Judge {
 public:
  explicit Judge(const SafetyConfig& config)
      : limit_(config.force_limit_n), step_(config.slew_n_per_s / kRateHz) {}

  /// \return true if it may follow the last one
  bool allows(double force) {
    const double allowed = (force * last_ >= 0.0 ? std::abs(last_) : 0.0) + step_;
    const bool fine = std::isfinite(force) && std::abs(force) <= limit_ &&
                      std::abs(force) <= allowed * (1.0 + 1e-12);
    last_ = force;
    ticks_with_force_ += force != 0.0 ? 1 : 0;
    return fine;
  }
  std::int64_t ticksWithForce() const { return ticks_with_force_; }

 private:
  double limit_;
  double step_;
  double last_ = 0.0;
  std::int64_t ticks_with_force_ = 0;
};

SafetyConfig quick() {
  SafetyConfig config;
  config.ramp_s = 0.1;
  config.resume_ramp_s = 0.005;
  return config;
}

/// Things that operators and stations do, at random.
void operate(SafetyChain& chain, Chance& chance) {
  if (chain.fault() != FaultReason::kNone && chance.oneIn(5.0)) {
    chain.recover();
  }
  if (!chain.isOpen() && chance.oneIn(2.0)) {
    chain.engage();
  }
  if (chance.oneIn(2000.0)) {
    chain.disengage();
  }
  if (chance.oneIn(2000.0)) {
    chain.setInUse(chance.oneIn(2.0) ? ~std::uint64_t{0} : 0b101U);
  }
}

/// A random walk with the faults of real sensors.
double hostileSample(double x, Chance& chance) {
  if (!chance.oneIn(300.0)) {
    return x;
  }
  switch (chance.below(4)) {
    case 0:
      return kNan;
    case 1:
      return kInfinity;
    case 2:
      return -0.1;
    default:
      return x + 0.02 * chance.gauss();
  }
}

std::uint32_t hostileFlags(Chance& chance) {
  return chance.oneIn(100.0) ? 1U << static_cast<unsigned>(chance.below(4)) : kExchangeOk;
}

TEST(HostileModelsTest, NoForceLeavesTheChainThatMayNot) {
  for (const bool controls : {false, true}) {
    SafetyConfig config = quick();
    config.passivity_controller = controls;
    SafetyChain chain(config, kSlices, 1.0 / kRateHz, 2);
    Chance chance(controls ? 5 : 6);
    std::array<HostileModel, kSlices> models{HostileModel(1), HostileModel(2), HostileModel(3)};
    std::array<Judge, kSlices> judges{Judge(config), Judge(config), Judge(config)};
    std::array<double, kSlices> hand{};
    std::int64_t wrong = 0;
    std::int64_t faults = 0;
    for (std::int64_t n = 0; n < allTicks() / 2; ++n) {
      std::array<double, kSlices> x{};
      std::array<double, kSlices> v{};
      for (std::size_t i = 0; i < kSlices; ++i) {
        const double before = hand[i];
        hand[i] = 0.999 * hand[i] + 2e-4 * chance.gauss();
        v[i] = (hand[i] - before) * kRateHz;
        x[i] = hostileSample(hand[i], chance);
      }
      operate(chain, chance);
      chain.validate(x.data(), hostileFlags(chance), chance.oneIn(500.0) ? chance.below(100) : 0);
      if (chance.oneIn(1000.0)) {
        chain.resume();
      }
      std::array<double, kSlices> force{};
      for (std::size_t i = 0; i < kSlices; ++i) {
        force[i] = models[i](x[i], v[i]);
      }
      const bool was_well = chain.fault() == FaultReason::kNone;
      chain.limit(force.data());
      faults += was_well && chain.fault() != FaultReason::kNone ? 1 : 0;
      for (std::size_t i = 0; i < kSlices; ++i) {
        wrong += judges[i].allows(force[i]) ? 0 : 1;
        wrong += !chain.isOpen() && force[i] != 0.0 ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(faults, allTicks() / 5000);
    for (const Judge& judge : judges) {
      EXPECT_GT(judge.ticksWithForce(), allTicks() / 50) << "else nothing was tried";
    }
  }
}

/// The same with a virtual hand on a virtual slice: what the model does comes back to it.
TEST(HostileModelsTest, ADeviceMeetsNoForceBeyondTheLimit) {
  const SafetyConfig config = quick();
  test::WallLoop loop(test::plainDevice(), config, kRateHz);
  HostileModel model(9);
  Judge judge(config);
  Chance chance(10);
  std::int64_t wrong = 0;
  for (std::int64_t n = 0; n < allTicks(); ++n) {
    if (n % 500 == 0) {
      loop.aimAt(0.01 * std::max(-2.9, std::min(2.9, chance.gauss())));
    }
    if (!loop.chain().isOpen()) {
      loop.recover();
      loop.engage();
    }
    loop.tick(model);
    wrong += judge.allows(loop.force()) ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(judge.ticksWithForce(), allTicks() / 50);
}

}  // namespace
}  // namespace ergotic::tgr
