// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mdl/mdl_lexer.hpp"

#include <algorithm>
#include <utility>

#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kBlanks = " \t\r";

/// The tokens of one line, whose comment is already cut off.
class LineCutter {
 public:
  LineCutter(const SceneBuilder& builder, const std::string& line, int number, std::size_t start)
      : builder_(builder), line_(line), number_(number), at_(start) {}

  Place place() const { return {number_, static_cast<int>(at_) + 1}; }

  bool skipBlanks() {
    at_ = std::min(line_.find_first_not_of(kBlanks, at_), line_.size());
    return at_ < line_.size();
  }

  MdlToken next() {
    switch (line_[at_]) {
      case '[':
        return group(MdlToken::Kind::kBracket, ']');
      case '\'':
        return group(MdlToken::Kind::kQuoted, '\'');
      case '+':
        builder_.fail(place(),
                      "a '+' outside brackets, allowed: an expression with '+' or "
                      "blanks in brackets, as in [a + b]");
      default:
        return bare();
    }
  }

 private:
  MdlToken bare() {
    const std::size_t end = std::min(line_.find_first_of(" \t\r+['", at_), line_.size());
    MdlToken token{MdlToken::Kind::kBare, line_.substr(at_, end - at_), place()};
    at_ = end;
    return token;
  }

  MdlToken group(MdlToken::Kind kind, char closing) {
    const char opening = line_[at_];
    const Place start = place();
    ++at_;
    MdlToken token{kind, "", place()};
    const std::size_t end = line_.find(closing, at_);
    if (end == std::string::npos) {
      builder_.fail(start, std::string("missing ") + closing + " for this " + opening);
    }
    token.text = line_.substr(at_, end - at_);
    const std::size_t nested = token.text.find('[');
    if (nested != std::string::npos) {
      at_ += nested;
      builder_.fail(place(), "brackets in brackets, allowed: one level");
    }
    at_ = end + 1;
    if (kind == MdlToken::Kind::kBracket) {
      cutPoint(token);
    }
    return token;
  }

  /// `@macro a b`: its name and its coordinates.
  static void cutPoint(MdlToken& token) {
    const std::string text = token.text;
    std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    if (begin == text.size() || text[begin] != '@') {
      return;
    }
    const Place origin = token.place;
    for (bool is_name = true; begin < text.size(); is_name = false) {
      const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
      const Place place{origin.line, origin.column + static_cast<int>(begin)};
      const MdlToken part{MdlToken::Kind::kBare, text.substr(begin, end - begin), place};
      if (is_name) {
        token.text = part.text;
        token.place = part.place;
      } else {
        token.at.push_back(part);
      }
      begin = std::min(text.find_first_not_of(kBlanks, end), text.size());
    }
  }

  const SceneBuilder& builder_;
  const std::string& line_;
  int number_;
  std::size_t at_;
};

void expectUtf8(const SceneBuilder& builder, const std::string& line, int number) {
  const std::size_t bad = findNonUtf8(line);
  if (bad != std::string::npos) {
    builder.fail({number, static_cast<int>(bad) + 1},
                 "a byte that is not UTF-8, allowed: in comments only");
  }
}

MdlLine cutElement(const SceneBuilder& builder,
                   const std::string& line,
                   int number,
                   std::size_t start) {
  expectUtf8(builder, line, number);
  LineCutter cutter(builder, line, number, start);
  MdlLine element;
  element.place = cutter.place();
  element.name = cutter.next().text.substr(1);
  if (element.name.empty()) {
    builder.fail(element.place, "a '@' without a name, allowed: @name keyword arguments");
  }
  if (!cutter.skipBlanks()) {
    builder.fail(element.place, "element " + quoted("@" + element.name) +
                                    " has no keyword, allowed: @name keyword arguments");
  }
  element.keyword = cutter.next();
  while (cutter.skipBlanks()) {
    element.arguments.push_back(cutter.next());
  }
  return element;
}

/// `~begin NAME`, `~end NAME`; another line that begins with `~` is prose.
bool cutGroup(const SceneBuilder& builder,
              const std::string& line,
              int number,
              std::size_t start,
              std::vector<MdlLine>& lines) {
  const std::size_t end = std::min(line.find_first_of(kBlanks, start), line.size());
  const std::string keyword = line.substr(start, end - start);
  if (keyword != kBeginGroup && keyword != kEndGroup) {
    return false;
  }
  expectUtf8(builder, line, number);
  const Place place{number, static_cast<int>(start) + 1};
  const std::string name = trimmed(line.substr(end));
  if (name.empty()) {
    builder.fail(place, quoted(keyword) + " without a name, allowed: " + keyword + " NAME");
  }
  lines.push_back({name, {MdlToken::Kind::kBare, keyword, place}, {}, place});
  return true;
}

/// `m mass 1 0 0` is most likely an element that lost its `@`: any word, a keyword, a value.
bool looksLikeElement(const std::string& line, std::size_t start) {
  const std::size_t second = line.find_first_not_of(kBlanks, line.find_first_of(kBlanks, start));
  const std::size_t third = line.find_first_not_of(kBlanks, line.find_first_of(kBlanks, second));
  if (second == std::string::npos || third == std::string::npos || line[start] == '~') {
    return false;
  }
  const std::string word = line.substr(second, line.find_first_of(kBlanks, second) - second);
  const auto& keywords = mdlKeywords();
  return std::find(keywords.begin(), keywords.end(), word) != keywords.end() &&
         std::string("0123456789.-[@").find(line[third]) != std::string::npos;
}

}  // namespace

const std::vector<std::string>& mdlKeywords() {
  static const std::vector<std::string> kKeywords = {
      "mass",         "osc",     "ground",    "posInput",    "spring",    "damper",
      "springDamper", "contact", "nlContact", "nlSpring2",   "nlSpring3", "nlSpringDamper",
      "nlPluck",      "nlBow",   "frcInput",  "posOutput",   "frcOutput", "param",
      "audioParam",   "string",  "chain",     "stiffString", "mesh",      "cornerMesh",
      "closedMesh",   "massG",   "nlSpring",  "detent"};
  return kKeywords;
}

std::string ofElement(const std::string& what, const MdlLine& line) {
  return what + " of " + quoted("@" + line.name);
}

std::vector<MdlLine> cutMdl(SceneBuilder& builder, const std::string& text) {
  std::vector<MdlLine> elements;
  std::size_t begin = byteOrderMark(text);
  const std::size_t mark = begin;
  for (int number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    // The mark counts in the columns of the first line, as it does for an editor's byte offset.
    const std::size_t origin = number == 1 ? begin - mark : begin;
    std::string line = text.substr(origin, end - origin);
    const std::size_t first = begin - origin;
    line.resize(std::min(line.find('#', first), line.size()));
    const std::size_t start = line.find_first_not_of(kBlanks, first);
    begin = end + 1;
    if (start == std::string::npos) {
      continue;
    }
    if (line[start] == '@') {
      elements.push_back(cutElement(builder, line, number, start));
    } else if (!cutGroup(builder, line, number, start, elements) && looksLikeElement(line, start)) {
      builder.warn({number, static_cast<int>(start) + 1},
                   "this line is skipped: an element begins with '@'");
    }
  }
  return elements;
}

}  // namespace ergotic::scene
