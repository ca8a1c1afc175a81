// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::scene {

/// A function of expressions, of one or two numbers.
struct Function {
  const char* name;
  std::size_t arguments;
  double (*value)(const double* arguments);
};

/// nullptr if there is none of this name.
const Function* findFunction(const std::string& name);
std::vector<std::string> functionNames();

}  // namespace ergotic::scene
