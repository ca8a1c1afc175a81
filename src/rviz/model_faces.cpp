// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <Eigen/Geometry>

namespace ergotic::panel {
namespace {

constexpr float kMaxCosine = 0.6F;           // of a corner of a mesh with four
constexpr float kMaxTriangleCosine = 0.95F;  // of a corner of a triangle
constexpr float kMinAgreement = 0.5F;        // of the normals at the corners: about flat
constexpr float kInside = 0.01F;             // of the length of a side, from it
constexpr int kSidesOfLink = 2;

struct Mesh {
  std::array<std::uint32_t, 4> corners;  // in order; a triangle repeats the last one
  std::size_t count = 4;
  float skew = 0.0F;  // the largest cosine of its corners: 0 is a rectangle
};

class FaceFinder {
 public:
  FaceFinder(const ModelStructure& structure, const LinkGraph& graph)
      : structure_(structure), graph_(graph), is_in_quad_(graph.modules()) {}

  ModuleIndices find() {
    accept(quads());
    for (const std::uint32_t module : quad_corners_) {
      is_in_quad_[module] = true;
    }
    accept(loneTriangles());
    roundOff();
    return std::move(triangles_);
  }

 private:
  /// Finds the quadrilaterals, each once: from its lowest module.
  std::vector<Mesh> quads() const {
    std::vector<Mesh> found;
    for (std::uint32_t a = 0; a < graph_.modules(); ++a) {
      forEachPair(a, [&](std::uint32_t b, std::uint32_t c) {
        for (const std::uint32_t d : graph_.of(b)) {
          if (d > a && d != c && graph_.areNeighbours(c, d)) {
            addIfFlat({{a, b, d, c}, 4}, kMaxCosine, found);
          }
        }
      });
    }
    return found;
  }
  std::vector<Mesh> loneTriangles() const {
    std::vector<Mesh> found;
    for (std::uint32_t a = 0; a < graph_.modules(); ++a) {
      forEachPair(a, [&](std::uint32_t b, std::uint32_t c) {
        if (graph_.areNeighbours(b, c) && !(is_in_quad_[a] && is_in_quad_[b] && is_in_quad_[c])) {
          addIfFlat({{a, b, c, c}, 3}, kMaxTriangleCosine, found);
        }
      });
    }
    return found;
  }
  template <class Visit>
  void forEachPair(std::uint32_t a, const Visit& visit) const {
    const ModuleIndices& around = graph_.of(a);
    for (std::size_t i = 0; i < around.size(); ++i) {
      for (std::size_t j = i + 1; j < around.size() && around[i] > a; ++j) {
        visit(around[i], around[j]);
      }
    }
  }

  void addIfFlat(Mesh mesh, float most_cosine, std::vector<Mesh>& found) const {
    Eigen::Vector3f first_normal = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < mesh.count; ++k) {
      const Eigen::Vector3f here = restOf(structure_, mesh.corners[k]);
      const Eigen::Vector3f to = restOf(structure_, mesh.corners[(k + 1) % mesh.count]) - here;
      const Eigen::Vector3f from =
          restOf(structure_, mesh.corners[(k + mesh.count - 1) % mesh.count]) - here;
      const float cosine = std::abs(to.dot(from)) / (to.norm() * from.norm());
      const Eigen::Vector3f normal = to.cross(from).normalized();
      if (k == 0) {
        first_normal = normal;
      }
      if (!(cosine <= most_cosine) || !(normal.dot(first_normal) >= kMinAgreement)) {
        return;
      }
      mesh.skew = std::max(mesh.skew, cosine);
    }
    if (isEmpty(mesh, first_normal)) {
      found.push_back(mesh);
    }
  }

  /// Whether no neighbour of its first corner lies inside, as in the squares that diagonals make.
  bool isEmpty(const Mesh& mesh, const Eigen::Vector3f& normal) const {
    const ModuleIndices& around = graph_.of(mesh.corners[0]);
    return std::none_of(around.begin(), around.end(),
                        [&](std::uint32_t module) { return isInside(module, mesh, normal); });
  }
  bool isInside(std::uint32_t module, const Mesh& mesh, const Eigen::Vector3f& normal) const {
    const Eigen::Vector3f place = restOf(structure_, module);
    for (std::size_t k = 0; k < mesh.count; ++k) {
      const Eigen::Vector3f here = restOf(structure_, mesh.corners[k]);
      const Eigen::Vector3f side = restOf(structure_, mesh.corners[(k + 1) % mesh.count]) - here;
      if (!(side.cross(place - here).dot(normal) > kInside * side.squaredNorm())) {
        return false;
      }
    }
    return true;
  }

  /// The most rectangular first, so that of a net with diagonals the squares are taken.
  void accept(std::vector<Mesh> meshes) {
    std::stable_sort(meshes.begin(), meshes.end(),
                     [](const Mesh& a, const Mesh& b) { return a.skew < b.skew; });
    for (const Mesh& mesh : meshes) {
      if (hasRoom(mesh)) {
        take(mesh);
      }
    }
  }
  bool hasRoom(const Mesh& mesh) const {
    for (std::size_t k = 0; k < mesh.count; ++k) {
      const auto side = sides_.find(linkOf(mesh, k));
      if (side != sides_.end() && side->second >= kSidesOfLink) {
        return false;
      }
    }
    return true;
  }
  void take(const Mesh& mesh) {
    for (std::size_t k = 0; k < mesh.count; ++k) {
      ++sides_[linkOf(mesh, k)];
    }
    if (mesh.count == 4) {
      quad_corners_.insert(quad_corners_.end(), mesh.corners.begin(), mesh.corners.end());
    }
    for (std::size_t k = 2; k < mesh.count; ++k) {
      triangles_.insert(triangles_.end(), {mesh.corners[0], mesh.corners[k - 1], mesh.corners[k]});
    }
  }
  static std::uint64_t linkOf(const Mesh& mesh, std::size_t k) {
    const auto [low, high] = std::minmax(mesh.corners[k], mesh.corners[(k + 1) % mesh.count]);
    return std::uint64_t{low} << 32 | high;
  }

  /// Fills the corners of the stairs that a square net makes of a round edge: where a module has
  /// three meshes around it, a triangle takes the place of the fourth.
  void roundOff() {
    std::vector<int> meshes(graph_.modules());
    for (const std::uint32_t module : quad_corners_) {
      ++meshes[module];
    }
    std::vector<Mesh> fillings;
    for (std::uint32_t a = 0; a < graph_.modules(); ++a) {
      const ModuleIndices rim = rimOf(a);
      if (meshes[a] == 3 && rim.size() == 2) {
        addIfFlat({{a, rim[0], rim[1], rim[1]}, 3}, kMaxTriangleCosine, fillings);
      }
    }
    accept(std::move(fillings));
  }
  /// Neighbours of a module at links that only one mesh lies on.
  ModuleIndices rimOf(std::uint32_t module) const {
    ModuleIndices rim;
    for (const std::uint32_t other : graph_.of(module)) {
      const auto side = sides_.find(linkOf({{module, other, other, other}, 2}, 0));
      if (side != sides_.end() && side->second == 1) {
        rim.push_back(other);
      }
    }
    return rim;
  }

  const ModelStructure& structure_;
  const LinkGraph& graph_;
  std::vector<bool> is_in_quad_;
  ModuleIndices quad_corners_;                    // [quads][4]
  std::unordered_map<std::uint64_t, int> sides_;  // of links, that meshes lie on
  ModuleIndices triangles_;
};

}  // namespace

ModuleIndices facesOf(const ModelStructure& structure, const LinkGraph& graph) {
  return FaceFinder(structure, graph).find();
}

}  // namespace ergotic::panel
