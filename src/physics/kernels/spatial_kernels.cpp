// SPDX-License-Identifier: BSD-3-Clause
#include "physics/kernels/spatial_kernels.hpp"

namespace ergotic::physics::kernels {

template <class Real>
const SpatialKernels<Real>& spatialKernels(rt::Isa isa) noexcept {
#if defined(__x86_64__)
  switch (isa) {
    case rt::Isa::kAvx512:
      return avx512::spatialKernels<Real>();
    case rt::Isa::kAvx2:
      return avx2::spatialKernels<Real>();
    default:
      break;
  }
#else
  static_cast<void>(isa);
#endif
  return baseline::spatialKernels<Real>();
}

template const SpatialKernels<float>& spatialKernels<float>(rt::Isa isa) noexcept;
template const SpatialKernels<double>& spatialKernels<double>(rt::Isa isa) noexcept;

}  // namespace ergotic::physics::kernels
