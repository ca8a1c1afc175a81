// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/free_slices.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "at.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "physics/certificate/port_links.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
/// What links join to a slice: modules that move, points, and the slices among them.
struct FreeSlices::Group {
  std::set<int> nodes;
  std::vector<int> slices;
  int masses = 0;  // no more than one too many are counted
};

namespace {

using scene::MatType;

constexpr int kMostMasses = 100;
// Of the steepest slope. Between a mass that is late by a half and by a quarter of its period, the
// worst, is a factor of 4.
constexpr double kParts[] = {0.0, 0.0625, 0.25, 1.0};

bool isFree(const scene::Mat& mat) {
  return mat.type == MatType::kMass || mat.type == MatType::kCell;
}

/// [mats] that hands move and let go.
using Hands = std::vector<unsigned char>;

bool isAt(const Hands& hands, const scene::Lia& lia) {
  return hands[at(lia.a)] != 0 || hands[at(lia.b)] != 0;
}

/// A link that is not linear as the spring and damper that it is around some place: what always
/// holds, and a part of what more it can be. Guarded, it moves its ends about as one whose force is
/// the mean over the steps on both sides does.
void makeLinear(scene::Lia& lia,
                const RatedNetwork& networks,
                const scene::Scene& now,
                double part) {
  const scene::Law& law = scene::lawOf(lia.type);
  const Slopes steepest = slopesAt(now, lia, kHandDepth);
  const double stiffness = law.has_linear_part ? now.valueOf(lia.stiffness) : 0.0;
  const double damping = law.has_linear_part ? now.valueOf(lia.damping) : 0.0;
  const double k = stiffness + part * (steepest.stiffness.highest - stiffness);
  const bool is_unforeseen = !networks.isExplicit(lia) && networks.crossesRates(lia);
  const double z = (is_unforeseen ? 0.5 : 1.0) *  // of the steps of an end that seems to stay
                   (damping + part * (steepest.damping.highest - damping));
  const double load = networks.inverseMassStep2(lia) * k + 2.0 * networks.inverseMassStep(lia) * z;
  const double mean = networks.isExplicit(lia) ? 1.0 : 1.0 + 0.25 * std::max(load, 0.0);
  lia.type = scene::LiaType::kSpringDamper;
  lia.scheme = scene::Scheme::kExplicit;
  lia.stiffness = {k / mean};
  lia.damping = {z / mean};
}

/// A scene with the links of slices at a part of what they can be, and what always holds elsewhere.
/// Links without a force are left out.
scene::Scene linearAround(const Hands& hands,
                          const RatedNetwork& networks,
                          scene::Scene now,
                          double part) {
  std::vector<scene::Lia> lias;
  for (scene::Lia lia : now.lias) {
    const bool is_at_slice = isAt(hands, lia);
    if (!hasLinearPart(lia) || (is_at_slice && lia.type != scene::LiaType::kSpringDamper)) {
      makeLinear(lia, networks, now, is_at_slice ? part : 0.0);
    }
    if (now.valueOf(lia.stiffness) != 0.0 || now.valueOf(lia.damping) != 0.0) {
      lias.push_back(std::move(lia));
    }
  }
  now.lias = std::move(lias);
  return now;
}

FreeSlices::Group groupOf(int slice, const Network& network, const Hands& hands) {
  const std::vector<std::vector<int>> links_of = linksOfNodes(network);
  std::vector<std::vector<int>> points_on(network.nodes.size());
  for (int node = 0; node < static_cast<int>(network.nodes.size()); ++node) {
    for (const Share& share : sharesNow(network, node)) {
      points_on[at(share.node)].push_back(node);
    }
  }
  FreeSlices::Group group{{slice}, {slice}, 0};
  std::vector<int> open{slice};
  const auto reach = [&](int node) {
    const bool is_slice = hands[at(node)] != 0;
    const bool is_free = network.nodes[at(node)].is_free;
    if ((is_slice || is_free || network.point_of[at(node)] >= 0) &&
        group.nodes.insert(node).second) {
      open.push_back(node);
      group.masses += is_free ? 1 : 0;
      if (is_slice) {
        group.slices.push_back(node);
      }
    }
  };
  while (!open.empty() && group.masses <= kMostMasses) {
    const int node = open.back();
    open.pop_back();
    for (const Share& share : sharesNow(network, node)) {
      reach(share.node);
    }
    for (const int point : points_on[at(node)]) {
      reach(point);
    }
    for (const int l : links_of[at(node)]) {
      reach(network.links[at(l)].a);
      reach(network.links[at(l)].b);
    }
  }
  return group;
}

/// A group by itself: everything else becomes ground, and is left alone.
scene::Scene onlyOf(const FreeSlices::Group& group, scene::Scene linear) {
  const auto isIn = [&](int node) { return group.nodes.count(node) != 0; };
  linear.lias.erase(
      std::remove_if(linear.lias.begin(), linear.lias.end(),
                     [&](const scene::Lia& lia) { return !isIn(lia.a) && !isIn(lia.b); }),
      linear.lias.end());
  for (std::size_t m = 0; m < linear.mats.size(); ++m) {
    if (isFree(linear.mats[m]) && !isIn(static_cast<int>(m))) {
      linear.mats[m].type = MatType::kGround;
    }
  }
  return linear;
}

/// Without dampers along lines that turn: what moves across them they leave alone.
scene::Scene withoutTurning(scene::Scene scene, const RatedNetwork& networks) {
  for (scene::Lia& lia : scene.lias) {
    if (networks.hasLineThatTurns(lia)) {
      lia.damping = {};
    }
  }
  return scene;
}

/// With the present values of the parameters, and with both ends of their ranges; with all dampers,
/// and without those that may do nothing.
std::vector<scene::Scene> casesOf(const RatedNetwork& networks) {
  const scene::Scene& scene = networks.scene();
  std::vector<scene::Scene> cases{scene};
  for (double scene::Parameter::*end : {&scene::Parameter::minimum, &scene::Parameter::maximum}) {
    scene::Scene other = scene;
    for (scene::Parameter& parameter : other.parameters) {
      parameter.value = parameter.*end;
    }
    if (!scene.parameters.empty()) {
      cases.push_back(std::move(other));
    }
  }
  const std::size_t count = cases.size();
  const bool turns = std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return networks.hasLineThatTurns(lia) && scene::largest(scene, lia.damping) > 0.0;
  });
  for (std::size_t i = 0; turns && i < count; ++i) {
    cases.push_back(withoutTurning(cases[i], networks));
  }
  return cases;
}

/// A number of the state, and by what it is multiplied to be about the length that it moves by.
struct Number {
  int index = 0;
  double length = 1.0;
};

std::vector<Number> numbersOf(const LinearStepper& stepper,
                              const scene::Scene& linear,
                              const Rates& rates) {
  const int slots = stepper.slots();
  std::vector<Number> numbers;
  for (int slot = 0; slot < slots; ++slot) {
    const int module = stepper.moduleOf(slot);
    if (module < 0) {
      continue;
    }
    const scene::Mat& mat = linear.mats[at(module)];
    if (isFree(mat)) {
      const StepUnits units(linear, rates, divisorOf(linear.sectionOf(mat), rates));
      numbers.push_back({slot});
      numbers.push_back({slots + slot});
      numbers.push_back({2 * slots + slot, units.inverseMass(linear.valueOf(mat.mass))});
    } else if (mat.type == MatType::kSlice) {
      numbers.push_back({slot});  // where it was last
    }
  }
  return numbers;
}

/// The largest of what a metre at the device makes of a slice's forces there.
double gainOf(const scene::Scene& scene, int slice) {
  double gain = 0.0;
  for (const scene::Port& port : scene.ports) {
    if (port.mat == slice && port.agent < 0) {
      gain = std::max(gain, std::abs(port.force_scale / port.position_scale));
    }
  }
  return gain;
}

bool isSlower(const scene::Scene& linear, const Rates& rates) {
  return std::any_of(linear.mats.begin(), linear.mats.end(), [&](const scene::Mat& mat) {
    return isFree(mat) && divisorOf(linear.sectionOf(mat), rates) > rates.ratio;
  });
}

Hands handsOn(const scene::Scene& scene, const std::vector<int>& slices) {
  Hands hands(scene.mats.size(), 0);
  for (const int slice : slices) {
    hands[at(slice)] = 1;
  }
  return hands;
}

std::vector<int> slicesInHands(const scene::Scene& scene) {
  std::set<int> slices;
  for (const scene::Port& port : scene.ports) {
    if (port.agent < 0) {
      slices.insert(port.mat);
    }
  }
  return {slices.begin(), slices.end()};
}

/// True if a link of one of them is not linear.
bool bends(const scene::Scene& scene, const std::vector<int>& slices) {
  const Hands hands = handsOn(scene, slices);
  return std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return isAt(hands, lia) && lia.type != scene::LiaType::kSpringDamper;
  });
}

}  // namespace

FreeSlices::FreeSlices(const RatedNetwork& networks)
    : networks_(networks), tick_s_(1.0 / networks.rates().gesturalHz()) {
  const scene::Scene& scene = networks.scene();
  const bool is_bent = bends(scene, slicesInHands(scene));
  const std::vector<scene::Scene> cases = casesOf(networks);
  for (const double part : kParts) {
    if (part == 0.0 || is_bent) {
      const bool is_end = part == 0.0 || part == 1.0;  // between them, present values will do
      for (std::size_t i = 0; i < (is_end ? cases.size() : 1); ++i) {
        addGroups(cases[i], part);
      }
    }
  }
}

void FreeSlices::addGroups(const scene::Scene& now, double part) {
  const std::vector<int> slices = slicesInHands(now);
  const Hands all = handsOn(now, slices);
  const scene::Scene joined = linearAround(all, networks_, now, part);
  const Network network(joined);
  std::set<int> known;
  for (const int slice : slices) {
    const Group alone = groupOf(slice, network, handsOn(now, {slice}));
    addCase(joined, alone, part);
    if (known.count(slice) == 0) {
      const Group group = groupOf(slice, network, all);
      known.insert(group.slices.begin(), group.slices.end());
      if (group.slices.size() > 1) {
        addCase(joined, group, part);
      }
    }
  }
}

void FreeSlices::addCase(const scene::Scene& joined, const Group& group, double part) {
  const bool is_new = part == 0.0 || bends(networks_.scene(), group.slices);
  if (group.masses == 0 || group.masses > kMostMasses || !is_new) {
    return;
  }
  const scene::Scene linear = onlyOf(group, linearPart(joined, group.slices));
  if (!isSlower(linear, networks_.rates())) {
    cases_.push_back(caseOf(linear));
    cases_.back().slices = group.slices;
  }
}

FreeSlices::Case FreeSlices::caseOf(const scene::Scene& linear) const {
  LinearStepper stepper(linear, networks_.rates());
  const std::vector<Number> numbers = numbersOf(stepper, linear, networks_.rates());
  const auto size = static_cast<Eigen::Index>(numbers.size());
  const auto slices = static_cast<Eigen::Index>(linear.ports.size());
  Case one{{}, Eigen::MatrixXd(size, size + slices), Eigen::MatrixXd(slices, size + slices)};
  for (Eigen::Index j = 0; j < size + slices; ++j) {
    Eigen::VectorXd from = Eigen::VectorXd::Zero(3 * stepper.slots());
    if (j < size) {
      from[numbers[static_cast<std::size_t>(j)].index] =
          1.0 / numbers[static_cast<std::size_t>(j)].length;
    }
    const Eigen::VectorXd to = stepper.step(from, static_cast<int>(j < size ? -1 : j - size));
    for (Eigen::Index i = 0; i < size; ++i) {
      const Number& number = numbers[static_cast<std::size_t>(i)];
      one.state(i, j) = to[number.index] * number.length;
    }
    for (Eigen::Index i = 0; i < slices; ++i) {
      const auto port = static_cast<std::size_t>(i);
      one.forces(i, j) = gainOf(networks_.scene(), linear.ports[port].mat) * stepper.forces()[port];
    }
  }
  return one;
}

std::vector<double> FreeSlices::radii(const DeviceTraits& device) const {
  std::vector<double> worst(networks_.scene().mats.size(), 1.0);
  for (const Case& one : cases_) {
    const double radius = this->radius(one, device);
    if (radius > 1.0 && isOfSlices(one, radius)) {
      for (const int slice : one.slices) {
        worst[at(slice)] = std::max(worst[at(slice)], radius);
      }
    }
  }
  return worst;
}

/// False if it grows as much while the slices are held, as what is guarded may once it is explicit:
/// that tells nothing of the slices.
bool FreeSlices::isOfSlices(const Case& one, double radius) {
  return spectralRadius(one.state.leftCols(one.state.rows())) - 1.0 < 0.5 * (radius - 1.0);
}

/// A tick of (masses and last positions; positions and steps of the slices; forces on their way),
/// the slices moved exactly by forces that are held, all of them as lengths.
double FreeSlices::radius(const Case& one, const DeviceTraits& device) const {
  const double decay = std::exp(-device.damping / device.mass * tick_s_);
  const double glide =
      device.mass / device.damping * (1.0 - decay);  // of a unit of speed in a tick
  const auto late = static_cast<Eigen::Index>(std::ceil(device.delay_ticks));
  const Eigen::Index size = one.state.rows();
  const Eigen::Index slices = one.forces.rows();
  const Eigen::Index place = size;
  const Eigen::Index forces = size + 2 * slices;
  const Eigen::Index all = forces + late * slices;
  Eigen::MatrixXd tick = Eigen::MatrixXd::Zero(all, all);
  tick.topLeftCorner(size, size + slices) = one.state;
  Eigen::MatrixXd answer = Eigen::MatrixXd::Zero(slices, all);
  answer.leftCols(size + slices) = one.forces * (tick_s_ * tick_s_ / device.mass);
  const auto unit = [&](Eigen::Index from) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::Identity(all, all).middleRows(from, slices);
  };
  const Eigen::MatrixXd acting = late == 0 ? answer : unit(forces);
  const double moved = device.mass * (tick_s_ - glide) / (device.damping * tick_s_ * tick_s_);
  tick.middleRows(place, slices) =
      unit(place) + glide / tick_s_ * unit(place + slices) + moved * acting;
  tick.middleRows(place + slices, slices) = decay * unit(place + slices) + glide / tick_s_ * acting;
  for (Eigen::Index i = 0; i + 1 < late; ++i) {
    tick.middleRows(forces + i * slices, slices) = unit(forces + (i + 1) * slices);
  }
  if (late > 0) {
    tick.bottomRows(slices) = answer;
  }
  return spectralRadius(tick);
}

}  // namespace ergotic::physics
