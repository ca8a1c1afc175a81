// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/certificate/findings.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Links that are more than springs and dampers: rules of contact, friction, tables, tanks of
/// energy.
void judgeLinks(const RatedNetwork& networks, Findings& findings);

/// Scalar modules that meet lines, planes and space along different axes.
void judgeAxes(const RatedNetwork& networks, Findings& findings);

/// Masses that links join to faster ones.
void judgeCouplings(const RatedNetwork& networks, Findings& findings);

/// The largest stiffness at each slice against what the device bears.
std::vector<PortCertificate> judgePorts(const RatedNetwork& networks,
                                        const DeviceTraits& device,
                                        Findings& findings);

/// Says which link is negative, if what is given is not semidefinite all the same.
/// \return what shows that it is, or nothing
void judgeSigns(const RatedNetwork& networks, const NetworkBound& network, Findings& findings);

}  // namespace ergotic::physics
