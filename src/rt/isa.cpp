// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/isa.hpp"

#include <algorithm>

#include "ergotic/exception.hpp"

namespace ergotic::rt {

std::vector<Isa> isas() {
  std::vector<Isa> found{Isa::kBaseline};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0) {
    found.push_back(Isa::kAvx2);
  }
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
      __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0) {
    found.push_back(Isa::kAvx512);
  }
#endif
  return found;
}

Isa bestIsa() {
  static const Isa best = isas().back();
  return best;
}

const char* nameOf(Isa isa) {
  switch (isa) {
    case Isa::kAvx2:
      return "avx2";
    case Isa::kAvx512:
      return "avx512";
    default:
      return "baseline";
  }
}

Isa isaNamed(const std::string& name) {
  std::string allowed;
  for (const Isa isa : isas()) {
    if (name == nameOf(isa)) {
      return isa;
    }
    allowed += (allowed.empty() ? "" : ", ") + std::string(nameOf(isa));
  }
  throw Exception("instruction set '" + name + "': this processor has " + allowed);
}

}  // namespace ergotic::rt
