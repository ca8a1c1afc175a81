// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/render_energies.hpp"

#include "ergotic/station/health.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

Report sectionsOf(const scene::Scene& scene, const physics::Energies& energies) {
  Report report = Report::list();
  for (std::size_t s = 0; s < energies.sections.size(); ++s) {
    const physics::SectionEnergy& energy = energies.sections[s];
    report.add(Report::map()
                   .add("section", Report::text(scene.sections[s].name))
                   .add("kinetic", Report::number(energy.kinetic))
                   .add("potential", Report::number(energy.potential))
                   .add("dissipated", Report::number(energy.dissipated))
                   .add("from_device", Report::number(energy.from_device))
                   .add("from_inputs", Report::number(energy.from_inputs))
                   .add("from_links", Report::number(energy.from_links)));
  }
  return report;
}

Report couplingsOf(const scene::Scene& scene, const physics::Energies& energies) {
  const auto name = [&scene](int section) {
    return scene.sections[static_cast<std::size_t>(section)].name;
  };
  Report report = Report::list();
  for (const physics::CouplingEnergy& energy : energies.couplings) {
    report.add(
        Report::map()
            .add("between", Report::text(name(energy.section_a) + " and " + name(energy.section_b)))
            .add("stored", Report::number(energy.stored))
            .add("dissipated", Report::number(energy.dissipated))
            .add("breathing", Report::number(energy.breathing)));
  }
  return report;
}

}  // namespace

void printEnergies(const physics::Instrument& instrument, std::ostream& out) {
  physics::Energies energies = instrument.makeEnergies();
  instrument.readEnergies(energies);
  Report::map()
      .add("energies_j",
           Report::map()
               .add("stored", Report::number(energies.stored))
               .add("from_parameters", Report::number(energies.from_parameters))
               .add("balance_residual", Report::number(energies.residual))
               .add("residual_share", Report::number(station::relativeResidual(energies)))
               .add("sections", sectionsOf(instrument.scene(), energies))
               .add("couplings", couplingsOf(instrument.scene(), energies)))
      .printText(out);
}

}  // namespace ergotic::tools
