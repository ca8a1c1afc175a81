// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace ergotic::tools {
namespace {

constexpr int kDigits = 9;
constexpr int kReadableDigits = 6;
constexpr std::size_t kWidth = 100;  // characters of a line that holds a map or a list

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
  const auto written = [value](int digits) {
    std::ostringstream text;
    text.precision(digits);
    text << value;
    return std::isfinite(value) ? text.str() : std::string("null");
  };
  Report report(Kind::kNumber, written(kDigits));
  report.readable_ = written(kReadableDigits);
  return report;
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
    const char* comma = "[";
    for (const auto& child : children_) {
      out << comma << child.second.value_;
      comma = ", ";
    }
    out << ']';
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

bool Report::fitsInFlow() const {
  if (isLeaf() || isVector()) {
    return true;
  }
  return kind_ == Kind::kMap && !children_.empty() &&
         std::all_of(children_.begin(), children_.end(),
                     [](const auto& child) { return child.second.fitsInFlow(); });
}

std::string Report::flow() const {
  if (isLeaf()) {
    return readable_;
  }
  const bool map = kind_ == Kind::kMap;
  std::string line;
  for (const auto& [name, child] : children_) {
    line += (line.empty() ? "" : ", ") + (map ? name + ": " : "") + child.flow();
  }
  return map ? "{" + line + "}" : "[" + line + "]";
}

void Report::printText(std::ostream& out) const {
  printText(out, 0, false);
}

/// \param after_dash  the first line goes on where a list item began
void Report::printText(std::ostream& out, int depth, bool after_dash) const {
  for (const auto& [name, child] : children_) {
    out << (after_dash ? "" : indent(depth));
    after_dash = false;
    const std::string head = indent(depth) + (kind_ == Kind::kMap ? name + ":" : "-");
    out << head.substr(static_cast<std::size_t>(depth) * 2);
    const std::string line = child.fitsInFlow() ? child.flow() : "";
    if (child.isLeaf() || (!line.empty() && head.size() + 1 + line.size() <= kWidth)) {
      out << ' ' << line << '\n';
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
