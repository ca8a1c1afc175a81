// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/rt/isa.hpp"

/// The kernels are compiled once for each level of vector instructions (CMakeLists.txt), in a
/// namespace of that level.
namespace ergotic::physics::kernels {

namespace baseline {
template <class Kernels>
const Kernels& kernels() noexcept;
}
#if defined(__x86_64__)
namespace avx2 {
template <class Kernels>
const Kernels& kernels() noexcept;
}
namespace avx512 {
template <class Kernels>
const Kernels& kernels() noexcept;
}
#endif

/// \tparam Kernels  BlockKernels, ModalKernels, SparseKernels or SpatialKernels of float or double
/// \pre this processor has the level
template <class Kernels>
const Kernels& kernelsOf(rt::Isa isa) noexcept {
#if defined(__x86_64__)
  switch (isa) {
    case rt::Isa::kAvx512:
      return avx512::kernels<Kernels>();
    case rt::Isa::kAvx2:
      return avx2::kernels<Kernels>();
    case rt::Isa::kBaseline:
      break;
  }
#else
  static_cast<void>(isa);
#endif
  return baseline::kernels<Kernels>();
}

}  // namespace ergotic::physics::kernels
