// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/certify.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/network/network_analysis.hpp"

namespace ergotic::physics {
namespace {

/// Audio parameters that anything but a place follows: places have a range, which is certified.
std::set<int> audioInCoefficients(const scene::Scene& scene) {
  std::set<int> found;
  const auto add = [&found](std::initializer_list<scene::Value> values) {
    for (const scene::Value& value : values) {
      found.insert(value.audio);
    }
  };
  for (const scene::Mat& mat : scene.mats) {
    add({mat.mass, mat.stiffness, mat.damping});
  }
  for (const scene::Lia& lia : scene.lias) {
    add({lia.stiffness, lia.damping, lia.law->nonlinearity, lia.law->width});
  }
  found.erase(-1);
  return found;
}

class Certifier {
 public:
  Certifier(const Network& network, const Rates& rates)
      : scene_(network.scene), networks_(network, rates), findings_(scene_.file) {}

  Certificate run(const DeviceTraits& device) {
    Certificate result;
    std::map<int, SectionCertificate> of_rate;
    for (int s = 0; s < static_cast<int>(scene_.sections.size()); ++s) {
      const int divisor = divisorOf(scene_.sections[at(s)], networks_.rates());
      const auto [known, is_new] = of_rate.try_emplace(divisor);
      if (is_new) {
        known->second = certifyRate(s, divisor);
      }
      result.sections.push_back(known->second);
      result.sections.back().section = s;
    }
    judgeAxes(networks_, findings_);
    judgeCouplings(networks_, findings_);
    for (const int index : audioInCoefficients(scene_)) {
      const scene::AudioParameter& parameter = scene_.audio_parameters[at(index)];
      findings_.add(Verdict::kUnproven, parameter.place,
                    "'" + parameter.name +
                        "' follows an audio input, which has no range: nothing is proven of what "
                        "it moves");
    }
    judgeLinks(networks_, findings_);
    result.ports = judgePorts(networks_, device, findings_);
    findings_.giveTo(result);
    return result;
  }

 private:
  /// Certifies all sections of one rate as one network; ends in slower sections are held, so fixed.
  SectionCertificate certifyRate(int s, int divisor) {
    const NetworkBound network = networks_.atOwnRate(divisor);
    judgeSigns(networks_, network, findings_);
    NetworkAnalysis analysis = analyse(network);
    if (networks_.hasLinkedMatched(divisor)) {
      // Matched modules change with the step in their own way, but stay below plain ones.
      const double plain =
          analyse(networks_.atOwnRate(divisor, RatedNetwork::kAll, true)).stable_step;
      analysis.stable_step = analysis.isProven() ? std::max(plain, network.step()) : plain;
    }
    SectionCertificate result;
    result.section = s;
    result.rate_hz = networks_.rates().audio_hz / divisor;
    result.lambda = analysis.lambda;
    result.exact = analysis.is_exact;
    result.link_bound = analysis.link_bound;
    result.worst_lia = analysis.worst_link;
    result.worst_mat = analysis.worst_owner;
    result.stable_rate_hz = 1.0 / (analysis.stable_step * scene_.time_unit_s);
    if (!analysis.isProven()) {
      refuse(result, analysis);
    }
    return result;
  }

  /// The limit of the generated body that holds the worst link or module; nullptr: none.
  const scene::BodyLimit* limitOf(const SectionCertificate& section) const {
    const auto is_within = [](int index, int first, int count) {
      return index >= first && index < first + count;
    };
    const auto found = std::find_if(
        scene_.body_limits.begin(), scene_.body_limits.end(), [&](const scene::BodyLimit& body) {
          return is_within(section.worst_lia, body.first_lia, body.lias) ||
                 is_within(section.worst_mat, body.first_mat, body.mats);
        });
    return found == scene_.body_limits.end() ? nullptr : &*found;
  }

  /// Error text: which link or module is too stiff, and what to do about it.
  std::string faultOf(const SectionCertificate& section) const {
    const bool is_link = section.worst_lia >= 0;
    return "section '" + scene_.sections[at(section.section)].name + "' at " +
           wholeHz(section.rate_hz) + " Hz: " +
           (is_link ? "link '" + scene_.lias[at(section.worst_lia)].name + "'"
                    : "module '" + scene_.mats[at(std::max(section.worst_mat, 0))].name + "'") +
           " is too stiff or too damped, bound " + describe(section.lambda) +
           ", allowed below 4. Soften it, make its masses heavier, or run the section at " +
           wholeHz(section.stable_rate_hz) + " Hz or more";
  }

  void refuse(const SectionCertificate& section, const NetworkAnalysis& analysis) {
    const scene::BodyLimit* const body = limitOf(section);
    const scene::Place place = body != nullptr ? body->place
                               : section.worst_lia >= 0
                                   ? scene_.lias[at(section.worst_lia)].place
                                   : scene_.mats[at(std::max(section.worst_mat, 0))].place;
    std::string text = body != nullptr ? body->text : faultOf(section);
    if (analysis.is_too_large) {
      text += ". It is only a bound: the network is too large to be tested exactly";
    } else if (analysis.is_bound) {
      text += ". It is only a bound: several points that move were taken at their worst together";
    }
    const Verdict verdict = verdictOn(section, analysis);
    if (verdict == Verdict::kBounded) {
      text +=
          ". What is too steep has a force that is bounded: it can rattle in time with the "
          "steps, but not grow";
    } else if (verdict == Verdict::kUnproven && isRefuted(analysis)) {
      text +=
          ". That is where links are at their steepest: at rest it is stable, and whether it "
          "grows depends on how it is played";
    }
    findings_.add(verdict, place, text);
  }

  /// True if the network is beyond its limit for certain.
  static bool isRefuted(const NetworkAnalysis& analysis) {
    return !analysis.is_too_large && !analysis.is_bound && analysis.lambda >= NetworkBound::kLimit;
  }

  /// The verdict on a network that is not proven stable. Only a linear network is shown to grow:
  /// other links may leave the range where their slope is too steep, or have a bounded force.
  Verdict verdictOn(const SectionCertificate& section, const NetworkAnalysis& analysis) const {
    if (!isRefuted(analysis)) {
      return Verdict::kUnproven;
    }
    const int divisor = divisorOf(scene_.sections[at(section.section)], networks_.rates());
    if (isRefuted(analyse(networks_.atRest(divisor)))) {
      return Verdict::kUnstable;
    }
    // Whether all that such forces act on loses energy is judged link by link.
    return analyse(networks_.withoutBounded(divisor)).isProven() ? Verdict::kBounded
                                                                 : Verdict::kUnproven;
  }

  const scene::Scene& scene_;
  RatedNetwork networks_;
  Findings findings_;
};

/// True if all links act along one axis: those between scalar sections do. In others, a link that
/// makes up for a negative one may act along another axis.
bool isAlongOneAxis(const scene::Scene& scene, const std::vector<int>& modules) {
  return std::all_of(modules.begin(), modules.end(), [&](int mat) {
    return scene.sectionOf(scene.mats[at(mat)]).geometry == scene::Geometry::kScalar;
  });
}

}  // namespace

void judgeSigns(const RatedNetwork& networks, const NetworkBound& network, Findings& findings) {
  const std::optional<std::vector<int>> beside = semidefiniteBesideNegative(network);
  if (beside && isAlongOneAxis(networks.scene(), *beside)) {
    return;
  }
  for (const NetworkBound::Link& link : network.links()) {
    if (link.stiffness.lowest >= 0.0 && link.damping.lowest >= 0.0) {
      continue;
    }
    const scene::Lia& lia = networks.scene().lias[at(std::max(link.label, 0))];
    findings.add(Verdict::kUnproven, lia.place,
                 "link '" + lia.name +
                     "' has a negative stiffness or damping that the links around it do not make "
                     "up for: it gives energy, no bound holds. Make it weaker or those stronger, "
                     "all of them between scalar sections");
    return;
  }
}

const char* toString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassive:
      return "passive";
    case Verdict::kBounded:
      return "bounded";
    case Verdict::kUnproven:
      return "unproven";
    case Verdict::kUnstable:
      return "unstable";
  }
  return "";
}

double Certificate::margin() const {
  double lambda = 0.0;
  for (const SectionCertificate& section : sections) {
    lambda = std::max(lambda, section.lambda);
  }
  return 1.0 - lambda / NetworkBound::kLimit;
}

Certificate certify(const scene::Scene& scene, const Rates& rates, const DeviceTraits& device) {
  for (const scene::Lia& lia : scene.lias) {
    if (scene::isOpen(lia.scheme)) {
      throw std::logic_error("link '" + lia.name + "' is not settled: nobody chose its scheme");
    }
  }
  return Certifier(Network(scene), rates).run(device);
}

}  // namespace ergotic::physics
