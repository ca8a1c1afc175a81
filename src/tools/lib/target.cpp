// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/target.hpp"

#include <sstream>
#include <utility>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "tools/lib/cost.hpp"

namespace ergotic::tools {
namespace {

using physics::Advice;
using physics::Proposal;

std::string nameOf(const Advice& advice) {
  return advice.part +
         (advice.parts > 1 ? " and " + std::to_string(advice.parts - 1) + " more" : "");
}

/// CPU time of one second of sound, %.
double cpuPercent(const scene::Scene& scene,
                  const physics::Rates& rates,
                  physics::CompileOptions options,
                  physics::Precision precision) {
  options.precision = precision;
  const auto instrument = physics::compile(physics::settle(scene, rates).scene, rates, options);
  return 100.0 / measureCost(*instrument).real_time_factor;
}

Report pairOf(Report now, Report proposed) {
  return Report::map().add("now", std::move(now)).add("proposed", std::move(proposed));
}

Report adviceReport(const Advice& advice, physics::Target::Unit unit) {
  Report report = Report::map();
  report.add("part", Report::text(nameOf(advice)))
      .add("judged", Report::text(advice.figure))
      .add("now", Report::text(physics::inUnit(advice.present, unit)))
      .add("proposed", Report::text(physics::inUnit(advice.proposed, unit)))
      .add("change", Report::text(advice.change.empty() ? "none" : advice.change));
  if (!advice.remark.empty()) {
    report.add("remark", Report::text(advice.remark));
  }
  return report;
}

}  // namespace

physics::Freedom freedomOf(const SceneOptions& options, const CompileChoice& compile) {
  physics::Freedom freedom;
  freedom.audio_rate = options.rate_hz == 0.0;
  freedom.gestural_rate = options.gestural_rate_hz == 0.0;
  freedom.precision = compile.precision.empty();
  return freedom;
}

Report targetReport(const scene::Scene& scene,
                    const physics::Rates& rates,
                    const physics::CompileOptions& options,
                    const std::string& text,
                    const physics::Freedom& freedom) {
  const physics::Target target = physics::targetOf(text);
  const Proposal proposal = physics::propose(scene, rates, options.precision, target, freedom);
  Report parts = Report::list();
  for (const Advice& advice : proposal.advice) {
    parts.add(adviceReport(advice, target.unit));
  }
  Report remarks = Report::list();
  for (const std::string& remark : proposal.remarks) {
    remarks.add(Report::text(remark));
  }
  return Report::map()
      .add("asked", Report::text(text))
      .add("reached", Report::text(proposal.is_reached ? "yes" : "no, this is the best there is"))
      .add("audio_rate_hz",
           pairOf(Report::number(rates.audio_hz), Report::number(proposal.rates.audio_hz)))
      .add("gestural_rate_hz",
           pairOf(Report::number(rates.gesturalHz()), Report::number(proposal.rates.gesturalHz())))
      .add("precision", pairOf(Report::text(nameOf(options.precision)),
                               Report::text(nameOf(proposal.precision))))
      .add("steps_per_s",
           pairOf(Report::number(proposal.present_cost), Report::number(proposal.cost)))
      .add("cpu_percent",
           pairOf(Report::number(cpuPercent(scene, rates, options, options.precision)),
                  Report::number(
                      cpuPercent(proposal.scene, proposal.rates, options, proposal.precision))))
      .add("parts", std::move(parts))
      .add("remarks", std::move(remarks));
}

std::vector<std::string> targetLines(const physics::Target& target, const Proposal& proposal) {
  std::vector<std::string> lines;
  std::ostringstream head;
  head << "target " << physics::inUnit(target.relative(), target.unit) << ": "
       << (proposal.is_reached ? "" : "out of reach; the best there is: ")
       << proposal.rates.audio_hz << " Hz, gestures " << proposal.rates.gesturalHz()
       << " Hz (R = " << proposal.rates.ratio << "), " << nameOf(proposal.precision)
       << ", predicted cost " << proposal.cost / proposal.present_cost << " of what it was";
  lines.push_back(head.str());
  for (const Advice& advice : proposal.advice) {
    lines.push_back("target: " + nameOf(advice) + ", " + advice.figure + ": " +
                    physics::inUnit(advice.present, target.unit) + " -> " +
                    physics::inUnit(advice.proposed, target.unit) + "; " +
                    (advice.change.empty() ? "left as it is" : advice.change) +
                    (advice.remark.empty() ? "" : " (" + advice.remark + ")"));
  }
  for (const std::string& remark : proposal.remarks) {
    lines.push_back("target: " + remark);
  }
  return lines;
}

}  // namespace ergotic::tools
