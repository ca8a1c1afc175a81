// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rviz/model_graph.hpp"

namespace ergotic::panel {

/// The surfaces of skins, plates and outlines: the meshes of the net that links make, where these
/// are flat and about square, or triangles. No link belongs to more than two meshes.
/// \return [triangles][3] modules
ModuleIndices facesOf(const ModelStructure& structure, const LinkGraph& graph);

}  // namespace ergotic::panel
