// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace ergotic::tools {

/// A tree of named values that is printed for a reader (as YAML) or for a program (as JSON).
class Report {
 public:
  static Report map() { return Report(Kind::kMap); }
  static Report list() { return Report(Kind::kList); }
  static Report text(const std::string& value);
  /// What is not finite becomes null.
  template <class Number>
  static Report number(Number value) {
    if constexpr (std::is_integral_v<Number>) {
      return whole(static_cast<std::int64_t>(value));
    } else {
      return real(value);
    }
  }

  /// Adds to a map. \return the map, for more
  Report& add(const std::string& name, Report value);
  /// Adds to a list. \return the list, for more
  Report& add(Report value) { return add({}, std::move(value)); }

  /// Every number with as many digits as give its bits again.
  void printJson(std::ostream& out) const;
  void printJsonLine(std::ostream& out) const;
  void printText(std::ostream& out) const;

 private:
  enum class Kind { kMap, kList, kText, kReal, kWhole };
  explicit Report(Kind kind) : kind_(kind) {}
  static Report real(double value);
  static Report whole(std::int64_t value);
  bool isNumber() const { return kind_ == Kind::kReal || kind_ == Kind::kWhole; }
  bool isLeaf() const { return kind_ == Kind::kText || isNumber(); }
  bool isVector() const;    ///< a list of numbers: printed on one line
  bool fitsInFlow() const;  ///< a map of numbers and words, however deep: may stand on one line
  std::string flow() const;
  nlohmann::ordered_json json() const;
  void printText(std::ostream& out, int depth, bool after_dash) const;

  Kind kind_;
  std::string text_;
  double real_ = 0.0;
  std::int64_t whole_ = 0;
  std::vector<std::pair<std::string, Report>> children_;
};

}  // namespace ergotic::tools
