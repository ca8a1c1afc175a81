// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/virtual_driver.hpp"
#include "tgr/drivers/virtual/in_process_driver.hpp"
#include "tgr/drivers/virtual/shared_memory_driver.hpp"

namespace ergotic::tgr {

std::unique_ptr<Driver> makeVirtualDriver(const VirtualDriverConfig& config) {
  if (config.shared_memory.empty()) {
    return std::make_unique<InProcessDriver>(config);
  }
  return std::make_unique<SharedMemoryDriver>(config);
}

}  // namespace ergotic::tgr
