// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace ergotic::tools {

/// A tree of named values that is printed for a reader (as YAML) or for a program (as JSON).
class Report {
 public:
  static Report map() { return Report(Kind::kMap, {}); }
  static Report list() { return Report(Kind::kList, {}); }
  static Report text(const std::string& value) { return Report(Kind::kText, value); }
  static Report number(double value);  ///< what is not finite becomes null
  static Report count(std::size_t value) { return Report(Kind::kNumber, std::to_string(value)); }

  /// Adds to a map. \return the map, for more
  Report& add(const std::string& name, Report value);
  /// Adds to a list. \return the list, for more
  Report& add(Report value) { return add({}, std::move(value)); }

  void printJson(std::ostream& out) const { printJson(out, 0); }
  void printText(std::ostream& out) const;

 private:
  enum class Kind { kMap, kList, kText, kNumber };
  Report(Kind kind, std::string value) : kind_(kind), value_(std::move(value)), readable_(value_) {}
  bool isLeaf() const { return kind_ == Kind::kText || kind_ == Kind::kNumber; }
  bool isVector() const;    ///< a list of numbers: printed on one line
  bool fitsInFlow() const;  ///< a map of numbers and words, however deep: may stand on one line
  std::string flow() const;
  void printJson(std::ostream& out, int depth) const;
  void printText(std::ostream& out, int depth, bool after_dash) const;

  Kind kind_;
  std::string value_;
  std::string readable_;  // the same, shorter
  std::vector<std::pair<std::string, Report>> children_;
};

}  // namespace ergotic::tools
