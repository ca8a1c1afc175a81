// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "at.hpp"
#include "constants.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "physics/settling/chaplet_load.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;
using scene::Scene;

constexpr double kRounding = 1e-6;

bool areClose(double a, double b) {
  return std::abs(a - b) <= kRounding * std::abs(b);
}

/// Finds the C2 that are attached to slower modules.
class Finder {
 public:
  Finder(const Network& network, const Rates& rates)
      : network_(network), scene_(network.scene), rates_(rates), lias_of_(linksOfNodes(network)) {}

  std::vector<FoundChaplet> find() const {
    std::vector<FoundChaplet> found;
    for (std::size_t i = 0; i < scene_.mats.size(); ++i) {
      if (auto chaplet = chapletFrom(static_cast<int>(i))) {
        found.push_back(std::move(*chaplet));
      }
    }
    return found;
  }

 private:
  int divisor(int mat) const { return divisorOf(scene_.sectionOf(scene_.mats[at(mat)]), rates_); }
  int farEnd(int lia, int mat) const {
    return scene_.lias[at(lia)].a == mat ? scene_.lias[at(lia)].b : scene_.lias[at(lia)].a;
  }

  /// Finds the chaplet whose first mass this is: it is between the two links of the chaplet, of
  /// which the first leads to a slower module.
  std::optional<FoundChaplet> chapletFrom(int first) const {
    const std::vector<int>& lias = lias_of_[at(first)];
    if (scene_.mats[at(first)].type != MatType::kMass || lias.size() != 2) {
      return std::nullopt;
    }
    const bool ordered = divisor(farEnd(lias[0], first)) > divisor(first);
    const int attached = ordered ? lias[0] : lias[1];
    const int between = ordered ? lias[1] : lias[0];
    const int last = farEnd(between, first);
    const int slow_divisor = divisor(farEnd(attached, first));
    if (scene_.mats[at(last)].type != MatType::kMass ||
        scene_.mats[at(last)].section != scene_.mats[at(first)].section ||
        slow_divisor <= divisor(first) || slow_divisor % divisor(first) != 0) {
      return std::nullopt;
    }
    std::vector<scene::ChapletStage> stages{stageOf(attached, first), stageOf(between, last)};
    if (!hasProportions(stages, attached, between)) {
      return std::nullopt;
    }
    const Chaplet chaplet(std::move(stages), divisor(first) / rates_.audio_hz,
                          slow_divisor / divisor(first));
    return FoundChaplet{nameOf(first), first, chaplet, loadOn(last, first, chaplet)};
  }

  scene::ChapletStage stageOf(int lia, int mat) const {
    const double unit = scene_.time_unit_s;
    return {scene_.valueOf(scene_.lias[at(lia)].stiffness) / (unit * unit),
            scene_.valueOf(scene_.lias[at(lia)].damping) / unit,
            scene_.valueOf(scene_.mats[at(mat)].mass)};
  }

  bool hasProportions(const std::vector<scene::ChapletStage>& stages,
                      int attached,
                      int between) const {
    const auto& table = scene::kChapletC2;
    return scene_.lias[at(attached)].type == LiaType::kSpringDamper &&
           scene_.lias[at(between)].type == LiaType::kSpringDamper && stages[1].damping == 0.0 &&
           areClose(stages[0].mass * table[1].mass, stages[1].mass * table[0].mass) &&
           areClose(stages[0].stiffness * table[1].stiffness,
                    stages[1].stiffness * table[0].stiffness) &&
           areClose(std::pow(stages[0].damping / table[0].damping, 2),
                    stages[0].stiffness * stages[0].mass / (table[0].stiffness * table[0].mass));
  }

  std::string nameOf(int first) const {
    const std::string& name = scene_.mats[at(first)].name;
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(0, dot);
  }

  /// Stiffness and damping of all that is linked to the last mass of a chaplet, at the Nyquist
  /// frequency of its slow side.
  ChapletLoad loadOn(int last, int first, const Chaplet& chaplet) const {
    ChapletLoad load;
    for (const int lia : lias_of_[at(last)]) {
      const int touched = farEnd(lia, last);
      if (touched == first) {
        continue;
      }
      const LinearNetwork around(network_, scene_.mats[at(touched)].section, last);
      if (around.moves(touched)) {
        const ChapletLoad more = loadAt(around, touched, 2.0 * kPi * chaplet.nyquistHz());
        load.stiffness += more.stiffness;
        load.damping += more.damping;
      }
    }
    return load;
  }

  const Network& network_;
  const Scene& scene_;
  const Rates& rates_;
  std::vector<std::vector<int>> lias_of_;  // [mats]
};

}  // namespace

std::vector<FoundChaplet> findChaplets(const Scene& scene, const Rates& rates) {
  return Finder(Network(scene), rates).find();
}

}  // namespace ergotic::physics
