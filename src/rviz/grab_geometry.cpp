// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/grab_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rviz/model_bodies.hpp"
#include "rviz/model_drawing.hpp"
#include "rviz/model_graph.hpp"
#include "rviz/model_hands.hpp"
#include "rviz/model_players.hpp"

namespace ergotic::panel {
namespace {

constexpr std::size_t kAxes = 3;
constexpr double kMaxOfSliceM = 0.1;  // what a hand may want, see HandTargets
constexpr double kMaxOfCoordinateM = 1.0;
constexpr double kMaxOfModuleM = 100.0;  // see HoldTarget
constexpr double kMinCameraM = 1e-3;     // from what it looks at
constexpr double kMinSine = 0.1;  // an axis that points at the eye has no place under the mouse

bool isWhole(const ModelStructure& structure) {
  const std::size_t sections = structure.section_poses.size();
  return structure.section_dimensions.size() == sections &&
         std::all_of(structure.section_dimensions.begin(), structure.section_dimensions.end(),
                     [](std::uint8_t dimension) { return dimension >= 1 && dimension <= kAxes; }) &&
         std::all_of(structure.module_sections.begin(), structure.module_sections.end(),
                     [sections](std::uint32_t section) { return section < sections; });
}

bool fits(const Handles& handles, const ModelStructure& structure) {
  const std::size_t count = handles.modules.size();
  return handles.names.size() == count && handles.end_effectors.size() == count &&
         handles.indices.size() == kAxes * count && handles.scales.size() == kAxes * count &&
         handles.offsets.size() == kAxes * count &&
         std::all_of(handles.modules.begin(), handles.modules.end(), [&](std::uint32_t module) {
           return module < structure.module_sections.size() &&
                  kAxes * module + 2 < structure.rest_positions.size();
         });
}

}  // namespace

int Handle::axes() const {
  return static_cast<int>(
      std::count_if(indices.begin(), indices.end(), [](int index) { return index >= 0; }));
}

bool Handle::plays(const std::string& module_name) const {
  return std::binary_search(played.begin(), played.end(), bodyOf(module_name));
}

std::string Handle::label() const {
  constexpr double kMmPerM = 1e3;
  constexpr double kSeenMm = 0.005;  // below it all digits are 0
  char moved[32];
  if (dimensions == 1) {
    const double mm = kMmPerM * displacement.x();
    std::snprintf(moved, sizeof moved, std::abs(mm) < kSeenMm ? "%.2f mm" : "%+.2f mm",
                  std::abs(mm) < kSeenMm ? 0.0 : mm);
  } else {
    std::snprintf(moved, sizeof moved, "%.2f mm", kMmPerM * displacement.norm());
  }
  return name.empty() ? moved : name + "  " + moved;
}

void HandleSet::show(const ModelStructure& structure) {
  structure_ = withHandsInPlace(structure);
  ++models_;
  build();
}

void HandleSet::show(const Handles& handles) {
  message_ = handles;
  build();
}

void HandleSet::show(const ModelState& state) {
  if (state.displacement.size() != coordinates_) {
    return;
  }
  displacement_ = state.displacement;
  for (Handle& handle : handles_) {
    handle.displacement = displacementOf(handle.first, handle.dimensions);
  }
}

/// Displacement of a module; one that is not finite counts as 0.
Eigen::Vector3d HandleSet::displacementOf(std::size_t first, int dimensions) const {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  for (int k = 0; k < dimensions && !displacement_.empty(); ++k) {
    const float moved = displacement_[first + static_cast<std::size_t>(k)];
    displacement[k] = std::isfinite(moved) ? static_cast<double>(moved) : 0.0;
  }
  return displacement;
}

Eigen::Vector3d HandleSet::restOf(std::size_t module) const {
  const Eigen::Vector3d in_model =
      Eigen::Map<const Eigen::Vector3f>(&structure_.rest_positions[kAxes * module]).cast<double>();
  return drawings_[structure_.module_sections[module]].to_section * in_model;
}

Eigen::Vector3d HandleSet::placeOf(std::size_t module) const {
  const std::size_t section = structure_.module_sections[module];
  return drawings_[section].drawing *
         (restOf(module) + displacementOf(first_[module], structure_.section_dimensions[section]));
}

bool HandleSet::isPlayed(std::size_t module) const {
  return module < structure_.module_names.size() &&
         std::any_of(handles_.begin(), handles_.end(), [&](const Handle& handle) {
           return handle.plays(structure_.module_names[module]);
         });
}

Eigen::Vector3d HandleSet::restPlaceOf(std::size_t module) const {
  return drawings_[structure_.module_sections[module]].drawing * restOf(module);
}

std::vector<Eigen::Vector3d> HandleSet::places() const {
  std::vector<Eigen::Vector3d> places;
  const std::size_t modules = drawings_.empty() ? 0 : structure_.module_sections.size();
  const std::vector<bool> are_modes = modesOfOutlines(structure_);
  for (std::size_t module = 0; module < modules; ++module) {
    const Eigen::Vector3d place = restPlaceOf(module);
    if (place.allFinite() && !(module < are_modes.size() && are_modes[module])) {
      places.push_back(place);
    }
  }
  return places;
}

std::vector<Eigen::Vector3d> HandleSet::camera() const {
  std::vector<Eigen::Vector3d> camera;
  for (const geometry_msgs::Point& place : structure_.camera) {
    camera.emplace_back(place.x, place.y, place.z);
  }
  const bool is_whole = camera.size() == 2 && camera[0].allFinite() && camera[1].allFinite() &&
                        (camera[0] - camera[1]).norm() > kMinCameraM;
  return is_whole ? camera : std::vector<Eigen::Vector3d>();
}

Handle HandleSet::handleOf(std::size_t module) const {
  const std::size_t section = structure_.module_sections[module];
  Handle handle;
  handle.dimensions = structure_.section_dimensions[section];
  handle.drawing = drawings_[section].drawing;
  handle.rest = restOf(module);
  return handle;
}

Handle HandleSet::moduleAt(std::size_t module) const {
  Handle handle = handleOf(module);
  handle.module = static_cast<int>(module);
  handle.name = module < structure_.module_names.size() ? structure_.module_names[module] : "";
  handle.first = first_[module];
  handle.displacement = displacementOf(handle.first, handle.dimensions);
  for (int k = 0; k < handle.dimensions; ++k) {
    handle.indices[static_cast<std::size_t>(k)] = k;
  }
  return handle;
}

/// Structure and handles come in two messages: until both are of one model there are none.
void HandleSet::build() {
  handles_.clear();
  drawings_.clear();
  first_.clear();
  displacement_.clear();
  coordinates_ = 0;
  ++version_;
  if (!isWhole(structure_)) {
    return;
  }
  std::vector<std::size_t> first;
  for (const std::uint32_t section : structure_.module_sections) {
    first.push_back(coordinates_);
    coordinates_ += structure_.section_dimensions[section];
  }
  const bool is_placed = structure_.rest_positions.size() == kAxes * first.size();
  for (std::size_t s = 0;
       is_placed && message_.display_zoom > 0.0 && s < structure_.section_poses.size(); ++s) {
    const geometry_msgs::Pose& pose = structure_.section_poses[s];
    const bool is_scalar = structure_.section_dimensions[s] == 1;
    drawings_.push_back(
        {drawingOf(pose, is_scalar ? message_.display_zoom : 1.0), drawingOf(pose, 1.0).inverse()});
  }
  if (drawings_.empty() || !fits(message_, structure_)) {
    return;
  }
  const auto played = isConsistent(structure_)
                          ? playedBy(structure_, message_.modules)
                          : std::vector<std::vector<std::string>>(message_.modules.size());
  for (std::size_t i = 0; i < message_.modules.size(); ++i) {
    Handle handle = handleOf(message_.modules[i]);
    handle.played = played[i];
    handle.name = message_.names[i];
    handle.end_effector = message_.end_effectors[i];
    handle.first = first[message_.modules[i]];
    std::copy_n(&message_.indices[kAxes * i], kAxes, handle.indices.begin());
    std::copy_n(&message_.scales[kAxes * i], kAxes, handle.scales.begin());
    std::copy_n(&message_.offsets[kAxes * i], kAxes, handle.offsets.begin());
    handles_.push_back(std::move(handle));
  }
  findAxes();
  if (message_.can_be_held.size() == first.size()) {
    first_ = std::move(first);
  }
}

/// A hand is taken wherever its key, hammer or bow is drawn.
void HandleSet::findAxes() {
  if (handles_.empty() || !isConsistent(structure_)) {
    return;
  }
  Eigen::AlignedBox3d filled;
  for (const Eigen::Vector3d& place : places()) {
    filled.extend(place);
  }
  const ModelShape shape = shapeOf(structure_);
  const auto size = static_cast<float>(filled.isEmpty() ? 0.0 : filled.diagonal().norm());
  for (const DrawnBody& body : bodiesOf(structure_, shape, size)) {
    for (std::size_t i = 0; i < handles_.size(); ++i) {
      if (message_.modules[i] == body.module) {
        const auto ends = axisOf(body);
        handles_[i].axis = {ends[0].cast<double>(), ends[1].cast<double>()};
      }
    }
  }
}

Drag::Drag(const Handle& handle, const Ray& ray, const Eigen::Vector3d& looks)
    : handle_(handle),
      looks_(looks.normalized()),
      grabbed_(handle.place()),
      last_(grabbed_),
      displacement_(handle.displacement) {
  last_ = pointOf(ray);
}

/// Target of a ray. A handle with one axis: the point of the axis that is nearest to the ray; else
/// the point where the ray meets the plane through the handle that faces the camera.
Eigen::Vector3d Drag::pointOf(const Ray& ray) const {
  if (handle_.axes() != 1) {
    const double facing = ray.direction.dot(looks_);
    return facing < kMinSine ? last_ : ray.at((grabbed_ - ray.origin).dot(looks_) / facing);
  }
  const auto axis_index = std::find_if(handle_.indices.begin(), handle_.indices.end(),
                                       [](int index) { return index >= 0; }) -
                          handle_.indices.begin();
  const Eigen::Vector3d axis = handle_.drawing.linear().col(axis_index).normalized();
  const double cosine = axis.dot(ray.direction);
  const double sine_square = 1.0 - cosine * cosine;
  if (sine_square < kMinSine * kMinSine) {
    return last_;
  }
  const Eigen::Vector3d to_handle = grabbed_ - ray.origin;
  const double along = (cosine * ray.direction - axis).dot(to_handle) / sine_square;
  return grabbed_ + along * axis;
}

void Drag::move(const Ray& ray, double share) {
  const Eigen::Vector3d point = pointOf(ray);
  add(share * (point - last_));
  last_ = point;
}

void Drag::push(double depth_m) {
  if (handle_.axes() > 1) {
    add(depth_m * looks_);
    grabbed_ += depth_m * looks_;
    last_ += depth_m * looks_;
  }
}

HandTargets Grab::targets() const {
  const Eigen::Vector3d way = drag_.displacement() - taken_.displacement;
  HandTargets wanted;
  wanted.end_effector = taken_.end_effector;
  for (const Handle& handle : moved_) {
    const Eigen::Vector3d displaced = handle.displacement + way;
    for (std::size_t k = 0; k < kAxes; ++k) {
      if (handle.indices[k] >= 0) {
        const double target =
            handle.scales[k] * displaced[static_cast<Eigen::Index>(k)] + handle.offsets[k];
        const double most = taken_.end_effector.empty() ? kMaxOfSliceM : kMaxOfCoordinateM;
        wanted.indices.push_back(static_cast<std::uint32_t>(handle.indices[k]));
        wanted.targets.push_back(std::clamp(target, -most, most));
      }
    }
  }
  return wanted;
}

HoldTarget Grab::target() const {
  HoldTarget wanted;
  wanted.module = taken_.module;
  for (std::size_t k = 0; k < kAxes; ++k) {
    wanted.target[k] = std::clamp(drag_.displacement()[static_cast<Eigen::Index>(k)],
                                  -kMaxOfModuleM, kMaxOfModuleM);
  }
  return wanted;
}

Grab::Grab(const HandleSet& set, const Handle& handle, const Ray& ray, const Eigen::Vector3d& looks)
    : taken_(handle), drag_(handle, ray, looks) {
  for (const Handle& other : set.handles()) {
    const bool is_same = other.first == handle.first;
    if (is_same || (!handle.end_effector.empty() && other.end_effector == handle.end_effector)) {
      moved_.push_back(other);
    }
  }
}

double Grab::stretchFrom(const Eigen::Vector3d& displacement) const {
  double square = 0.0;
  for (std::size_t k = 0; k < kAxes; ++k) {
    if (taken_.indices[k] >= 0) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double way = taken_.scales[k] * (drag_.displacement()[axis] - displacement[axis]);
      square += way * way;
    }
  }
  return std::sqrt(square);
}

void Drag::add(const Eigen::Vector3d& way) {
  const Eigen::Vector3d in_section = handle_.drawing.linear().inverse() * way;
  for (int k = 0; k < 3; ++k) {
    if (handle_.indices[static_cast<std::size_t>(k)] >= 0) {
      displacement_[k] += in_section[k];
    }
  }
}

double distanceToLine(const Eigen::Vector2d& from,
                      const Eigen::Vector2d& begin,
                      const Eigen::Vector2d& end) {
  const Eigen::Vector2d way = end - begin;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp((from - begin).dot(way) / square, 0.0, 1.0) : 0.0;
  return (begin + share * way - from).norm();
}

}  // namespace ergotic::panel
