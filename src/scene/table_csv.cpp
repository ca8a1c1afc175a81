// SPDX-License-Identifier: BSD-3-Clause
#include "scene/table_csv.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/number.hpp"
#include "scene/source_text.hpp"

namespace ergotic::scene {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// One line of two numbers.
class CsvLine {
 public:
  CsvLine(const std::string& file, int line, std::string_view text)
      : file_(file), line_(line), text_(text.substr(0, text.find('#'))) {
    skipBlanks();
  }

  bool empty() const { return at_ == text_.size(); }

  double number(const std::string& what, const Limits& limits) {
    start_ = at_;
    const std::size_t end = std::min(text_.find_first_of(" \t\r,", at_), text_.size());
    const std::string word(text_.substr(at_, end - at_));
    at_ = end;
    if (word.empty()) {
      fail(what + " is missing, allowed: two numbers in a line");
    }
    const std::optional<double> number = parseNumber(word);
    if (!number) {
      fail(what + " = " + quoted(word) + " is not a finite number, allowed: " + limits.text());
    }
    if (!limits.hold(*number)) {
      fail(outOfRange(what, *number, limits));
    }
    return *number;
  }

  void skipSeparator() {
    skipBlanks();
    if (!empty() && text_[at_] == ',') {
      ++at_;
      skipBlanks();
    }
  }

  void expectEnd() {
    skipBlanks();
    start_ = at_;
    if (!empty()) {
      fail("more than two numbers in a line, allowed: two");
    }
  }

  /// At the number that was read last, or tried.
  [[noreturn]] void fail(const std::string& what) const {
    throw TextError(file_, line_, static_cast<int>(start_) + 1, what);
  }

 private:
  void skipBlanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

  const std::string& file_;
  int line_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;
};

}  // namespace

Table readTableCsv(const std::string& text, const std::string& file) {
  checkBytes(text, file, Bytes::kUtf8);
  Table table;
  int line = 0;
  std::size_t begin = byteOrderMark(text);
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    CsvLine csv(file, ++line, std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (csv.empty()) {
      continue;
    }
    const Limits first =
        table.empty() ? Limits{} : Limits{"", table.points.back().first, kInfinity, true};
    const double x = csv.number("first number of a point", first);
    if (table.points.size() == kMaxTablePoints) {
      csv.fail("too many points, allowed: 2..." + std::to_string(kMaxTablePoints));
    }
    csv.skipSeparator();
    table.points.emplace_back(x, csv.number("force of a point", kForceLimits));
    csv.expectEnd();
  }
  if (table.points.size() < 2) {
    throw TextError(file, std::max(line, 1), 1,
                    "the table has " + std::to_string(table.points.size()) +
                        " points, allowed: 2..." + std::to_string(kMaxTablePoints));
  }
  return table;
}

}  // namespace ergotic::scene
