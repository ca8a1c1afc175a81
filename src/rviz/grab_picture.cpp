// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/grab_picture.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>

#include <algorithm>
#include <cstdio>

#include <rviz/ogre_helpers/billboard_line.h>
#include <rviz/ogre_helpers/movable_text.h>
#include <rviz/ogre_helpers/shape.h>

namespace ergotic::panel {
namespace {

constexpr float kMarkAlpha = 0.45F;
constexpr double kNearTheMost = 0.8;  // of the force that a hand gives

Ogre::Vector3 cube(double size) {
  return Ogre::Vector3(static_cast<float>(size));
}

}  // namespace

GrabPicture::GrabPicture(Ogre::SceneManager& scenes)
    : scenes_(scenes),
      node_(scenes.getRootSceneNode()->createChildSceneNode()),
      text_node_(node_->createChildSceneNode()),
      mark_(std::make_unique<rviz::Shape>(rviz::Shape::Sphere, &scenes, node_)),
      target_(std::make_unique<rviz::Shape>(rviz::Shape::Sphere, &scenes, node_)),
      head_(std::make_unique<rviz::Shape>(rviz::Shape::Cone, &scenes, node_)),
      band_(std::make_unique<rviz::BillboardLine>(&scenes, node_)),
      text_(std::make_unique<rviz::MovableText>("0 N", "Liberation Sans", 0.01F)) {
  mark_->setColor(1.0F, 1.0F, 1.0F, kMarkAlpha);
  text_->setTextAlignment(rviz::MovableText::H_LEFT, rviz::MovableText::V_ABOVE);
  text_->showOnTop();
  text_node_->attachObject(text_.get());
  hide();
}

GrabPicture::~GrabPicture() {
  text_node_->detachAllObjects();
  text_.reset();
  band_.reset();
  head_.reset();
  target_.reset();
  mark_.reset();
  scenes_.destroySceneNode(text_node_);
  scenes_.destroySceneNode(node_);
}

void GrabPicture::setFrame(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

void GrabPicture::hide() {
  node_->setVisible(false);
}

void GrabPicture::showText(const Eigen::Vector3d& place, const std::string& text, double size) {
  text_->setCaption(text);
  text_->setCharacterHeight(static_cast<float>(1.2 * size));
  text_node_->setPosition(toOgre(place + size * up_));
}

void GrabPicture::showHover(const Eigen::Vector3d& place, const std::string& name, double size) {
  hide();
  mark_->setPosition(toOgre(place));
  mark_->setScale(cube(size));
  mark_->setColor(1.0F, 1.0F, 1.0F, kMarkAlpha);
  mark_->getRootNode()->setVisible(true);
  showText(place, name, size);
  text_node_->setVisible(true);
}

void GrabPicture::showPull(const Eigen::Vector3d& handle,
                           const Eigen::Vector3d& wanted,
                           double newtons,
                           double share,
                           double size) {
  node_->setVisible(true);
  const bool is_near = share > kNearTheMost;
  const float g = is_near ? 0.25F : 0.9F;
  const float b = is_near ? 0.2F : 0.4F;
  mark_->setPosition(toOgre(handle));
  mark_->setScale(cube(size));
  target_->setPosition(toOgre(wanted));
  target_->setScale(cube(0.6 * size));
  for (rviz::Shape* shape : {target_.get(), head_.get()}) {
    shape->setColor(1.0F, g, b, 0.9F);
  }
  band_->clear();
  band_->setLineWidth(static_cast<float>((0.08 + 0.25 * std::min(share, 1.0)) * size));
  band_->setColor(1.0F, g, b, 0.9F);
  band_->addPoint(toOgre(handle));
  band_->addPoint(toOgre(wanted));

  const Eigen::Vector3d way = wanted - handle;
  const bool has_way = way.norm() > 0.3 * size;
  head_->getRootNode()->setVisible(has_way);
  if (has_way) {
    head_->setPosition(toOgre(handle + 0.5 * way));
    head_->setOrientation(Ogre::Vector3::UNIT_Y.getRotationTo(toOgre(way.normalized())));
    head_->setScale(cube(0.7 * size));
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.1f N", newtons);
  showText(wanted, text, size);
}

}  // namespace ergotic::panel
