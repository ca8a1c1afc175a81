// SPDX-License-Identifier: BSD-3-Clause
#include "physics/kernels/block_kernels.hpp"

namespace ergotic::physics::kernels {

template <class Real>
const BlockKernels<Real>& blockKernels(rt::Isa isa) noexcept {
#if defined(__x86_64__)
  switch (isa) {
    case rt::Isa::kAvx512:
      return avx512::blockKernels<Real>();
    case rt::Isa::kAvx2:
      return avx2::blockKernels<Real>();
    default:
      break;
  }
#else
  static_cast<void>(isa);
#endif
  return baseline::blockKernels<Real>();
}

template const BlockKernels<float>& blockKernels<float>(rt::Isa isa) noexcept;
template const BlockKernels<double>& blockKernels<double>(rt::Isa isa) noexcept;

}  // namespace ergotic::physics::kernels
