// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/free_slices.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/certificate/attached_cases.hpp"
#include "physics/certificate/hand_slopes.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "physics/interpolation.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
/// Nonlinear links are judged at slopes between what always holds and their steepest: the part (0
/// to 1) of that range at slices and elsewhere, and whether contacts are closed.
struct FreeSlices::Parts {
  double of_slices = 0.0;
  double of_others = 0.0;
  bool closes = false;
  bool are_fine = false;  ///< left out where much is attached
  bool areNone() const { return of_slices == 0.0 && of_others == 0.0; }
  /// There are few of the first cases and many others.
  int mostMasses() const { return areNone() ? 100 : 50; }
  bool areEnds() const { return of_slices == 0.0 || of_slices == 1.0; }
};

namespace {

using Parts = FreeSlices::Parts;
using scene::MatType;

// What is attached to a link is worst where it answers about a quarter of a period late: with 0.08
// kg a factor of 1.2 beside that it grows by 2 % a second less.
constexpr double kFineness = 1.4142135623730951;
constexpr double kMinPart = 0.0625;
constexpr int kFineMasses = 30;  // of more only every fourth, a factor of 4

std::vector<Parts> allParts() {
  std::vector<Parts> parts{{0.0, 0.0}};
  double part = kMinPart;
  for (int i = 0; part < 0.99; ++i, part *= kFineness) {
    parts.push_back({part, 0.0, false, i % 4 != 0});
  }
  for (const Parts& end : {Parts{1.0, 0.0}, Parts{0.0, 1.0}, Parts{1.0, 1.0}, Parts{0.0, 1.0, true},
                           Parts{1.0, 1.0, true}}) {
    parts.push_back(end);
  }
  return parts;
}

constexpr double kGrows = 1.0 + 1e-6;  // per tick

bool isBent(const scene::Lia& lia) {
  return lia.type != scene::LiaType::kSpringDamper;
}

bool isAt(const Hands& hands, const scene::Lia& lia) {
  return hands[at(lia.a)] != 0 || hands[at(lia.b)] != 0;
}

bool isContact(const scene::Lia& lia) {
  return scene::lawOf(lia.type).kind == scene::Law::Kind::kGap;
}

/// Energy-stable links of every module. [mats]
std::vector<int> energyStableLinksOn(const scene::Scene& scene) {
  std::vector<int> stable_links(scene.mats.size(), 0);
  for (const scene::Lia& lia : scene.lias) {
    if (lia.scheme == scene::Scheme::kEnergyStable) {
      ++stable_links[at(lia.a)];
      ++stable_links[at(lia.b)];
    }
  }
  return stable_links;
}

/// A link that is not linear as the spring and damper that it is around some place: what always
/// holds, and a part of what more it can be. Energy-stable, it moves its ends about as one whose
/// force is the mean over the steps on both sides does; springs only where they are stiff for a
/// step. \param stable_links  energy-stable ones that share a module of the link
void makeLinear(scene::Lia& lia,
                const RatedNetwork& networks,
                const scene::Scene& now,
                double part,
                int stable_links) {
  const scene::Law& law = scene::lawOf(lia.type);
  const Slopes steepest = slopesInHand(now, lia);
  const double stiffness = law.has_linear_part ? now.valueOf(lia.stiffness) : 0.0;
  const double damping = law.has_linear_part ? now.valueOf(lia.damping) : 0.0;
  const double k = stiffness + part * (steepest.stiffness.highest - stiffness);
  const bool is_unforeseen = !networks.isExplicit(lia) && networks.crossesRates(lia) &&
                             !isInterpolated(now, networks.rates(), lia);
  const double z = (is_unforeseen ? 0.5 : 1.0) *  // of the steps of an end that seems to stay
                   (damping + part * (steepest.damping.highest - damping));
  const double load = networks.inverseMassStep2(lia) * k + 2.0 * networks.inverseMassStep(lia) * z;
  const double mean =
      networks.isExplicit(lia) ? 1.0 : 1.0 + 0.25 * stable_links * std::max(load, 0.0);
  const bool is_mean = isContact(lia) || stable_links * load > 1.0;
  lia.type = scene::LiaType::kSpringDamper;
  lia.scheme = scene::Scheme::kExplicit;
  lia.stiffness = {is_mean ? k / mean : k};
  lia.damping = {z / mean};
}

/// A scene with its links at parts of what they can be. Links without a force are left out.
scene::Scene linearAround(const Hands& hands,
                          const RatedNetwork& networks,
                          scene::Scene now,
                          const Parts& parts) {
  const std::vector<int> stable_links = energyStableLinksOn(now);
  std::vector<scene::Lia> lias;
  for (scene::Lia lia : now.lias) {
    if (!hasLinearPart(lia) || isBent(lia)) {
      const double of_others = parts.closes || !isContact(lia) ? parts.of_others : 0.0;
      makeLinear(lia, networks, now, isAt(hands, lia) ? parts.of_slices : of_others,
                 std::max(stable_links[at(lia.a)], stable_links[at(lia.b)]));
    }
    if (now.valueOf(lia.stiffness) != 0.0 || now.valueOf(lia.damping) != 0.0) {
      lias.push_back(std::move(lia));
    }
  }
  now.lias = std::move(lias);
  return now;
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
      if (mat.coupling == scene::Coupling::kSmooth) {
        numbers.push_back({slots + slot});  // and how far it had gone to there
      }
    }
  }
  for (int number = 3 * slots; number < stepper.numbers(); ++number) {
    numbers.push_back({number, 1.0 / (rates.gesturalHz() * rates.gesturalHz())});  // of 1 kg
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

/// True if that is something else than what always holds: of links that move with it.
bool bends(const scene::Scene& scene, const Attached& attached, const Parts& parts) {
  const Hands hands = handsOn(scene, attached.slices);
  const auto isIn = [&](int node) { return attached.nodes.count(node) != 0; };
  const auto has = [&](bool at_slices) {
    return std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
      return isBent(lia) && (isIn(lia.a) || isIn(lia.b)) && isAt(hands, lia) == at_slices &&
             (at_slices || isContact(lia) == parts.closes);
    });
  };
  return (parts.of_slices == 0.0 || has(true)) && (parts.of_others == 0.0 || has(false));
}

/// True if that is attached there only by links that may open, or snap out.
bool mayLetGo(const scene::Scene& scene, int slice, const Parts& parts) {
  return !parts.areNone() &&
         std::none_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
           return (lia.a == slice || lia.b == slice) && lia.type == scene::LiaType::kTable;
         });
}

bool hasGuards(const scene::Scene& scene, const Attached& attached) {
  return std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return lia.scheme == scene::Scheme::kEnergyStable &&
           (attached.nodes.count(lia.a) != 0 || attached.nodes.count(lia.b) != 0);
  });
}

}  // namespace

FreeSlices::FreeSlices(const RatedNetwork& networks)
    : networks_(networks),
      tick_s_(1.0 / networks.rates().gesturalHz()),
      left_out_(networks.scene().mats.size(), nullptr) {
  const Network network(networks.scene());
  const std::vector<int> slices = slicesInHands(networks.scene());
  std::set<int> known;
  for (const int slice : slices) {
    if (known.count(slice) == 0) {
      const Attached body = bodyOn(slice, network, handsOn(networks.scene(), slices));
      known.insert(body.slices.begin(), body.slices.end());
      addBody(body);
    }
  }
}

void FreeSlices::addBody(const Attached& body) {
  if (const char* const reason = notTold(body, networks_.network())) {
    for (const int slice : body.slices) {
      left_out_[at(slice)] = reason;
    }
    return;
  }
  const std::vector<scene::Scene> cases = casesOf(body, networks_);
  const std::vector<scene::Lia>& lias = cases.front().lias;
  const bool is_bent = std::any_of(lias.begin(), lias.end(), isBent);
  for (const Parts& parts : allParts()) {
    const std::size_t count =
        parts.areEnds() ? cases.size() : 1;  // between them, the present values will do
    for (std::size_t i = 0; i < (is_bent || parts.areNone() ? count : 0); ++i) {
      addAll(body.slices, cases[i], parts);
    }
  }
}

/// \param slices  of one body, which need not are joined in this case
void FreeSlices::addAll(const std::vector<int>& slices,
                        const scene::Scene& now,
                        const Parts& parts) {
  const Hands all = handsOn(now, slices);
  const scene::Scene joined = linearAround(all, networks_, now, parts);
  const Network network(joined);
  std::set<int> known;
  for (const int slice : slices) {
    add(joined, attachedTo(slice, network, handsOn(now, {slice}), parts.mostMasses()), parts);
    if (known.count(slice) == 0) {
      const Attached together = attachedTo(slice, network, all, parts.mostMasses());
      known.insert(together.slices.begin(), together.slices.end());
      if (together.slices.size() > 1) {
        add(joined, together, parts);
      }
    }
  }
}

void FreeSlices::add(const scene::Scene& joined, const Attached& attached, const Parts& parts) {
  if (attached.masses == 0 || (parts.are_fine && attached.masses > kFineMasses) ||
      !bends(networks_.scene(), attached, parts)) {
    return;
  }
  const char* const reason = notWorkedOut(attached, joined, networks_.rates());
  for (const int slice : attached.slices) {
    if (reason != nullptr || (attached.is_cut && !mayLetGo(networks_.scene(), slice, parts))) {
      left_out_[at(slice)] = reason == nullptr ? "so many masses" : reason;
    }
  }
  if (reason != nullptr) {
    return;
  }
  cases_.push_back(caseOf(onlyOf(attached, linearPart(joined, attached.slices))));
  cases_.back().slices = attached.slices;
  if (!parts.closes && hasGuards(networks_.scene(), attached) &&
      heldRadius(cases_.back()) > kGrows) {
    for (const int slice : attached.slices) {
      left_out_[at(slice)] = "energy-stable links that are stiff for a step";
    }
  }
}

FreeSlices::Case FreeSlices::caseOf(const scene::Scene& linear) const {
  LinearStepper stepper(linear, networks_.rates());
  const std::vector<Number> numbers = numbersOf(stepper, linear, networks_.rates());
  const auto size = static_cast<Eigen::Index>(numbers.size());
  const auto slices = static_cast<Eigen::Index>(linear.ports.size());
  Case one{{}, Eigen::MatrixXd(size, size + slices), Eigen::MatrixXd(slices, size + slices)};
  for (Eigen::Index j = 0; j < size + slices; ++j) {
    Eigen::VectorXd from = Eigen::VectorXd::Zero(stepper.numbers());
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

/// Spectral radius while the slices are held.
double FreeSlices::heldRadius(const Case& one) {
  return spectralRadius(one.state.leftCols(one.state.rows()));
}

/// False if it grows as much while the slices are held, as what is energy-stable may once it is
/// explicit: that tells nothing of the slices.
bool FreeSlices::isOfSlices(const Case& one, double radius) {
  return heldRadius(one) - 1.0 < 0.5 * (radius - 1.0);
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
