// SPDX-License-Identifier: BSD-3-Clause
#include "support/nets.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace ergotic::test {
namespace {

constexpr double kNetMass = 1e-3;    // kg
constexpr double kAmplitude = 1e-3;  // m

}  // namespace

int Nets::module(bool moves) {
  if (!moves) {
    return to.ground(ground_position, section);
  }
  const double kg = kNetMass * (1.0 + any(-scatter, scatter));
  const double x = any(-kAmplitude, kAmplitude);
  if (has_cells && to.scene.mats.size() % 3 == 0) {
    return to.cell(kg, 0.02 * kg * rate_hz * rate_hz, 1e-3 * kg * rate_hz, x, 0.0, section);
  }
  return to.mass(kg, x, 0.0, section);
}

void Nets::join(int a, int b) {
  const double k = 1.0 + any(-scatter, scatter);
  const double z = has_one_ratio ? k : 1.0 + any(-scatter, scatter);
  const int l =
      to.spring(a, b, k * kappa * kNetMass * rate_hz * rate_hz, z * zeta * kNetMass * rate_hz);
  to.scene.lias[static_cast<std::size_t>(l)].rest_length = any(-rest_length, rest_length);
}

int Nets::string(int modules, Ends ends) {
  const int first = module(ends == Ends::kFree);
  for (int m = first + 1; m < first + modules; ++m) {
    module(m + 1 < first + modules || ends != Ends::kFixed);
    join(m - 1, m);
  }
  return first;
}

int Nets::bar(int modules) {
  const int first = string(modules);
  for (int m = first + 2; m < first + modules; ++m) {
    join(m - 2, m);
  }
  return first;
}

int Nets::plate(int rows, int columns, bool corners, bool clamped) {
  const auto first = static_cast<int>(to.scene.mats.size());
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      module(!clamped || (r > 0 && r + 1 < rows && c > 0 && c + 1 < columns));
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int m = first + r * columns + c;
      const bool below = r + 1 < rows;
      // Springs between fixed modules are not there.
      const auto tie = [&](bool exists, int other) {
        if (exists &&
            (to.scene.mats[static_cast<std::size_t>(m)].type != scene::MatType::kGround ||
             to.scene.mats[static_cast<std::size_t>(other)].type != scene::MatType::kGround)) {
          join(m, other);
        }
      };
      tie(c + 1 < columns, m + 1);
      tie(below, m + columns);
      tie(corners && below && c > 0, m + columns - 1);
      tie(corners && below && c + 1 < columns, m + columns + 1);
    }
  }
  return first;
}

int Nets::triangles(int side) {
  std::vector<int> id(static_cast<std::size_t>(side * side));
  std::iota(id.begin(), id.end(), static_cast<int>(to.scene.mats.size()));
  for (std::size_t i = 0; i < id.size(); ++i) {
    module(true);
  }
  const int first = id.front();
  std::shuffle(id.begin(), id.end(), random);
  const auto node = [&](int r, int c) { return id[static_cast<std::size_t>(r * side + c)]; };
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      if (c + 1 < side) {
        join(node(r, c), node(r, c + 1));
      }
      if (r + 1 < side) {
        join(node(r, c), node(r + 1, c));
      }
      if (r + 1 < side && c + 1 < side) {
        random() % 2 == 0 ? join(node(r, c), node(r + 1, c + 1))
                          : join(node(r, c + 1), node(r + 1, c));
      }
    }
  }
  return first;
}

int Nets::star(int rays) {
  const int hub = to.mass(kNetMass * rays, 0.0, 0.0, section);
  for (int i = 0; i < rays; ++i) {
    join(hub, module(true));
  }
  return hub;
}

}  // namespace ergotic::test
