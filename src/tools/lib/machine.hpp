// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::tools {

/// Name of the processor of this machine; `unknown` if there is none.
std::string processorName();

/// Name, release and version of the running kernel, as `uname -srv`.
std::string kernelName();

}  // namespace ergotic::tools
