// SPDX-License-Identifier: BSD-3-Clause
#define ERGOTIC_LEVEL baseline
#define ERGOTIC_VECTOR_BYTES 16
#include "physics/kernels/block_kernel_source.hpp"
