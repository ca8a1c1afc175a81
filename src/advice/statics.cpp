// SPDX-License-Identifier: BSD-3-Clause
#include "advice/statics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/network/section_stiffness.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::MatType;

constexpr double kMinPivot = 1e-13;  // of the largest: what is less is a motion left open
constexpr double kRounding = 1e-12;

/// Displacement from rest by a hand or an agent at the start, m.
double placeOfHand(const scene::Scene& scene, const scene::Port& port) {
  const double hand = port.agent >= 0 ? scene.agents[at(port.agent)].at(0.0) : 0.0;
  return (hand - port.offset) / port.position_scale;
}

}  // namespace

Statics::Statics(const Network& network)
    : network_(network), scene_(network.scene), sets_(network.nodes.size()) {
  addSprings();
}

/// All modules under a point with their weights, also those that nothing moves.
Shares Statics::sharesOf(int mat) const {
  const int point = network_.point_of[at(mat)];
  if (point < 0) {
    return {{mat, 1.0}};
  }
  Shares shares;
  const int connections = static_cast<int>(scene_.connections.size());
  if (point < connections) {
    const scene::GridPlace place = scene::placeOf(scene_, scene_.connections[at(point)]);
    for (std::size_t i = 0; i < at(place.count); ++i) {
      shares.push_back({place.mats[i], place.weights[i]});
    }
  } else {
    for (const scene::Tap::Share& share : scene_.taps[at(point - connections)].shares) {
      shares.push_back({share.mat, share.weight});
    }
  }
  return shares;
}

/// Position of a module at the start; a point has no start of its own.
Eigen::Vector3d Statics::startOf(int mat) const {
  const scene::Mat& module = scene_.mats[at(mat)];
  if (module.type != MatType::kSlice) {
    return module.position;
  }
  Eigen::Vector3d place = module.rest;
  for (const scene::Port& port : scene_.ports) {
    if (port.mat == mat) {
      place[port.axis] += placeOfHand(scene_, port);
    }
  }
  return place;
}

void Statics::addSprings() {
  std::vector<Spring> springs;
  for (std::size_t l = 0; l < scene_.lias.size(); ++l) {
    const scene::Lia& lia = scene_.lias[l];
    Spring spring{sharesOf(lia.a), network_.links[l].at_rest, -lia.rest_length};
    if (lia.bend >= 0 || spring.stiffness == 0.0) {
      continue;
    }
    for (const Share& share : sharesOf(lia.b)) {
      spring.ends.push_back({share.node, -share.weight});
    }
    spring.elongation += beginningOf(lia.a).x() - beginningOf(lia.b).x();
    springs.push_back(std::move(spring));
  }
  for (const scene::Bend& bend : scene_.bends) {
    Spring spring{{}, scene_.valueOf(bend.stiffness), -bend.rest_length};
    for (const scene::Bend::End& end : bend.ends) {
      spring.ends.push_back({end.mat, end.weight});
      spring.elongation += end.weight * startOf(end.mat).x();
    }
    springs.push_back(std::move(spring));
  }
  for (const Spring& spring : springs) {
    const auto first = std::find_if(spring.ends.begin(), spring.ends.end(), [this](const Share& s) {
      return network_.nodes[at(s.node)].is_free;
    });
    for (auto other = first; other != spring.ends.end(); ++other) {
      if (network_.nodes[at(other->node)].is_free) {
        sets_.join(other->node, first->node);
      }
    }
  }
  for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
    if (network_.nodes[at(m)].is_free) {
      Body& body = bodies_[sets_.setOf(m)];
      body.mats.push_back(m);
      body.is_scalar &= scene_.sectionOf(scene_.mats[at(m)]).geometry == Geometry::kScalar;
      body.is_held_by_cells |= network_.nodes[at(m)].stiffness.now != 0.0;
    }
  }
  for (Spring& spring : springs) {
    add(std::move(spring));
  }
}

void Statics::add(Spring spring) {
  const auto moved = std::find_if(spring.ends.begin(), spring.ends.end(), [this](const Share& s) {
    return network_.nodes[at(s.node)].is_free;
  });
  if (moved == spring.ends.end()) {
    return;
  }
  Body& body = bodies_[sets_.setOf(moved->node)];
  double sum = 0.0;
  for (const Share& end : spring.ends) {
    sum += end.weight;
    body.is_scalar &= scene_.sectionOf(scene_.mats[at(end.node)]).geometry == Geometry::kScalar;
    if (!network_.nodes[at(end.node)].is_free) {
      body.holders.insert(end.node);
    }
  }
  body.is_levered |= std::abs(sum) > kRounding;
  body.springs.push_back(std::move(spring));
}

int Statics::bodyOf(int mat) {
  const Shares shares = sharesNow(network_, mat);
  return shares.empty() ? -1 : sets_.setOf(shares.front().node);
}

std::vector<unsigned char> Statics::movedBy(const scene::Port& port) {
  std::vector<unsigned char> moved(scene_.mats.size(), 0);
  moved[at(port.mat)] = 1;
  for (const auto& [name, body] : bodies_) {
    if (body.holders.count(port.mat) > 0) {
      for (const int mat : body.mats) {
        moved[at(mat)] = 1;
      }
    }
  }
  for (int m = 0; m < static_cast<int>(moved.size()); ++m) {
    if (network_.point_of[at(m)] >= 0) {
      const Shares shares = sharesNow(network_, m);
      moved[at(m)] = std::any_of(shares.begin(), shares.end(),
                                 [&moved](const Share& s) { return moved[at(s.node)] != 0; });
    }
  }
  return moved;
}

std::size_t Statics::placeIn(const Body& body, int mat) {
  return static_cast<std::size_t>(std::lower_bound(body.mats.begin(), body.mats.end(), mat) -
                                  body.mats.begin());
}

/// Solves for the displacements of modules by forces on them; false if they are not held.
bool Statics::solve(const Body& body, std::vector<double>& pushed) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < body.mats.size(); ++i) {
    entries.emplace_back(i, i, network_.nodes[at(body.mats[i])].stiffness.now);
  }
  for (const Spring& spring : body.springs) {
    for (const Share& a : spring.ends) {
      for (const Share& b : spring.ends) {
        if (network_.nodes[at(a.node)].is_free && network_.nodes[at(b.node)].is_free) {
          entries.emplace_back(placeIn(body, a.node), placeIn(body, b.node),
                               spring.stiffness * a.weight * b.weight);
        }
      }
    }
  }
  const auto rows = static_cast<Eigen::Index>(body.mats.size());
  Eigen::SparseMatrix<double> stiffness(rows, rows);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(stiffness);
  if (factors.info() != Eigen::Success) {
    return false;
  }
  const Eigen::ArrayXd pivots = factors.vectorD().array().abs();
  if (!(pivots.minCoeff() > kMinPivot * pivots.maxCoeff())) {
    return false;
  }
  Eigen::Map<Eigen::VectorXd> forces(pushed.data(), rows);
  forces = factors.solve(forces).eval();
  return true;
}

const std::vector<double>& Statics::offsetsOf(Body& body) {
  if (body.is_settled) {
    return body.offsets;
  }
  body.is_settled = true;
  body.offsets.assign(body.mats.size(), 0.0);
  if (!body.is_scalar || (body.holders.empty() && !body.is_held_by_cells)) {
    return body.offsets;
  }
  std::map<int, double> force;
  for (const int mat : body.mats) {
    const scene::Mat& module = scene_.mats[at(mat)];
    const Network::Node& node = network_.nodes[at(mat)];
    force[mat] = node.mass.now * scene_.sectionOf(module).gravity.x() + module.push->force.x() -
                 node.stiffness.now * module.position.x();
  }
  for (const Spring& spring : body.springs) {
    for (const Share& end : spring.ends) {
      if (network_.nodes[at(end.node)].is_free) {
        force[end.node] -= spring.stiffness * end.weight * spring.elongation;
      }
    }
  }
  std::vector<double> offsets;
  for (const int mat : body.mats) {
    offsets.push_back(force[mat]);
  }
  const bool is_pushed =
      std::any_of(offsets.begin(), offsets.end(), [](double f) { return f != 0.0; });
  if (is_pushed && solve(body, offsets)) {
    body.offsets = std::move(offsets);
  }
  return body.offsets;
}

/// Position of a module or point, by the positions of modules.
template <class Places>
Eigen::Vector3d Statics::placeBy(int mat, const Places& place_of_module) const {
  const int point = network_.point_of[at(mat)];
  if (point < 0) {
    return place_of_module(mat);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const int connections = static_cast<int>(scene_.connections.size());
  if (point < connections) {
    for (const Share& share : sharesOf(mat)) {
      sum += share.weight * place_of_module(share.node);
    }
    return sum;
  }
  for (const Share& share : sharesOf(mat)) {
    sum += share.weight * (place_of_module(share.node) - scene_.mats[at(share.node)].rest);
  }
  sum.x() += scene_.taps[at(point - connections)].offset;
  return sum + scene_.mats[at(mat)].rest;
}

Eigen::Vector3d Statics::beginningOf(int mat) const {
  return placeBy(mat, [this](int module) { return startOf(module); });
}

Eigen::Vector3d Statics::placeOf(int mat) {
  return placeBy(mat, [this](int module) -> Eigen::Vector3d {
    const int name = bodyOf(module);
    if (name < 0) {
      return startOf(module);
    }
    Body& body = bodies_.at(name);
    return startOf(module) + offsetsOf(body)[placeIn(body, module)] * Eigen::Vector3d::UnitX();
  });
}

/// Displacement of the slice of a port per metre of the hand, as another section sees it.
Eigen::Vector3d Statics::wayOfSlice(const scene::Port& port,
                                    const scene::Section& seen_from) const {
  Eigen::Vector3d way = Eigen::Vector3d::Unit(port.axis) / port.position_scale;
  const scene::Section& own = scene_.sectionOf(scene_.mats[at(port.mat)]);
  if (&own == &seen_from || own.geometry == Geometry::kScalar) {
    return way;
  }
  return movingPart(seen_from.pose.linear().transpose() * (own.pose.linear() * way),
                    seen_from.geometry);
}

bool Statics::followsAlone(const Body& body, int slice) const {
  if (body.is_levered || body.is_held_by_cells || body.holders != std::set<int>{slice}) {
    return false;
  }
  const Geometry geometry = scene_.sectionOf(scene_.mats[at(slice)]).geometry;
  return std::all_of(body.mats.begin(), body.mats.end(), [&](int mat) {
    return scene_.sectionOf(scene_.mats[at(mat)]).geometry == geometry;
  });
}

/// \pre the body hangs on the slice, but not alone
const std::vector<double>& Statics::waysOf(int name, const scene::Port& port) {
  const auto [known, is_new] = ways_.try_emplace({name, &port});
  std::vector<double>& ways = known->second;
  if (!is_new) {
    return ways;
  }
  const Body& body = bodies_.at(name);
  std::map<int, double> force;
  for (const Spring& spring : body.springs) {
    double drawn = 0.0;
    for (const Share& end : spring.ends) {
      drawn += end.node == port.mat ? end.weight / port.position_scale : 0.0;
    }
    for (const Share& end : spring.ends) {
      force[end.node] -= spring.stiffness * end.weight * drawn;
    }
  }
  for (const int mat : body.mats) {
    ways.push_back(force[mat]);
  }
  if (!body.is_scalar || !solve(body, ways)) {
    untold_.insert(name);
    ways.assign(body.mats.size(), 0.0);
  }
  return ways;
}

Eigen::Vector3d Statics::wayOf(int mat, const scene::Port& port) {
  if (mat == port.mat) {
    return wayOfSlice(port, scene_.sectionOf(scene_.mats[at(mat)]));
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  if (network_.point_of[at(mat)] >= 0) {
    for (const Share& share : sharesOf(mat)) {
      sum += share.weight * wayOf(share.node, port);
    }
    return sum;
  }
  const int name = bodyOf(mat);
  if (name < 0 || bodies_.at(name).holders.count(port.mat) == 0) {
    return sum;
  }
  const Body& body = bodies_.at(name);
  if (followsAlone(body, port.mat)) {
    return wayOfSlice(port, scene_.sectionOf(scene_.mats[at(mat)]));
  }
  sum.x() = waysOf(name, port)[placeIn(body, mat)];
  return sum;
}

double Statics::among(int body, const std::vector<double>& ways, int mat) {
  double way = 0.0;
  for (const Share& share : sharesNow(network_, mat)) {
    if (sets_.setOf(share.node) == body) {
      way += share.weight * ways[placeIn(bodies_.at(body), share.node)];
    }
  }
  return way;
}

/// [mats] of its body, m for 1 N on it; empty where that is not known.
std::vector<double> Statics::yieldOf(int mat) {
  const int name = bodyOf(mat);
  const Body& body = bodies_.at(name);
  std::vector<double> ways(body.mats.size(), 0.0);
  for (const Share& share : sharesNow(network_, mat)) {
    ways[placeIn(body, share.node)] += share.weight;
  }
  return solve(body, ways) ? ways : std::vector<double>{};
}

std::vector<double> Statics::pushedWays(int thing,
                                        int by,
                                        const scene::Port& port,
                                        double softness) {
  const int name = bodyOf(thing);
  if (name < 0 || !bodies_.at(name).is_scalar || name == bodyOf(by)) {
    return {};
  }
  const Body& body = bodies_.at(name);
  const double way = wayOf(by, port).x();
  if (body.holders.empty() && !body.is_held_by_cells) {  // it goes as a whole, if it cannot turn
    return body.mats.size() == 1 && body.mats[0] == thing ? std::vector<double>{way}
                                                          : std::vector<double>{};
  }
  std::vector<double> ways = yieldOf(thing);
  double yields = softness;
  if (bodyOf(by) >= 0) {
    const std::vector<double> pusher = yieldOf(by);
    if (pusher.empty()) {
      return {};
    }
    yields += among(bodyOf(by), pusher, by);
  }
  if (!ways.empty()) {
    yields += among(name, ways, thing);
    std::for_each(ways.begin(), ways.end(), [&](double& one) { one *= way / yields; });
  }
  return ways;
}

std::vector<int> Statics::followersOf(const scene::Port& port) {
  std::vector<int> followers;
  for (const auto& [name, body] : bodies_) {
    if (followsAlone(body, port.mat)) {
      followers.insert(followers.end(), body.mats.begin(), body.mats.end());
    }
  }
  std::sort(followers.begin(), followers.end());
  return followers;
}

}  // namespace ergotic::physics
