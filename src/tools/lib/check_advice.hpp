// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace CLI {
class App;
}

namespace ergotic::tools {

/// Options of the advice by `check`.
struct AdviceChoice {
  bool is_wanted = false;
  std::vector<std::string> wishes;  ///< `pitch BODY HZ`, `t60 BODY S`, `margin M`
};

void addOptions(CLI::App& app, AdviceChoice& choice);

/// Prints possible changes of a scene, and the parameters that fulfil the wishes, on stdout.
/// \param scene  not settled
/// \throws Exception if a wish cannot be read, or no body has its name
void checkAdvice(const scene::Scene& scene,
                 const physics::Rates& rates,
                 const physics::DeviceTraits& device,
                 const AdviceChoice& choice,
                 bool json);

}  // namespace ergotic::tools
