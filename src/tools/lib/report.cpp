// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/report.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

namespace ergotic::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kReadableDigits = 6;
constexpr std::size_t kWidth = 100;  // characters of a line that holds a map or a list

std::string indent(int depth) {
  return std::string(static_cast<std::size_t>(depth) * 2, ' ');
}

std::string readable(double value) {
  std::ostringstream text;
  text.precision(kReadableDigits);
  text << value;
  return std::isfinite(value) ? text.str() : std::string("null");
}

/// Names of files may hold any bytes: what is no UTF-8 is replaced.
std::string written(const Json& json, int spaces) {
  return json.dump(spaces, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Report Report::text(const std::string& value) {
  Report report(Kind::kText);
  report.text_ = value;
  return report;
}

Report Report::real(double value) {
  Report report(Kind::kReal);
  report.real_ = value;
  report.text_ = readable(value);
  return report;
}

Report Report::whole(std::int64_t value) {
  Report report(Kind::kWhole);
  report.whole_ = value;
  report.text_ = std::to_string(value);
  return report;
}

Report& Report::add(const std::string& name, Report value) {
  children_.emplace_back(name, std::move(value));
  return *this;
}

Json Report::json() const {
  switch (kind_) {
    case Kind::kText:
      return text_;
    case Kind::kReal:
      return real_;
    case Kind::kWhole:
      return whole_;
    case Kind::kMap:
    case Kind::kList:
      break;
  }
  Json json = kind_ == Kind::kMap ? Json::object() : Json::array();
  for (const auto& [name, child] : children_) {
    if (kind_ == Kind::kMap) {
      json[name] = child.json();
    } else {
      json.push_back(child.json());
    }
  }
  return json;
}

void Report::printJson(std::ostream& out) const {
  out << written(json(), 2);
}

void Report::printJsonLine(std::ostream& out) const {
  out << written(json(), -1) << '\n';
}

bool Report::isVector() const {
  return kind_ == Kind::kList && !children_.empty() &&
         std::all_of(children_.begin(), children_.end(),
                     [](const auto& child) { return child.second.isNumber(); });
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
    return text_;
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
