// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include <nlohmann/json.hpp>

namespace ergotic::tools {

/// Report of a tool: a tree of named values, in the order in which they were named.
using Json = nlohmann::ordered_json;

/// Writes YAML for a reader: numbers of six digits, small maps and vectors on one line.
void printText(const Json& report, std::ostream& out);
/// Writes JSON for a program: every number with as many digits as give its bits again; numbers that
/// are not finite become null, and bytes that are no UTF-8 are replaced.
void printJson(const Json& report, std::ostream& out);
/// Writes to stdout, for a program or for a reader.
void tell(const Json& report, bool for_program);
/// As `printJson`, on one line.
void printJsonLine(const Json& report, std::ostream& out);

}  // namespace ergotic::tools
