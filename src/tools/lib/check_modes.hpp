// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/advice/modes.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace CLI {
class App;
}

namespace ergotic::tools {

/// Options of the modes by `check`.
struct ModesChoice {
  bool are_wanted = false;
  physics::ModeWindow window;
  std::string csv;   ///< empty: not written
  std::string plot;  ///< empty: not drawn
};

void addOptions(CLI::App& app, ModesChoice& choice);

/// Says on stdout what a scene sounds at, and nothing else.
/// \param asked    as it was read \param settled  the same at these rates
/// \throws Exception if a file cannot be written
void checkModes(const scene::Scene& asked,
                const scene::Scene& settled,
                const physics::Rates& rates,
                const ModesChoice& choice,
                bool json);

}  // namespace ergotic::tools
