// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <OgreQuaternion.h>
#include <OgreVector3.h>

#include <memory>
#include <string>

#include <Eigen/Core>

namespace Ogre {
class SceneManager;
class SceneNode;
}  // namespace Ogre
namespace rviz {
class BillboardLine;
class MovableText;
class Shape;
}  // namespace rviz

namespace ergotic::panel {

inline Ogre::Vector3 toOgre(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Picture of the grab tool: a ring of light about the handle under the mouse and its name; of a
/// handle that is held, the target, the band between, and the pull in newtons, red near the force
/// limit of the hand. Places are in frame `model`.
/// Thread: of the window
class GrabPicture {
 public:
  explicit GrabPicture(Ogre::SceneManager& scenes);
  ~GrabPicture();
  GrabPicture(const GrabPicture&) = delete;
  GrabPicture& operator=(const GrabPicture&) = delete;

  /// Sets the pose of frame `model` in the fixed frame.
  void setFrame(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);
  void hide();
  /// Sets the upward direction of the screen, of length 1.
  void setUp(const Eigen::Vector3d& up) { up_ = up; }
  /// \param size  of a handle's mark, m
  void showHover(const Eigen::Vector3d& place, const std::string& name, double size);
  /// \param share  of the hand's force limit
  void showPull(const Eigen::Vector3d& handle,
                const Eigen::Vector3d& wanted,
                double newtons,
                double share,
                double size);

 private:
  void showText(const Eigen::Vector3d& place, const std::string& text, double size);

  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  Ogre::SceneManager& scenes_;
  Ogre::SceneNode* node_;
  Ogre::SceneNode* text_node_;
  std::unique_ptr<rviz::Shape> mark_;
  std::unique_ptr<rviz::Shape> target_;
  std::unique_ptr<rviz::Shape> head_;  // of the arrow, at the middle of the band
  std::unique_ptr<rviz::BillboardLine> band_;
  std::unique_ptr<rviz::MovableText> text_;
};

}  // namespace ergotic::panel
