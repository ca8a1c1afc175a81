// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_display.hpp"

#include <OgreCamera.h>
#include <OgreSceneNode.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>

#include "rviz/model_hands.hpp"

namespace ergotic::panel {
namespace {

constexpr double kStaleS = 1.5;     // without a state; the station sends at least one a second
constexpr double kTellS = 1.0;      // from one look at the times to the next
constexpr float kMovedEye = 1e-3F;  // of its distance from the model

struct GlowOption {
  const char* name;
  GlowBy quantity;
};
constexpr std::array<GlowOption, 6> kGlowOptions = {{{"speed", GlowBy::kSpeed},
                                                     {"displacement", GlowBy::kDisplacement},
                                                     {"force", GlowBy::kForce},
                                                     {"energy", GlowBy::kEnergy},
                                                     {"tension", GlowBy::kTension},
                                                     {"section", GlowBy::kNothing}}};

Eigen::Vector3f eigenOf(const Ogre::Vector3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

ModelDisplay::ModelDisplay() {
  station_ = new rviz::StringProperty("Station", "/station", "Name of the station's node.", this);
  colour_by_ = new rviz::EnumProperty(
      "Colour by", kGlowOptions[0].name,
      "What makes parts of the model glow: their speed from picture to picture, their displacement "
      "from rest, the force by which their neighbours pull them back, their energy, or the tension "
      "of their links, each as a share of the largest among the strings, the surfaces and bars, or "
      "the masses of their section. By tension, what is slacker than at rest is blue. With "
      "section, "
      "nothing glows, and each section has its colour.",
      this);
  for (std::size_t i = 0; i < kGlowOptions.size(); ++i) {
    colour_by_->addOption(kGlowOptions[i].name, static_cast<int>(i));
  }
  gain_ = new rviz::FloatProperty(
      "Displacement gain", 1.0F,
      "By which displacements are magnified, on top of display_zoom of the station. At other "
      "values than 1, things that touch in the model may seem not to touch.",
      this);
  gain_->setMin(0.0F);
  gain_->setMax(1000.0F);
  thickness_ = new rviz::FloatProperty("Thickness", 1.0F,
                                       "Of strings and of single masses, 1 is as usual.", this);
  thickness_->setMin(0.1F);
  thickness_->setMax(20.0F);
  links_ = new rviz::BoolProperty("Links", true,
                                  "Whether links between the parts of the model are drawn.", this);
}

ModelDisplay::~ModelDisplay() {
  unsubscribe();
}

void ModelDisplay::onInitialize() {
  picture_ = std::make_unique<ModelPicture>(*scene_node_);
  connect(station_, &rviz::Property::changed, this, [this] { subscribe(); });
  connect(gain_, &rviz::Property::changed, this, [this] { changeScale(); });
  connect(colour_by_, &rviz::Property::changed, this, [this] { changeGlow(); });
  connect(thickness_, &rviz::Property::changed, this, [this] { rebuild(); });
  connect(links_, &rviz::Property::changed, this, [this] { rebuild(); });
}

void ModelDisplay::onEnable() {
  subscribe();
}

void ModelDisplay::onDisable() {
  unsubscribe();
}

void ModelDisplay::reset() {
  rviz::Display::reset();
  subscribe();
}

void ModelDisplay::unsubscribe() {
  structure_topic_.shutdown();
  state_topic_.shutdown();
  handles_topic_.shutdown();
  structure_.reset();
  state_.reset();
  if (picture_) {
    picture_->clear();
  }
}

void ModelDisplay::subscribe() {
  unsubscribe();
  if (!isEnabled()) {
    return;
  }
  const std::string station = station_->getStdString();
  std::string error;
  if (!ros::names::validate(station, error) || station.empty() || station[0] == '~') {
    setStatusStd(rviz::StatusProperty::Error, "Station", "There is no such name: " + error);
    return;
  }
  structure_topic_ = update_nh_.subscribe<ModelStructure>(
      station + "/model_structure", 1,
      [this](const ModelStructure::ConstPtr& message) { begin(message); });
  handles_topic_ = update_nh_.subscribe<Handles>(
      station + "/handles", 1,
      [this](const Handles::ConstPtr& message) { setZoom(message->display_zoom); });
  state_topic_ = update_nh_.subscribe<ModelState>(
      station + "/model_state", 1,
      [this](const ModelState::ConstPtr& message) { state_ = message; });
  tellStation();
}

/// Whatever was drawn before is gone, even if the new structure cannot be drawn.
void ModelDisplay::begin(const ModelStructure::ConstPtr& structure) {
  picture_->clear();
  structure_.reset();
  came_ = ros::WallTime::now();
  if (!isConsistent(*structure)) {
    setStatus(rviz::StatusProperty::Error, "Model",
              "The lists of model_structure do not fit each other.");
    return;
  }
  structure_ = boost::make_shared<ModelStructure>(withHandsInPlace(*structure));
  shape_ = shapeOf(*structure_);
  motion_ = ModelMotion(*structure_, shape_);
  changeGlow();
  motion_.setScale(zoom_, static_cast<double>(gain_->getFloat()));
  rebuild();
  tellModel();
}

void ModelDisplay::setZoom(double zoom) {
  if (zoom > 0.0 && zoom != zoom_) {
    zoom_ = zoom;
    changeScale();
    rebuild();
  }
}

void ModelDisplay::changeScale() {
  motion_.setScale(zoom_, static_cast<double>(gain_->getFloat()));
  must_draw_ = true;
}

void ModelDisplay::changeGlow() {
  motion_.glowBy(kGlowOptions[static_cast<std::size_t>(colour_by_->getOptionInt())].quantity);
  must_draw_ = true;
}

void ModelDisplay::rebuild() {
  if (structure_ && picture_) {
    picture_->show(ModelMesh(*structure_, shape_, motion_,
                             static_cast<double>(thickness_->getFloat()), links_->getBool()));
    must_draw_ = true;
  }
}

void ModelDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  const ros::WallTime start = ros::WallTime::now();
  if (structure_ && findFrame()) {
    takeState();
    if (drawIfNeeded()) {
      const double spent_ms = 1e3 * (ros::WallTime::now() - start).toSec();
      worst_ms_ = std::max(worst_ms_, spent_ms);
      spent_ms_ += spent_ms;
      ++pictures_;
    }
  }
  if ((start - told_).toSec() > kTellS) {
    told_ = start;
    tellStation();
    tellPicture();
  }
}

bool ModelDisplay::findFrame() {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const std::string& frame = structure_->header.frame_id;
  const bool is_known =
      context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
  scene_node_->setVisible(is_known);
  if (!is_known) {
    if (std::exchange(has_frame_, false)) {
      setStatusStd(rviz::StatusProperty::Error, "Frame",
                   "Where frame " + frame + " is in the fixed frame is not known.");
    }
    return false;
  }
  if (!std::exchange(has_frame_, true)) {
    deleteStatus("Frame");
  }
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
  Eigen::Isometry3f model = Eigen::Isometry3f::Identity();
  model.translation() = eigenOf(position);
  model.linear() = Eigen::Quaternionf(orientation.w, orientation.x, orientation.y, orientation.z)
                       .toRotationMatrix();
  to_model_ = model.inverse();
  return true;
}

void ModelDisplay::takeState() {
  const ros::WallTime now = ros::WallTime::now();
  if (state_ && belongs(*state_, *structure_)) {
    motion_.show(*state_);
    came_ = now;
    must_draw_ = true;
  }
  state_.reset();
  const bool is_stale = (now - came_).toSec() > kStaleS;
  if (is_stale != std::exchange(is_stale_, is_stale)) {
    must_draw_ = true;
    tellStation();
  }
}

bool ModelDisplay::drawIfNeeded() {
  const Eigen::Vector3f now = eye();
  if (!must_draw_ && (now - drawn_for_).norm() < kMovedEye * now.norm()) {
    return false;
  }
  drawn_for_ = now;
  draw();
  return true;
}

Eigen::Vector3f ModelDisplay::eye() const {
  const Ogre::Camera* const camera = context_->getViewManager()->getRenderPanel()->getCamera();
  return to_model_ * eigenOf(camera->getDerivedPosition());
}

void ModelDisplay::draw() {
  must_draw_ = false;
  MeshView view;
  view.eye = drawn_for_;
  view.by_section = kGlowOptions[static_cast<std::size_t>(colour_by_->getOptionInt())].quantity ==
                    GlowBy::kNothing;
  view.is_stale = is_stale_;
  picture_->draw(motion_, view);
}

void ModelDisplay::tellStation() {
  using rviz::StatusProperty;
  if (state_topic_.getNumPublishers() == 0) {
    setStatus(StatusProperty::Warn, "Station", "There is no station of that name.");
  } else if (!structure_) {
    setStatus(StatusProperty::Warn, "Station", "It has loaded no model.");
  } else if (is_stale_) {
    setStatus(StatusProperty::Warn, "Station",
              "It sends nothing: the picture is frozen, and grey.");
  } else {
    setStatus(StatusProperty::Ok, "Station", "It plays.");
  }
}

void ModelDisplay::tellModel() {
  const QString text = QString("%1: %2 modules, %3 links")
                           .arg(QString::fromStdString(structure_->name))
                           .arg(structure_->module_sections.size())
                           .arg(structure_->links.size() / 2);
  setStatus(rviz::StatusProperty::Ok, "Model", text);
}

/// Reports the drawing times of the last second.
void ModelDisplay::tellPicture() {
  if (pictures_ > 0) {
    setStatus(rviz::StatusProperty::Ok, "Picture",
              QString("%1 ms of rviz's own thread, %2 at worst, %3 vertices")
                  .arg(spent_ms_ / pictures_, 0, 'f', 2)
                  .arg(worst_ms_, 0, 'f', 2)
                  .arg(picture_->vertices()));
  }
  pictures_ = 0;
  spent_ms_ = worst_ms_ = 0.0;
}

}  // namespace ergotic::panel

#include <pluginlib/class_list_macros.hpp>
PLUGINLIB_EXPORT_CLASS(ergotic::panel::ModelDisplay, rviz::Display)
