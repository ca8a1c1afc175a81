// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/report.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>

namespace ergotic::tools {
namespace {

constexpr int kReadableDigits = 6;
constexpr std::size_t kLineWidth = 100;  // characters of a line that holds a map or a list

std::string indent(int depth) {
  return std::string(static_cast<std::size_t>(depth) * 2, ' ');
}

std::string readable(double value) {
  std::ostringstream text;
  text.precision(kReadableDigits);
  text << value;
  return std::isfinite(value) ? text.str() : std::string("null");
}

std::string written(const Json& json, int spaces) {
  return json.dump(spaces, ' ', false, Json::error_handler_t::replace);
}

/// A list of numbers: printed on one line.
bool isVector(const Json& json) {
  return json.is_array() && !json.empty() &&
         std::all_of(json.begin(), json.end(), [](const Json& item) { return item.is_number(); });
}

/// Whether a value may be printed on one line: a map of numbers and words, however deep.
bool fitsInFlow(const Json& json) {
  return json.is_primitive() || isVector(json) ||
         (json.is_object() && !json.empty() && std::all_of(json.begin(), json.end(), fitsInFlow));
}

std::string flow(const Json& json) {
  if (json.is_string()) {
    return json.get<std::string>();
  }
  if (json.is_primitive()) {
    return json.is_number_float() ? readable(json.get<double>()) : json.dump();
  }
  std::string line;
  for (const auto& [name, child] : json.items()) {
    line += (line.empty() ? "" : ", ") + (json.is_object() ? name + ": " : "") + flow(child);
  }
  return json.is_object() ? "{" + line + "}" : "[" + line + "]";
}

/// \param after_dash  the first line continues that of a list item
void printText(const Json& json, std::ostream& out, int depth, bool after_dash) {
  for (const auto& [name, child] : json.items()) {
    out << (after_dash ? "" : indent(depth));
    after_dash = false;
    const std::string head = json.is_object() ? name + ":" : "-";
    out << head;
    const std::string line = fitsInFlow(child) ? flow(child) : "";
    const std::size_t width = indent(depth).size() + head.size() + 1 + line.size();
    if (child.is_primitive() || (!line.empty() && width <= kLineWidth)) {
      out << ' ' << line << '\n';
    } else if (child.empty()) {
      out << " none\n";
    } else {
      out << (json.is_array() ? ' ' : '\n');
      printText(child, out, depth + 1, json.is_array());
    }
  }
}

}  // namespace

void printText(const Json& report, std::ostream& out) {
  printText(report, out, 0, false);
}

void printJson(const Json& report, std::ostream& out) {
  out << written(report, 2);
}

void tell(const Json& report, bool for_program) {
  if (for_program) {
    printJson(report, std::cout);
    std::cout << '\n';
  } else {
    printText(report, std::cout);
  }
}

void printJsonLine(const Json& report, std::ostream& out) {
  out << written(report, -1) << '\n';
}

}  // namespace ergotic::tools
