// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/machine.hpp"

#include <fstream>

#include <sys/utsname.h>

namespace ergotic::tools {

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string kernelName() {
  utsname name{};
  if (uname(&name) != 0) {
    return "unknown";
  }
  return std::string(name.sysname) + ' ' + name.release + ' ' + name.version;
}

}  // namespace ergotic::tools
