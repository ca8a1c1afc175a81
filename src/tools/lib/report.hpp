// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include <nlohmann/json.hpp>

namespace ergotic::tools {

/// What tools report: a tree of named values, in the order in which they were named.
using Json = nlohmann::ordered_json;

/// For a reader, as YAML: numbers of six digits, small maps and vectors on one line.
void printText(const Json& report, std::ostream& out);
/// For a program: every number with as many digits as give its bits again; what is not finite is
/// null, and bytes that are no UTF-8 are replaced.
void printJson(const Json& report, std::ostream& out);
/// On stdout, for one or the other.
void tell(const Json& report, bool for_program);
/// As `printJson`, on one line.
void printJsonLine(const Json& report, std::ostream& out);

}  // namespace ergotic::tools
