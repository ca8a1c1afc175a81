// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <OgreHardwareVertexBuffer.h>
#include <OgreMaterial.h>
#include <OgreRenderOperation.h>
#include <OgreVertexIndexData.h>

#include <memory>
#include <vector>

#include "rviz/model_mesh.hpp"

namespace Ogre {
class SceneNode;
}  // namespace Ogre

namespace ergotic::panel {

/// A mesh in the scene of rviz: one vertex buffer that is written anew for each picture, and static
/// indices of triangles, lines and points. Thread: of the window
class ModelPicture {
 public:
  /// \param parent  outlives this
  explicit ModelPicture(Ogre::SceneNode& parent);
  ~ModelPicture();
  ModelPicture(const ModelPicture&) = delete;
  ModelPicture& operator=(const ModelPicture&) = delete;

  /// Shows this mesh, and no other any more.
  void show(ModelMesh mesh);
  void clear();
  /// \param view  the eye in frame `model`
  void draw(const ModelMotion& motion, const MeshView& view);
  std::size_t vertices() const { return mesh_.vertices(); }

 private:
  class Part;
  void add(const ModuleIndices& indices, Ogre::RenderOperation::OperationType type);

  Ogre::SceneNode& node_;
  Ogre::MaterialPtr material_;
  ModelMesh mesh_;
  std::unique_ptr<Ogre::VertexData> vertices_;
  Ogre::HardwareVertexBufferSharedPtr buffer_;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace ergotic::panel
