// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rviz/model_drawing.hpp"

namespace ergotic::panel {
namespace {

// A clock that was set back while a model plays must not hide it.
constexpr double kLongestHandOverS = 5.0;
constexpr float kHoldS = 0.12F;  // in which what glows fades to 1/e, so that it does not flicker
constexpr float kReferenceS = 4.0F;  // the same for what it is compared with
constexpr float kMinElapsedS = 1e-3F;
constexpr float kMaxElapsedS = 1.0F;
constexpr float kMinM = 2e-6F;       // below which nothing is seen to glow
constexpr float kMinStrain = 1e-4F;  // of a link
constexpr float kMinSpeed = 6e-5F;   // m/s, the same at 30 states per second

/// Kinds of modules for the scale of the glow. Each kind has a scale of its own: a hammer that
/// flies would outshine the string that it has struck, and the string the soundboard.
constexpr std::uint32_t kKinds = 3;
std::uint32_t kindOf(ModuleLook look) {
  switch (look) {
    case ModuleLook::kString:
      return 0;
    case ModuleLook::kBar:
    case ModuleLook::kSurface:
      return 1;
    default:
      return 2;
  }
}

std::size_t coordinatesOf(const ModelStructure& structure) {
  std::size_t coordinates = 0;
  for (const std::uint32_t section : structure.module_sections) {
    coordinates += structure.section_dimensions[section];
  }
  return coordinates;
}

float leastOf(GlowBy quantity) {
  switch (quantity) {
    case GlowBy::kSpeed:
      return kMinSpeed;
    case GlowBy::kEnergy:
      return kMinSpeed * kMinSpeed;
    case GlowBy::kTension:
      return kMinStrain;
    default:
      return kMinM;
  }
}

}  // namespace

bool belongs(const ModelState& state, const ModelStructure& structure) {
  const double age_s = (structure.header.stamp - state.header.stamp).toSec();
  const bool is_older = age_s > 0.0 && age_s < kLongestHandOverS;
  return !is_older && state.displacement.size() == coordinatesOf(structure);
}

ModelMotion::ModelMotion(const ModelStructure& structure, const ModelShape& shape)
    : section_of_(structure.module_sections),
      now_(section_of_.size(), Eigen::Vector3f::Zero()),
      before_(now_),
      measures_(section_of_.size()),
      glow_(section_of_.size()),
      references_(kKinds * structure.section_poses.size()) {
  for (std::size_t s = 0; s < structure.section_poses.size(); ++s) {
    SectionMotion section;
    section.pose = structure.section_poses[s];
    section.to_section = drawingOf(section.pose, 1.0).inverse().cast<float>();
    section.dimensions = structure.section_dimensions[s];
    sections_.push_back(section);
  }
  const LinkGraph graph(structure, [](std::size_t) { return true; });
  for (std::size_t i = 0; i < section_of_.size(); ++i) {
    const ModuleLook look = shape.looks[i];
    rests_.emplace_back(sections_[section_of_[i]].to_section * restOf(structure, i));
    can_glow_.push_back(look != ModuleLook::kHand && look != ModuleLook::kGround &&
                        look != ModuleLook::kHidden);
    neighbours_.push_back(graph.of(i));
    reference_of_.push_back(kKinds * section_of_[i] + kindOf(look));
  }
  setScale(1.0, 1.0);
}

void ModelMotion::setScale(double zoom, double gain) {
  rest_places_.clear();
  std::vector<Eigen::Affine3f> drawings;
  for (SectionMotion& section : sections_) {
    const Eigen::Affine3d drawing = drawingOf(section.pose, section.dimensions == 1 ? zoom : 1.0);
    section.drawn = (gain * drawing.linear()).cast<float>();
    drawings.push_back(drawing.cast<float>());
  }
  for (std::size_t i = 0; i < rests_.size(); ++i) {
    rest_places_.emplace_back(drawings[section_of_[i]] * rests_[i]);
  }
  place();
}

void ModelMotion::glowBy(GlowBy quantity) {
  glows_by_ = quantity;
  std::fill(measures_.begin(), measures_.end(), 0.0F);
  std::fill(glow_.begin(), glow_.end(), 0.0F);
  std::fill(references_.begin(), references_.end(), 0.0F);
}

Eigen::Vector3f ModelMotion::upOf(std::size_t module) const {
  return sections_[section_of_[module]].drawn.col(0).normalized();
}

void ModelMotion::show(const ModelState& state) {
  std::swap(now_, before_);
  const float* moved = state.displacement.data();
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const int dimensions = sections_[section_of_[i]].dimensions;
    for (int k = 0; k < 3; ++k) {
      now_[i][k] = k < dimensions && std::isfinite(moved[k]) ? moved[k] : 0.0F;
    }
    moved += dimensions;
  }
  const double stamp_s = state.header.stamp.toSec();
  const double previous_s = std::exchange(stamp_s_, stamp_s);
  if (previous_s == 0.0 || stamp_s <= previous_s) {
    before_ = now_;  // it was not seen to move, or a recording begins anew
  }
  place();
  measure(std::clamp(static_cast<float>(stamp_s - previous_s), kMinElapsedS, kMaxElapsedS));
}

void ModelMotion::place() {
  places_.resize(now_.size());
  for (std::size_t i = 0; i < now_.size(); ++i) {
    places_[i] = rest_places_[i] + sections_[section_of_[i]].drawn * now_[i];
  }
}

void ModelMotion::measure(float elapsed_s) {
  if (glows_by_ == GlowBy::kNothing) {
    return;
  }
  const float kept = std::exp(-elapsed_s / kHoldS);
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (can_glow_[i]) {
      const float before = kept * measures_[i];
      const float now = measureOf(i, elapsed_s);
      measures_[i] = std::abs(now) >= std::abs(before) ? now : before;
    }
  }
  glow(elapsed_s);
}

float ModelMotion::measureOf(std::size_t module, float elapsed_s) const {
  switch (glows_by_) {
    case GlowBy::kSpeed:
      return (now_[module] - before_[module]).norm() / elapsed_s;
    case GlowBy::kEnergy:
      return (now_[module] - before_[module]).squaredNorm() / (elapsed_s * elapsed_s);
    case GlowBy::kForce:
      return awayFromNeighbours(module);
    case GlowBy::kTension:
      return tension(module);
    default:
      return now_[module].norm();
  }
}

float ModelMotion::awayFromNeighbours(std::size_t module) const {
  const ModuleIndices& around = neighbours_[module];
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const std::uint32_t other : around) {
    sum += now_[other] - now_[module];
  }
  return around.empty() ? 0.0F : sum.norm() / static_cast<float>(around.size());
}

float ModelMotion::tension(std::size_t module) const {
  const ModuleIndices& around = neighbours_[module];
  const bool is_scalar = sections_[section_of_[module]].dimensions == 1;
  float sum = 0.0F;
  for (const std::uint32_t other : around) {
    const Eigen::Vector3f moved = now_[other] - now_[module];
    const Eigen::Vector3f rest = rests_[other] - rests_[module];
    const float length = rest.norm();  // neighbours lie apart
    sum += (is_scalar ? moved.norm() : (rest + moved).norm() - length) / length;
  }
  return around.empty() ? 0.0F : sum / static_cast<float>(around.size());
}

/// Less than in proportion, so that what moves a tenth as much is still seen.
void ModelMotion::glow(float elapsed_s) {
  const float kept = std::exp(-elapsed_s / kReferenceS);
  for (float& reference : references_) {
    reference = std::max(kept * reference, leastOf(glows_by_));
  }
  for (std::size_t i = 0; i < measures_.size(); ++i) {
    float& reference = references_[reference_of_[i]];
    reference = std::max(reference, std::abs(measures_[i]));
  }
  for (std::size_t i = 0; i < measures_.size(); ++i) {
    const float root = std::sqrt(std::abs(measures_[i]) / references_[reference_of_[i]]);
    glow_[i] = std::copysign(root * std::sqrt(root), measures_[i]);
  }
}

}  // namespace ergotic::panel
