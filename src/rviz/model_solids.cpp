// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_solids.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace ergotic::panel {
namespace {

constexpr float kBoxReach = 0.75F;  // half its side, which looks as large as the ball

Solid icosahedron() {
  const float golden = 0.5F * (1.0F + std::sqrt(5.0F));
  Solid solid;
  for (const float one : {-1.0F, 1.0F}) {
    for (const float other : {-golden, golden}) {
      solid.corners.emplace_back(0.0F, one, other);
      solid.corners.emplace_back(one, other, 0.0F);
      solid.corners.emplace_back(other, 0.0F, one);
    }
  }
  const auto are_next = [&](std::size_t a, std::size_t b) {
    return (solid.corners[a] - solid.corners[b]).norm() < 2.1F;  // the edges have length 2
  };
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (are_next(a, b) && are_next(b, c) && are_next(a, c)) {
          solid.triangles.insert(solid.triangles.end(), {a, b, c});
        }
      }
    }
  }
  return solid;
}

/// Divides each triangle into four.
Solid subdivided(Solid solid) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middleOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(solid.corners.size()));
    if (is_new) {
      solid.corners.emplace_back(0.5F * (solid.corners[a] + solid.corners[b]));
    }
    return at->second;
  };
  ModuleIndices triangles;
  for (std::size_t t = 0; t < solid.triangles.size(); t += 3) {
    const std::uint32_t a = solid.triangles[t];
    const std::uint32_t b = solid.triangles[t + 1];
    const std::uint32_t c = solid.triangles[t + 2];
    const std::uint32_t ab = middleOf(a, b);
    const std::uint32_t bc = middleOf(b, c);
    const std::uint32_t ca = middleOf(c, a);
    triangles.insert(triangles.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  solid.triangles = std::move(triangles);
  return solid;
}

Solid makeBall() {
  Solid solid = subdivided(icosahedron());
  for (Eigen::Vector3f& corner : solid.corners) {
    corner.normalize();
  }
  solid.normals = solid.corners;
  return solid;
}

Solid makeBox() {
  Solid solid;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<std::uint32_t>(solid.corners.size());
      for (const auto& [u, v] :
           {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
        Eigen::Vector3f corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = u;
        corner[(axis + 2) % 3] = v;
        solid.corners.emplace_back(kBoxReach * corner);
        solid.normals.emplace_back(side * Eigen::Vector3f::Unit(axis));
      }
      solid.triangles.insert(solid.triangles.end(),
                             {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
  return solid;
}

/// Adds one that is stretched to `reach` from its middle to its sides.
void add(Solid& whole, const Solid& part, const Eigen::Vector3f& reach, const Eigen::Vector3f& at) {
  const auto first = static_cast<std::uint32_t>(whole.corners.size());
  const float of_part = &part == &box() ? kBoxReach : 1.0F;
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    whole.corners.emplace_back(at + part.corners[i].cwiseProduct(reach) / of_part);
    whole.normals.emplace_back(part.normals[i].cwiseQuotient(reach).normalized());
  }
  for (const std::uint32_t corner : part.triangles) {
    whole.triangles.push_back(first + corner);
  }
}

Solid makeKey() {
  Solid solid;
  add(solid, box(), {0.5F, 0.8F, 3.0F}, {-0.5F, 0.0F, -2.2F});
  return solid;
}

Solid makeHammer() {
  Solid solid;
  add(solid, ball(), {1.2F, 0.9F, 0.9F}, {-1.2F, 0.0F, 0.0F});
  add(solid, box(), {0.2F, 0.2F, 2.8F}, {-1.2F, 0.0F, -3.2F});
  return solid;
}

Solid makeFinger() {
  Solid solid;
  add(solid, ball(), {2.4F, 0.9F, 0.9F}, {-2.4F, 0.0F, 0.0F});
  return solid;
}

Solid makePlectrum() {
  Solid solid;
  add(solid, ball(), {0.25F, 1.3F, 2.0F}, {0.0F, 0.0F, -2.0F});
  return solid;
}

Solid makeBow() {
  constexpr float kHalf = 18.0F;
  constexpr float kStickAt = -2.2F;
  Solid solid;
  add(solid, box(), {kHalf, 0.5F, 0.1F}, {0.0F, 0.0F, -0.1F});
  add(solid, box(), {kHalf, 0.3F, 0.3F}, {0.0F, 0.0F, kStickAt});
  for (const float end : {-kHalf, kHalf}) {
    add(solid, box(), {0.8F, 0.5F, 1.1F}, {end, 0.0F, -1.2F});
  }
  return solid;
}

}  // namespace

const Solid& ball() {
  static const Solid solid = makeBall();
  return solid;
}

const Solid& box() {
  static const Solid solid = makeBox();
  return solid;
}

const Solid& key() {
  static const Solid solid = makeKey();
  return solid;
}

const Solid& hammer() {
  static const Solid solid = makeHammer();
  return solid;
}

const Solid& finger() {
  static const Solid solid = makeFinger();
  return solid;
}

const Solid& plectrum() {
  static const Solid solid = makePlectrum();
  return solid;
}

const Solid& bow() {
  static const Solid solid = makeBow();
  return solid;
}

}  // namespace ergotic::panel
