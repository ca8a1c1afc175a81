// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "ergotic/tgr/device.hpp"

namespace ergotic::node {

/// Makes drivers by name: those of the core, and whatever packages export to `ergotic` as
/// `ergotic::tgr::DriverFactory` (docs/ros.md). It holds the code of the drivers that it made, and
/// so has to outlive them.
/// Thread: one. Realtime: no
class DriverPlugins {
 public:
  /// Looks for plugins, loads none. \throws Exception if the package itself is not found
  DriverPlugins();
  ~DriverPlugins();
  DriverPlugins(const DriverPlugins&) = delete;
  DriverPlugins& operator=(const DriverPlugins&) = delete;

  /// \param driver    `virtual`, `replay`, or `package/name` of a plugin; `name` alone means
  ///                  `ergotic/name`
  /// \param settings  map
  /// \param place     of the settings, for messages
  /// \throws Exception naming the drivers that exist, saying why one cannot be loaded, or what is
  ///         wrong with its settings
  std::unique_ptr<tgr::Driver> make(const std::string& driver,
                                    const YAML::Node& settings,
                                    const std::string& place);

 private:
  class Loader;
  std::unique_ptr<Loader> loader_;
};

}  // namespace ergotic::node
