// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include <Eigen/Core>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/disjoint_sets.hpp"

namespace ergotic::physics {
namespace {

constexpr double kCosineRounding = 1e-12;  // of a cosine

/// Scalar modules that links join have one axis in common whatever their sections' poses, but meet
/// what is Euclidean along the axis of their own section. Where these differ no displacements in
/// space are those of the network: a ring of three masses that sees one axis turned round is
/// stiffer than any of the same links.
class AxesJudge {
 public:
  AxesJudge(const RatedNetwork& networks, Findings& findings)
      : networks_(networks),
        scene_(networks.scene()),
        bodies_(scene_.mats.size()),
        findings_(findings) {}

  void run() {
    for (const scene::Lia& lia : scene_.lias) {
      if (networks_.isExplicit(lia) && isScalar(lia.a) && isScalar(lia.b)) {
        join(lia);
      }
    }
    for (const scene::Lia& lia : scene_.lias) {
      if (networks_.isExplicit(lia) && isScalar(lia.a) != isScalar(lia.b)) {
        see(lia);
      }
    }
  }

 private:
  bool isScalar(int mat) const {
    return scene_.sectionOf(scene_.mats[at(mat)]).geometry == scene::Geometry::kScalar;
  }

  template <class Visit>
  void visitModules(int end, const Visit& visit) const {
    for (const Shares& place : placesOf(networks_.network(), end)) {
      for (const Share& share : place) {
        visit(share.node);
      }
    }
  }

  void join(const scene::Lia& lia) {
    int first = -1;
    for (const int end : {lia.a, lia.b}) {
      visitModules(end, [&](int module) {
        first = first < 0 ? module : first;
        bodies_.join(module, first);
      });
    }
  }

  void see(const scene::Lia& lia) {
    const int scalar = isScalar(lia.a) ? lia.a : lia.b;
    if (!(networks_.inverseMass(lia.a) > 0.0 && networks_.inverseMass(lia.b) > 0.0)) {
      return;
    }
    const Eigen::Vector3d axis = scene_.sectionOf(scene_.mats[at(scalar)]).pose.linear().col(0);
    bool is_told = false;
    visitModules(scalar, [&](int module) {
      const auto [known, is_new] = axes_.try_emplace(bodies_.setOf(module), axis);
      if (!is_told && known->second.dot(axis) < 1.0 - kCosineRounding) {
        is_told = true;
        findings_.add(Verdict::kUnproven, lia.place,
                      "link '" + lia.name +
                          "' joins something scalar to a line, a plane or space along another "
                          "axis than links around it do: no bound is known. Turn the scalar "
                          "sections that links join alike");
      }
    });
  }

  const RatedNetwork& networks_;
  const scene::Scene& scene_;
  DisjointSets bodies_;                  // scalar modules
  std::map<int, Eigen::Vector3d> axes_;  // along which each meets others
  Findings& findings_;
};

}  // namespace

void judgeAxes(const RatedNetwork& networks, Findings& findings) {
  AxesJudge(networks, findings).run();
}

}  // namespace ergotic::physics
