// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_shape.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "rviz/model_faces.hpp"

namespace ergotic::panel {
namespace {

constexpr std::size_t kMinOfRow = 4;  // modules of what is a string or a bar, and not single masses
constexpr int kNoPart = -1;

class ShapeFinder {
 public:
  explicit ShapeFinder(const ModelStructure& structure)
      : structure_(structure),
        is_mode_(modesOfOutlines(structure)),
        is_outline_(placesOfOutlines(structure)),
        parts_(structure.module_sections.size(), kNoPart) {
    shape_.looks.resize(parts_.size(), ModuleLook::kMass);
  }

  ModelShape find() {
    addStrings();
    addSurfaces();
    addRows();
    addBodies();
    addLinks();
    return std::move(shape_);
  }

 private:
  bool isFree(std::size_t module) const { return parts_[module] == kNoPart && !is_mode_[module]; }
  /// Whether a module belongs to a body; hands and points only touch bodies.
  bool isOfBody(std::size_t module) const {
    const std::uint8_t type = structure_.module_types[module];
    return type == ModelStructure::MASS || type == ModelStructure::CELL ||
           type == ModelStructure::GROUND || is_outline_[module];
  }
  void assign(std::size_t module, ModuleLook look, int part) {
    shape_.looks[module] = look;
    parts_[module] = part;
  }

  void addStrings() {
    for (std::size_t s = 0; s < structure_.string_first.size(); ++s) {
      ModuleIndices row(structure_.string_count[s]);
      std::iota(row.begin(), row.end(), structure_.string_first[s]);
      const bool is_one = std::all_of(row.begin(), row.end(), [&](auto i) { return isFree(i); });
      if (row.size() > 1 && is_one) {
        addRow(std::move(row), ModuleLook::kString);
      }
    }
  }
  void addRow(ModuleIndices row, ModuleLook look) {
    for (const std::uint32_t module : row) {
      assign(module, look, next_part_);
    }
    ++next_part_;
    (look == ModuleLook::kString ? shape_.strings : shape_.bars).push_back(std::move(row));
  }

  LinkGraph bodies() const {
    return {structure_, [this](std::size_t i) { return isFree(i) && isOfBody(i); }};
  }
  void addSurfaces() {
    shape_.triangles = facesOf(structure_, bodies());
    for (const std::uint32_t module : shape_.triangles) {
      assign(module, ModuleLook::kSurface, next_part_);
    }
    ++next_part_;
  }

  void addRows() {
    const LinkGraph graph = bodies();
    for (std::uint32_t i = 0; i < graph.modules(); ++i) {
      if (isFree(i) && graph.of(i).size() == 1) {
        addRowFrom(graph, i);
      }
    }
  }
  void addRowFrom(const LinkGraph& graph, std::uint32_t end) {
    ModuleIndices row{end};
    for (std::uint32_t next = graph.of(end).front(); graph.of(next).size() <= 2;) {
      const std::uint32_t before = row.back();
      row.push_back(next);
      if (graph.of(next).size() == 1) {
        break;
      }
      next = graph.of(next)[graph.of(next)[0] == before ? 1 : 0];
    }
    if (row.size() >= kMinOfRow) {
      const bool is_bar = is_outline_[end] || (graph.isBridged(row[1]) && !isSpanned(row));
      addRow(std::move(row), is_bar ? ModuleLook::kBar : ModuleLook::kString);
    }
  }
  /// Whether a row spans from ground to ground, as a stiff string; bars are clamped by two grounds,
  /// or free.
  bool isSpanned(const ModuleIndices& row) const {
    const auto isGround = [&](std::size_t i) {
      return structure_.module_types[row[i]] == ModelStructure::GROUND;
    };
    return isGround(0) && !isGround(1) && !isGround(row.size() - 2) && isGround(row.size() - 1);
  }

  void addBodies() {
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
      if (is_mode_[i]) {
        assign(i, ModuleLook::kHidden, kNoPart);
      } else if (isFree(i)) {
        assign(i, lookOf(structure_.module_types[i]), kNoPart);
        shape_.bodies.push_back(i);
      }
    }
  }
  static ModuleLook lookOf(std::uint8_t type) {
    switch (type) {
      case ModelStructure::GROUND:
        return ModuleLook::kGround;
      case ModelStructure::SLICE:
      case ModelStructure::DRIVEN:
        return ModuleLook::kHand;
      case ModelStructure::POINT:
        return ModuleLook::kPoint;
      default:
        return ModuleLook::kMass;
    }
  }

  void addLinks() {
    for (std::size_t i = 0; i < structure_.links.size(); i += 2) {
      const std::uint32_t a = structure_.links[i];
      const std::uint32_t b = structure_.links[i + 1];
      const bool is_inside = parts_[a] == parts_[b] && parts_[a] != kNoPart;
      if (a != b && !is_inside && !is_mode_[a] && !is_mode_[b]) {
        shape_.links.insert(shape_.links.end(), {a, b});
      }
    }
  }

  const ModelStructure& structure_;
  std::vector<bool> is_mode_;
  std::vector<bool> is_outline_;
  std::vector<int> parts_;  // [modules] of one string, one bar, or the surfaces
  int next_part_ = 0;
  ModelShape shape_;
};

}  // namespace

ModelShape shapeOf(const ModelStructure& structure) {
  return ShapeFinder(structure).find();
}

}  // namespace ergotic::panel
