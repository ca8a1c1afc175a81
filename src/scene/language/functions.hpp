// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::scene {

/// A function of expressions, of one or two numbers.
struct Function {
  /// Kinds of the arguments, and of the result.
  enum class Kinds {
    kBare,   ///< numbers without units (angles too), and gives one
    kSame,   ///< all of one kind, and gives that
    kRoot,   ///< any, and gives its root
    kPower,  ///< any and a number
  };
  const char* name;
  std::size_t arguments;
  Kinds kinds;
  double (*value)(const double* arguments);
};

/// nullptr if there is none of this name.
const Function* findFunction(const std::string& name);
std::vector<std::string> functionNames();

}  // namespace ergotic::scene
