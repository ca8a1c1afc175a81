// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace ergotic::tgr {

/// Reads comma-separated rows; skips blank lines and lines that start with `#`; knows where
/// everything stands in the file. Numbers are read in the C locale.
class CsvReader {
 public:
  /// \param name  of the file, for messages
  CsvReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  /// \return false at the end of the file
  bool nextRow();

  /// Fields of the row, without the spaces around them.
  std::size_t size() const noexcept { return fields_.size(); }
  std::string_view text(std::size_t field) const { return fields_[field].text; }

  /// \throws TextError unless the row has `count` fields
  void requireSize(std::size_t count) const;
  /// \throws TextError unless the field is a finite number within the range
  double number(std::size_t field, const char* what, double minimum, double maximum) const;
  /// \throws TextError unless the field is a whole number within the range
  std::int64_t integer(std::size_t field,
                       const char* what,
                       std::int64_t minimum,
                       std::int64_t maximum) const;
  /// \throws TextError pointing at the field
  [[noreturn]] void fail(std::size_t field, const std::string& what) const;

 private:
  struct Field {
    std::string_view text;
    int column;
  };
  void split();
  template <class Number>
  Number parse(std::size_t field, const char* what, Number minimum, Number maximum) const;

  std::istream& in_;
  std::string name_;
  std::string line_;
  int line_number_ = 0;
  std::vector<Field> fields_;
};

}  // namespace ergotic::tgr
