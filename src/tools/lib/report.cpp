// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace ergotic::tools {
namespace {

constexpr int kDigits = 9;

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      result += code;
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string indent(int depth) {
  return std::string(static_cast<std::size_t>(depth) * 2, ' ');
}

}  // namespace

Report Report::number(double value) {
  std::ostringstream text;
  text.precision(kDigits);
  text << value;
  return Report(Kind::kNumber, std::isfinite(value) ? text.str() : "null");
}

Report& Report::add(const std::string& name, Report value) {
  children_.emplace_back(name, std::move(value));
  return *this;
}

void Report::printJson(std::ostream& out, int depth) const {
  if (isLeaf()) {
    out << (kind_ == Kind::kText ? quoted(value_) : value_);
    return;
  }
  if (isVector()) {
    printVector(out);
    return;
  }
  const bool map = kind_ == Kind::kMap;
  out << (map ? "{" : "[");
  const char* separator = "\n";
  for (const auto& [name, child] : children_) {
    out << separator << indent(depth + 1);
    if (map) {
      out << quoted(name) << ": ";
    }
    child.printJson(out, depth + 1);
    separator = ",\n";
  }
  out << (children_.empty() ? "" : "\n" + indent(depth)) << (map ? "}" : "]");
}

bool Report::isVector() const {
  return kind_ == Kind::kList && !children_.empty() &&
         std::all_of(children_.begin(), children_.end(),
                     [](const auto& child) { return child.second.kind_ == Kind::kNumber; });
}

void Report::printVector(std::ostream& out) const {
  const char* separator = "[";
  for (const auto& child : children_) {
    out << separator << child.second.value_;
    separator = ", ";
  }
  out << ']';
}

void Report::printText(std::ostream& out) const {
  printText(out, 0, false);
}

/// \param after_dash  the first line goes on where a list item began
void Report::printText(std::ostream& out, int depth, bool after_dash) const {
  for (const auto& [name, child] : children_) {
    out << (after_dash ? "" : indent(depth));
    after_dash = false;
    out << (kind_ == Kind::kMap ? name + ":" : "-");
    if (child.isLeaf()) {
      out << ' ' << child.value_ << '\n';
    } else if (child.isVector()) {
      out << ' ';
      child.printVector(out);
      out << '\n';
    } else if (child.children_.empty()) {
      out << " none\n";
    } else if (kind_ == Kind::kList) {
      out << ' ';
      child.printText(out, depth + 1, true);
    } else {
      out << '\n';
      child.printText(out, depth + 1, false);
    }
  }
}

}  // namespace ergotic::tools
