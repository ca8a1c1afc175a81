// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <utility>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/network.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;
using scene::Mat;
using scene::MatType;
using scene::Scene;

bool mayBeInTank(const Scene& scene, const Mat& mat) {
  const scene::Section& section = scene.sectionOf(mat);
  return (mat.type == MatType::kMass || mat.type == MatType::kCell ||
          mat.type == MatType::kGround) &&
         section.geometry == scene::Geometry::kScalar && section.modes == scene::kNoModes &&
         section.sleep_energy == 0.0;
}

/// Modules that are in a tank, or whose links somebody else has chosen a scheme for. [mats]
std::vector<bool> takenModules(const Scene& scene) {
  std::vector<bool> taken(scene.mats.size(), false);
  for (const Lia& lia : scene.lias) {
    if (lia.tank >= 0) {
      taken[at(lia.a)] = taken[at(lia.b)] = true;
    }
  }
  return taken;
}

bool mayShare(const Scene& scene, const std::vector<bool>& taken, const Lia& lia) {
  const Mat& a = scene.mats[at(lia.a)];
  const Mat& b = scene.mats[at(lia.b)];
  const auto isTaken = [&](int mat) {
    return taken[at(mat)] && scene.mats[at(mat)].type != MatType::kGround;
  };
  return lia.type == scene::LiaType::kCubic && lia.scheme == scene::Scheme::kAuto && lia.tank < 0 &&
         a.section == b.section && mayBeInTank(scene, a) && mayBeInTank(scene, b) &&
         !isTaken(lia.a) && !isTaken(lia.b) && lia.stiffness.audio < 0 && lia.damping.audio < 0 &&
         lia.law->nonlinearity.audio < 0 && scene::rangeOf(scene, lia.stiffness).lowest >= 0.0 &&
         scene::rangeOf(scene, lia.damping).lowest >= 0.0 &&
         scene::rangeOf(scene, lia.law->nonlinearity).lowest >= 0.0;
}

/// Modules that springs and hardening links join.
class JoinedModules {
 public:
  JoinedModules(const Scene& scene, const std::vector<std::size_t>& hardening)
      : network_(scene), sets_(scene.mats.size()) {
    for (const Network::Link& link : network_.links) {
      if (link.at_least > 0.0) {
        join(link);
      }
    }
    for (const std::size_t l : hardening) {
      join(network_.links[l]);
    }
    for (const Network::Bend& bend : network_.bends) {
      for (const Share& end : bend.ends) {
        sets_.join(end.node, bend.ends.front().node);
      }
    }
  }

  /// Names the body that a link is of, -1: nothing of it moves.
  int bodyOf(std::size_t link) {
    const int a = network_.links[link].a;
    const int b = network_.links[link].b;
    const int free = network_.nodes[at(a)].is_free ? a : network_.nodes[at(b)].is_free ? b : -1;
    return free < 0 ? -1 : sets_.setOf(free);
  }

 private:
  void join(const Network::Link& link) {
    if (network_.nodes[at(link.a)].is_free && network_.nodes[at(link.b)].is_free) {
      sets_.join(link.a, link.b);
    }
  }

  Network network_;
  DisjointSets sets_;
};

bool isAlwaysNothing(const Scene& scene, const scene::Value& value) {
  return scene::largest(scene, value) == 0.0;
}

/// Leaves to a hardening link what is not linear of it.
void moveLinearPart(Scene& scene, std::size_t index) {
  Lia& lia = scene.lias[index];
  if (isAlwaysNothing(scene, lia.stiffness) && isAlwaysNothing(scene, lia.damping)) {
    return;
  }
  Lia linear;
  linear.name = scene::Name(lia.name + ".linear");
  linear.a = lia.a;
  linear.b = lia.b;
  linear.stiffness = lia.stiffness;
  linear.damping = lia.damping;
  linear.rest_length = lia.rest_length;
  linear.place = lia.place;
  linear.scheme = scene::Scheme::kAuto;
  lia.stiffness = lia.damping = {};
  scene.lias.push_back(std::move(linear));
}

int addTank(Scene& scene, const Lia& first) {
  scene::Tank tank;
  tank.name = scene::Name(first.name + ".tank");
  tank.place = first.place;
  scene.tanks.push_back(std::move(tank));
  return static_cast<int>(scene.tanks.size()) - 1;
}

void share(Scene& scene, const std::vector<std::size_t>& links, std::vector<std::string>& notes) {
  const Lia first = scene.lias[links.front()];
  const int tank = addTank(scene, first);
  for (const std::size_t l : links) {
    scene.lias[l].tank = tank;
    scene.lias[l].scheme = scene::Scheme::kEnergyStable;
    moveLinearPart(scene, l);
  }
  notes.push_back(noteAt(scene, first.place) + "link '" + first.name + "' and " +
                  std::to_string(links.size() - 1) +
                  " more harden one body and share one tank of energy (scheme: energy_stable keeps "
                  "them apart)");
}

}  // namespace

void shareTanks(Scene& scene, std::vector<std::string>& notes) {
  const std::vector<bool> taken = takenModules(scene);
  std::vector<std::size_t> hardening;
  for (std::size_t l = 0; l < scene.lias.size(); ++l) {
    if (mayShare(scene, taken, scene.lias[l])) {
      hardening.push_back(l);
    }
  }
  if (hardening.size() < 2) {
    return;
  }
  JoinedModules joined(scene, hardening);
  std::vector<std::vector<std::size_t>> bodies(scene.mats.size());
  for (const std::size_t l : hardening) {
    if (const int body = joined.bodyOf(l); body >= 0) {
      bodies[at(body)].push_back(l);
    }
  }
  for (const std::vector<std::size_t>& links : bodies) {
    if (links.size() > 1) {
      share(scene, links, notes);
    }
  }
}

}  // namespace ergotic::physics
