// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_nets.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "at.hpp"

namespace ergotic::tools {
namespace {

using scene::SceneBuilder;
using scene::Value;

constexpr double kSpeed = 0.1;  // m/s, of the fastest at the start

/// A net as a mesh program makes it, before anything is numbered.
struct Triangles {
  std::vector<Eigen::Vector3d> points;
  std::vector<bool> fixed;
  std::vector<std::vector<int>> neighbours;
};

void join(Triangles& net, int a, int b) {
  if (!net.fixed[at(a)] || !net.fixed[at(b)]) {
    net.neighbours[at(a)].push_back(b);
    net.neighbours[at(b)].push_back(a);
  }
}

Triangles triangulate(const Size& size, Dice& dice) {
  Triangles net;
  net.neighbours.resize(at(size.rows * size.columns));
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const double x = column + dice.number(-0.3, 0.3);
      net.points.emplace_back(0.0, x, row + dice.number(-0.3, 0.3));
      net.fixed.push_back(row == 0 || column == 0 || row == size.rows - 1 ||
                          column == size.columns - 1);
    }
  }
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const int here = row * size.columns + column;
      const bool right = column + 1 < size.columns;
      const bool below = row + 1 < size.rows;
      if (right) {
        join(net, here, here + 1);
      }
      if (below) {
        join(net, here, here + size.columns);
      }
      if (right && below) {
        dice.below(2) == 0 ? join(net, here, here + size.columns + 1)
                           : join(net, here + 1, here + size.columns);
      }
    }
  }
  return net;
}

/// Breadth first, in a shuffled order of the points and of the neighbours of each.
std::vector<int> shuffledOrder(Triangles& net, Dice& dice) {
  std::vector<int> seeds(net.points.size());
  std::iota(seeds.begin(), seeds.end(), 0);
  dice.shuffle(seeds);
  std::vector<bool> seen(net.points.size());
  std::vector<int> order;
  for (const int seed : seeds) {
    if (seen[at(seed)]) {
      continue;
    }
    seen[at(seed)] = true;
    order.push_back(seed);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      std::vector<int>& around = net.neighbours[at(order[next])];
      dice.shuffle(around);
      for (const int neighbour : around) {
        if (!seen[at(neighbour)]) {
          seen[at(neighbour)] = true;
          order.push_back(neighbour);
        }
      }
    }
  }
  return order;
}

}  // namespace

Value benchStiffness(double kappa) {
  return {kappa * kBenchMass * kBenchRateHz * kBenchRateHz};
}

Value benchDamping() {
  return {1e-7 * kBenchMass * kBenchRateHz};
}

SceneBuilder benchBuilder(const char* name, scene::Geometry geometry) {
  SceneBuilder builder(std::string("bench ") + name, "");
  builder.scene().name = name;
  scene::Section section;
  section.name = "audio";
  section.geometry = geometry;
  builder.add(std::move(section));
  return builder;
}

int addModule(SceneBuilder& builder, const Eigen::Vector3d& rest, bool moves, int section) {
  scene::Mat mat;
  mat.name = "m." + std::to_string(builder.scene().mats.size());
  mat.type = moves ? scene::MatType::kMass : scene::MatType::kGround;
  mat.section = section;
  mat.mass = {kBenchMass};
  mat.rest = rest;
  mat.position = rest;
  return builder.add(std::move(mat));
}

void addSpring(SceneBuilder& builder, int a, int b, const Value& stiffness) {
  scene::Lia lia;
  lia.name = "l." + std::to_string(builder.scene().lias.size());
  lia.a = a;
  lia.b = b;
  lia.stiffness = stiffness;
  lia.damping = benchDamping();
  builder.add(std::move(lia));
}

void addContact(SceneBuilder& builder, int lower, int upper, const Value& stiffness) {
  addSpring(builder, lower, upper, stiffness);
  builder.scene().lias.back().type = scene::LiaType::kContact;
}

void scatterCoefficients(scene::Scene& scene, Dice& dice) {
  const auto scatter = [&dice](Value& value) { value.factor *= dice.number(0.85, 1.15); };
  for (scene::Mat& mat : scene.mats) {
    scatter(mat.mass);
  }
  for (scene::Lia& lia : scene.lias) {
    scatter(lia.stiffness);
    scatter(lia.damping);
  }
}

void stir(scene::Scene& scene, Dice& dice) {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  double mass = 0.0;
  const auto each = [&scene](const auto& change) {
    for (scene::Mat& mat : scene.mats) {
      if (mat.type == scene::MatType::kMass) {
        change(mat, scene::dimensionsOf(scene.sectionOf(mat).geometry));
      }
    }
  };
  each([&](scene::Mat& mat, int dimensions) {
    for (int c = 0; c < dimensions; ++c) {
      mat.push.edit().velocity[c] = dice.number(-kSpeed, kSpeed);
    }
    momentum += mat.mass.factor * mat.push->velocity;
    mass += mat.mass.factor;
  });
  each([&](scene::Mat& mat, int dimensions) {
    mat.push.edit().velocity.head(dimensions) -= momentum.head(dimensions) / mass;
  });
}

void addTriangulation(SceneBuilder& builder, int modules, Dice& dice) {
  const auto count = [](int rows, int columns) {
    const int edges = rows * (columns - 1) + columns * (rows - 1);
    const int outer = 2 * (rows - 1) + 2 * (columns - 1);
    return (rows - 2) * (columns - 2) + edges - outer + (rows - 1) * (columns - 1) - 2;
  };
  Triangles net = triangulate(sizeFor(modules, 4, count), dice);
  const std::vector<int> order = shuffledOrder(net, dice);
  builder.reserve(order.size(), 3 * order.size(), {});
  std::vector<int> number(order.size());
  for (const int point : order) {
    number[at(point)] = addModule(builder, net.points[at(point)], !net.fixed[at(point)]);
  }
  for (const int point : order) {
    for (const int other : net.neighbours[at(point)]) {
      if (number[at(other)] > number[at(point)]) {
        const double length = (net.points[at(other)] - net.points[at(point)]).norm();
        addSpring(builder, number[at(point)], number[at(other)],
                  benchStiffness(0.07 / std::max(length, 0.4)));
      }
    }
  }
  scatterCoefficients(builder.scene(), dice);
}

void addRandomGraph(SceneBuilder& builder, int modules, Dice& dice) {
  const int masses = modules / 3;
  const int links = modules - masses;
  builder.reserve(at(masses), at(links), {});
  for (int i = 0; i < masses; ++i) {
    addModule(builder, Eigen::Vector3d::Zero(), true);
  }
  // No mass gets more than twelve, or one of a million would be unstable.
  std::vector<int> degrees(at(masses));
  for (int l = 0; l < links;) {
    const int a = dice.below(masses);
    const int b = dice.below(masses);
    if (a != b && degrees[at(a)] < 12 && degrees[at(b)] < 12) {
      addSpring(builder, a, b, benchStiffness(0.08));
      ++degrees[at(a)];
      ++degrees[at(b)];
      ++l;
    }
  }
  scatterCoefficients(builder.scene(), dice);
}

void addCube(SceneBuilder& builder, int modules) {
  // n^3 masses and 3 n^2 (n - 1) links, with layers for rows.
  int side = 2;
  while (4 * (side + 1) * (side + 1) * (side + 1) - 3 * (side + 1) * (side + 1) <= modules) {
    ++side;
  }
  const int slice = side * side + 2 * side * (side - 1);  // modules of a layer
  const int layers =
      std::max(2, (modules + side * side + (slice + side * side) / 2) / (slice + side * side));
  builder.reserve(at(layers * side * side), at(3 * layers * side * side), {});
  const auto index = [side](int x, int y, int z) { return (z * side + y) * side + x; };
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        addModule(builder, {0.0, x + 0.3 * z, y + 0.2 * z}, x + y + z > 0);
      }
    }
  }
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const int here = index(x, y, z);
        if (x + 1 < side) {
          addSpring(builder, here, index(x + 1, y, z), benchStiffness(0.15));
        }
        if (y + 1 < side) {
          addSpring(builder, here, index(x, y + 1, z), benchStiffness(0.15));
        }
        if (z + 1 < layers) {
          addSpring(builder, here, index(x, y, z + 1), benchStiffness(0.15));
        }
      }
    }
  }
}

}  // namespace ergotic::tools
