// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Geometry>

namespace ergotic::panel {
namespace {

constexpr std::uint32_t kTubeSides = 6;
constexpr std::uint32_t kBarSides = 8;  // vertices of a cross-section: two of each side
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Shares of the size of the model.
constexpr float kTubeRadius = 0.0022F;
constexpr float kMinSizeM = 0.01F;

constexpr float kBarWidthOfLength = 0.14F;
constexpr float kBarWidthOfDistance = 0.7F;  // to the next bar
constexpr float kBarThickness = 0.18F;       // of its width

/// Directions across a row of modules, which turn as little as they can from each to the next.
class AcrossRow {
 public:
  AcrossRow(const ModuleIndices& row,
            const std::vector<Eigen::Vector3f>& places,
            const Eigen::Vector3f& wanted)
      : row_(row), places_(places), across_(wanted) {
    if (along(0).cross(wanted).squaredNorm() < 0.01F) {  // the row begins that way
      across_ = along(0).unitOrthogonal();
    }
  }

  /// Moves to joint i; to be called for 0, 1, 2... in order.
  void moveTo(std::size_t i) {
    along_ = along(i);
    const Eigen::Vector3f turned = across_ - across_.dot(along_) * along_;
    if (turned.squaredNorm() > 1e-6F) {
      across_ = turned.normalized();
    }
    side_ = along_.cross(across_);
  }
  const Eigen::Vector3f& along() const { return along_; }
  const Eigen::Vector3f& across() const { return across_; }
  const Eigen::Vector3f& side() const { return side_; }

 private:
  Eigen::Vector3f along(std::size_t i) const {
    const std::size_t before = i > 0 ? i - 1 : i;
    const std::size_t behind = std::min(i + 1, row_.size() - 1);
    const Eigen::Vector3f way = places_[row_[behind]] - places_[row_[before]];
    return way.squaredNorm() > 0.0F ? Eigen::Vector3f(way.normalized()) : Eigen::Vector3f::UnitY();
  }

  const ModuleIndices& row_;
  const std::vector<Eigen::Vector3f>& places_;
  Eigen::Vector3f along_ = Eigen::Vector3f::UnitY();
  Eigen::Vector3f across_;
  Eigen::Vector3f side_ = Eigen::Vector3f::UnitZ();
};

float nearestOther(std::size_t self, const std::vector<Eigen::Vector3f>& middles) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < middles.size(); ++i) {
    if (i != self) {
      least = std::min(least, (middles[i] - middles[self]).norm());
    }
  }
  return least;
}

}  // namespace

/// Writes the vertices of one picture.
class ModelMesh::Filling {
 public:
  Filling(ModelMesh& mesh, const ModelMotion& motion, const MeshView& view, MeshVertex* out)
      : mesh_(mesh),
        motion_(motion),
        places_(motion.places()),
        view_(view),
        tints_(view.by_section ? mesh.section_tints_ : mesh.tints_),
        light_(view.eye, mesh.middle_, mesh.up_),
        out_(out) {}

  void surface() {
    const ModuleIndices& corners = mesh_.surface_corners_;
    const ModuleIndices& modules = mesh_.surface_;
    mesh_.normals_.assign(modules.size(), Eigen::Vector3f::Zero());
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      const Eigen::Vector3f& a = places_[modules[corners[t]]];
      const Eigen::Vector3f normal =
          (places_[modules[corners[t + 1]]] - a).cross(places_[modules[corners[t + 2]]] - a);
      for (std::size_t k = 0; k < 3; ++k) {
        Eigen::Vector3f& sum = mesh_.normals_[corners[t + k]];
        sum += sum.dot(normal) < 0.0F ? Eigen::Vector3f(-normal) : normal;
      }
    }
    for (std::size_t i = 0; i < modules.size(); ++i) {
      const Eigen::Vector3f& place = places_[modules[i]];
      put(modules[i], place, light_.on(mesh_.normals_[i], place));
    }
  }

  void tube(const Row& row) {
    AcrossRow frame(row.modules, places_, motion_.upOf(row.modules.front()));
    for (std::size_t i = 0; i < row.modules.size(); ++i) {
      frame.moveTo(i);
      for (std::uint32_t k = 0; k < kTubeSides; ++k) {
        const float angle = 2.0F * static_cast<float>(M_PI) * static_cast<float>(k) / kTubeSides;
        putAround(row, i, std::cos(angle) * frame.across() + std::sin(angle) * frame.side());
      }
    }
  }

  void bar(const Row& row) {
    AcrossRow frame(row.modules, places_, motion_.upOf(row.modules.front()));
    for (std::size_t i = 0; i < row.modules.size(); ++i) {
      frame.moveTo(i);
      for (std::uint32_t k = 0; k < kBarSides; ++k) {
        putOnBar(row, i, frame, k);
      }
    }
  }

  void barEnds(const Row& row) {
    AcrossRow frame(row.modules, places_, motion_.upOf(row.modules.front()));
    for (const std::size_t end : {std::size_t{0}, row.modules.size() - 1}) {
      frame.moveTo(end);
      for (std::uint32_t k = 0; k < kBarSides; k += 2) {
        putCorner(row, end, frame, k / 2, frame.along());
      }
    }
  }

  void body(const DrawnBody& body) {
    const Solid& solid = *body.solid;
    const Eigen::Matrix3f turn = body.radius * body.turn;
    const std::vector<float>& lights = lightsOf(body);
    for (std::size_t k = 0; k < solid.corners.size(); ++k) {
      put(body.module, places_[body.module] + turn * solid.corners[k], lights[k]);
    }
  }

  void dot(std::uint32_t module) { put(module, places_[module], kDotLight); }

 private:
  static constexpr float kDotLight = 0.75F;

  /// Those that have one solid, and are turned alike, are lit alike: all are about as far from the
  /// camera. Bodies of one kind follow each other mostly.
  const std::vector<float>& lightsOf(const DrawnBody& body) {
    if (body.solid != lit_ || body.turn != lit_turn_) {
      lit_ = body.solid;
      lit_turn_ = body.turn;
      lights_.clear();
      for (const Eigen::Vector3f& normal : body.solid->normals) {
        lights_.push_back(light_.on(body.turn * normal, mesh_.middle_));
      }
    }
    return lights_;
  }
  void put(std::uint32_t module, const Eigen::Vector3f& place, float light) {
    *out_++ = {place.x(), place.y(), place.z(),
               colourOf(tints_[module], light, motion_.glow()[module], view_.is_stale)};
  }
  void putAround(const Row& row, std::size_t i, const Eigen::Vector3f& normal) {
    const Eigen::Vector3f place = places_[row.modules[i]] + row.radius * normal;
    put(row.modules[i], place, light_.on(normal, place));
  }
  /// Side k / 2 of the bar: above, right, below, left; each from one corner to the next.
  void putOnBar(const Row& row, std::size_t i, const AcrossRow& frame, std::uint32_t k) {
    const Eigen::Vector3f normals[] = {frame.across(), frame.side(), -frame.across(),
                                       -frame.side()};
    putCorner(row, i, frame, (k / 2 + k % 2) % 4, normals[k / 2]);
  }
  /// Corners are counted from above left to above right, below right and below left.
  void putCorner(const Row& row,
                 std::size_t i,
                 const AcrossRow& frame,
                 std::uint32_t corner,
                 const Eigen::Vector3f& normal) {
    const float side = corner == 1 || corner == 2 ? 1.0F : -1.0F;
    const float height = corner < 2 ? kBarThickness : -kBarThickness;
    const Eigen::Vector3f place =
        places_[row.modules[i]] + row.radius * (side * frame.side() + height * frame.across());
    put(row.modules[i], place, light_.on(normal, place));
  }

  ModelMesh& mesh_;
  const ModelMotion& motion_;
  const std::vector<Eigen::Vector3f>& places_;
  const MeshView& view_;
  const std::vector<Tint>& tints_;
  ModelLight light_;
  const Solid* lit_ = nullptr;
  Eigen::Matrix3f lit_turn_ = Eigen::Matrix3f::Identity();
  std::vector<float> lights_;  // of the solid that was lit last
  MeshVertex* out_;
};

ModelMesh::ModelMesh(const ModelStructure& structure,
                     const ModelShape& shape,
                     const ModelMotion& motion,
                     double thickness,
                     bool has_links)
    : dot_of_(shape.looks.size(), kNone) {
  for (std::size_t i = 0; i < shape.looks.size(); ++i) {
    tints_.push_back(tintOf(shape.looks[i]));
    section_tints_.push_back(tintOfSection(structure.module_sections[i]));
  }
  measure(motion, shape);
  addSurfaces(shape);
  addTubes(shape, static_cast<float>(thickness));
  addBars(shape, motion);
  addBodies(structure, shape, static_cast<float>(thickness));
  first_dot_ = vertices_;
  addRim();
  addThinStrings(shape);
  addSmallBodies(shape);
  if (has_links) {
    addLinks(shape);
  }
  vertices_ += dots_.size();
}

void ModelMesh::measure(const ModelMotion& motion, const ModelShape& shape) {
  Eigen::AlignedBox3f filled;
  for (std::size_t i = 0; i < shape.looks.size(); ++i) {
    if (shape.looks[i] != ModuleLook::kHidden && motion.restPlaces()[i].allFinite()) {
      filled.extend(motion.restPlaces()[i]);
    }
  }
  if (!filled.isEmpty()) {
    middle_ = filled.center();
    size_ = std::max(filled.diagonal().norm(), kMinSizeM);
  }
}

void ModelMesh::addTriangles(std::uint32_t first, const ModuleIndices& corners) {
  for (const std::uint32_t corner : corners) {
    triangles_.push_back(first + corner);
  }
}

void ModelMesh::addSurfaces(const ModelShape& shape) {
  std::unordered_map<std::uint32_t, std::uint32_t> numbers;
  for (const std::uint32_t module : shape.triangles) {
    const auto [at, is_new] =
        numbers.try_emplace(module, static_cast<std::uint32_t>(surface_.size()));
    if (is_new) {
      surface_.push_back(module);
    }
    surface_corners_.push_back(at->second);
  }
  addTriangles(0, surface_corners_);
  vertices_ += surface_.size();
}

void ModelMesh::addTubes(const ModelShape& shape, float thickness) {
  std::size_t modules = 0;
  for (const ModuleIndices& row : shape.strings) {
    modules += row.size();
  }
  if (modules > kMaxTubeModules) {
    return;  // they are lines
  }
  for (const ModuleIndices& row : shape.strings) {
    const auto first = static_cast<std::uint32_t>(vertices_);
    for (std::uint32_t i = 0; i + 1 < row.size(); ++i) {
      for (std::uint32_t k = 0; k < kTubeSides; ++k) {
        const std::uint32_t a = i * kTubeSides + k;
        const std::uint32_t b = i * kTubeSides + (k + 1) % kTubeSides;
        addTriangles(first, {a, b, a + kTubeSides, b, b + kTubeSides, a + kTubeSides});
      }
    }
    tubes_.push_back({row, thickness * kTubeRadius * size_});
    vertices_ += row.size() * kTubeSides;
  }
}

void ModelMesh::addBars(const ModelShape& shape, const ModelMotion& motion) {
  std::vector<Eigen::Vector3f> middles;
  for (const ModuleIndices& row : shape.bars) {
    middles.push_back(motion.restPlaces()[row[row.size() / 2]]);
  }
  for (std::size_t b = 0; b < shape.bars.size(); ++b) {
    const ModuleIndices& row = shape.bars[b];
    const auto first = static_cast<std::uint32_t>(vertices_);
    const auto ends = static_cast<std::uint32_t>(row.size() * kBarSides);
    for (std::uint32_t i = 0; i + 1 < row.size(); ++i) {
      for (std::uint32_t k = 0; k < kBarSides; k += 2) {
        const std::uint32_t a = i * kBarSides + k;
        addTriangles(first, {a, a + 1, a + kBarSides, a + 1, a + 1 + kBarSides, a + kBarSides});
      }
    }
    for (const std::uint32_t end : {ends, ends + 4}) {
      addTriangles(first, {end, end + 1, end + 2, end, end + 2, end + 3});
    }
    const float length =
        (motion.restPlaces()[row.back()] - motion.restPlaces()[row.front()]).norm();
    const float width =
        std::min(kBarWidthOfLength * length, kBarWidthOfDistance * nearestOther(b, middles));
    bars_.push_back({row, 0.5F * width});
    vertices_ += ends + 8;
  }
}

void ModelMesh::addBodies(const ModelStructure& structure,
                          const ModelShape& shape,
                          float thickness) {
  bodies_ = bodiesOf(structure, shape, size_);
  for (DrawnBody& body : bodies_) {
    body.radius *= thickness;
    addTriangles(static_cast<std::uint32_t>(vertices_), body.solid->triangles);
    vertices_ += body.solid->corners.size();
  }
}

std::uint32_t ModelMesh::dotOf(std::uint32_t module) {
  std::uint32_t& dot = dot_of_[module];
  if (dot == kNone) {
    dot = static_cast<std::uint32_t>(first_dot_ + dots_.size());
    dots_.push_back(module);
  }
  return dot;
}

/// The links of a surface that lie on one triangle alone. What lies on two is the diagonal of a
/// mesh, or inside.
void ModelMesh::addRim() {
  std::unordered_map<std::uint64_t, int> sides;
  const auto linkOf = [&](std::size_t i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const auto [low, high] = std::minmax(surface_corners_[i], surface_corners_[next]);
    return std::uint64_t{low} << 32 | high;
  };
  for (std::size_t i = 0; i < surface_corners_.size(); ++i) {
    ++sides[linkOf(i)];
  }
  for (std::size_t i = 0; i < surface_corners_.size(); ++i) {
    const std::uint64_t link = linkOf(i);
    if (sides[link] == 1) {
      lines_.push_back(dotOf(surface_[link >> 32]));
      lines_.push_back(dotOf(surface_[link & kNone]));
    }
  }
}

void ModelMesh::addThinStrings(const ModelShape& shape) {
  for (std::size_t s = tubes_.size(); s < shape.strings.size(); ++s) {
    const ModuleIndices& row = shape.strings[s];
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      lines_.push_back(dotOf(row[i]));
      lines_.push_back(dotOf(row[i + 1]));
    }
  }
}

void ModelMesh::addSmallBodies(const ModelShape& shape) {
  for (std::size_t b = bodies_.size(); b < shape.bodies.size(); ++b) {
    points_.push_back(dotOf(shape.bodies[b]));
  }
}

void ModelMesh::addLinks(const ModelShape& shape) {
  for (const std::uint32_t module : shape.links) {
    lines_.push_back(dotOf(module));
  }
}

void ModelMesh::fill(const ModelMotion& motion, const MeshView& view, MeshVertex* out) {
  Filling filling(*this, motion, view, out);
  filling.surface();
  for (const Row& row : tubes_) {
    filling.tube(row);
  }
  for (const Row& row : bars_) {
    filling.bar(row);
    filling.barEnds(row);
  }
  for (const DrawnBody& body : bodies_) {
    filling.body(body);
  }
  for (const std::uint32_t module : dots_) {
    filling.dot(module);
  }
}

}  // namespace ergotic::panel
