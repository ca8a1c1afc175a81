// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::test {

/// One line of a `.mdl` text: `@name keyword arguments...`; brackets are taken off their arguments.
struct MdlElement {
  std::string name;
  std::string keyword;
  std::vector<std::string> arguments;
};

/// Modules of a macro, for the points on it: `name.<i>`, or `name.<row>.<column>`.
struct MdlNet {
  std::string name;
  int rows = 1;
  int columns = 1;
  std::string module(int row, int column) const;
};

struct MdlElements {
  std::vector<MdlElement> lines;
  std::vector<MdlNet> nets;
};

/// The elements of a text; in place of every macro the masses, grounds and springs that it means,
/// as written in the published conventions.
MdlElements readMdlElements(const std::string& text);

}  // namespace ergotic::test
