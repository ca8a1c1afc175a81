// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

#include "scene/language/constant.hpp"
#include "scene/language/pose.hpp"

namespace ergotic::scene {

/// Where names are looked up while a scene or an instance of a definition is written out.
struct Frame {
  Scope scope;
  std::string prefix;                           ///< of its names, as `left.`; the scene: nothing
  std::set<std::string> heads;                  ///< what its own names begin with, up to a dot
  std::map<std::string, std::string> sections;  ///< by their roles
  int text = 0;                                 ///< Place::origin of the text it is written in
  int origin = 0;                               ///< and of what is written out of that, if not 0
  std::size_t definitions = 0;                  ///< so many may be used in it
  Pose pose{};                                  ///< of what it makes
  int depth = 0;                                ///< of instances in instances
};

}  // namespace ergotic::scene
