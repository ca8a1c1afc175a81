// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {

/// One line of words with commas or blanks between them; `#` begins a comment.
class CsvLine {
 public:
  CsvLine(const std::string& file, int line, std::string_view text)
      : file_(file), line_(line), text_(text.substr(0, text.find('#'))) {
    skipBlanks();
  }

  /// True if nothing is left.
  bool empty() const { return at_ == text_.size(); }

  /// The next word, empty if there is none.
  std::string word() {
    start_ = at_;
    const std::size_t end = std::min(text_.find_first_of(" \t\r,", at_), text_.size());
    std::string word(text_.substr(at_, end - at_));
    at_ = end;
    return word;
  }

  /// \param expected  what a line has, for messages
  double number(const std::string& what, const Limits& limits, const std::string& expected) {
    const std::string text = word();
    if (text.empty()) {
      fail(what + " is missing, allowed: " + expected);
    }
    const std::optional<double> number = parseNumber(text);
    if (!number) {
      fail(what + " = " + quoted(text) + " is not a finite number, allowed: " + limits.text());
    }
    if (!limits.hold(*number)) {
      fail(outOfRange(what, *number, limits));
    }
    return *number;
  }

  /// What separates a word from the one after it.
  void skipSeparator() {
    skipBlanks();
    if (!empty() && text_[at_] == ',') {
      ++at_;
      skipBlanks();
    }
  }

  /// \throws TextError with this message if anything is left
  void expectEnd(const std::string& message) {
    skipBlanks();
    start_ = at_;
    if (!empty()) {
      fail(message);
    }
  }

  /// At the word that was read last, or tried.
  [[noreturn]] void fail(const std::string& what) const {
    throw TextError(file_, line_, static_cast<int>(start_) + 1, what);
  }

 private:
  void skipBlanks() { at_ = std::min(text_.find_first_not_of(" \t\r", at_), text_.size()); }

  const std::string& file_;
  int line_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;
};

/// Calls `read(line)` for every line that has words. \return lines
/// \throws TextError if the text has bytes that none may have
template <class Read>
int forEachCsvLine(const std::string& text, const std::string& file, const Read& read) {
  checkBytes(text, file, Bytes::kUtf8);
  int line = 0;
  std::size_t begin = byteOrderMark(text);
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    CsvLine csv(file, ++line, std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    if (!csv.empty()) {
      read(csv);
    }
  }
  return line;
}

}  // namespace ergotic::scene
