// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_picture.hpp"

#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreResourceGroupManager.h>
#include <OgreSceneNode.h>
#include <OgreSimpleRenderable.h>
#include <OgreTechnique.h>

#include <cstddef>
#include <string>
#include <utility>

namespace ergotic::panel {
namespace {

constexpr float kPointPixels = 3.0F;

/// Vertices have their colour, light included.
Ogre::MaterialPtr makeMaterial() {
  static int count = 0;
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(
      "ergotic/model " + std::to_string(++count),
      Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  material->setReceiveShadows(false);
  material->setLightingEnabled(false);
  material->setCullingMode(Ogre::CULL_NONE);
  material->setPointSize(kPointPixels);
  return material;
}

}  // namespace

/// Triangles, lines or points of a mesh.
class ModelPicture::Part : public Ogre::SimpleRenderable {
 public:
  Part(Ogre::VertexData& vertices,
       const ModuleIndices& indices,
       Ogre::RenderOperation::OperationType type,
       const Ogre::MaterialPtr& material)
      : indices_(std::make_unique<Ogre::IndexData>()) {
    indices_->indexCount = indices.size();
    indices_->indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
        Ogre::HardwareIndexBuffer::IT_32BIT, indices.size(),
        Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
    indices_->indexBuffer->writeData(0, sizeof(std::uint32_t) * indices.size(), indices.data(),
                                     true);
    mRenderOp.vertexData = &vertices;
    mRenderOp.indexData = indices_.get();
    mRenderOp.operationType = type;
    mRenderOp.useIndexes = true;
    setMaterial(material);
    setBoundingBox(Ogre::AxisAlignedBox::BOX_INFINITE);  // it moves, and is mostly in the picture
  }
  Ogre::Real getBoundingRadius() const override { return 1.0F; }
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* /*camera*/) const override { return 0.0F; }

 private:
  std::unique_ptr<Ogre::IndexData> indices_;
};

ModelPicture::ModelPicture(Ogre::SceneNode& parent)
    : node_(*parent.createChildSceneNode()), material_(makeMaterial()) {}

ModelPicture::~ModelPicture() {
  clear();
  Ogre::MaterialManager::getSingleton().remove(material_);
  node_.getParentSceneNode()->removeAndDestroyChild(&node_);
}

void ModelPicture::clear() {
  node_.detachAllObjects();
  parts_.clear();
  vertices_.reset();
  buffer_.reset();
  mesh_ = {};
}

void ModelPicture::show(ModelMesh mesh) {
  clear();
  mesh_ = std::move(mesh);
  if (mesh_.vertices() == 0) {
    return;
  }
  vertices_ = std::make_unique<Ogre::VertexData>();
  vertices_->vertexCount = mesh_.vertices();
  Ogre::VertexDeclaration& layout = *vertices_->vertexDeclaration;
  layout.addElement(0, offsetof(MeshVertex, x), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout.addElement(0, offsetof(MeshVertex, colour), Ogre::VET_UBYTE4_NORM, Ogre::VES_DIFFUSE);
  buffer_ = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
      sizeof(MeshVertex), mesh_.vertices(),
      Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
  vertices_->vertexBufferBinding->setBinding(0, buffer_);
  add(mesh_.triangles(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  add(mesh_.lines(), Ogre::RenderOperation::OT_LINE_LIST);
  add(mesh_.points(), Ogre::RenderOperation::OT_POINT_LIST);
}

void ModelPicture::add(const ModuleIndices& indices, Ogre::RenderOperation::OperationType type) {
  if (!indices.empty()) {
    parts_.push_back(std::make_unique<Part>(*vertices_, indices, type, material_));
    node_.attachObject(parts_.back().get());
  }
}

void ModelPicture::draw(const ModelMotion& motion, const MeshView& view) {
  if (!buffer_) {
    return;
  }
  void* const out = buffer_->lock(Ogre::HardwareBuffer::HBL_DISCARD);
  mesh_.fill(motion, view, static_cast<MeshVertex*>(out));
  buffer_->unlock();
}

}  // namespace ergotic::panel
