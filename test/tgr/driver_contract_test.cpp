// SPDX-License-Identifier: BSD-3-Clause
#include "support/driver_contract.hpp"

#include "tgr/driver_rigs.hpp"

namespace ergotic::test {

using DriverRigs = ::testing::
    Types<InProcessRig, SharedMemoryRig, ReplayRig, FaultyRig, CombinedRig, CalibratedRig>;
INSTANTIATE_TYPED_TEST_SUITE_P(Drivers, DriverContractTest, DriverRigs);

}  // namespace ergotic::test
