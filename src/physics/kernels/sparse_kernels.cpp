// SPDX-License-Identifier: BSD-3-Clause
#include "physics/kernels/sparse_kernels.hpp"

namespace ergotic::physics::kernels {

template <class Real>
const SparseKernels<Real>& sparseKernels(rt::Isa isa) noexcept {
#if defined(__x86_64__)
  switch (isa) {
    case rt::Isa::kAvx512:
      return avx512::sparseKernels<Real>();
    case rt::Isa::kAvx2:
      return avx2::sparseKernels<Real>();
    default:
      break;
  }
#else
  static_cast<void>(isa);
#endif
  return baseline::sparseKernels<Real>();
}

template const SparseKernels<float>& sparseKernels<float>(rt::Isa isa) noexcept;
template const SparseKernels<double>& sparseKernels<double>(rt::Isa isa) noexcept;

}  // namespace ergotic::physics::kernels
