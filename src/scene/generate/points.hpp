// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/generate/scene_builder.hpp"

/// Massless modules on others.
namespace ergotic::scene {

/// Adds a connection and its kPoint, which starts where the modules around it are.
/// \param connection  all but `mat`
/// \return            index of the point
/// \throws TextError  if the name is taken
int addPoint(SceneBuilder& builder, const std::string& name, Connection connection);

/// Adds a tap and its kPoint, which starts where its modules take it.
/// \param tap  all but `mat`; one share at least
/// \return     index of the point
/// \throws TextError  if the name is taken
int addTap(SceneBuilder& builder, const std::string& name, Tap tap);

}  // namespace ergotic::scene
