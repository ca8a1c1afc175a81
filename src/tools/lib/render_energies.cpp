// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/render_energies.hpp"

#include "ergotic/station/health.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

Json sectionsOf(const scene::Scene& scene, const physics::Energies& energies) {
  Json report = Json::array();
  for (std::size_t s = 0; s < energies.sections.size(); ++s) {
    const physics::SectionEnergy& energy = energies.sections[s];
    report.push_back({{"section", scene.sections[s].name},
                      {"kinetic", energy.kinetic},
                      {"potential", energy.potential},
                      {"dissipated", energy.dissipated},
                      {"from_device", energy.from_device},
                      {"from_inputs", energy.from_inputs},
                      {"from_links", energy.from_links}});
  }
  return report;
}

Json couplingsOf(const scene::Scene& scene, const physics::Energies& energies) {
  const auto name = [&scene](int section) {
    return scene.sections[static_cast<std::size_t>(section)].name;
  };
  Json report = Json::array();
  for (const physics::CouplingEnergy& energy : energies.couplings) {
    report.push_back({{"between", name(energy.section_a) + " and " + name(energy.section_b)},
                      {"stored", energy.stored},
                      {"dissipated", energy.dissipated},
                      {"made", energy.made}});
  }
  return report;
}

}  // namespace

void printEnergies(const physics::Instrument& instrument, std::ostream& out) {
  physics::Energies energies = instrument.makeEnergies();
  instrument.readEnergies(energies);
  const Json report{{"energies_j",
                     {{"stored", energies.stored},
                      {"from_parameters", energies.from_parameters},
                      {"balance_residual", energies.residual},
                      {"residual_share", station::relativeResidual(energies)},
                      {"sections", sectionsOf(instrument.scene(), energies)},
                      {"couplings", couplingsOf(instrument.scene(), energies)}}}};
  printText(report, out);
}

}  // namespace ergotic::tools
