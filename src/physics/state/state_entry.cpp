// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/state/state_entry.hpp"

#include <cmath>
#include <cstring>

#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

template <class Real>
double numberAt(const unsigned char* place) {
  Real number{};
  std::memcpy(&number, place, sizeof number);
  return static_cast<double>(number);
}

}  // namespace

void checkFinite(const std::vector<StateEntry>& entries, const std::vector<unsigned char>& state) {
  for (const StateEntry& entry : entries) {
    const auto [doubles, floats] = entry.numbers;
    const std::size_t element = doubles * sizeof(double) + floats * sizeof(float);
    std::size_t count = 0;
    const auto check = [&](double number) {
      if (!std::isfinite(number)) {
        throw Exception("number " + std::to_string(count) + " of '" + entry.name + "' is " +
                        std::to_string(number) + ", allowed: finite numbers");
      }
      ++count;
    };
    for (std::size_t at = 0; element > 0 && at + element <= entry.size; at += element) {
      const unsigned char* place = state.data() + entry.offset + at;
      for (std::size_t i = 0; i < doubles; ++i, place += sizeof(double)) {
        check(numberAt<double>(place));
      }
      for (std::size_t i = 0; i < floats; ++i, place += sizeof(float)) {
        check(numberAt<float>(place));
      }
    }
  }
}

}  // namespace ergotic::physics
