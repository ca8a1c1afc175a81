// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "ergotic/scene/value.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {

/// Reads rows of fields from a text, a line at a time, as editors, spreadsheets and programs write
/// them: with commas or blanks between the fields, fields in quotes, any line ends, a byte order
/// mark, a line `sep=,` on top. `#` begins a comment; lines without fields are skipped, and so are
/// empty fields at the end of a line.
///
/// Text that cannot be understood for sure is refused, with advice on how to save it: semicolons
/// between the fields, commas in numbers, UTF-16.
class CsvReader {
 public:
  /// \param file     for messages
  /// \param columns  what a line has, for messages
  CsvReader(std::istream& in, std::string file, std::string columns);

  /// Sets the columns for messages from now on. \param columns  as in the constructor
  void setColumns(std::string columns) { columns_ = std::move(columns); }

  /// Goes to the next row.
  /// \return false at the end of the text
  /// \throws TextError if a line cannot be understood, or the text cannot be read to its end
  bool next();

  /// Number of fields in the row; empty fields at its end do not count.
  std::size_t size() const { return fields_.size(); }
  /// Empty if there is no such field.
  std::string_view text(std::size_t field) const {
    return field < size() ? fields_[field].text : std::string_view();
  }
  /// The text in small letters, for words of a header.
  std::string word(std::size_t field) const;
  /// True of the first row of the text if its fields are words: none is empty or a number.
  bool isHeader() const;

  /// \throws TextError if there is no such field, or if it is no finite number within the limits
  double number(std::size_t field, std::string_view what, const Limits& limits) const;
  /// A whole number. \throws TextError as `number`
  double whole(std::size_t field, std::string_view what, const Limits& limits) const;
  /// \throws TextError if the row has more fields
  void expectEnd(std::size_t fields) const;

  /// Position of a field of the row, or where it is missing.
  Place place(std::size_t field) const {
    return {line_number_, field < size() ? fields_[field].column : end_column_};
  }
  /// Fails at a field of the row, or where it is missing. \throws TextError
  [[noreturn]] void fail(std::size_t field, const std::string& what) const;
  /// Fails at the line that was read last. \throws TextError
  [[noreturn]] void failAtLine(const std::string& what) const;

 private:
  struct Field {
    std::string_view text;  ///< text of the field, within the line
    int column;
  };
  bool nextLine();
  bool isSeparatorLine();
  void split();
  std::size_t takeField(std::size_t at);
  std::size_t takeQuoted(std::size_t at);
  void checkWords(std::size_t end) const;
  void refuseDecimalCommas(std::size_t end) const;
  [[noreturn]] void refuseNumber(std::size_t field,
                                 const std::string& what,
                                 const Limits& limits) const;
  [[noreturn]] void failAt(std::size_t offset, const std::string& what) const;

  std::istream& in_;
  std::string file_;
  std::string columns_;
  std::string block_;  ///< text up to a line feed: several lines of old Macintosh files
  std::size_t next_ = std::string::npos;  ///< index in the block at which its next line begins
  std::string line_;
  int line_number_ = 0;
  int rows_ = 0;
  std::vector<Field> fields_;
  int end_column_ = 1;  ///< column that a further field would have
};

}  // namespace ergotic::scene
