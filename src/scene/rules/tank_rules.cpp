// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "ergotic/scene/coarse_string.hpp"
#include "scene/laws/range.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

/// Whether what it is tuned to follows a parameter.
bool isTunedByParameter(const Scene& scene, int spring) {
  return std::any_of(scene.strings.begin(), scene.strings.end(), [&](const StringInfo& string) {
    return string.frequency_hz > 0.0 && string.mass.parameter >= 0 && spring >= string.first_lia &&
           spring < string.first_lia + string.count - 1;
  });
}

std::string springFault(const Scene& scene, const Tank& tank, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= scene.lias.size()) {
    return "has a spring that does not exist, there are " + std::to_string(scene.lias.size()) +
           " links";
  }
  const Lia& spring = scene.lias[static_cast<std::size_t>(index)];
  const Range k = rangeOf(scene, spring.stiffness);
  const bool is_coarse =
      std::any_of(scene.strings.begin(), scene.strings.end(), [&](const StringInfo& string) {
        return string.coarse && index >= string.first_lia &&
               index < string.first_lia + coarseLinks(string.count - 2);
      });
  if (spring.type != LiaType::kSpringDamper || spring.bend >= 0 || k.lowest < 0.0 ||
      k.highest == 0.0 || is_coarse || spring.stiffness.audio >= 0) {
    return "is of link " + quoted(spring.name) +
           ", allowed: springs of stiffness >= 0, not always 0, not those of coarse strings or "
           "bends";
  }
  if (tank.hardening.parameter >= 0 &&
      (spring.stiffness.parameter >= 0 || isTunedByParameter(scene, index))) {
    return "has a parameter for hardening, and spring " + quoted(spring.name) +
           " follows one, allowed: one of them";
  }
  return {};
}

std::string stretchFault(const Scene& scene, const Tank& tank) {
  const Range hardening = rangeOf(scene, tank.hardening);
  for (const double end : {hardening.lowest, hardening.highest}) {
    if (!kHardeningLimits.hold(end)) {
      return outOfRange("has a hardening", end, kHardeningLimits);
    }
  }
  if (!kSpacingLimits.hold(tank.spacing)) {
    return outOfRange("has a spacing", tank.spacing, kSpacingLimits);
  }
  std::set<int> springs;
  for (const int spring : tank.springs) {
    if (std::string fault = springFault(scene, tank, spring); !fault.empty()) {
      return fault;
    }
    if (!springs.insert(spring).second) {
      return "is of link " + quoted(scene.lias[static_cast<std::size_t>(spring)].name) +
             " twice, allowed: once";
    }
  }
  return {};  // that of a body, of its own hard links, is of no spring
}

/// Links of one tank are one body: what acts on one of its modules answers on all.
class TankRules {
 public:
  explicit TankRules(const Scene& scene)
      : scene_(scene), section_(scene.tanks.size(), -1), tank_of_(scene.mats.size(), -1) {}

  std::string faultOf(const Lia& lia) {
    if (static_cast<std::size_t>(lia.tank) >= scene_.tanks.size()) {
      return "has a tank that does not exist, there are " + std::to_string(scene_.tanks.size());
    }
    const bool is_hard = lia.type == LiaType::kCubic && lia.scheme == Scheme::kEnergyStable &&
                         largest(scene_, lia.stiffness) == 0.0 &&
                         largest(scene_, lia.damping) == 0.0 && lia.law->nonlinearity.audio < 0 &&
                         rangeOf(scene_, lia.law->nonlinearity).lowest >= 0.0;
    if (!is_hard) {
      return "has a tank, allowed with one: cubic with stiffness and damping 0 (write a "
             "spring_damper beside it) and nonlinearity >= 0";
    }
    for (const int end : {lia.a, lia.b}) {
      if (std::string fault = endFault(lia, end); !fault.empty()) {
        return fault;
      }
    }
    return {};
  }

 private:
  std::string endFault(const Lia& lia, int end) {
    const Mat& mat = scene_.mats[static_cast<std::size_t>(end)];
    const Section& section = scene_.sectionOf(mat);
    int& own = section_[static_cast<std::size_t>(lia.tank)];
    own = own < 0 ? mat.section : own;
    if (!isModule(mat) || mat.section != own || section.geometry != Geometry::kScalar) {
      return "shares a tank and ends on module " + quoted(mat.name) +
             ", allowed: masses, cells and grounds of one scalar section";
    }
    if (section.modes != kNoModes) {
      return "shares a tank in section " + quoted(section.name) +
             ", which is played by its modes, allowed: sections without 'modes'";
    }
    int& tank = tank_of_[static_cast<std::size_t>(end)];
    if (mat.type != MatType::kGround && tank >= 0 && tank != lia.tank) {
      return "ends on module " + quoted(mat.name) + ", which belongs to tank " +
             quoted(scene_.tanks[static_cast<std::size_t>(tank)].name) +
             " too, allowed: one tank for each module";
    }
    tank = lia.tank;
    return {};
  }

  const Scene& scene_;
  std::vector<int> section_;  // [tanks]
  std::vector<int> tank_of_;  // [mats]
};

}  // namespace

std::optional<Fault> wrongTank(const Scene& scene) {
  for (const Tank& tank : scene.tanks) {
    if (const std::string fault = tank.is_mean ? stretchFault(scene, tank) : ""; !fault.empty()) {
      return Fault{tank.place, "link " + quoted(tank.name) + " " + fault};
    }
  }
  TankRules rules(scene);
  for (const Lia& lia : scene.lias) {
    if (const std::string fault = lia.tank < 0 ? "" : rules.faultOf(lia); !fault.empty()) {
      return Fault{lia.place, "link " + quoted(lia.name) + " " + fault};
    }
  }
  return std::nullopt;
}

}  // namespace ergotic::scene
