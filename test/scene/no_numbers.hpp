// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <regex>

#include "support/test.hpp"

namespace ergotic::scene {

/// Fails unless `read(text)` takes a text, and refuses it, with a place, wherever one of its
/// numbers is replaced by one that is not finite. \return numbers
template <class Read>
int expectFiniteNumbers(const std::string& text, const Read& read) {
  EXPECT_NO_THROW(read(text));
  const std::regex number(R"(([\s\[,:])([-+]?[0-9][0-9.eE+-]*)(?=[\s,\]\}]))");
  int count = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at) {
    const auto where = static_cast<std::size_t>(at->position(2));
    const std::size_t line = text.rfind('\n', where) + 1;
    if (text.substr(line, where - line).find('#') != std::string::npos) {
      continue;
    }
    ++count;
    for (const char* word : {"nan", ".nan", "inf", "-.inf", "1e999"}) {
      std::string spoilt = text;
      spoilt.replace(where, at->str(2).size(), word);
      EXPECT_THAT(complaintOf<TextError>([&] { read(spoilt); }), HasSubstr(": error: "))
          << spoilt.substr(line, spoilt.find('\n', line) - line);
    }
  }
  return count;
}

}  // namespace ergotic::scene
