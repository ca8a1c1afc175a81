// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/pose.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "scene/language/language_keys.hpp"
#include "scene/limits.hpp"
#include "scene/text/number.hpp"
#include "scene/text/quantity.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kSheets[] = {"mesh", "membrane", "plate"};  // along the axes of their section
constexpr const char* kSpot[] = {"mesh", "membrane", "plate",
                                 "resonator"};  // have one place, 0 if none

std::vector<double> numbersOf(const SceneBuilder& builder,
                              const Node& node,
                              const std::string& what,
                              const Limits& limits,
                              std::size_t fewest,
                              const char* allowed) {
  std::vector<double> numbers;
  if (node.isScalar() && fewest == 1) {
    return {numberOf(builder, node, what, limits, node.place())};
  }
  if (!node.isList() || node.size() < std::max<std::size_t>(fewest, 2) || node.size() > 3) {
    builder.fail(node.place(), what + " is " + kindOf(node) + ", allowed: " + allowed);
  }
  for (const Node& item : node) {
    numbers.push_back(numberOf(builder, item, what, limits, node.place()));
  }
  return numbers;
}

/// The numbers of a list, or of the one that stands in its place; none if it holds anything else,
/// which its reader will refuse.
std::optional<Eigen::Vector3d> vectorIn(const Node& node, const char* unit) {
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  const std::size_t count = node.isList() ? node.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Node& item = node.isList() ? node[i] : node;
    const auto number = item.isScalar() && i < 3 ? parseQuantity(item.text(), unit)
                                                 : std::variant<double, NoQuantity>(NoQuantity{});
    if (!std::holds_alternative<double>(number)) {
      return std::nullopt;
    }
    vector[static_cast<Eigen::Index>(i)] = std::get<double>(number);
  }
  return vector;
}

Node listOf(const Eigen::Vector3d& numbers, Eigen::Index count, Place place) {
  Node list(Node::Kind::kList, place);
  for (Eigen::Index i = 0; i < count; ++i) {
    list.add({Node::Kind::kScalar, place, shortest(numbers[i])});
  }
  return list;
}

class Mover {
 public:
  Mover(const Pose& pose, const std::string& geometry, Node& element)
      : pose_(pose),
        is_scalar_(geometry == "scalar"),
        element_(element),
        moving_(geometry == "space"   ? 3
                : geometry == "plane" ? 2
                                      : 1) {}

  /// A place at rest. \param is_needed  it is zeros where it is not said
  void place(const std::string& key, bool is_needed) {
    Node* const node = find(key);
    if (node == nullptr && !is_needed) {
      return;
    }
    const Node zeros(Node::Kind::kList, element_.place());
    const std::optional<Eigen::Vector3d> at = vectorIn(node == nullptr ? zeros : *node, "m");
    if (!at || (node != nullptr && !node->isList())) {
      return;
    }
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    if (is_scalar_) {
      to.head<2>() = pose_.bench * Eigen::Vector2d(at->head<2>());
    } else {
      to = pose_.space * *at;
    }
    put(key, node,
        listOf(to, is_scalar_ ? 2 : 3, node == nullptr ? element_.place() : node->place()));
  }
  /// Moves a vector of the coordinates that move.
  void moving(const std::string& key, bool is_place) {
    Node* const node = find(key);
    if (node == nullptr || is_scalar_) {
      return;
    }
    if (const auto at = vectorIn(*node, is_place ? "m" : "m/s")) {
      const Eigen::Vector3d to =
          is_place ? pose_.space * *at : Eigen::Vector3d(pose_.space.linear() * *at);
      put(key, node, listOf(to, moving_, node->place()));
    }
  }

 private:
  Node* find(const std::string& key) {
    for (std::size_t i = 0; i + 1 < element_.parts().size(); i += 2) {
      if (element_[i].text() == key) {
        return &element_.parts()[i + 1];
      }
    }
    return nullptr;
  }
  void put(const std::string& key, Node* node, Node value) {
    if (node != nullptr) {
      *node = std::move(value);
      return;
    }
    element_.add({Node::Kind::kScalar, element_.place(), key});
    element_.add(std::move(value));
  }

  const Pose& pose_;
  bool is_scalar_;
  Node& element_;
  Eigen::Index moving_;
};

}  // namespace

Pose Pose::operator*(const Pose& inner) const {
  return {is_moved || inner.is_moved, is_turned || inner.is_turned, bench * inner.bench,
          space * inner.space};
}

Pose poseOf(const SceneBuilder& builder, const Node* at, const Node* rotate) {
  Pose pose;
  if (at != nullptr) {
    const std::vector<double> place =
        numbersOf(builder, *at, "'at' of an instance", kMetreLimits, 2, "[y, z] or [x, y, z], m");
    pose.is_moved = true;
    pose.space.translation().head(static_cast<Eigen::Index>(place.size())) =
        Eigen::Map<const Eigen::VectorXd>(place.data(), static_cast<Eigen::Index>(place.size()));
    pose.bench.translation() = Eigen::Vector2d(place[place.size() - 2], place[place.size() - 1]);
  }
  if (rotate != nullptr) {
    const std::vector<double> angles =
        numbersOf(builder, *rotate, "'rotate' of an instance", kAngleLimits, 1,
                  "an angle, or [roll, pitch, yaw]");
    if (angles.size() == 2) {
      builder.fail(rotate->place(),
                   "'rotate' of an instance is a list of 2, allowed: an angle, or "
                   "[roll, pitch, yaw]");
    }
    const bool is_about_all = angles.size() == 3;
    pose.is_moved = pose.is_turned = true;
    pose.space.linear() =
        (Eigen::AngleAxisd(angles.back(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(is_about_all ? angles[1] : 0.0, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(is_about_all ? angles[0] : 0.0, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    // What is seen of a scalar section is its workbench, y and z.
    pose.bench.linear() = Eigen::Rotation2Dd(angles.front()).toRotationMatrix();
  }
  return pose;
}

void moveTo(const SceneBuilder& builder,
            const Pose& pose,
            const std::string& part,
            const std::string& geometry,
            Node& element) {
  const Node* const type = element.find("type");
  const std::string word = type == nullptr ? "" : type->text();
  if (!pose.is_moved || word == "point" || word == "tap" || !element.isMap()) {
    return;
  }
  if (pose.is_turned && (contains(kSheets, word) || geometry == "line")) {
    builder.fail(element.place(), "an instance that is turned has a '" + word +
                                      "' along the axes of its section, allowed: 'rotate' where "
                                      "there are strings, bars and single modules in scalar "
                                      "sections, planes and space");
  }
  if (geometry == "plane" && pose.space.linear().col(2) != Eigen::Vector3d::UnitZ()) {
    builder.fail(element.place(),
                 "an instance in a plane is turned out of it, allowed: 'rotate' by an angle");
  }
  Mover mover(pose, geometry, element);
  const bool is_generated = part == "generators";
  const bool is_bar = is_generated && word == "bar";
  const bool is_long = is_bar || element.find("to") != nullptr;
  mover.place("from", is_long);
  mover.place("to", is_bar);
  mover.place("at", is_generated ? contains(kSpot, word) : !is_long);
  mover.moving("x", true);
  mover.moving("v", false);
}

}  // namespace ergotic::scene
