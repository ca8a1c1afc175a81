// SPDX-License-Identifier: BSD-3-Clause
// Cells and sums over modes, compiled once for each level of vector instructions: CMakeLists.txt
// sets ERGOTIC_LEVEL, the namespace, and ERGOTIC_VECTOR_BYTES. Nothing here may be shared with
// other translation units, which run on other processors: no standard library, everything in that
// namespace.
#include "physics/kernels/modal_kernels.hpp"

#include "physics/kernels/levels.hpp"

namespace ergotic::physics::kernels::ERGOTIC_LEVEL {
namespace {

constexpr int kBytes = ERGOTIC_VECTOR_BYTES;
/// Sums are taken in as many lanes at every level, so that all give the same bits.
constexpr int kBlockBytes = 128;
constexpr int kChains = kBlockBytes / kBytes;

template <class Real>
struct VectorOf;
template <>
struct VectorOf<float> {
  typedef float Type __attribute__((vector_size(kBytes), aligned(4), may_alias));
};
template <>
struct VectorOf<double> {
  typedef double Type __attribute__((vector_size(kBytes), aligned(8), may_alias));
};
template <class Real>
struct Wide {
  using Vector = typename VectorOf<Real>::Type;
  static constexpr int kLanes = kBytes / static_cast<int>(sizeof(Real));
  static constexpr int kBlock = kBlockBytes / static_cast<int>(sizeof(Real));
};

template <class Real>
inline typename Wide<Real>::Vector& at(Real* to) noexcept {
  return *reinterpret_cast<typename Wide<Real>::Vector*>(to);
}

template <class Real>
inline const typename Wide<Real>::Vector& load(const Real* from) noexcept {
  return *reinterpret_cast<const typename Wide<Real>::Vector*>(from);
}

template <class Real>
struct Sum {
  typename Wide<Real>::Vector chains[kChains] = {};
  Real rest = Real(0);

  /// Halves of the block are added until one lane is left. \param blocks  0: the lanes are empty
  Real total(int blocks) noexcept {
    if (blocks == 0) {
      return rest;
    }
    for (int half = kChains / 2; half > 0; half /= 2) {
      for (int c = 0; c < half; ++c) {
        chains[c] += chains[c + half];
      }
    }
    Real lanes[Wide<Real>::kLanes];
    at(lanes) = chains[0];
    for (int half = Wide<Real>::kLanes / 2; half > 0; half /= 2) {
      for (int k = 0; k < half; ++k) {
        lanes[k] += lanes[k + half];
      }
    }
    return lanes[0] + rest;
  }
};

template <bool kIsMetered, class Real>
double stepCells(const CellArguments<Real>& a) noexcept {
  Sum<Real> lost;
  int i = 0;
  for (; i + Wide<Real>::kBlock <= a.count; i += Wide<Real>::kBlock) {
    for (int c = 0; c < kChains; ++c) {
      const int k = i + c * Wide<Real>::kLanes;
      const typename Wide<Real>::Vector before = load(a.d + k);
      const typename Wide<Real>::Vector now =
          before - (load(a.lose + k) * before + load(a.pull + k) * load(a.x + k)) +
          (load(a.inverse_mass + k) * load(a.f + k) + load(a.drift + k));
      if constexpr (kIsMetered) {
        lost.chains[c] += load(a.loss + k) * now * (now + before);
      }
      at(a.d_last + k) = before;
      at(a.d + k) = now;
      at(a.x + k) += now;
    }
  }
  for (; i < a.count; ++i) {
    const Real before = a.d[i];
    const Real now = before - (a.lose[i] * before + a.pull[i] * a.x[i]) +
                     (a.inverse_mass[i] * a.f[i] + a.drift[i]);
    if constexpr (kIsMetered) {
      lost.rest += a.loss[i] * now * (now + before);
    }
    a.d_last[i] = before;
    a.d[i] = now;
    a.x[i] += now;
  }
  return kIsMetered ? static_cast<double>(lost.total(a.count / Wide<Real>::kBlock)) : 0.0;
}

template <class Real>
double step(const CellArguments<Real>& a) noexcept {
  return a.loss == nullptr ? stepCells<false>(a) : stepCells<true>(a);
}

template <class Real>
void gather(const ModalArguments<Real>& a, Real* sums) noexcept {
  Sum<Real> x;
  Sum<Real> d;
  int i = 0;
  for (; i + Wide<Real>::kBlock <= a.count; i += Wide<Real>::kBlock) {
    for (int c = 0; c < kChains; ++c) {
      const int k = i + c * Wide<Real>::kLanes;
      x.chains[c] += load(a.weights + k) * load(a.x + k);
      d.chains[c] += load(a.weights + k) * load(a.d + k);
    }
  }
  for (; i < a.count; ++i) {
    x.rest += a.weights[i] * a.x[i];
    d.rest += a.weights[i] * a.d[i];
  }
  const int blocks = a.count / Wide<Real>::kBlock;
  sums[0] = x.total(blocks);
  sums[1] = d.total(blocks);
}

template <class Real>
void scatter(const Real* weights, int count, Real force, Real* f) noexcept {
  for (int i = 0; i < count; ++i) {
    f[i] += weights[i] * force;
  }
}

template <class Real>
Real stepAhead(const ModalArguments<Real>& a) noexcept {
  Sum<Real> step;
  int i = 0;
  for (; i + Wide<Real>::kBlock <= a.count; i += Wide<Real>::kBlock) {
    for (int c = 0; c < kChains; ++c) {
      const int k = i + c * Wide<Real>::kLanes;
      step.chains[c] +=
          load(a.weights + k) *
          (load(a.d + k) - (load(a.lose + k) * load(a.d + k) + load(a.pull + k) * load(a.x + k)) +
           (load(a.inverse_mass + k) * load(a.f + k) + load(a.drift + k)));
    }
  }
  for (; i < a.count; ++i) {
    step.rest += a.weights[i] * (a.d[i] - (a.lose[i] * a.d[i] + a.pull[i] * a.x[i]) +
                                 (a.inverse_mass[i] * a.f[i] + a.drift[i]));
  }
  return step.total(a.count / Wide<Real>::kBlock);
}

template <class Real>
constexpr ModalKernels<Real> kKernels = {step<Real>, gather<Real>, scatter<Real>, stepAhead<Real>};

}  // namespace

template <>
const ModalKernels<float>& kernels() noexcept {
  return kKernels<float>;
}
template <>
const ModalKernels<double>& kernels() noexcept {
  return kKernels<double>;
}

}  // namespace ergotic::physics::kernels::ERGOTIC_LEVEL
