// SPDX-License-Identifier: BSD-3-Clause
#if defined(__x86_64__)
#define ERGOTIC_LEVEL avx512
#define ERGOTIC_VECTOR_BYTES 64
#include "physics/kernels/spatial_kernel_source.hpp"
#endif
