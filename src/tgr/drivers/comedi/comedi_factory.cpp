// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_factory.hpp"

#include "tgr/drivers/comedi/comedi_driver.hpp"

namespace ergotic::tgr {

std::unique_ptr<Driver> ComediFactory::make(const YAML::Node& settings,
                                            const std::string& file) const {
  return std::make_unique<ComediDriver>(readComediSettings(settings, file));
}

}  // namespace ergotic::tgr
