// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/csv.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ergotic/exception.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr char kHowToSave[] =
    "allowed: commas between the fields and points in the numbers (in a spreadsheet, save as CSV "
    "with English number formats)";

bool endsField(char c) {
  return c == ',' || c == ' ' || c == '\t' || c == '#' || c == ';';
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trimmedView(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(kBlanks), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// True for a word, but not for `nan`, which is a number that is not allowed.
bool isWord(std::string_view text) {
  const std::string small = inSmallLetters(text);
  const bool has_letter = std::any_of(small.begin(), small.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80U;
  });
  return has_letter && !isDigit(small.front()) && small.front() != '-' && small.front() != '+' &&
         small.front() != '.' && small != "nan" && small != "inf" && small != "infinity";
}

/// A comma where a number has its point: `0,5`.
bool hasDecimalComma(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) {
    return false;
  }
  text[comma] = '.';
  return parseNumber(text).has_value();
}

}  // namespace

CsvReader::CsvReader(std::istream& in, std::string file, std::string columns)
    : in_(in), file_(std::move(file)), columns_(std::move(columns)) {}

bool CsvReader::next() {
  while (nextLine()) {
    if (rows_ == 0 && isSeparatorLine()) {
      continue;
    }
    split();
    if (!fields_.empty()) {
      ++rows_;
      return true;
    }
  }
  return false;
}

/// Lines end with LF, CR LF or CR.
bool CsvReader::nextLine() {
  if (next_ == std::string::npos) {
    if (!std::getline(in_, block_)) {
      if (in_.bad()) {
        failAtLine("the text cannot be read beyond this line");
      }
      return false;
    }
    if (line_number_ == 0) {
      refuseUtf16(block_, file_);
      block_.erase(0, byteOrderMark(block_));
    }
    next_ = 0;
  }
  const std::size_t end = std::min(block_.find('\r', next_), block_.size());
  line_.assign(block_, next_, end - next_);
  next_ = end + 1 < block_.size() ? end + 1 : std::string::npos;
  ++line_number_;
  return true;
}

/// `sep=,`, which spreadsheets read and write.
bool CsvReader::isSeparatorLine() {
  std::string line = inSmallLetters(line_);
  line.erase(std::remove(line.begin(), line.end(), '"'), line.end());
  if (line.compare(0, 4, "sep=") != 0) {
    return false;
  }
  const std::string separator = line.substr(4);
  if (separator.empty() || separator[0] == ',' || separator[0] == '\t' || separator[0] == ' ') {
    return true;
  }
  failAt(0,
         std::string("the line names another separator of the fields than a comma, ") + kHowToSave);
}

void CsvReader::split() {
  fields_.clear();
  const auto skipBlanks = [this](std::size_t from) {
    return std::min(line_.find_first_not_of(kBlanks, from), line_.size());
  };
  std::size_t at = skipBlanks(0);
  bool has_blanks = false;  // alone between two fields
  while (at < line_.size() && line_[at] != '#') {
    const std::size_t end = takeField(at);
    at = skipBlanks(end);
    const bool is_comma = at < line_.size() && line_[at] == ',';
    has_blanks = has_blanks || (!is_comma && at > end && at < line_.size() && line_[at] != '#');
    at = is_comma ? skipBlanks(at + 1) : at;
  }
  checkWords(at);
  if (has_blanks) {
    refuseDecimalCommas(at);
  }
  while (!fields_.empty() && fields_.back().text.empty()) {
    fields_.pop_back();
  }
  end_column_ = static_cast<int>(at) + 1;
}

/// Comments may have any bytes.
void CsvReader::checkWords(std::size_t end) const {
  const auto isPlain = [](char c) { return (c >= ' ' && c < '\x7F') || c == '\t'; };
  if (!std::all_of(line_.begin(), line_.begin() + static_cast<std::ptrdiff_t>(end), isPlain)) {
    checkBytes(line_.substr(0, end), file_, Bytes::kUtf8, line_number_);
  }
}

/// \return where it ends
std::size_t CsvReader::takeField(std::size_t at) {
  if (line_[at] == '"') {
    return takeQuoted(at);
  }
  std::size_t end = at;
  while (end < line_.size() && !endsField(line_[end])) {
    ++end;
  }
  if (end < line_.size() && line_[end] == ';') {
    failAt(end, std::string("a semicolon separates the fields, as spreadsheets write it where "
                            "numbers have commas, ") +
                    kHowToSave);
  }
  fields_.push_back({std::string_view(line_).substr(at, end - at), static_cast<int>(at) + 1});
  return end;
}

/// `""` in it is a quotation mark, of which one is left in the line.
std::size_t CsvReader::takeQuoted(std::size_t at) {
  std::size_t end = at + 1;
  std::size_t written = end;
  for (;; ++end) {
    if (end >= line_.size()) {
      failAt(at,
             "a quotation mark opens a field that does not end in its line, allowed: one at each "
             "end of a field");
    }
    if (line_[end] == '"' && line_.compare(end, 2, "\"\"") != 0) {
      break;
    }
    end += line_[end] == '"' ? 1 : 0;
    line_[written++] = line_[end];
  }
  fields_.push_back({trimmedView(std::string_view(line_).substr(at + 1, written - at - 1)),
                     static_cast<int>(at) + 1});
  ++end;
  if (end < line_.size() && line_[end] == ';') {
    return takeField(end);  // says what it thinks of it
  }
  if (end < line_.size() && !endsField(line_[end])) {
    failAt(end, "text after the quotation mark that ends a field, allowed: a comma");
  }
  return end;
}

/// Refuses decimal commas: where blanks separate the fields, a comma between two digits is in a
/// number.
void CsvReader::refuseDecimalCommas(std::size_t end) const {
  for (std::size_t i = 1; i + 1 < end; ++i) {
    if (line_[i] == ',' && isDigit(line_[i - 1]) && isDigit(line_[i + 1])) {
      failAt(i, std::string("a comma between digits, where blanks separate the fields, ") +
                    kHowToSave);
    }
  }
}

std::string CsvReader::word(std::size_t field) const {
  return inSmallLetters(text(field));
}

bool CsvReader::isHeader() const {
  return rows_ == 1 && std::all_of(fields_.begin(), fields_.end(),
                                   [](const Field& field) { return isWord(field.text); });
}

double CsvReader::number(std::size_t field, std::string_view what, const Limits& limits) const {
  const std::optional<double> number = parseNumber(text(field));
  if (!number || !limits.hold(*number)) {
    refuseNumber(field, std::string(what), limits);
  }
  return *number;
}

void CsvReader::refuseNumber(std::size_t field,
                             const std::string& what,
                             const Limits& limits) const {
  const std::string given(text(field));
  if (given.empty()) {
    fail(field, what + " is missing, allowed: " + columns_);
  }
  if (hasDecimalComma(given)) {
    fail(field, what + " = " + quoted(given) + " has a decimal comma, " + kHowToSave);
  }
  if (const std::optional<double> number = parseNumber(given)) {
    fail(field, outOfRange(what, *number, limits));
  }
  fail(field, what + " = " + quoted(given) + " is not a finite number, allowed: " + limits.text());
}

double CsvReader::whole(std::size_t field, std::string_view what, const Limits& limits) const {
  const double value = number(field, what, limits);
  if (value != std::floor(value)) {
    fail(field, std::string(what) + " = " + numberText(value) + ", allowed: whole numbers");
  }
  return value;
}

void CsvReader::expectEnd(std::size_t fields) const {
  if (size() > fields) {
    fail(fields, "more than " + std::to_string(fields) + " fields in a line, allowed: " + columns_);
  }
}

void CsvReader::fail(std::size_t field, const std::string& what) const {
  const Place at = place(field);
  throw TextError(file_, at.line, at.column, what);
}

void CsvReader::failAtLine(const std::string& what) const {
  throw TextError(file_, std::max(line_number_, 1), 1, what);
}

void CsvReader::failAt(std::size_t offset, const std::string& what) const {
  throw TextError(file_, line_number_, static_cast<int>(offset) + 1, what);
}

}  // namespace ergotic::scene
