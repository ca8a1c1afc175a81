// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "certify_parts.hpp"

namespace ergotic::physics {
namespace {

constexpr double kWarned = 0.5;         // of the passivity limit
constexpr double kTooMuch = 2.0;        // of it
constexpr double kHandDepth = 1e-3;     // m, where a slope grows with it
constexpr int kLongestSeries = 100000;  // links in a row

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The links of every module, to follow them from a slice.
class Stiffnesses {
 public:
  explicit Stiffnesses(const SceneNetwork& networks)
      : networks_(networks), links_of_(networks.scene().mats.size()) {
    for (int l = 0; l < static_cast<int>(networks.scene().lias.size()); ++l) {
      links_of_[at(lia(l).a)].push_back(l);
      links_of_[at(lia(l).b)].push_back(l);
    }
  }

  /// Sum over the links of a slice, in the model's units.
  double of(int slice) const {
    double sum = 0.0;
    for (const int l : links_of_[at(slice)]) {
      sum += series(slice, l);
    }
    return sum;
  }

  /// The link that gives most of it, -1: none.
  int worst(int slice) const {
    const std::vector<int>& links = links_of_[at(slice)];
    const auto found = std::max_element(links.begin(), links.end(), [&](int a, int b) {
      return series(slice, a) < series(slice, b);
    });
    return found == links.end() ? -1 : *found;
  }

 private:
  const scene::Lia& lia(int l) const { return networks_.scene().lias[at(l)]; }

  double slope(int l) const { return std::abs(stiffnessAt(networks_.scene(), lia(l), kHandDepth)); }

  /// One link after the other through masses that nothing else holds; what comes then is held.
  double series(int from, int l) const {
    double stiffness = slope(l);
    for (int links = 1; links < kLongestSeries && stiffness > 0.0; ++links) {
      const int mat = lia(l).a == from ? lia(l).b : lia(l).a;
      const std::vector<int>& here = links_of_[at(mat)];
      if (networks_.scene().mats[at(mat)].type != scene::MatType::kMass || here.size() != 2) {
        break;
      }
      from = mat;
      l = here[0] == l ? here[1] : here[0];
      stiffness = 1.0 / (1.0 / stiffness + 1.0 / slope(l));
    }
    return stiffness;
  }

  const SceneNetwork& networks_;
  std::vector<std::vector<int>> links_of_;  // [mats]
};

}  // namespace

std::vector<PortCertificate> judgePorts(const SceneNetwork& networks,
                                        const DeviceTraits& device,
                                        Findings& findings) {
  const scene::Scene& scene = networks.scene();
  std::vector<PortCertificate> certificates;
  if (scene.ports.empty()) {
    return certificates;
  }
  const Stiffnesses stiffnesses(networks);
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    const scene::Port& port = scene.ports[at(p)];
    PortCertificate certificate;
    certificate.port = p;
    certificate.stiffness = stiffnesses.of(port.mat) * std::abs(port.force_scale) /
                            (std::abs(port.position_scale) * scene.time_unit_s * scene.time_unit_s);
    certificate.limit =
        2.0 * device.damping * networks.rates().gesturalHz() / (1.0 + 2.0 * device.delay_ticks);
    certificates.push_back(certificate);
    if (certificate.stiffness <= kWarned * certificate.limit) {
      continue;
    }
    const std::string link = scene.lias[at(stiffnesses.worst(port.mat))].name;
    const std::string text = "port '" + port.name + "': the hand may meet " +
                             describe(certificate.stiffness) + " N/m, mostly by link '" + link +
                             "'; a slice with " + describe(device.damping) +
                             " N s/m of its own is passive up to " + describe(certificate.limit) +
                             " N/m at " + wholeHz(networks.rates().gesturalHz()) + " Hz";
    const std::string advice =
        ". Soften the link, scale the force down, or raise the gestural rate";
    if (certificate.stiffness > kTooMuch * certificate.limit) {
      findings.add(Verdict::kUnproven, port.place, text + ": it will buzz or jump" + advice);
    } else {
      findings.add(Verdict::kPassive, port.place, text + " (silent below half of it)" + advice);
    }
  }
  return certificates;
}

}  // namespace ergotic::physics
