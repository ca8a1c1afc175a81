// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/exception.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "lab/lib/bench_nets.hpp"
#include "scene/generate/mesh.hpp"
#include "scene/generate/string.hpp"

namespace ergotic::tools {
namespace {

using scene::MeshEdges;
using scene::Scene;
using scene::SceneBuilder;

constexpr int kMassesOfString = 100;
constexpr int kModulesOfString = 2 * kMassesOfString + 1;

int stringsIn(int modules) {
  return std::max(1, (modules + kModulesOfString / 2) / kModulesOfString);
}

/// Strings beside each other, tuned to 64 different pitches.
void addStrings(SceneBuilder& builder, int count, int masses = kMassesOfString) {
  for (int i = 0; i < count; ++i) {
    scene::StringSpec spec;
    spec.name = "string" + std::to_string(i);
    spec.masses = masses;
    spec.mass = {kBenchMass};
    spec.stiffness = benchStiffness(0.2 + 0.4 * (i % 64) / 64.0);
    spec.damping = benchDamping();
    spec.from = {0.0, 0.0, 0.01 * i};
    spec.to = {0.0, 0.65, 0.01 * i};
    addString(builder, spec);
  }
}

scene::MeshSpec plateSpec(const std::string& name, const Size& size, bool diagonals) {
  scene::MeshSpec spec;
  spec.name = name;
  spec.rows = size.rows;
  spec.columns = size.columns;
  spec.mass = {kBenchMass};
  spec.stiffness = benchStiffness(0.15);
  spec.damping = benchDamping();
  if (diagonals) {
    spec.diagonal_stiffness = benchStiffness(0.07);
  }
  spec.spacing = 0.01;
  return spec;
}

/// Modules of a mesh with fixed edges.
int fixedPlateModules(int rows, int columns, bool diagonals) {
  const int inner = (rows - 2) * (columns - 2);
  const int straight = (rows - 2) * (columns - 1) + (columns - 2) * (rows - 1);
  return inner + straight + (diagonals ? 2 * (rows - 1) * (columns - 1) - 4 : 0);
}

Size fixedPlateSize(int modules, bool diagonals) {
  return sizeFor(modules, 4, [diagonals](int rows, int columns) {
    return fixedPlateModules(rows, columns, diagonals);
  });
}

template <bool kDiagonals>
void addPlate(SceneBuilder& builder, int modules) {
  addMesh(builder, plateSpec("plate", fixedPlateSize(modules, kDiagonals), kDiagonals));
}

void chain(SceneBuilder& builder, int modules) {
  addStrings(builder, 1, std::max(1, (modules - 1) / 2));
}

void strings(SceneBuilder& builder, int modules) {
  addStrings(builder, stringsIn(modules));
}

void plate8Free(SceneBuilder& builder, int modules) {
  const Size size = sizeFor(modules, 4, [](int rows, int columns) {
    return rows * columns + rows * (columns - 1) + columns * (rows - 1) +
           2 * (rows - 1) * (columns - 1);
  });
  scene::MeshSpec spec = plateSpec("plate", size, true);
  spec.edges = MeshEdges::kFree;
  addMesh(builder, spec);
}

/// Bending: springs that push, to the neighbours of the neighbours along rows and columns.
void plateBending(SceneBuilder& builder, int modules) {
  const Size size = sizeFor(modules, 6, [](int rows, int columns) {
    return fixedPlateModules(rows, columns, true) + 2 * (rows - 2) * (columns - 2);
  });
  addMesh(builder, plateSpec("plate", size, true));
  const auto isFixed = [&builder](int mat) {
    return builder.scene().mats[static_cast<std::size_t>(mat)].type == scene::MatType::kGround;
  };
  const auto bend = [&](int a, int b) {
    if (!isFixed(a) || !isFixed(b)) {
      addSpring(builder, a, b, benchStiffness(-0.02));
    }
  };
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const int here = row * size.columns + column;
      if (column + 2 < size.columns) {
        bend(here, here + 2);
      }
      if (row + 2 < size.rows) {
        bend(here, here + 2 * size.columns);
      }
    }
  }
}

void triangulated(SceneBuilder& builder, int modules) {
  Dice dice(3);
  addTriangulation(builder, modules, dice);
}

void randomGraph(SceneBuilder& builder, int modules) {
  Dice dice(4);
  addRandomGraph(builder, modules, dice);
}

void net3d(SceneBuilder& builder, int modules) {
  scene::MeshSpec spec = plateSpec("net", fixedPlateSize(modules, false), false);
  spec.rest_length_ratio = 0.2;
  addMesh(builder, spec);
}

/// A plate whose rows and columns harden from place to place, all of them in one tank.
void gong(SceneBuilder& builder, int modules) {
  const Size size = sizeFor(modules, 4, [](int rows, int columns) {
    const int inner = (rows - 2) * (columns - 2);
    return 2 * fixedPlateModules(rows, columns, false) - inner;
  });
  addMesh(builder, plateSpec("plate", size, false));
  Scene& scene = builder.scene();
  constexpr double kThickness = 1e-4;  // m: drawn so far, a link is twice as stiff
  const std::size_t springs = scene.lias.size();
  for (std::size_t l = 0; l < springs; ++l) {
    scene::Lia lia = scene.lias[l];
    lia.name = scene::Name("hard." + std::to_string(l));
    lia.type = scene::LiaType::kCubic;
    lia.scheme = scene::Scheme::kEnergyStable;
    lia.law.edit().nonlinearity = (1.0 / (kThickness * kThickness)) * lia.stiffness;
    lia.stiffness = lia.damping = {};
    lia.tank = 0;
    builder.add(std::move(lia));
  }
  scene::Tank tank;
  tank.name = scene::Name("gong");
  scene.tanks.push_back(std::move(tank));
}

/// A plate over stops that every tenth of its masses lies on.
void contacts(SceneBuilder& builder, int modules) {
  const Size size = sizeFor(modules, 4, [](int rows, int columns) {
    return fixedPlateModules(rows, columns, false) + (rows - 2) * (columns - 2) / 10;
  });
  addMesh(builder, plateSpec("plate", size, false));
  int inner = 0;
  const int mats = static_cast<int>(builder.scene().mats.size());
  for (int i = 0; i < mats; ++i) {
    const scene::Mat mat = builder.scene().mats[static_cast<std::size_t>(i)];
    if (mat.type == scene::MatType::kMass && ++inner % 10 == 0) {
      addContact(builder, addModule(builder, mat.rest, false), i, benchStiffness(0.04));
    }
  }
}

/// Hears the velocity of masses spread over the scene.
void hear(SceneBuilder& builder, int outputs) {
  const int mats = static_cast<int>(builder.scene().mats.size());
  for (int i = 0; i < outputs; ++i) {
    scene::Output output;
    output.name = "out" + std::to_string(i + 1);
    output.quantity = scene::Quantity::kVelocity;
    output.point.mat = static_cast<int>(mats * (i + 0.5) / outputs);
    output.channel = i;
    builder.scene().outputs.push_back(std::move(output));
  }
}

int addRunningSection(SceneBuilder& builder, const std::string& name) {
  scene::Section section;
  section.name = name;
  return builder.add(std::move(section));
}

int addGesturalSection(SceneBuilder& builder) {
  scene::Section section;
  section.name = "hands";
  section.gestural = true;
  return builder.add(std::move(section));
}

int addSlice(SceneBuilder& builder, int section) {
  const int number = static_cast<int>(builder.scene().ports.size());
  const int slice = addModule(builder, Eigen::Vector3d::Zero(), false, section);
  builder.scene().mats.back().type = scene::MatType::kSlice;
  scene::Port port;
  port.name = "slice" + std::to_string(number);
  port.mat = slice;
  port.slice = number;
  builder.scene().ports.push_back(std::move(port));
  return slice;
}

/// A place of the plate that one slice moves along it and another presses.
void addPlayedPoint(SceneBuilder& builder, int hands, double across) {
  const int presses = addSlice(builder, hands);
  const int moves = addSlice(builder, hands);
  const int point = addModule(builder, Eigen::Vector3d::Zero(), false);
  builder.scene().mats.back().type = scene::MatType::kPoint;
  scene::Connection place;
  place.mat = point;
  place.along.at = {0.5};
  place.across.at = {across};
  place.along.guide = moves;
  place.along.scale = 10.0;
  place.along.minimum = 0.1;
  place.along.maximum = 0.9;
  place.speed = 1.0;
  builder.scene().connections.push_back(place);
  addContact(builder, presses, point, {2000.0});
  builder.scene().lias.back().scheme = scene::Scheme::kAuto;
  builder.scene().lias.back().damping = {0.05};  // explicit, as it loses more than a hit may give
}

void station7k(SceneBuilder& builder, int modules) {
  addPlate<true>(builder, modules);
  hear(builder, 24);
  const int hands = addGesturalSection(builder);
  for (int i = 0; i < 6; ++i) {
    addPlayedPoint(builder, hands, 0.2 + 0.12 * i);
  }
}

/// A hammer on a spring that strikes a mass, the first from `struck` on, from below.
void addHammer(SceneBuilder& builder, int hands, int struck) {
  while (builder.scene().mats[static_cast<std::size_t>(struck)].type != scene::MatType::kMass) {
    ++struck;
  }
  const int hammer = addModule(builder, {-1e-4, 0.0, 0.0}, true, hands);
  builder.scene().mats.back().mass = {0.01};
  const int rail = addModule(builder, Eigen::Vector3d::Zero(), false, hands);
  addSpring(builder, rail, hammer, {20.0});
  addContact(builder, hammer, struck, {500.0});
}

void mixed200k(SceneBuilder& builder, int modules) {
  constexpr int kPlates = 4;
  constexpr int kHammers = 12;
  addStrings(builder, stringsIn(modules / 2));
  // Instruments of their own, that only hands at the gestural rate join.
  for (int p = 0; p < kPlates; ++p) {
    const Size size = fixedPlateSize(modules / 2 / kPlates, true);
    scene::MeshSpec plate = plateSpec("plate" + std::to_string(p), size, true);
    plate.section = addRunningSection(builder, plate.name);
    addMesh(builder, plate);
  }
  hear(builder, 24);
  const int mats = static_cast<int>(builder.scene().mats.size());
  const int hands = addGesturalSection(builder);
  for (int i = 0; i < kHammers; ++i) {
    addHammer(builder, hands, static_cast<int>(mats * (i + 0.31) / kHammers));
  }
}

}  // namespace

Scene BenchKind::make(int size) const {
  SceneBuilder builder = benchBuilder(name, geometry);
  add(builder, size);
  if (is_scattered) {
    Dice dice(2);
    scatterCoefficients(builder.scene(), dice);
  }
  Dice dice(1);
  stir(builder.scene(), dice);
  return physics::settle(builder.finish(), benchRates()).scene;
}

const std::vector<BenchKind>& benchKinds() {
  static const std::vector<BenchKind> kinds{
      {"chain", "one long string", 7000, true, chain},
      {"strings", "strings of 100 masses, every element different", 64 * kModulesOfString, true,
       strings, true},
      {"strings_hom", "strings of 100 equal masses", 64 * kModulesOfString, true, strings},
      {"plate4", "4 neighbours, fixed edges", 7000, true, addPlate<false>},
      {"plate8", "8 neighbours, fixed edges", 7000, true, addPlate<true>},
      {"plate4_het", "4 neighbours, every element different", 7000, true, addPlate<false>, true},
      {"plate8_het", "8 neighbours, every element different", 7000, true, addPlate<true>, true},
      {"plate8_free", "8 neighbours, free edges", 7000, true, plate8Free},
      {"plate_bending", "8 neighbours and those after the next", 7000, true, plateBending},
      {"triangulated", "irregular triangles", 7000, true, triangulated},
      {"random", "links between any two, 4 per mass", 7000, true, randomGraph},
      {"net3d", "a net that moves in space", 7000, true, net3d, false, scene::Geometry::kSpace},
      {"scalar3d", "a cubic lattice", 7000, true, addCube},
      {"contacts", "a plate, every tenth mass on a stop", 7000, true, contacts},
      {"gong", "a plate, 4 neighbours, that hardens: one tank", 7000, false, gong},
      {"station7k", "a plate with 12 slices at 6 moving places, 24 outputs", 7000, false,
       station7k},
      {"mixed200k", "strings, plates, slow hammers, 24 outputs", 200'000, true, mixed200k},
  };
  return kinds;
}

const BenchKind& benchKindNamed(const std::string& name) {
  std::string names;
  for (const BenchKind& kind : benchKinds()) {
    if (name == kind.name) {
      return kind;
    }
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  }
  throw Exception("there is no scene '" + name + "', allowed: " + names);
}

std::size_t modulesOf(const Scene& scene) {
  const auto masses = std::count_if(scene.mats.begin(), scene.mats.end(), [](const auto& mat) {
    return mat.type == scene::MatType::kMass;
  });
  return scene.lias.size() + static_cast<std::size_t>(masses);
}

physics::Rates benchRates() {
  return {kBenchRateHz, 14};
}

}  // namespace ergotic::tools
