// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ergotic/scene/scene.hpp"

namespace ergotic::tgr {

enum class EndEffectorType : std::uint8_t {
  kKey,     ///< 1 slice, 1 coordinate: a lever
  kBow,     ///< 2 slices, 2 coordinates: along the bow, and its pressure
  kStick,   ///< 2 or 3 slices, as many coordinates: a tip on a gimbal, x y (z along the stick)
  kBall,    ///< 3 slices, 3 coordinates: x y z of a point in a parallel linkage
  kHandle,  ///< 6 slices, 3 coordinates for each of its points, which are at least three
};

/// Configuration of an end-effector on a group of slices: its geometry, and the ports of the scene
/// that it moves. The equations of each type are in docs/tgr.md.
struct EndEffectorConfig {
  std::string name;
  EndEffectorType type = EndEffectorType::kKey;
  std::vector<int> slices;  ///< slices of the device, in the order of the type
  std::vector<std::string>
      ports;                      ///< ports of the scene, one for each coordinate; empty name: none
  double position_scale = 1.0;    ///< x_model = x / position_scale
  double force_scale = 1.0;       ///< F_hand = force_scale F_model
  double lever = 1.0;             ///< key, bow: m of the coordinate per m of the slice
  double angle = 0.0;             ///< bow: between its slices' and its own axes, rad
  double arm = 0.1;               ///< stick: from its pivot to where the slices push, m
  double length = 0.3;            ///< stick: from its pivot to its tip, m
  double rod = 0.15;              ///< ball, handle: length of each rod, m
  double base_radius = 0.1;       ///< ball, handle: radius of the circle of slices, m
  double platform_radius = 0.05;  ///< ball, handle: of the circle on which the rods end, m
  std::vector<Eigen::Vector3d> points;  ///< handle: where its points are, from its centre, m
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in tgr_base, for the picture
  scene::Place place;
};

/// End-effectors of a device. Slices and ports that none of them names stay as the scene says: a
/// port with a slice moves with it.
struct EndEffectors {
  std::string file;  ///< name of the file, for messages
  std::vector<EndEffectorConfig> list;
};

/// Reads `end_effectors: {name: {type: ..., slices: [...], ports: [...], ...}}`; an empty text is
/// none, and `devices` beside it is passed over. \throws TextError with file:line:col, value and
/// allowed range
EndEffectors readEndEffectors(const std::string& text, const std::string& name);
std::string toYaml(const EndEffectors& end_effectors);

/// The map of one end-effector from slices to coordinates, a pure function: neither scale nor
/// ports. Where the linkage cannot be, `forward` says so. Realtime: yes, but the maker.
class Kinematics {
 public:
  virtual ~Kinematics() = default;
  int slices() const noexcept { return slices_; }
  int coordinates() const noexcept { return coordinates_; }

  /// \param q              [slices] m from rest
  /// \param[out] x         [coordinates] m from where they are with all slices at rest
  /// \param[out] jacobian  [coordinates][slices] dx/dq, row by row
  /// \return false beyond the workspace; nothing is written then
  virtual bool forward(const double* q, double* x, double* jacobian) const noexcept = 0;
  /// Pose of the end-effector in its own frame, for display. \pre forward(q) is true
  virtual Eigen::Isometry3d pose(const double* q) const noexcept = 0;

  static constexpr int kMaxSlicesOfOne = 6;
  static constexpr int kMaxCoordinates = 24;  ///< eight points of a handle

 protected:
  Kinematics(int slices, int coordinates) noexcept : slices_(slices), coordinates_(coordinates) {}

 private:
  int slices_;
  int coordinates_;
};

/// Moves slices until the coordinates are as near to the wanted ones as they get, in the sense of
/// least squares: a handle has more coordinates than slices. Levenberg-Marquardt, from `q` on, and
/// never out of the workspace. Realtime: no
///
/// \param x          [coordinates] m, wanted
/// \param most       slices stay within +-most, m
/// \param[in,out] q  [slices] m from rest, within the workspace
/// \return what is left between the coordinates and the wanted ones, m (norm)
double bringTo(const Kinematics& kinematics, const double* x, double most, double* q) noexcept;

/// \throws TextError (place of the end-effector) if a dimension is out of range or the linkage
///         cannot be put together
std::unique_ptr<Kinematics> makeKinematics(const EndEffectorConfig& config,
                                           const std::string& file);

}  // namespace ergotic::tgr
