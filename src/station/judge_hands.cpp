// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/judge_hands.hpp"

#include <algorithm>
#include <utility>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::station {
namespace {

using physics::HandLevel;
using scene::numberText;

/// [ports] what the certificate says of them.
std::vector<double> ofPorts(const scene::Scene& scene,
                            const physics::Certificate& certificate,
                            double physics::PortCertificate::*what) {
  std::vector<double> values(scene.ports.size());
  for (const physics::PortCertificate& port : certificate.ports) {
    values[static_cast<std::size_t>(port.port)] = port.*what;
  }
  return values;
}

std::string describe(const tgr::EndEffectorConfig& config, const SliceLoad& met) {
  const bool is_damper = met.damping * met.stiffness_limit > met.together * met.damping_limit;
  const std::string unit = is_damper ? " N s/m" : " N/m";
  const bool is_refused = met.level == HandLevel::kRefused;
  return (is_refused ? "error: " : "warning: ") + ("end-effector " + scene::quoted(config.name)) +
         " renders up to " + numberText(is_damper ? met.damping : met.together) + unit +
         " at its slices, which are passive up to " +
         numberText(is_damper ? met.damping_limit : met.stiffness_limit) + unit +
         (is_refused ? ": it will buzz or jump" : "") +
         ". Lower its force_scale, raise its position_scale, or raise the gestural rate";
}

void tell(HandFindings& findings, HandLevel level, const std::string& text) {
  if (level != HandLevel::kSilent) {
    (level == HandLevel::kRefused ? findings.refusals : findings.warnings).push_back(text);
  }
}

void judgeEndEffectors(const tgr::EndEffectors& end_effectors, HandFindings& findings) {
  for (const tgr::EndEffectorConfig& config : end_effectors.list) {
    const auto found = std::find_if(
        findings.slices.begin(), findings.slices.end(), [&config](const SliceLoad& load) {
          return std::find(config.slices.begin(), config.slices.end(), load.slice) !=
                 config.slices.end();
        });
    if (found != findings.slices.end()) {
      tell(findings, found->level,
           end_effectors.file + ":" + std::to_string(config.place.line) + ":" +
               std::to_string(config.place.column) + ": " + describe(config, *found));
    }
  }
}

/// Ports that the certificate left to an end-effector that is not there any more.
void judgeFreedPorts(const scene::Scene& scene,
                     const physics::Certificate& certificate,
                     const tgr::EndEffectors& end_effectors,
                     HandFindings& findings) {
  const std::vector<int> taken = tgr::takenPorts(scene, end_effectors);
  for (const physics::PortCertificate& port : certificate.ports) {
    const bool is_free = scene.ports[static_cast<std::size_t>(port.port)].slice >= 0 &&
                         std::find(taken.begin(), taken.end(), port.port) == taken.end();
    if (is_free && !port.is_judged) {
      tell(findings, port.level, port.finding);
    }
  }
}

}  // namespace

HandFindings judgeHands(const scene::Scene& scene,
                        const physics::Rates& rates,
                        const physics::Certificate& certificate,
                        const physics::DeviceTraits& device,
                        const tgr::EndEffectors& end_effectors) {
  using physics::PortCertificate;
  const auto rendered = [&](double PortCertificate::*what) {
    return tgr::renderedAtSlices(scene, end_effectors, ofPorts(scene, certificate, what));
  };
  const std::vector<tgr::Rendered> stiffness = rendered(&PortCertificate::stiffness);
  const std::vector<tgr::Rendered> damping = rendered(&PortCertificate::damping);
  const std::vector<tgr::Rendered> interpolated =
      rendered(&PortCertificate::interpolated_stiffness);
  const std::vector<tgr::Rendered> interpolated_damping =
      rendered(&PortCertificate::interpolated_damping);
  const physics::HandLoop loop(device, 1.0 / rates.gesturalHz(), std::max(2, rates.ratio));
  HandFindings findings;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const physics::HandLoad load{stiffness[i].together, damping[i].together,
                                 std::min(interpolated[i].together, stiffness[i].together),
                                 std::min(interpolated_damping[i].together, damping[i].together)};
    findings.slices.push_back(
        {stiffness[i].slice, stiffness[i].alone, load.stiffness, load.damping,
         loop.stiffnessLimit(physics::partOf(load.interpolated_stiffness, load.stiffness)),
         loop.dampingLimit(physics::partOf(load.interpolated_damping, load.damping)),
         loop.judge(load)});
  }
  judgeEndEffectors(end_effectors, findings);
  judgeFreedPorts(scene, certificate, end_effectors, findings);
  return findings;
}

FittedHands fitHands(const Performer& performer,
                     const tgr::EndEffectors& end_effectors,
                     int slices,
                     const physics::DeviceTraits& device) {
  const physics::Instrument& instrument = *performer.instrument;
  FittedHands fitted;
  fitted.rig = tgr::makeRig(instrument.scene(), end_effectors, slices);
  HandFindings findings = judgeHands(instrument.scene(), instrument.rates(), performer.certificate,
                                     device, end_effectors);
  if (!findings.refusals.empty() && !performer.allow_unproven) {
    throw Exception(findings.refusals.front());
  }
  fitted.warnings = std::move(findings.warnings);
  fitted.warnings.insert(fitted.warnings.end(), findings.refusals.begin(), findings.refusals.end());
  return fitted;
}

void giveHands(Performer& performer,
               const tgr::EndEffectors& end_effectors,
               int slices,
               const physics::DeviceTraits& device) {
  FittedHands fitted = fitHands(performer, end_effectors, slices, device);
  performer.rig = std::move(fitted.rig);
  performer.warnings.insert(performer.warnings.end(), fitted.warnings.begin(),
                            fitted.warnings.end());
}

}  // namespace ergotic::station
