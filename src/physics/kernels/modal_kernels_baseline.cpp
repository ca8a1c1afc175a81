// SPDX-License-Identifier: BSD-3-Clause
#define ERGOTIC_LEVEL baseline
#include "physics/kernels/modal_kernel_source.hpp"
