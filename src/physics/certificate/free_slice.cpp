// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/free_slice.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "at.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "physics/certificate/port_links.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

constexpr int kMostMasses = 100;
// Of the steepest slope. Between a mass that is late by a half and by a quarter of its period, the
// worst, is a factor of 4.
constexpr double kParts[] = {0.0, 0.0625, 0.25, 1.0};

bool isFree(const scene::Mat& mat) {
  return mat.type == MatType::kMass || mat.type == MatType::kCell;
}

bool isAt(int mat, const scene::Lia& lia) {
  return lia.a == mat || lia.b == mat;
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
  const double z = damping + part * (steepest.damping.highest - damping);
  const double load = networks.inverseMassStep2(lia) * k + 2.0 * networks.inverseMassStep(lia) * z;
  const double mean = networks.isExplicit(lia) ? 1.0 : 1.0 + 0.25 * std::max(load, 0.0);
  lia.type = scene::LiaType::kSpringDamper;
  lia.scheme = scene::Scheme::kExplicit;
  lia.stiffness = {k / mean};
  lia.damping = {z / mean};
}

/// What hangs on a slice with its links at a part of what they can be, and what always holds
/// elsewhere. Links without a force are left out.
scene::Scene linearAround(int slice, const RatedNetwork& networks, scene::Scene now, double part) {
  std::vector<scene::Lia> lias;
  for (scene::Lia lia : now.lias) {
    if (!hasLinearPart(lia) || (isAt(slice, lia) && lia.type != scene::LiaType::kSpringDamper)) {
      makeLinear(lia, networks, now, isAt(slice, lia) ? part : 0.0);
    }
    if (now.valueOf(lia.stiffness) != 0.0 || now.valueOf(lia.damping) != 0.0) {
      lias.push_back(std::move(lia));
    }
  }
  now.lias = std::move(lias);
  return now;
}

/// Masses that links lead to from a slice, as far as they are to be counted: there may be a few
/// more, on strings and meshes that other points join.
int massesBehind(int slice, const Network& network) {
  const std::vector<std::vector<int>> links_of = linksOfNodes(network);
  std::set<int> seen{slice};
  std::vector<int> open{slice};
  int masses = 0;
  const auto reach = [&](int node) {
    if (seen.insert(node).second) {
      open.push_back(node);
      masses += network.nodes[at(node)].is_free ? 1 : 0;
    }
  };
  while (!open.empty() && masses <= kMostMasses) {
    const int node = open.back();
    open.pop_back();
    for (const Share& share : sharesNow(network, node)) {
      reach(share.node);
    }
    for (const int l : links_of[at(node)]) {
      const scene::Lia& lia = network.scene.lias[at(l)];
      const int other = lia.a == node ? lia.b : lia.a;
      if (network.nodes[at(other)].is_free || network.point_of[at(other)] >= 0) {
        reach(other);
      }
    }
  }
  return masses;
}

/// What moves with a slice; everything else becomes ground, and is left alone.
scene::Scene hangingOn(int slice, scene::Scene linear, const Rates& rates) {
  const Network network(linear);
  const RatedNetwork networks(network, rates);
  std::set<int> islands;
  for (const scene::Lia& lia : linear.lias) {
    if (isAt(slice, lia)) {
      islands.insert(networks.islandOf(lia));
    }
  }
  std::vector<scene::Lia> lias;
  for (const scene::Lia& lia : linear.lias) {
    if (isAt(slice, lia) || islands.count(networks.islandOf(lia)) != 0) {
      lias.push_back(lia);
    }
  }
  scene::Scene hanging = linear;
  hanging.lias = std::move(lias);
  for (std::size_t m = 0; m < linear.mats.size(); ++m) {
    if (isFree(linear.mats[m]) && islands.count(networks.islandOf(static_cast<int>(m))) == 0) {
      hanging.mats[m].type = MatType::kGround;
    }
  }
  return hanging;
}

/// With the present values of the parameters, and with both ends of their ranges.
std::vector<scene::Scene> casesOf(const scene::Scene& scene) {
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

}  // namespace

FreeSlice::FreeSlice(const RatedNetwork& networks, int p)
    : tick_s_(1.0 / networks.rates().gesturalHz()) {
  const scene::Scene& scene = networks.scene();
  const int slice = scene.ports[at(p)].mat;
  const bool is_linear = std::all_of(scene.lias.begin(), scene.lias.end(), [&](const auto& lia) {
    return !isAt(slice, lia) || lia.type == scene::LiaType::kSpringDamper;
  });
  for (const double part : kParts) {
    if (part == 0.0 || !is_linear) {
      addCases(networks, p, part);
    }
  }
}

void FreeSlice::addCases(const RatedNetwork& networks, int p, double part) {
  const Rates& rates = networks.rates();
  const scene::Port& port = networks.scene().ports[at(p)];
  for (const scene::Scene& now : casesOf(networks.scene())) {
    const scene::Scene joined = linearAround(port.mat, networks, now, part);
    const int behind = massesBehind(port.mat, Network(joined));
    if (behind > kMostMasses) {
      return;
    }
    if (behind == 0) {
      continue;
    }
    const scene::Scene linear = hangingOn(port.mat, linearPart(joined, p), rates);
    const auto masses = std::count_if(linear.mats.begin(), linear.mats.end(), isFree);
    const bool is_slower =
        std::any_of(linear.mats.begin(), linear.mats.end(), [&](const scene::Mat& mat) {
          return isFree(mat) && divisorOf(linear.sectionOf(mat), rates) > rates.ratio;
        });
    if (masses <= kMostMasses && !is_slower) {
      cases_.push_back(caseOf(linear, rates, std::abs(port.force_scale / port.position_scale)));
    }
  }
}

FreeSlice::Case FreeSlice::caseOf(const scene::Scene& linear,
                                  const Rates& rates,
                                  double gain) const {
  LinearStepper stepper(linear, rates);
  const std::vector<Number> numbers = numbersOf(stepper, linear, rates);
  const auto size = static_cast<Eigen::Index>(numbers.size());
  Case one{Eigen::MatrixXd(size, size + 1), Eigen::RowVectorXd(size + 1)};
  for (Eigen::Index j = 0; j <= size; ++j) {
    Eigen::VectorXd from = Eigen::VectorXd::Zero(3 * stepper.slots());
    if (j < size) {
      from[numbers[static_cast<std::size_t>(j)].index] =
          1.0 / numbers[static_cast<std::size_t>(j)].length;
    }
    const Eigen::VectorXd to = stepper.step(from, j < size ? 0.0 : 1.0);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Number& number = numbers[static_cast<std::size_t>(i)];
      one.state(i, j) = to[number.index] * number.length;
    }
    one.force[j] = gain * stepper.force();
  }
  return one;
}

double FreeSlice::radius(const DeviceTraits& device) const {
  double worst = 1.0;
  for (const Case& one : cases_) {
    const double radius = this->radius(one, device);
    if (radius > worst && isOfSlice(one, radius)) {
      worst = radius;
    }
  }
  return worst;
}

/// False if it grows as much while the slice is held, as what is guarded may once it is explicit:
/// that tells nothing of the slice.
bool FreeSlice::isOfSlice(const Case& one, double radius) {
  return spectralRadius(one.state.leftCols(one.state.rows())) - 1.0 < 0.5 * (radius - 1.0);
}

/// A tick of (masses and last position; position and step of the slice; forces on their way), the
/// slice moved exactly by the force that is held, all of them as lengths.
double FreeSlice::radius(const Case& one, const DeviceTraits& device) const {
  const double decay = std::exp(-device.damping / device.mass * tick_s_);
  const double glide =
      device.mass / device.damping * (1.0 - decay);  // of a unit of speed in a tick
  const auto late = static_cast<Eigen::Index>(std::ceil(device.delay_ticks));
  const Eigen::Index size = one.state.rows();
  const Eigen::Index place = size;
  const Eigen::Index forces = size + 2;
  Eigen::MatrixXd tick = Eigen::MatrixXd::Zero(forces + late, forces + late);
  tick.topLeftCorner(size, size + 1) = one.state;
  Eigen::RowVectorXd answer = Eigen::RowVectorXd::Zero(tick.cols());
  answer.head(size + 1) = one.force * (tick_s_ * tick_s_ / device.mass);
  const Eigen::RowVectorXd acting =
      late == 0 ? answer : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(tick.cols(), forces));
  const double moved = device.mass * (tick_s_ - glide) / (device.damping * tick_s_ * tick_s_);
  tick(place, place) = 1.0;
  tick(place, place + 1) = glide / tick_s_;
  tick.row(place) += moved * acting;
  tick(place + 1, place + 1) = decay;
  tick.row(place + 1) += glide / tick_s_ * acting;
  for (Eigen::Index i = 0; i + 1 < late; ++i) {
    tick(forces + i, forces + i + 1) = 1.0;
  }
  if (late > 0) {
    tick.bottomRows(1) = answer;
  }
  return spectralRadius(tick);
}

}  // namespace ergotic::physics
