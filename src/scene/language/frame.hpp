// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

#include "scene/language/constant.hpp"
#include "scene/language/pose.hpp"

namespace ergotic::scene {

/// Context in which names are looked up while a scene or an instance of a definition is written
/// out.
struct Frame {
  Scope scope;
  std::string prefix;                           ///< prefix of its names, as `left.`; scene: empty
  std::set<std::string> heads;                  ///< heads of its own names, up to a dot
  std::map<std::string, std::string> sections;  ///< sections by their roles
  int text = 0;                                 ///< Place::origin of the text it is written in
  int origin = 0;                               ///< origin of what it writes, if not 0
  std::size_t definitions = 0;                  ///< so many may be used in it
  Pose pose{};                                  ///< pose of what it makes
  int depth = 0;                                ///< depth of instances in instances
};

}  // namespace ergotic::scene
