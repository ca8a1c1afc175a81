// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::tools {

/// Of this machine, as it calls itself; `unknown` if it does not.
std::string processorName();

/// Name, release and version of the running kernel, as `uname -srv`.
std::string kernelName();

}  // namespace ergotic::tools
