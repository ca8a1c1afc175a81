// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/certificate/free_slices.hpp"
#include "physics/certificate/port_links.hpp"
#include "physics/interpolation.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

// Growth of what is attached to a slice, 1/s: slower is less than any hand and any loss takes.
constexpr double kWarnedGrowth = 0.01;
constexpr double kRefusedGrowth = 1.0;  // with twice the damping

bool isTaken(int port, const DeviceTraits& device) {
  const auto& taken = device.taken_ports;
  return std::find(taken.begin(), taken.end(), port) != taken.end();
}

class PortJudge {
 public:
  PortJudge(const RatedNetwork& networks, const DeviceTraits& device)
      : networks_(networks),
        scene_(networks.scene()),
        device_(device),
        links_(networks.network(), networks.rates()),
        rate_hz_(networks.rates().gesturalHz()),
        loop_(device, 1.0 / rate_hz_, std::max(2, networks.rates().ratio)),
        free_slices_(networks),
        free_levels_(levelsOfFreeSlices()) {}

  PortCertificate judge(int p) const {
    const scene::Port& port = scene_.ports[at(p)];
    const double at_device = std::abs(port.force_scale / port.position_scale) / scene_.time_unit_s;
    PortCertificate met;
    met.port = p;
    met.stiffness = links_.stiffness(port) * at_device / scene_.time_unit_s;
    met.interpolated_stiffness =
        links_.interpolatedStiffness(port) * at_device / scene_.time_unit_s;
    met.damping = std::max(links_.damping(port), 0.0) * at_device;
    met.interpolated_damping = std::max(links_.interpolatedDamping(port), 0.0) * at_device;
    met.stiffness_limit = loop_.stiffnessLimit(partOf(met.interpolated_stiffness, met.stiffness));
    met.damping_limit = loop_.dampingLimit(partOf(met.interpolated_damping, met.damping));
    met.level = std::max(loop_.judge(loadOf(met)), free_levels_[at(port.mat)]);
    if (free_slices_.leftOut(port.mat) != nullptr) {
      met.level = std::max(met.level, HandLevel::kWarned);
    }
    // What an end-effector makes of a port is known where that is.
    met.is_judged = port.slice >= 0 && !isTaken(p, device_);
    return met;
  }

  /// Error text for a link that drives the hand instead of resisting it; empty: there is none.
  std::string describeDriving(const scene::Port& port) const {
    const int link = links_.driving(port);
    return link < 0 ? ""
                    : "port '" + port.name + "': link '" + scene_.lias[at(link)].name +
                          "' has a negative stiffness, damping or nonlinearity and drives the "
                          "hand: it gives energy, no bound holds. Let it be 0 or more";
  }

  std::string describe(const PortCertificate& met) const {
    const scene::Port& port = scene_.ports[at(met.port)];
    const HandLevel of_links = loop_.judge(loadOf(met));
    const HandLevel of_free = free_levels_[at(port.mat)];
    std::string text = "port '" + port.name + "': ";
    if (of_links < of_free) {
      text += describeFree(port, of_free);
    } else if (of_links != HandLevel::kSilent) {
      text += describeLinks(port, met, of_links);
    }
    if (free_slices_.leftOut(port.mat) != nullptr) {
      const bool is_alone = of_links == HandLevel::kSilent && of_free == HandLevel::kSilent;
      text += (is_alone ? "" : ". Beside, ") + describeLeftOut(port);
    }
    return text;
  }

 private:
  /// Levels of slices that nobody holds: with what is attached to it, a slice may oscillate
  /// although its links alone do not make it do so. [mats]
  std::vector<HandLevel> levelsOfFreeSlices() const {
    std::vector<HandLevel> levels(scene_.mats.size(), HandLevel::kSilent);
    if (!(device_.mass > 0.0) || !free_slices_.areJudged()) {
      return levels;
    }
    DeviceTraits twice = device_;
    twice.damping *= 2.0;
    const auto grows = [this](double radius, double most) {
      return rate_hz_ * (radius - 1.0) > most;
    };
    const std::vector<double> once = free_slices_.radii(device_);
    if (!grows(*std::max_element(once.begin(), once.end()), kWarnedGrowth)) {
      return levels;
    }
    const std::vector<double> damped = free_slices_.radii(twice);
    for (std::size_t m = 0; m < levels.size(); ++m) {
      if (grows(once[m], kWarnedGrowth)) {
        levels[m] = grows(damped[m], kRefusedGrowth) ? HandLevel::kRefused : HandLevel::kWarned;
      }
    }
    return levels;
  }

  std::string ofSlice() const {
    return "a slice of " + physics::describe(device_.mass) + " kg with " +
           physics::describe(device_.damping) + " N s/m of its own, answered " +
           physics::describe(device_.delay_ticks) + " ticks late, ";
  }

  /// True if a link joins a slice to a module that forces move, or to another slice.
  bool leadsOn(const scene::Lia& lia) const {
    const auto isSlice = [this](int mat) {
      return scene_.mats[at(mat)].type == scene::MatType::kSlice;
    };
    return networks_.inverseMass(lia.a) > 0.0 || networks_.inverseMass(lia.b) > 0.0 ||
           (isSlice(lia.a) && isSlice(lia.b));
  }

  std::string ofAttached(const scene::Port& port) const {
    const std::vector<int>& links = links_.ofNodes()[at(port.mat)];
    const auto first = std::find_if(links.begin(), links.end(),
                                    [this](int l) { return leadsOn(scene_.lias[at(l)]); });
    return "what is attached to link '" +
           scene_.lias[at(first == links.end() ? links.front() : *first)].name + "'";
  }

  std::string describeFree(const scene::Port& port, HandLevel level) const {
    return "when nobody holds it, " + ofSlice() + "begins to swing with " + ofAttached(port) +
           (level == HandLevel::kRefused ? ": it will buzz" : "") +
           ". Damp what is attached there, soften the link, scale the force down, or raise the "
           "gestural "
           "rate";
  }

  std::string describeLeftOut(const scene::Port& port) const {
    return "it is not known whether a slice that nobody holds begins to swing with " +
           ofAttached(port) + ", because the analysis leaves out " +
           free_slices_.leftOut(port.mat) +
           ". Try it without a hand first, or scale the force down";
  }

  std::string describeLinks(const scene::Port& port,
                            const PortCertificate& met,
                            HandLevel level) const {
    const bool is_damper = met.damping * met.stiffness_limit > met.stiffness * met.damping_limit;
    const int link = is_damper ? links_.mostDamped(port) : links_.stiffest(port);
    const bool is_growing = scene::lawOf(scene_.lias[at(link)].type).growth != nullptr;
    std::string text =
        "the hand may meet " + physics::describe(is_damper ? met.damping : met.stiffness) +
        (is_damper ? " N s/m" : " N/m") + (is_growing ? " within a millimetre" : "") +
        ", mostly by link '" + scene_.lias[at(link)].name + "'; a slice " +
        (is_damper ? "of " + physics::describe(device_.mass) + " kg " : "") + "with " +
        physics::describe(device_.damping) + " N s/m of its own and a delay of " +
        physics::describe(device_.delay_ticks) + " ticks " +
        (is_damper ? "bears up to " : "is passive up to ") +
        physics::describe(is_damper ? met.damping_limit : met.stiffness_limit) +
        (is_damper ? " N s/m at " : " N/m at ") + wholeHz(rate_hz_) + " Hz";
    text += level == HandLevel::kRefused ? ": it will buzz or jump"
                                         : " (and does not buzz below half of it)";
    text += met.interpolated_stiffness + met.interpolated_damping > 0.0
                ? ". Interpolation adds a delay of " + physics::describe(kInterpolationDelay) +
                      " ticks (coupling: hold has none)"
                : "";
    return text + (is_damper ? ". Lower the damping" : ". Soften the link") +
           ", scale the force down, or raise the gestural rate";
  }

  const RatedNetwork& networks_;
  const scene::Scene& scene_;
  const DeviceTraits& device_;
  PortLinks links_;
  double rate_hz_;
  HandLoop loop_;
  FreeSlices free_slices_;
  std::vector<HandLevel> free_levels_;  // [mats]
};

}  // namespace

std::vector<PortCertificate> judgePorts(const RatedNetwork& networks,
                                        const DeviceTraits& device,
                                        Findings& findings) {
  const scene::Scene& scene = networks.scene();
  std::vector<PortCertificate> certificates;
  if (scene.ports.empty()) {
    return certificates;
  }
  const PortJudge judge(networks, device);
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    const scene::Port& port = scene.ports[at(p)];
    if (port.agent >= 0) {
      continue;  // no hand is there
    }
    if (const std::string text = judge.describeDriving(port); !text.empty()) {
      findings.add(Verdict::kUnproven, port.place, text);
    }
    PortCertificate met = judge.judge(p);
    if (met.level != HandLevel::kSilent) {
      const bool is_refused = met.level == HandLevel::kRefused;
      const std::string text = judge.describe(met);
      met.finding = findings.locate(port.place, is_refused ? "error" : "warning", text);
      if (met.is_judged) {
        findings.add(is_refused ? Verdict::kUnproven : Verdict::kPassive, port.place, text);
      }
    }
    certificates.push_back(std::move(met));
  }
  return certificates;
}

}  // namespace ergotic::physics
