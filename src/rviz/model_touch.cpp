// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_touch.hpp"

#include <cstddef>
#include <string>

namespace ergotic::panel {
namespace {

Touch touchOf(const std::string& law) {
  if (law == "felt" || law == "power-law contact" || law == "cubic contact") {
    return Touch::kStrike;
  }
  if (law == "contact") {
    return Touch::kPress;
  }
  if (law == "pluck" || law == "one-way pluck") {
    return Touch::kPluck;
  }
  const bool rubs = law == "bow" || law == "smooth bow" || law == "friction";
  return rubs ? Touch::kRub : Touch::kNone;
}

}  // namespace

std::vector<Touch> touchesOf(const ModelStructure& structure) {
  std::vector<Touch> of_laws;
  for (const std::string& law : structure.law_names) {
    of_laws.push_back(touchOf(law));
  }
  std::vector<Touch> touches;
  for (std::size_t link = 0; link < structure.links.size() / 2; ++link) {
    const std::size_t law =
        link < structure.link_types.size() ? structure.link_types[link] : of_laws.size();
    touches.push_back(law < of_laws.size() ? of_laws[law] : Touch::kNone);
  }
  return touches;
}

}  // namespace ergotic::panel
