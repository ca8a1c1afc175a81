// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_probe.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <memory>

namespace ergotic::tools {
namespace {

constexpr int kTries = 7;
constexpr double kTryNs = 5e6;
constexpr int kChains = 12;  // more than the latency of an addition and a multiplication hides

template <class Real, int kBytes>
struct Wide {
  using Type __attribute__((vector_size(kBytes), may_alias)) = Real;
};

/// x <- a x + b over the whole array: every number is read and written once.
template <class Real, int kBytes>
__attribute__((always_inline)) inline void updateAll(Real* data, std::size_t count) {
  using Vector = typename Wide<Real, kBytes>::Type;
  constexpr std::size_t kLanes = kBytes / sizeof(Real);
  auto* vectors = reinterpret_cast<Vector*>(data);
  for (std::size_t i = 0; i < count / kLanes; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) {
      vectors[i + k] = vectors[i + k] * Real(0.5) + Real(1);
    }
  }
}

/// As many additions as multiplications, in registers. \return operations
template <class Real, int kBytes>
__attribute__((always_inline)) inline double operate(Real* data, int rounds) {
  using Vector = typename Wide<Real, kBytes>::Type;
  auto* vectors = reinterpret_cast<Vector*>(data);
  Vector sums[kChains];
  for (int k = 0; k < kChains; ++k) {
    sums[k] = vectors[k];
  }
  for (int i = 0; i < rounds; ++i) {
    for (int k = 0; k < kChains; ++k) {
      sums[k] = sums[k] * Real(0.5) + Real(1);
    }
  }
  for (int k = 0; k < kChains; ++k) {
    vectors[k] = sums[k];
  }
  return 2.0 * kChains * rounds * (kBytes / static_cast<double>(sizeof(Real)));
}

template <class Real>
struct Probes {
  void (*update)(Real* data, std::size_t count);
  double (*operate)(Real* data, int rounds);
};

template <class Real>
void updateBaseline(Real* data, std::size_t count) {
  updateAll<Real, 16>(data, count);
}
template <class Real>
double operateBaseline(Real* data, int rounds) {
  return operate<Real, 16>(data, rounds);
}

#if defined(__x86_64__)
template <class Real>
__attribute__((target("avx2"))) void updateAvx2(Real* data, std::size_t count) {
  updateAll<Real, 32>(data, count);
}
template <class Real>
__attribute__((target("avx2"))) double operateAvx2(Real* data, int rounds) {
  return operate<Real, 32>(data, rounds);
}
template <class Real>
__attribute__((target("avx512f"))) void updateAvx512(Real* data, std::size_t count) {
  updateAll<Real, 64>(data, count);
}
template <class Real>
__attribute__((target("avx512f"))) double operateAvx512(Real* data, int rounds) {
  return operate<Real, 64>(data, rounds);
}
#endif

template <class Real>
Probes<Real> probesFor(rt::Isa isa) {
#if defined(__x86_64__)
  if (isa == rt::Isa::kAvx512) {
    return {updateAvx512<Real>, operateAvx512<Real>};
  }
  if (isa == rt::Isa::kAvx2) {
    return {updateAvx2<Real>, operateAvx2<Real>};
  }
#else
  static_cast<void>(isa);
#endif
  return {updateBaseline<Real>, operateBaseline<Real>};
}

/// The best of several tries: amount that `run(rounds)` gives per ns.
template <class Run>
double bestRate(const Run& run) {
  double best = 0.0;
  int rounds = 1;
  for (int attempt = 0; attempt < kTries;) {
    const double begin = threadCpuNs();
    const double amount = run(rounds);
    const double ns = threadCpuNs() - begin;
    if (ns < kTryNs && rounds < (1 << 28)) {
      rounds *= 2;
      continue;
    }
    best = std::max(best, amount / ns);
    ++attempt;
  }
  return best;
}

/// \param fallback  where the system does not say
std::size_t cacheBytes(int name, std::size_t fallback) {
  const long bytes = sysconf(name);
  return bytes > 0 ? static_cast<std::size_t>(bytes) : fallback;
}

std::vector<MemoryLevel> levelsOfMachine() {
  const std::size_t l1 = cacheBytes(_SC_LEVEL1_DCACHE_SIZE, std::size_t{32} << 10U);
  const std::size_t l2 = cacheBytes(_SC_LEVEL2_CACHE_SIZE, std::size_t{1} << 20U);
  const std::size_t l3 = cacheBytes(_SC_LEVEL3_CACHE_SIZE, std::size_t{16} << 20U);
  const std::size_t most = std::size_t{256} << 20U;
  return {{"L1", l1, 0.0, l1 / 2},
          {"L2", l2, 0.0, l2 / 2},
          {"L3", l3, 0.0, l3 / 2},
          {"memory", 0, 0.0, std::min(most, std::max(4 * l3, std::size_t{64} << 20U))}};
}

template <class Real>
MachineLimits probe(rt::Isa isa) {
  const Probes<Real> probes = probesFor<Real>(isa);
  MachineLimits limits;
  limits.levels = levelsOfMachine();
  constexpr std::size_t kBlock = 4096;
  const std::size_t most = limits.levels.back().probed / kBlock * kBlock;
  const std::unique_ptr<void, decltype(&std::free)> room(std::aligned_alloc(kBlock, most),
                                                         &std::free);
  auto* data = static_cast<Real*>(room.get());
  std::fill_n(data, most / sizeof(Real), Real(1));
  for (MemoryLevel& level : limits.levels) {
    level.probed = level.probed / kBlock * kBlock;
    level.gb_per_s = bestRate([&](int rounds) {
      for (int i = 0; i < rounds; ++i) {
        probes.update(data, level.probed / sizeof(Real));
      }
      return 2.0 * static_cast<double>(level.probed) * rounds;
    });
  }
  limits.gflops = bestRate([&](int rounds) { return probes.operate(data, 64 * rounds); });
  return limits;
}

}  // namespace

const MemoryLevel& MachineLimits::levelFor(std::size_t bytes) const {
  for (const MemoryLevel& level : levels) {
    if (bytes <= level.bytes) {
      return level;
    }
  }
  return levels.back();
}

MachineLimits probeMachine(rt::Isa isa, physics::Precision precision) {
  return precision == physics::Precision::kFloat ? probe<float>(isa) : probe<double>(isa);
}

double threadCpuNs() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace ergotic::tools
