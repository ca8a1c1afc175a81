// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "at.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "physics/certificate/findings.hpp"
#include "physics/network/couplings.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;
using scene::Scene;

constexpr int kMaxRaised = 100;  // modules of a section

bool staysSlow(const scene::Mat& mat) {
  return mat.type == MatType::kSlice || mat.type == MatType::kDriven;
}

class Raiser {
 public:
  Raiser(Scene& scene, const Rates& rates, const Complete& complete)
      : scene_(scene), rates_(rates), complete_(complete) {}

  /// Raises one section. \return what to say of it, empty: there is none to raise
  std::string raiseOne() {
    const Scene candidate = complete_(scene_);
    const Network network(candidate);
    const RatedNetwork networks(network, rates_);
    for (const auto& [island, coupling] : findCouplings(networks)) {
      const auto open =
          std::find_if(coupling.nonlinear.begin(), coupling.nonlinear.end(), [this](int l) {
            return at(l) < scene_.lias.size() && scene_.lias[at(l)].scheme == scene::Scheme::kAuto;
          });
      if (open != coupling.nonlinear.end() && !hasChaplet(networks, island) &&
          moved(coupling.slow_section) <= kMaxRaised) {
        return raise(coupling, scene_.lias[at(*open)]);
      }
    }
    return {};
  }

 private:
  bool hasChaplet(const RatedNetwork& networks, int island) const {
    const std::vector<FoundChaplet> found = findChaplets(networks.scene(), rates_);
    return std::any_of(found.begin(), found.end(), [&](const FoundChaplet& chaplet) {
      return networks.islandOf(chaplet.first) == island;
    });
  }

  int moved(int section) const {
    return static_cast<int>(std::count_if(
        scene_.mats.begin(), scene_.mats.end(),
        [&](const scene::Mat& mat) { return mat.section == section && !staysSlow(mat); }));
  }

  std::string raise(const Coupling& coupling, const scene::Lia& beside) {
    const scene::Section& slow = scene_.sections[at(coupling.slow_section)];
    std::string text = noteAt(scene_, slow.place) + "section '" + slow.name + "' is stepped at " +
                       wholeHz(rates_.audio_hz / coupling.fastest) + " Hz, not at " +
                       wholeHz(rates_.audio_hz / coupling.slowest) + ", because link '" +
                       beside.name +
                       "' is not linear: of such a link beside two rates nothing is proven. "
                       "scheme: explicit keeps the rate";
    scene::Section& raised = scene_.sections[at(sectionToRaise(coupling.slow_section))];
    raised.gestural = false;
    raised.divisor = coupling.fastest;
    return text;
  }

  /// The section whose rate is raised: this one, or, where something has to stay slow, a new one
  /// for everything else.
  int sectionToRaise(int section) {
    const auto isHere = [&](const scene::Mat& mat) { return mat.section == section; };
    const bool stays =
        std::any_of(scene_.mats.begin(), scene_.mats.end(),
                    [&](const scene::Mat& mat) { return isHere(mat) && staysSlow(mat); });
    if (!stays) {
      return section;
    }
    scene::Section fast = scene_.sections[at(section)];
    fast.name += ".raised";
    scene_.sections.push_back(std::move(fast));
    const int raised = static_cast<int>(scene_.sections.size()) - 1;
    for (scene::Mat& mat : scene_.mats) {
      if (isHere(mat) && !staysSlow(mat)) {
        mat.section = raised;
      }
    }
    return raised;
  }

  Scene& scene_;
  Rates rates_;
  const Complete& complete_;
};

bool mayBeRaised(const Scene& scene, const Rates& rates) {
  const bool is_open = std::any_of(scene.lias.begin(), scene.lias.end(), [](const scene::Lia& lia) {
    return lia.scheme == scene::Scheme::kAuto;
  });
  return is_open && std::any_of(scene.mats.begin(), scene.mats.end(), [&](const scene::Mat& mat) {
           return divisorOf(scene.sectionOf(mat), rates) > 1 &&
                  (mat.type == MatType::kMass || mat.type == MatType::kCell);
         });
}

}  // namespace

void raiseRates(Scene& scene,
                const Rates& rates,
                const Complete& complete,
                std::vector<std::string>& notes) {
  while (mayBeRaised(scene, rates)) {
    const std::string note = Raiser(scene, rates, complete).raiseOne();
    if (note.empty()) {
      return;
    }
    notes.push_back(note);
  }
}

}  // namespace ergotic::physics
