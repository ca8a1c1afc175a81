// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <ergotic/ModelState.h>
#include <ergotic/ModelStructure.h>

#include "rviz/model_shape.hpp"

namespace ergotic::panel {

/// Quantity that makes a module glow.
enum class GlowBy : std::uint8_t {
  kSpeed,         ///< speed from one state to the next, m/s
  kDisplacement,  ///< distance from rest, m
  kForce,         ///< distance from the mean of the neighbours, which pull it back, m
  kEnergy,        ///< square of the speed, m^2/s^2
  kTension,       ///< how much longer its links are than at rest, as a share; negative: shorter. Of
                  ///< modules that move along x alone, how steep they are, whichever way
  kNothing,
};

/// Whether a state is one of this structure: it has as many coordinates as the structure has, and
/// was not taken shortly before the structure was sent, which those of an earlier model are.
bool belongs(const ModelState& state, const ModelStructure& structure);

/// Drawn positions and glow of the modules of a model. Thread: one
class ModelMotion {
 public:
  ModelMotion() = default;
  /// \pre isConsistent(structure)
  ModelMotion(const ModelStructure& structure, const ModelShape& shape);

  /// \param zoom  `display_zoom` of Handles \param gain  additional gain of displacements
  void setScale(double zoom, double gain);
  void glowBy(GlowBy quantity);
  /// \pre belongs(state, structure)
  void show(const ModelState& state);

  /// [modules] m, frame `model`. What is not finite is drawn at rest.
  const std::vector<Eigen::Vector3f>& places() const { return places_; }
  /// [modules] where they are drawn at rest.
  const std::vector<Eigen::Vector3f>& restPlaces() const { return rest_places_; }
  /// [modules] 0...1, as share of the largest of its section in the last seconds: of strings,
  /// of bars and surfaces, or of single masses. Hands and grounds do not glow. By tension it is
  /// negative, down to -1, where links are shorter than at rest.
  const std::vector<float>& glow() const { return glow_; }
  /// Along which the modules of a section move that move along x alone, length 1, frame `model`.
  Eigen::Vector3f upOf(std::size_t module) const;

 private:
  void place();
  void measure(float elapsed_s);
  float measureOf(std::size_t module, float elapsed_s) const;
  float awayFromNeighbours(std::size_t module) const;
  float tension(std::size_t module) const;
  void glow(float elapsed_s);

  struct SectionMotion {
    Eigen::Affine3f to_section;  // from frame `model`
    geometry_msgs::Pose pose;
    int dimensions = 1;
    Eigen::Matrix3f drawn = Eigen::Matrix3f::Identity();  // of displacements, with zoom and gain
  };
  std::vector<SectionMotion> sections_;
  std::vector<std::uint32_t> section_of_;  // [modules]
  std::vector<bool> can_glow_;             // [modules]
  std::vector<Eigen::Vector3f> rests_;     // [modules] in the section
  std::vector<ModuleIndices> neighbours_;  // [modules]
  std::vector<Eigen::Vector3f> now_;       // [modules] displacements in the section, m
  std::vector<Eigen::Vector3f> before_;    // [modules] of the state before
  std::vector<Eigen::Vector3f> places_;
  std::vector<Eigen::Vector3f> rest_places_;
  std::vector<float> measures_;  // [modules] of the quantity, held for a moment
  std::vector<float> glow_;
  std::vector<float> references_;            // [kinds] of what glows most
  std::vector<std::uint32_t> reference_of_;  // [modules] index into them
  GlowBy glows_by_ = GlowBy::kSpeed;
  double stamp_s_ = 0.0;  // of the latest state; 0: none came
};

}  // namespace ergotic::panel
