// SPDX-License-Identifier: BSD-3-Clause
#include "physics/kernels/modal_kernels.hpp"

namespace ergotic::physics::kernels {

template <class Real>
const ModalKernels<Real>& modalKernels(rt::Isa isa) noexcept {
#if defined(__x86_64__)
  switch (isa) {
    case rt::Isa::kAvx512:
      return avx512::modalKernels<Real>();
    case rt::Isa::kAvx2:
      return avx2::modalKernels<Real>();
    default:
      break;
  }
#else
  static_cast<void>(isa);
#endif
  return baseline::modalKernels<Real>();
}

template const ModalKernels<float>& modalKernels<float>(rt::Isa isa) noexcept;
template const ModalKernels<double>& modalKernels<double>(rt::Isa isa) noexcept;

}  // namespace ergotic::physics::kernels
