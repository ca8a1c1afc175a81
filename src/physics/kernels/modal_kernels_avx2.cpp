// SPDX-License-Identifier: BSD-3-Clause
#if defined(__x86_64__)
#define ERGOTIC_LEVEL avx2
#include "physics/kernels/modal_kernel_source.hpp"
#endif
