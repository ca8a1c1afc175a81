// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_factory.hpp"

#include "tgr/drivers/comedi/comedi_driver.hpp"

namespace ergotic::tgr {

std::unique_ptr<Driver> ComediFactory::make(const std::string& settings,
                                            const std::string& place) const {
  return std::make_unique<ComediDriver>(readComediSettings(settings, place));
}

}  // namespace ergotic::tgr
