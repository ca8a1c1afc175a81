// SPDX-License-Identifier: BSD-3-Clause
// Gestures of both kinds, as a virtual hand follows them, and what they ask of a scene.
#include "ergotic/tgr/gesture.hpp"

#include <cmath>

#include "ergotic/tgr/driver.hpp"
#include "fuzz/fuzz.hpp"
#include "fuzz/memory_file.hpp"
#include "tgr/drivers/virtual/target_gesture.hpp"

namespace ergotic::fuzz {
namespace {

void follow(tgr::TargetGesture gesture) {
  gesture.setTickRate(3000.0);
  for (int slice = 0; slice < tgr::kMaxSlices; ++slice) {
    for (const double t_s : {0.0, 1e-4, 0.5, 1e6, 1e300}) {
      const tgr::HandTarget target = gesture.at(slice, t_s);
      if (!std::isfinite(target.position) || !std::isfinite(target.velocity)) {
        fail("a target that is not finite");
      }
    }
  }
}

}  // namespace
}  // namespace ergotic::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const fuzz::MemoryFile file(data, size);
  try {
    fuzz::follow(tgr::readTargetGesture(file.path(), tgr::kMaxSlices));
    for (const tgr::GestureValue& value : tgr::readGestureValues(file.path())) {
      if (!std::isfinite(value.value) || value.parameter.empty()) {
        fuzz::fail("a parameter without a name, or a value that is not finite");
      }
    }
  } catch (const Exception&) {
  }
  return 0;
}
