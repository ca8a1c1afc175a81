// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::rt {

/// Levels of vector instructions that kernels exist for. All give the same bits.
enum class Isa {
  kBaseline,  ///< instructions of every processor of the architecture: SSE2, NEON
  kAvx2,
  kAvx512,
};

/// The best level that this processor has. Realtime: no.
Isa bestIsa();

/// Levels that this processor has, the baseline first.
std::vector<Isa> isas();

/// "baseline", "avx2", "avx512".
const char* nameOf(Isa isa);

/// \throws Exception if there is no such level, or this processor lacks it; lists those it has
Isa isaNamed(const std::string& name);

}  // namespace ergotic::rt
