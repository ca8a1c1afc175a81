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

Json pairOf(Json now, Json proposed) {
  return {{"now", std::move(now)}, {"proposed", std::move(proposed)}};
}

Json adviceReport(const Advice& advice, physics::Target::Unit unit) {
  Json report = {{"part", nameOf(advice)},
                 {"judged", advice.figure},
                 {"now", physics::inUnit(advice.present, unit)},
                 {"proposed", physics::inUnit(advice.proposed, unit)},
                 {"change", advice.change.empty() ? "none" : advice.change}};
  if (!advice.remark.empty()) {
    report["remark"] = advice.remark;
  }
  return report;
}

}  // namespace

physics::Freedom freedomOf(const SceneOptions& options, const CompileChoice& compile) {
  physics::Freedom freedom;
  freedom.audio_rate = options.rate_hz == 0.0;
  freedom.gestural_rate = options.gestural_rate_hz == 0.0;
  freedom.precision = compile.precision.empty() || compile.precision == "auto";
  return freedom;
}

Json targetReport(const scene::Scene& scene,
                  const physics::Rates& rates,
                  const physics::CompileOptions& options,
                  const std::string& text,
                  const physics::Freedom& freedom) {
  const physics::Target target = physics::targetOf(text);
  const Proposal proposal = physics::propose(scene, rates, options.precision, target, freedom);
  Json parts = Json::array();
  for (const Advice& advice : proposal.advice) {
    parts.push_back(adviceReport(advice, target.unit));
  }
  return {{"asked", text},
          {"reached", proposal.is_reached ? "yes" : "no, this is the best there is"},
          {"audio_rate_hz", pairOf(rates.audio_hz, proposal.rates.audio_hz)},
          {"gestural_rate_hz", pairOf(rates.gesturalHz(), proposal.rates.gesturalHz())},
          {"precision", pairOf(nameOf(options.precision), nameOf(proposal.precision))},
          {"steps_per_s", pairOf(proposal.present_cost, proposal.cost)},
          {"cpu_percent",
           pairOf(cpuPercent(scene, rates, options, options.precision),

                  cpuPercent(proposal.scene, proposal.rates, options, proposal.precision))},
          {"parts", std::move(parts)},
          {"remarks", proposal.remarks}};
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
