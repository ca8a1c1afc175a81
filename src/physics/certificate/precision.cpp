// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/precision.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "at.hpp"
#include "constants.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/load_matrix.hpp"
#include "physics/network/network.hpp"
#include "physics/note.hpp"

namespace ergotic::physics {
namespace {

/// A spring that never lets go, or a bend: k u u^T on what it joins.
struct Load {
  Shares ends;  // the free ones
  double stiffness = 0.0;
  bool is_anchored = false;  // one of its ends is held by what no force moves
  bool is_plain = true;      // positive, between two modules at most
};

/// Modules that are joined by loads.
struct Body {
  std::vector<int> modules;
  std::vector<std::size_t> loads;
  bool is_anchored = false;
  bool is_plain = true;  // connected to the ground, it is held
};

class Bodies {
 public:
  explicit Bodies(const scene::Scene& scene)
      : network_(scene), row_of_(scene.mats.size(), -1), joined_(scene.mats.size()) {
    for (std::size_t l = 0; l < network_.links.size(); ++l) {
      if (scene.lias[l].bend < 0) {
        addLink(network_.links[l]);
      }
    }
    for (const Network::Bend& bend : network_.bends) {
      add({bend.ends, bend.stiffness.lowest, false, false});
    }
    collect();
  }

  std::vector<int> freeOnes() {
    std::vector<int> found;
    for (const Body& body : bodies_) {
      if (body.modules.size() > 1 && !isHeld(body)) {
        found.push_back(body.modules.front());
      }
    }
    return found;
  }

 private:
  void addLink(const Network::Link& link) {
    Load load{sharesNow(network_, link.a), link.at_least};
    const Shares other = sharesNow(network_, link.b);
    load.is_anchored = load.ends.empty() || other.empty();
    for (const Share& share : other) {
      load.ends.push_back({share.node, -share.weight});
    }
    load.is_plain = load.stiffness > 0.0 && load.ends.size() <= 2 &&
                    network_.point_of[at(link.a)] < 0 && network_.point_of[at(link.b)] < 0;
    add(std::move(load));
  }

  void add(Load load) {
    if (load.ends.empty() || load.stiffness == 0.0) {
      return;
    }
    for (const Share& end : load.ends) {
      joined_.join(end.node, load.ends.front().node);
    }
    loads_.push_back(std::move(load));
  }

  void collect() {
    std::vector<Body> bodies(network_.nodes.size());
    for (std::size_t m = 0; m < network_.nodes.size(); ++m) {
      if (network_.nodes[m].is_free) {
        Body& body = bodies[at(joined_.setOf(static_cast<int>(m)))];
        body.modules.push_back(static_cast<int>(m));
        body.is_anchored = body.is_anchored || network_.nodes[m].stiffness.range.lowest > 0.0;
      }
    }
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      Body& body = bodies[at(joined_.setOf(loads_[l].ends.front().node))];
      body.loads.push_back(l);
      body.is_anchored = body.is_anchored || loads_[l].is_anchored;
      body.is_plain = body.is_plain && loads_[l].is_plain;
    }
    bodies_ = std::move(bodies);
  }

  /// Positive springs that are joined hold one another.
  bool isHeld(const Body& body) {
    return body.is_plain ? body.is_anchored : isHeldByItsMatrix(body);
  }

  /// True if all motions are faster than kHeldHz: K - w^2 M is positive definite, for unit masses.
  bool isHeldByItsMatrix(const Body& body) {
    for (std::size_t row = 0; row < body.modules.size(); ++row) {
      row_of_[at(body.modules[row])] = static_cast<int>(row);
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(stiffnessOf(body));
    return solver.info() == Eigen::Success && (solver.vectorD().array() > 0.0).all();
  }

  Eigen::SparseMatrix<double> stiffnessOf(const Body& body) const {
    LoadMatrix matrix(static_cast<int>(body.modules.size()));
    const double slowest = 2.0 * kPi * kHeldHz * network_.scene.time_unit_s;
    for (std::size_t row = 0; row < body.modules.size(); ++row) {
      const Network::Node& node = network_.nodes[at(body.modules[row])];
      const int i = static_cast<int>(row);
      matrix.add(i, i, node.stiffness.range.lowest / node.mass.range.highest - slowest * slowest);
    }
    for (const std::size_t l : body.loads) {
      const Load& load = loads_[l];
      for (const Share& a : load.ends) {
        for (const Share& b : load.ends) {
          matrix.add(row_of_[at(a.node)], row_of_[at(b.node)],
                     load.stiffness * weightOf(a) * weightOf(b));
        }
      }
    }
    return matrix.sum();
  }

  double weightOf(const Share& end) const {
    return end.weight / std::sqrt(network_.nodes[at(end.node)].mass.range.highest);
  }

  Network network_;
  std::vector<int> row_of_;  // [nodes] in the matrix of their body
  DisjointSets joined_;
  std::vector<Load> loads_;
  std::vector<Body> bodies_;  // [nodes] by the module that names them, most are empty
};

std::string nameOf(const scene::Scene& scene, int mat) {
  return "'" + scene.mats[at(mat)].name.str() + "'";
}

/// "'b.0' and 11 other bodies move" or "'b.0' moves".
std::string whoMoves(const scene::Scene& scene, const std::vector<int>& bodies) {
  const std::size_t others = bodies.size() - 1;
  return "nothing holds the body of " + nameOf(scene, bodies.front()) +
         (others == 0 ? "" : " (nor those of " + std::to_string(others) + " other modules)") +
         " in its place";
}

}  // namespace

std::vector<int> bodiesThatMoveFreely(const scene::Scene& scene) {
  return Bodies(scene).freeOnes();
}

CompileOptions withPrecision(CompileOptions options, const scene::Scene& scene) {
  if (options.precision == Precision::kAuto) {
    options.precision =
        bodiesThatMoveFreely(scene).empty() ? Precision::kFloat : Precision::kDouble;
  }
  return options;
}

std::vector<std::string> notesOnPrecision(const scene::Scene& scene) {
  const std::vector<int> bodies = bodiesThatMoveFreely(scene);
  if (bodies.empty()) {
    return {};
  }
  return {noteAt(scene, scene.mats[at(bodies.front())].place) + whoMoves(scene, bodies) +
          ", so the scene plays in double precision: in single precision its springs would add a "
          "noise that grows with the distance it moves"};
}

Certificate inPrecision(Certificate certificate,
                        const scene::Scene& scene,
                        const CompileOptions& options) {
  const std::vector<int> bodies =
      options.precision == Precision::kFloat ? bodiesThatMoveFreely(scene) : std::vector<int>();
  if (!bodies.empty() && certificate.verdict < Verdict::kUnproven) {
    certificate.verdict = Verdict::kUnproven;
    certificate.findings.insert(
        certificate.findings.begin(),
        scene::textOf(scene, scene.mats[at(bodies.front())].place) +
            ": warning: " + whoMoves(scene, bodies) +
            ", and in single precision its springs see distances that are rounded by 6e-8 of how "
            "far it is: a noise that grows as it moves. Play it with precision: auto or double, "
            "or tie it to the ground (a stiffness that brings it back within a second is enough)");
  }
  return certificate;
}

}  // namespace ergotic::physics
