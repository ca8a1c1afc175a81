// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scene/generate/body.hpp"

namespace ergotic::scene {

constexpr double kHighestPartialHz = 20'000.0;  ///< that a body of modes may have

/// A point that a body is touched or heard at: `<body>.<name>`.
struct BodyPlace {
  std::string name;
  double along = 0.0;   ///< fractions of its grid
  double across = 0.0;  ///< 0 in a row
  Place place;
};

/// One vibration of a body: a matched cell.
struct Partial {
  double frequency_hz = 0.0;
  double t60_s = 0.0;           ///< 0: no loss
  double mass = 1.0;            ///< kg
  std::vector<double> weights;  ///< weight at each place
};

/// A body that is its modes: cells `name.0` ..., and at each place a tap `name.<place>` with the
/// weights of that place; one that has none there is left out of it.
struct ModalSpec {
  std::string name;
  int section = 0;
  std::vector<Partial> partials;
  std::vector<std::string> places;
  std::vector<Eigen::Vector3d> seen_at;  ///< rest of each place in pictures, m; may be empty
  Outline outline;                       ///< without places: it has none
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of the first cell, m
  Place place;
};

/// Appends the body. \throws TextError if a name is taken, or no partial is felt at a place
void addModalBody(SceneBuilder& builder, const ModalSpec& spec);

/// How a body is played.
struct BodyForm {
  bool is_modal = false;
  int partials = 0;  ///< partials of modal ones; 0: all below 18 kHz, kMaxPartials at most
  std::vector<BodyPlace> places;
};

/// The vibrations of a body by itself, without its losses, by frequency. Places are fractions of
/// its length and width, as those of BodyPlace.
class Vibrations {
 public:
  /// What a picture shows of it: places, and lines between them.
  struct Drawn {
    std::vector<Eigen::Vector2d> places;
    std::vector<std::pair<int, int>> lines;
  };

  virtual ~Vibrations() = default;
  virtual int count() const = 0;
  virtual double stiffness(int mode) const = 0;  ///< as the square of its frequency, in any unit
  virtual double mass() const = 0;               ///< of the whole, kg
  virtual Eigen::Vector3d begin() const = 0;     ///< where it begins at rest, m
  /// Displacement at a place, if the mean square of that over the mass is 1.
  virtual double shape(int mode, double along, double across) const = 0;
  virtual Eigen::Vector3d rest(double along, double across) const = 0;  ///< of a place, m
  virtual Drawn drawn(int modes) const = 0;
};

/// How many vibrations of a body are needed.
int partialsOf(const BodyWish& wish, const BodyForm& form);

/// Adds a body as modes from its vibrations.
/// \throws TextError if these are too few, or a partial is above kHighestPartialHz
void addVibratingBody(SceneBuilder& builder,
                      const std::string& name,
                      int section,
                      const BodyWish& wish,
                      const BodyForm& form,
                      Place place,
                      const Vibrations& body);

/// Adds a network of a body with a pitch to a scene, in a section.
using AddNetwork = std::function<void(SceneBuilder& builder, int section, const BodyWish& wish)>;

/// Adds a body with a pitch: the network itself, with a tap at each place; or the modes of one,
/// which are in tune at every rate and need none to be stable. Motions as a whole are left out
/// then. \throws TextError as the network does, or if a partial is above kHighestPartialHz
void addBody(SceneBuilder& builder,
             const std::string& name,
             int section,
             const BodyWish& wish,
             const BodyForm& form,
             Place place,
             const AddNetwork& network);

}  // namespace ergotic::scene
