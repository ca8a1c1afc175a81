// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Makes drivers of measurement boards under comedi.
class ComediFactory final : public DriverFactory {
 public:
  std::unique_ptr<Driver> make(const YAML::Node& settings, const std::string& file) const override;
};

}  // namespace ergotic::tgr
