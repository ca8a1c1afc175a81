// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/csv.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>

#include "ergotic/exception.hpp"

namespace ergotic::tgr {
namespace {

constexpr std::string_view kSpaces = " \t\r";

}  // namespace

bool CsvReader::nextRow() {
  while (std::getline(in_, line_)) {
    ++line_number_;
    const std::size_t first = line_.find_first_not_of(kSpaces);
    if (first != std::string::npos && line_[first] != '#') {
      split();
      return true;
    }
  }
  return false;
}

void CsvReader::split() {
  fields_.clear();
  const std::string_view line = line_;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(kSpaces, begin), end);
    std::string_view field = line.substr(first, end - first);
    field = field.substr(0, field.find_last_not_of(kSpaces) + 1);
    fields_.push_back({field, static_cast<int>(first) + 1});
    begin = end + 1;
  }
}

void CsvReader::requireSize(std::size_t count) const {
  if (size() != count) {
    fail(std::min(size() - 1, count),
         std::to_string(size()) + " columns, expected " + std::to_string(count));
  }
}

void CsvReader::fail(std::size_t field, const std::string& what) const {
  throw TextError(name_, line_number_, fields_[field].column, what);
}

template <class Number>
Number CsvReader::parse(std::size_t field, const char* what, Number minimum, Number maximum) const {
  const std::string_view given = text(field);
  Number value{};
  const char* const end = given.data() + given.size();
  const auto [stopped, error] = std::from_chars(given.data(), end, value);
  if (error == std::errc{} && stopped == end && value >= minimum && value <= maximum) {
    return value;
  }
  std::ostringstream message;
  message << what << " '" << given << "', allowed " << minimum << "..." << maximum;
  fail(field, message.str());
}

double CsvReader::number(std::size_t field,
                         const char* what,
                         double minimum,
                         double maximum) const {
  return parse(field, what, minimum, maximum);
}

std::int64_t CsvReader::integer(std::size_t field,
                                const char* what,
                                std::int64_t minimum,
                                std::int64_t maximum) const {
  return parse(field, what, minimum, maximum);
}

}  // namespace ergotic::tgr
