// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/port_links.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "at.hpp"
#include "physics/certificate/hand_slopes.hpp"
#include "physics/interpolation.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
namespace {

constexpr double kRigidStiffness = 1e30;  // N/m, of what sticks together
constexpr int kLongestSeries = 100000;    // links in a row

template <class Value>
int largest(const std::vector<int>& links, const Value& value) {
  const auto found = std::max_element(links.begin(), links.end(),
                                      [&](int a, int b) { return value(a) < value(b); });
  return found == links.end() ? -1 : *found;
}

}  // namespace

PortLinks::PortLinks(const Network& network, const Rates& rates)
    : network_(network),
      scene_(network.scene),
      rates_(rates),
      links_of_(linksOfNodes(network)),
      is_in_hand_(scene_.mats.size(), 0),
      is_under_tap_(scene_.mats.size(), 0) {
  for (const scene::Tap& tap : scene_.taps) {
    for (const scene::Tap::Share& share : tap.shares) {
      is_under_tap_[at(share.mat)] = 1;
    }
  }
  for (const scene::Port& port : scene_.ports) {
    if (port.agent < 0) {
      is_in_hand_[at(port.mat)] = 1;
    }
  }
}

double PortLinks::stiffness(const scene::Port& port) const {
  double sum = 0.0;
  for (const int l : linksOf(port)) {
    sum += along(port, l);
  }
  if (port.filter < 0 || sum == 0.0) {
    return sum;
  }
  // What is faster than the filter its own damper brings to rest.
  return 1.0 / (1.0 / sum + 1.0 / atSlice(port).stiffness);
}

/// Modules behind a filter reach the slice by the filter's link alone.
double PortLinks::interpolatedStiffness(const scene::Port& port) const {
  const std::vector<int>& own = links_of_[at(port.mat)];
  if (port.filter >= 0) {
    return std::any_of(own.begin(), own.end(), [&](int l) { return isInterpolated(l); })
               ? stiffness(port)
               : 0.0;
  }
  double sum = 0.0;
  for (const int l : own) {
    sum += isInterpolated(l) ? along(port, l) : 0.0;
  }
  return sum;
}

int PortLinks::stiffest(const scene::Port& port) const {
  return largest(linksOf(port), [&](int l) { return along(port, l); });
}

int PortLinks::mostDamped(const scene::Port& port) const {
  return largest(links_of_[at(port.mat)], [&](int l) { return dampingAt(port, l); });
}

double PortLinks::damping(const scene::Port& port) const {
  double sum = 0.0;
  for (const int l : links_of_[at(port.mat)]) {
    sum += dampingAt(port, l);
  }
  return sum;
}

double PortLinks::interpolatedDamping(const scene::Port& port) const {
  double sum = 0.0;
  for (const int l : links_of_[at(port.mat)]) {
    sum += isInterpolated(l) ? dampingAt(port, l) : 0.0;
  }
  return sum;
}

bool PortLinks::isInterpolated(int l) const {
  return physics::isInterpolated(scene_, rates_, scene_.lias[at(l)]);
}

int PortLinks::driving(const scene::Port& port) const {
  const auto drives = [this](int l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const Slopes& slopes = link(l).slopes;
    return !isHeldBack(l) && (slopes.stiffness.lowest < 0.0 || slopes.damping.lowest < 0.0 ||
                              scene::rangeOf(scene_, lia.law->nonlinearity).lowest < 0.0);
  };
  const std::vector<int>& links = links_of_[at(port.mat)];
  const auto found = std::find_if(links.begin(), links.end(), drives);
  return found == links.end() ? -1 : *found;
}

/// A tank has an effect only if forces move at least one end of the link.
bool PortLinks::isHeldBack(int l) const {
  const auto moves = [this](int mat) {
    return network_.nodes[at(mat)].is_free || network_.point_of[at(mat)] >= 0;
  };
  return scene_.lias[at(l)].scheme == scene::Scheme::kEnergyStable &&
         (moves(link(l).a) || moves(link(l).b));
}

PortLinks::Resistance PortLinks::atSlice(const scene::Port& port) const {
  return sum(port, port.mat, links_of_[at(port.mat)]);
}

PortLinks::Resistance PortLinks::heldAtSlice(const scene::Port& port) const {
  return sum(port, port.mat, ownLinks(port, false));
}

PortLinks::Resistance PortLinks::interpolatedAtSlice(const scene::Port& port) const {
  return sum(port, port.mat, ownLinks(port, true));
}

std::vector<int> PortLinks::ownLinks(const scene::Port& port, bool interpolated) const {
  std::vector<int> links;
  const std::vector<int>& all = links_of_[at(port.mat)];
  std::copy_if(all.begin(), all.end(), std::back_inserter(links),
               [&](int l) { return isInterpolated(l) == interpolated; });
  return links;
}

PortLinks::Resistance PortLinks::behindFilter(const scene::Port& port) const {
  return sum(port, port.filter, linksOf(port));
}

bool PortLinks::isAttached(const scene::Port& port, int l) const {
  return otherEnd(l, port.filter) == port.mat;
}

std::vector<int> PortLinks::linksOf(const scene::Port& port) const {
  if (port.filter < 0) {
    return links_of_[at(port.mat)];
  }
  std::vector<int> links;
  const std::vector<int>& all = links_of_[at(port.filter)];
  std::copy_if(all.begin(), all.end(), std::back_inserter(links),
               [&](int l) { return !isAttached(port, l); });
  return links;
}

/// If a link acts in a frame with fewer coordinates than the module has, the module's axes are
/// projected onto it; otherwise its line may lie along any of them.
double PortLinks::share(const scene::Port& port, int mat, int l) const {
  return share(port, port, mat, l);
}

/// Share of a link's force along the axis of `port` per motion along the axis of `moved`.
double PortLinks::share(const scene::Port& port, const scene::Port& moved, int mat, int l) const {
  const scene::Section& from = scene_.sectionOf(scene_.mats[at(mat)]);
  const scene::Section& to = scene_.sectionOf(scene_.mats[at(otherEnd(l, mat))]);
  if (to.geometry >= from.geometry) {
    return port.axis == moved.axis ? 1.0 : 0.0;
  }
  const Eigen::Matrix3d seen = to.pose.linear().transpose() * from.pose.linear();
  const auto count = dimensionsOf(to.geometry);
  return seen.col(port.axis).head(count).dot(seen.col(moved.axis).head(count));
}

/// Hands that move the axes of a module together feel more than one axis alone: the sum over a row
/// bounds what any of them feels.
double PortLinks::shareTogether(const scene::Port& port, int mat, int l) const {
  double sum = 0.0;
  for (const scene::Port& moved : scene_.ports) {
    if (moved.mat == port.mat && moved.agent < 0) {
      sum += std::abs(share(port, moved, mat, l));
    }
  }
  return sum;
}

/// Another hand may go the other way, and then each feels twice what it would if that were held.
double PortLinks::hands(int mat) const {
  return is_in_hand_[at(mat)] != 0 ? 2.0 : 1.0;
}

double PortLinks::along(const scene::Port& port, int l) const {
  const int mat = port.filter < 0 ? port.mat : port.filter;
  const Series all = series(mat, l);
  return shareTogether(port, mat, l) * hands(all.end) * all.stiffness;
}

double PortLinks::dampingAt(const scene::Port& port, int l) const {
  return shareTogether(port, port.mat, l) * hands(otherEnd(l, port.mat)) * damping(l);
}

double PortLinks::slope(int l) const {
  if (scene::sticks(scene_.lias[at(l)].type)) {
    return kRigidStiffness;
  }
  return std::abs(slopesInHand(scene_, scene_.lias[at(l)]).stiffness.highest);
}

double PortLinks::damping(int l) const {
  return slopesInHand(scene_, scene_.lias[at(l)]).damping.highest;
}

/// Adds up links in series through masses that nothing else holds; the module after them is held.
PortLinks::Series PortLinks::series(int from, int l) const {
  Series all{slope(l), otherEnd(l, from)};
  for (int links = 1; links < kLongestSeries && all.stiffness > 0.0; ++links) {
    const std::vector<int>& here = links_of_[at(all.end)];
    const scene::Mat& mat = scene_.mats[at(all.end)];
    if (mat.type != scene::MatType::kMass || here.size() != 2 || is_under_tap_[at(all.end)] != 0 ||
        leavesModesOut(network_, mat.section)) {  // it gives way less than it seems
      break;
    }
    const int next = here[0] == l ? here[1] : here[0];
    const int end = otherEnd(next, all.end);
    if (end == from) {
      break;  // side by side
    }
    from = all.end;
    l = next;
    all = {1.0 / (1.0 / all.stiffness + 1.0 / slope(l)), end};
  }
  return all;
}

PortLinks::Resistance PortLinks::sum(const scene::Port& port,
                                     int mat,
                                     const std::vector<int>& links) const {
  Resistance sum;
  for (const int l : links) {
    if (scene::sticks(scene_.lias[at(l)].type)) {
      continue;  // which it does up to some force only
    }
    const double part = share(port, mat, l);
    sum.stiffness += part * slope(l);
    sum.damping += part * damping(l);
  }
  return sum;
}

}  // namespace ergotic::physics
