// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// Sorts the links of a run that spatial kernels can step (explicit spring-dampers and contacts
/// between points of one section), or that share a tank, into spans: those whose ends follow one
/// another, as along the rows of a net, then all others. Leaves other runs as they are. Realtime:
/// no
void arrangeInSpans(LinkRun& run);

}  // namespace ergotic::physics
