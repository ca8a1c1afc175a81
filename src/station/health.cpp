// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/health.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace ergotic::station {
namespace {

constexpr std::size_t kMostWarnings = 5;  // links named; a generator makes many

std::string warningOf(const scene::Scene& scene, const physics::GuardReport& guard) {
  const scene::Lia& lia = scene.lias[static_cast<std::size_t>(guard.lia)];
  std::ostringstream text;
  text.precision(2);
  text << scene.file << ':' << lia.place.line << ':' << lia.place.column << ": warning: link '"
       << lia.name << "': its force was cut in " << 100.0 * clippedShare(guard) << " % of "
       << guard.active << " steps so that it makes no energy; raise the rate or soften the link";
  return text.str();
}

}  // namespace

double clippedShare(const physics::GuardReport& guard) {
  return guard.active == 0 ? 0.0
                           : static_cast<double>(guard.clipped) / static_cast<double>(guard.active);
}

std::vector<std::string> guardWarnings(const scene::Scene& scene,
                                       const std::vector<physics::GuardReport>& guards) {
  std::vector<physics::GuardReport> cut;
  std::copy_if(guards.begin(), guards.end(), std::back_inserter(cut),
               [](const physics::GuardReport& guard) {
                 return guard.active >= kMinActiveSteps && clippedShare(guard) > kMaxClippedShare;
               });
  std::sort(cut.begin(), cut.end(),
            [](const auto& a, const auto& b) { return clippedShare(a) > clippedShare(b); });
  std::vector<std::string> warnings;
  for (std::size_t g = 0; g < std::min(cut.size(), kMostWarnings); ++g) {
    warnings.push_back(warningOf(scene, cut[g]));
  }
  if (cut.size() > kMostWarnings) {
    warnings.push_back(scene.file + ": warning: and " + std::to_string(cut.size() - kMostWarnings) +
                       " more guarded links were cut as often");
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
