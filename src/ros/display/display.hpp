// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <ergotic/ModelState.h>
#include <ergotic/ModelStructure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ergotic/station/performer.hpp"
#include "ros/display/end_effector_frames.hpp"
#include "ros/display/markers.hpp"
#include "ros/display/newest.hpp"
#include "ros/display/outlines.hpp"

namespace ergotic::node {

/// Picture of a model. It is made by the thread that loads the model, as that takes time as well.
struct Picture {
  ModelStructure structure;  ///< without a stamp
  Markers markers;
  Outlines outlines;
};

/// Draws the model that plays, in a thread of its own: however long a picture takes, nothing else
/// waits for it. Frames that arrive meanwhile are dropped, but for the newest.
/// Thread: command thread, all but the constructor. None of these functions waits for a picture
class Display {
 public:
  Display(const ::ros::NodeHandle& node, const FrameNames& names);

  /// Shows another model from now on; null: none.
  void show(std::shared_ptr<Picture> picture);
  /// Shows other end-effectors from now on.
  void show(const tgr::EndEffectors& end_effectors);
  /// Whether there is a subscriber.
  bool isWatched() const;
  /// Shows a motion frame of the last model. It is copied only if there is a subscriber.
  void show(const station::MotionFrame& motion);

 private:
  struct News {
    std::optional<std::shared_ptr<Picture>> picture;
    std::optional<tgr::EndEffectors> end_effectors;
    bool has_moved = false;
    ModelState motion;  // keeps its memory
  };

  // Thread: the display's own.
  void draw(News& news);
  void begin(std::shared_ptr<Picture> picture);
  void draw(ModelState& motion);
  void drawMarkers(const ModelState& motion);
  void drawShapes(const ::ros::Time& stamp);

  ::ros::NodeHandle node_;
  FrameNames names_;
  ::ros::Publisher model_structure_;
  ::ros::Publisher model_state_;
  ::ros::Publisher markers_;
  ::ros::Publisher end_effector_shapes_;

  std::shared_ptr<Picture> picture_;
  EndEffectorFrames frames_;
  bool erases_ = false;         // what was drawn before, with the next frame
  bool erases_shapes_ = false;  // the same of the end-effectors alone

  Newest<News> news_;  // last: its thread needs all the others
};

}  // namespace ergotic::node
