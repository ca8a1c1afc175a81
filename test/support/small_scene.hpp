// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"

namespace ergotic::test {

/// A small scene as text, thrown near the limits of what the certificate allows.
struct SmallScene {
  std::string family;  ///< what is searched
  physics::Rates rates;
  std::vector<std::string> sections;
  std::vector<std::string> mats;
  std::vector<std::string> lias;

  std::string text() const;  ///< YAML: all that `check` and `render` need but the rates
};

/// Families in turn; some masses and links of every law, explicit, energy-stable or automatic, at
/// one rate or several, scalar or Euclidean. Nothing drives it: it starts to move, within some
/// millimetres. \return the same scene for the same seed
SmallScene smallScene(unsigned seed);

/// The same, with most ends of links on taps of the masses and grounds around.
SmallScene withTaps(SmallScene scene, unsigned seed);

/// Whether a link is a spring of a stretch.
bool isStretched(const SmallScene& scene, const std::string& link);

/// The same, with every scheme left to the station.
SmallScene leftOpen(SmallScene scene);

}  // namespace ergotic::test
