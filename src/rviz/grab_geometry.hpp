// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <ergotic/HandTargets.h>
#include <ergotic/Handles.h>
#include <ergotic/HoldTarget.h>
#include <ergotic/ModelState.h>
#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

/// Ray from the eye through the mouse pointer, in frame `model`.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< of length 1

  Eigen::Vector3d at(double distance) const { return origin + distance * direction; }
};

/// A module that can be taken: its drawn position, and its mover.
struct Handle {
  std::string name;
  int module = -1;           ///< index in ModelStructure, if a hand holds the module itself
  std::string end_effector;  ///< end-effector of its coordinates; empty: slices
  std::array<int, 3> indices{-1, -1, -1};
  std::array<double, 3> scales{1.0, 1.0, 1.0};
  std::array<double, 3> offsets{};
  Eigen::Affine3d drawing = Eigen::Affine3d::Identity();   ///< from its section to the picture
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();          ///< m, in its section
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of now
  std::size_t first = 0;                                   ///< of its displacements in ModelState
  /// Both ends of what is drawn of it, m from its place, frame `model`; 0 if it is a point.
  std::array<Eigen::Vector3d, 2> axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::vector<std::string> played;  ///< strings, bars and surfaces that it plays, see playedBy
  int dimensions = 1;

  /// Drawn position at a displacement, m.
  Eigen::Vector3d placeAt(const Eigen::Vector3d& displaced) const {
    return drawing * (rest + displaced);
  }
  Eigen::Vector3d place() const { return placeAt(displacement); }
  int axes() const;  ///< number of axes along which it can be moved
  /// Whether it plays the string, bar or surface to which a module of this name belongs.
  bool plays(const std::string& module_name) const;
  /// Its name, and its distance from rest, mm: with a sign if it moves along x alone.
  std::string label() const;
};

/// The handles of the model that plays. Thread: one
class HandleSet {
 public:
  void show(const ModelStructure& structure);
  void show(const Handles& handles);
  /// Takes a state. A state with another number of coordinates belongs to another model, and is
  /// ignored.
  void show(const ModelState& state);

  const std::vector<Handle>& handles() const { return handles_; }
  /// Handle for a module that a hand can hold anywhere, in its present state. \pre below modules()
  Handle moduleAt(std::size_t module) const;
  /// Number of modules of the structure, once its handles have arrived, else 0.
  std::size_t modules() const { return first_.size(); }
  /// Calls `visit(module, drawn position, drawn position at rest)` for all modules that can be
  /// held.
  template <class Visit>
  void forEachModule(const Visit& visit) const {
    for (std::size_t module = 0; module < modules(); ++module) {
      if (message_.can_be_held[module] != 0) {
        visit(module, placeOf(module), restPlaceOf(module));
      }
    }
  }
  /// Whether a hand plays the string, bar or surface that this module is of.
  bool isPlayed(std::size_t module) const;
  /// Name of the frame `model` of its station.
  const std::string& frame() const { return structure_.header.frame_id; }
  /// Drawn positions of all modules at rest, frame `model`, m; empty until the structure is known.
  /// Modes of a body with an outline are left out.
  std::vector<Eigen::Vector3d> places() const;
  /// Camera position and target of the scene, frame `model`, m; empty: the scene gives none.
  std::vector<Eigen::Vector3d> camera() const;
  /// Number of models so far.
  int models() const { return models_; }
  /// Number of changes of the handles so far.
  int version() const { return version_; }

 private:
  struct Drawing {
    Eigen::Affine3d drawing;     // from the section to the picture
    Eigen::Affine3d to_section;  // from frame `model`
  };
  void build();
  Handle handleOf(std::size_t module) const;
  void findAxes();
  Eigen::Vector3d restOf(std::size_t module) const;
  Eigen::Vector3d displacementOf(std::size_t first, int dimensions) const;
  Eigen::Vector3d placeOf(std::size_t module) const;
  Eigen::Vector3d restPlaceOf(std::size_t module) const;

  ModelStructure structure_;
  Handles message_;
  std::vector<float> displacement_;  // of ModelState; empty: none came
  std::vector<Drawing> drawings_;    // [sections]
  std::vector<std::size_t> first_;   // [modules] of its displacements; empty: nothing can be held
  std::vector<Handle> handles_;
  std::size_t coordinates_ = 0;
  int models_ = 0;
  int version_ = 0;
};

/// A handle that follows the mouse: along its axis if it has but one, else in the plane that faces
/// the camera, from where both were when it was taken.
class Drag {
 public:
  /// \param looks  the camera's direction of view, frame `model`
  Drag(const Handle& handle, const Ray& ray, const Eigen::Vector3d& looks);

  /// The mouse has moved. \param share  of its way that counts: below 1 for fine motion
  void move(const Ray& ray, double share);
  /// Nearer or farther along the view, m in the picture.
  void push(double depth_m);

  /// Target of the handle, m from its rest, in its section.
  const Eigen::Vector3d& displacement() const { return displacement_; }

 private:
  Eigen::Vector3d pointOf(const Ray& ray) const;
  void add(const Eigen::Vector3d& way);

  Handle handle_;
  Eigen::Vector3d looks_;
  Eigen::Vector3d grabbed_;  // where the mouse took it, in the picture
  Eigen::Vector3d last_;     // of the mouse, on the axis or in the plane
  Eigen::Vector3d displacement_;
};

/// Handle in the hand of a player. All modules of an end-effector move together.
class Grab {
 public:
  Grab(const HandleSet& set, const Handle& handle, const Ray& ray, const Eigen::Vector3d& looks);

  Drag& drag() { return drag_; }
  const Handle& handle() const { return taken_; }  ///< as it was when it was taken
  /// Target in the picture.
  Eigen::Vector3d place() const { return taken_.placeAt(drag_.displacement()); }
  /// Distance between target and present position, m of coordinate or slice.
  double stretchFrom(const Eigen::Vector3d& displacement) const;
  /// Message to the station, with targets within a hand's range; without a stamp.
  HandTargets targets() const;
  /// Message for a module that is held itself. \pre handle().module >= 0
  HoldTarget target() const;

 private:
  Handle taken_;
  std::vector<Handle> moved_;  // as they were when it was taken
  Drag drag_;
};

/// From a point to the nearest one of a line between two, all in one unit.
double distanceToLine(const Eigen::Vector2d& from,
                      const Eigen::Vector2d& begin,
                      const Eigen::Vector2d& end);

/// What a hand with that stiffness and most force gives over a distance, N.
inline double pullOf(double stiffness, double most_n, double distance_m) {
  return std::min(stiffness * distance_m, most_n);
}

}  // namespace ergotic::panel
