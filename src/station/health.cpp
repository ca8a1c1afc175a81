// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/health.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ergotic/scene/grid.hpp"

namespace ergotic::station {
namespace {

constexpr std::size_t kMaxWarnings = 5;  // links named; a generator makes many

/// Modules by their energy-stable links, which share what they may spend, and how far a force moves
/// each.
class Mobility {
 public:
  explicit Mobility(const scene::Scene& scene) : scene_(scene), links_(scene.mats.size(), 0.0) {
    for (const scene::Lia& lia : scene.lias) {
      if (lia.scheme == scene::Scheme::kEnergyStable) {
        for (const int end : {lia.a, lia.b}) {
          visit(end, 1.0, [this](std::size_t mat, double /*weight*/) { links_[mat] += 1.0; });
        }
      }
    }
  }

  /// 1/kg, as if all energy-stable links of a module pushed at once.
  double of(int end) const {
    double mobility = 0.0;
    visit(end, 1.0, [&](std::size_t mat, double weight) {
      mobility +=
          std::max(links_[mat], 1.0) * weight * weight / scene_.valueOf(scene_.mats[mat].mass);
    });
    return mobility;
  }

  /// The masses that a module is, or lies on as a point, and how much each counts.
  template <class Visit>
  void visit(int index, double weight, const Visit& seen) const {
    const auto mat = static_cast<std::size_t>(index);
    const scene::MatType type = scene_.mats[mat].type;
    if (type == scene::MatType::kMass || type == scene::MatType::kCell) {
      return seen(mat, weight);
    }
    if (type != scene::MatType::kPoint) {
      return;
    }
    for (const scene::Connection& connection : scene_.connections) {
      if (connection.mat == index) {
        const scene::GridPlace around = scene::placeOf(scene_, connection);
        for (std::size_t i = 0; i < static_cast<std::size_t>(around.count); ++i) {
          visit(around.mats[i], weight * around.weights[i], seen);
        }
      }
    }
    for (const scene::Tap& tap : scene_.taps) {
      for (std::size_t i = 0; tap.mat == index && i < tap.shares.size(); ++i) {
        visit(tap.shares[i].mat, weight * tap.shares[i].weight, seen);
      }
    }
  }

 private:
  const scene::Scene& scene_;
  std::vector<double> links_;  // [mats] that are energy-stable
};

/// Whether a point moves over a body.
bool isLed(const scene::Scene& scene, int mat) {
  return std::any_of(scene.connections.begin(), scene.connections.end(),
                     [mat](const scene::Connection& c) {
                       return c.mat == mat && (c.along.guide >= 0 || c.across.guide >= 0);
                     });
}

/// The tank whose links end on a module that this one is, or lies on; nullptr if there is none.
const scene::Tank* tankAt(const scene::Scene& scene, const Mobility& mobility, int mat) {
  const scene::Tank* found = nullptr;
  mobility.visit(mat, 1.0, [&](std::size_t module, double /*weight*/) {
    for (const scene::Lia& lia : scene.lias) {
      if (lia.tank >= 0 && (static_cast<std::size_t>(lia.a) == module ||
                            static_cast<std::size_t>(lia.b) == module)) {
        found = &scene.tanks[static_cast<std::size_t>(lia.tank)];
      }
    }
  });
  return found;
}

/// Why a link that its masses can follow gives back less than it took, and what to do.
std::string adviceOf(const scene::Scene& scene, const scene::Lia& lia) {
  const Mobility mobility(scene);
  for (const int end : {lia.a, lia.b}) {
    const scene::Tank* tank = tankAt(scene, mobility, end);
    if (tank != nullptr) {
      return "it presses on what '" + std::string(tank->name) +
             "' holds in one tank of energy, which it cannot foresee. Put a spring_damper here, "
             "and "
             "the contact between what presses and the hand";
    }
    if (isLed(scene, end)) {
      return "the point on which it presses moves over a body, which takes what it holds. Put a "
             "spring_damper here, and the contact between what presses and the hand, or move the "
             "point more slowly";
    }
  }
  return "it gives back less than it took. Lower its 'damping', raise the rate, or let fewer "
         "contacts share a module";
}

std::string warningOf(const scene::Scene& scene,
                      const physics::Rates& rates,
                      const physics::TankReport& tank) {
  const scene::Lia& lia = scene.lias[static_cast<std::size_t>(tank.lia)];
  const double stiffness = scene.valueOf(lia.stiffness);
  const bool is_linear = lia.type == scene::LiaType::kContact ||
                         lia.type == scene::LiaType::kSpringDamper;  // 'stiffness' is a slope
  const double most = mostStiffness(scene, lia, rates);
  std::ostringstream text;
  text.precision(2);
  text << scene.file << ':' << lia.place.line << ':' << lia.place.column << ": warning: link '"
       << lia.name << "': its force was cut in " << 100.0 * clippedShare(tank) << " % of "
       << tank.active << " steps so that it makes no energy";
  if (!is_linear) {
    text << ": where it is pressed most it is too steep for these masses and this rate, or its "
            "damping takes too much. Lower its 'stiffness' or 'damping', raise the rate, or let "
            "fewer contacts share a module";
  } else if (stiffness > most) {
    text << ": its 'stiffness' is " << stiffness << ", and from about " << most
         << " down these masses can follow it at this rate. Lower it, raise the rate, or let fewer "
            "contacts share a module";
  } else {
    text << ": " << adviceOf(scene, lia);
  }
  return text.str();
}

}  // namespace

double clippedShare(const physics::TankReport& tank) {
  return tank.active == 0 ? 0.0
                          : static_cast<double>(tank.clipped) / static_cast<double>(tank.active);
}

bool isCutTooOften(const physics::TankReport& tank) {
  return tank.active >= kMinActiveSteps && clippedShare(tank) > kMaxClippedShare;
}

double mostStiffness(const scene::Scene& scene,
                     const scene::Lia& lia,
                     const physics::Rates& rates) {
  const auto divisor = [&](int mat) {
    const auto& module = scene.mats[static_cast<std::size_t>(mat)];
    return physics::divisorOf(scene.sectionOf(module), rates);
  };
  const double step = std::min(divisor(lia.a), divisor(lia.b)) / rates.audio_hz / scene.time_unit_s;
  const Mobility mobility(scene);
  return 1.0 / (step * step * (mobility.of(lia.a) + mobility.of(lia.b)));
}

std::vector<std::string> tankWarnings(const scene::Scene& scene,
                                      const physics::Rates& rates,
                                      const std::vector<physics::TankReport>& tanks) {
  std::vector<physics::TankReport> cut;
  std::copy_if(tanks.begin(), tanks.end(), std::back_inserter(cut), isCutTooOften);
  std::sort(cut.begin(), cut.end(),
            [](const auto& a, const auto& b) { return clippedShare(a) > clippedShare(b); });
  std::vector<std::string> warnings;
  for (std::size_t g = 0; g < std::min(cut.size(), kMaxWarnings); ++g) {
    warnings.push_back(warningOf(scene, rates, cut[g]));
  }
  if (cut.size() > kMaxWarnings) {
    warnings.push_back(scene.file + ": warning: and " + std::to_string(cut.size() - kMaxWarnings) +
                       " more energy-stable links were cut as often");
  }
  return warnings;
}

double relativeResidual(const physics::Energies& energies) {
  double all = std::abs(energies.stored);
  for (const physics::SectionEnergy& section : energies.sections) {
    all += std::abs(section.dissipated);
  }
  for (const physics::CouplingEnergy& coupling : energies.couplings) {
    all += std::abs(coupling.dissipated);
  }
  return all > 0.0 ? energies.residual / all : 0.0;
}

}  // namespace ergotic::station
