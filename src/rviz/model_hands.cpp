// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_hands.hpp"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "rviz/model_touch.hpp"

namespace ergotic::panel {
namespace {

constexpr float kBeside = 0.03F;  // of the size of the model: nearer is in place
constexpr float kMinBesideM = 1e-3F;
constexpr float kMinLengthM = 1e-6F;

/// A link as one of its modules sees it.
struct LinkEnd {
  std::uint32_t other = 0;
  Touch touch = Touch::kNone;
};
using LinkEnds = std::vector<std::vector<LinkEnd>>;  // [modules]

LinkEnds linkEndsOf(const ModelStructure& structure) {
  const std::vector<Touch> touches = touchesOf(structure);
  LinkEnds ends(structure.module_sections.size());
  for (std::size_t link = 0; link < touches.size(); ++link) {
    const std::uint32_t a = structure.links[2 * link];
    const std::uint32_t b = structure.links[2 * link + 1];
    ends[a].push_back({b, touches[link]});
    ends[b].push_back({a, touches[link]});
  }
  return ends;
}

bool isHand(ModuleLook look) {
  return look == ModuleLook::kHand;
}

/// Whether a module makes a string, a bar or a surface with others.
bool isOfPart(ModuleLook look) {
  return look == ModuleLook::kString || look == ModuleLook::kBar || look == ModuleLook::kSurface;
}

/// x of its section in frame `model`.
Eigen::Vector3f axisOf(const ModelStructure& structure, std::size_t module) {
  const auto& q = structure.section_poses[structure.module_sections[module]].orientation;
  const Eigen::Quaterniond turn(q.w, q.x, q.y, q.z);
  return (turn * Eigen::Vector3d::UnitX()).cast<float>();
}

bool movesAlongX(const ModelStructure& structure, std::size_t module) {
  return structure.section_dimensions[structure.module_sections[module]] == 1;
}

class FormFinder {
 public:
  FormFinder(const ModelStructure& structure, const ModelShape& shape)
      : structure_(structure), looks_(shape.looks), ends_(linkEndsOf(structure)) {}

  HandBody bodyOf(std::uint32_t module) const {
    HandBody body;
    const ModuleLook look = looks_[module];
    if (!isHand(look) && look != ModuleLook::kMass) {
      return body;
    }
    const LinkEnd* const touched = touchedBy(module);
    body.form = touched != nullptr                       ? formOf(module, touched->touch)
                : isHand(look) && !ends_[module].empty() ? HandForm::kKey
                                                         : HandForm::kNone;
    turn(module, touched, body);
    return body;
  }

 private:
  /// Contact link of a module to a string, bar, surface, or a point on one; null if there is none.
  const LinkEnd* touchedBy(std::uint32_t module) const {
    const auto& ends = ends_[module];
    const auto found = std::find_if(ends.begin(), ends.end(), [&](const LinkEnd& end) {
      const ModuleLook other = looks_[end.other];
      return end.touch != Touch::kNone && (isOfPart(other) || other == ModuleLook::kPoint);
    });
    return found != ends.end() ? &*found : nullptr;
  }
  HandForm formOf(std::uint32_t module, Touch touch) const {
    switch (touch) {
      case Touch::kPluck:
        return HandForm::kPlectrum;
      case Touch::kRub:
        return HandForm::kBow;
      case Touch::kStrike:
        return HandForm::kHammer;
      default:
        return isHand(looks_[module]) || isHeld(module) ? HandForm::kFinger : HandForm::kHammer;
    }
  }
  /// Whether a hand holds the module by a link that is no contact.
  bool isHeld(std::uint32_t module) const {
    const auto& ends = ends_[module];
    return std::any_of(ends.begin(), ends.end(), [&](const LinkEnd& end) {
      return end.touch == Touch::kNone && isHand(looks_[end.other]);
    });
  }

  void turn(std::uint32_t module, const LinkEnd* touched, HandBody& body) const {
    const Eigen::Vector3f here = restOf(structure_, module);
    const Eigen::Vector3f there = touched != nullptr ? restOf(structure_, touched->other) : here;
    if (movesAlongX(structure_, module)) {
      const Eigen::Vector3f axis = axisOf(structure_, module);
      body.towards = (there - here).dot(axis) < 0.0F ? Eigen::Vector3f(-axis) : axis;
    } else if ((there - here).norm() > kMinLengthM) {
      body.towards = (there - here).normalized();
    }
    body.along = body.towards.unitOrthogonal();
    if (touched != nullptr) {
      alignWith(touched->other, body);
    }
  }
  /// Aligns a hand with a link inside of the part that it touches.
  void alignWith(std::uint32_t touched, HandBody& body) const {
    for (const LinkEnd& end : ends_[touched]) {
      const Eigen::Vector3f way = restOf(structure_, end.other) - restOf(structure_, touched);
      const Eigen::Vector3f across = way - way.dot(body.towards) * body.towards;
      if (isOfPart(looks_[end.other]) && across.norm() > kMinLengthM) {
        body.along = across.normalized();
        return;
      }
    }
  }

  const ModelStructure& structure_;
  const std::vector<ModuleLook>& looks_;
  LinkEnds ends_;
};

class Placing {
 public:
  explicit Placing(ModelStructure& structure)
      : structure_(structure),
        shape_(shapeOf(structure)),
        ends_(linkEndsOf(structure)),
        is_placed_(shape_.looks.size()) {
    Eigen::AlignedBox3f filled;
    for (std::size_t i = 0; i < is_placed_.size(); ++i) {
      is_placed_[i] = isOfPart(shape_.looks[i]);
      if (is_placed_[i] && restOf(structure_, i).allFinite()) {
        filled.extend(restOf(structure_, i));
      }
    }
    beside_ = filled.isEmpty() ? 0.0F : std::max(kBeside * filled.diagonal().norm(), kMinBesideM);
  }

  /// Places the hands: first those that touch the parts, then those that move these, and so on.
  void run() {
    placePoints();
    for (bool has_moved = beside_ > 0.0F; has_moved;) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t module : shape_.bodies) {
        if (!is_placed_[module] && movesAlongX(structure_, module) && place(module)) {
          next.push_back(module);
        }
      }
      for (const std::uint32_t module : next) {
        is_placed_[module] = true;
      }
      has_moved = !next.empty();
    }
  }

 private:
  /// Points that lie on a string or a surface, but not on its fixed ends.
  void placePoints() {
    for (const std::uint32_t point : shape_.bodies) {
      is_placed_[point] = shape_.looks[point] == ModuleLook::kPoint && liesOnPart(point);
    }
  }
  bool liesOnPart(std::uint32_t point) const {
    float least = 2.0F * beside_;  // between the modules of a coarse net, too
    bool is_fixed = true;
    for (std::size_t i = 0; i < is_placed_.size(); ++i) {
      const float distance = (restOf(structure_, i) - restOf(structure_, point)).norm();
      if (isOfPart(shape_.looks[i]) && distance < least) {
        least = distance;
        is_fixed = structure_.module_types[i] == ModelStructure::GROUND;
      }
    }
    return !is_fixed;
  }
  /// \return whether it has a place now
  bool place(std::uint32_t module) {
    const auto wanted = wantedPlace(module);
    if (wanted) {
      const Eigen::Vector3f axis = axisOf(structure_, module);
      const Eigen::Vector3f way = *wanted - restOf(structure_, module);
      const Eigen::Vector3f aside = way - way.dot(axis) * axis;
      if (aside.norm() > beside_) {
        Eigen::Map<Eigen::Vector3f>(&structure_.rest_positions[std::size_t{3} * module]) += aside;
      }
    }
    return wanted.has_value();
  }
  /// The middle of what it acts on that has a place; of contacts alone, if there are any.
  std::optional<Eigen::Vector3f> wantedPlace(std::uint32_t module) const {
    for (const bool touches : {true, false}) {
      Eigen::AlignedBox3f acted_on;
      for (const LinkEnd& end : ends_[module]) {
        if (is_placed_[end.other] && (end.touch != Touch::kNone) == touches) {
          acted_on.extend(restOf(structure_, end.other));
        }
      }
      if (!acted_on.isEmpty()) {
        const Eigen::Vector3f axis = axisOf(structure_, module);
        const Eigen::Vector3f size = acted_on.sizes();
        const bool is_one_place = (size - size.dot(axis) * axis).norm() < 2.0F * beside_;
        return is_one_place ? std::optional<Eigen::Vector3f>(acted_on.center()) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  ModelStructure& structure_;
  ModelShape shape_;
  LinkEnds ends_;
  std::vector<bool> is_placed_;  // [modules]
  float beside_ = 0.0F;          // m
};

}  // namespace

std::vector<HandBody> handsOf(const ModelStructure& structure, const ModelShape& shape) {
  const FormFinder finder(structure, shape);
  std::vector<HandBody> hands;
  for (const std::uint32_t module : shape.bodies) {
    hands.push_back(finder.bodyOf(module));
  }
  return hands;
}

ModelStructure withHandsInPlace(ModelStructure structure) {
  if (isConsistent(structure)) {
    Placing(structure).run();
  }
  return structure;
}

}  // namespace ergotic::panel
