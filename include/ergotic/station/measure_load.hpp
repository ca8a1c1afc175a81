// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/performer.hpp"

namespace ergotic::station {

/// Share of the time between two ticks that the fastest of many ticks takes here and now, by the
/// clock of the calling thread: 1 fills it. Ticks that meet cold caches, contacts or other programs
/// take longer. The performer is left as it was made.
/// \return 0 if a thread that shares its ticks does not keep up
/// \pre it does not play. Realtime: no. Thread: any. Takes a tenth of a second, or five ticks
double measureLoad(Performer& performer);

/// Describes how much a model exceeds the permitted load, and what reduces the load.
/// \param load  of measureLoad, above `max_load`
std::string describeLoad(const physics::Instrument& instrument, double load, double max_load);

}  // namespace ergotic::station
