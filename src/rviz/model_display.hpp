// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <Eigen/Geometry>
#include <ergotic/Handles.h>
#include <ergotic/ModelState.h>
#include <ergotic/ModelStructure.h>
#include <ros/ros.h>
#include <rviz/display.h>

#include "rviz/model_motion.hpp"
#include "rviz/model_picture.hpp"
#include "rviz/model_shape.hpp"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace ergotic::panel {

/// Shows the model that plays as what it is: strings, bars, surfaces and bodies, which glow where
/// they vibrate. It has all of it from the topics `model_structure`, `model_state` and `handles` of
/// a station. Thread: of the window
class ModelDisplay : public rviz::Display {
 public:
  ModelDisplay();
  ~ModelDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void subscribe();
  void unsubscribe();
  void begin(const ModelStructure::ConstPtr& structure);
  void setZoom(double zoom);
  void rebuild();
  void changeScale();
  void changeGlow();

  bool findFrame();
  void takeState();
  bool drawIfNeeded();
  void draw();
  Eigen::Vector3f eye() const;
  void tellStation();
  void tellPicture();
  void tellModel();

  // Properties belong to the display, which deletes them.
  rviz::StringProperty* station_;
  rviz::EnumProperty* colour_by_;
  rviz::FloatProperty* gain_;
  rviz::FloatProperty* thickness_;
  rviz::BoolProperty* links_;

  ros::Subscriber structure_topic_;
  ros::Subscriber state_topic_;
  ros::Subscriber handles_topic_;

  ModelStructure::ConstPtr structure_;  // null: none came
  ModelState::ConstPtr state_;          // the newest that was not shown; null: none
  double zoom_ = 1.0;
  ModelShape shape_;
  ModelMotion motion_;
  std::unique_ptr<ModelPicture> picture_;
  Eigen::Isometry3f to_model_ = Eigen::Isometry3f::Identity();  // from the fixed frame

  ros::WallTime came_;  // the latest state of this model
  bool is_stale_ = true;
  bool must_draw_ = false;
  bool has_frame_ = true;                                // until it was looked for in vain
  Eigen::Vector3f drawn_for_ = Eigen::Vector3f::Zero();  // eye of the latest picture
  double worst_ms_ = 0.0;                                // of a second's pictures
  double spent_ms_ = 0.0;
  int pictures_ = 0;
  ros::WallTime told_;
};

}  // namespace ergotic::panel
