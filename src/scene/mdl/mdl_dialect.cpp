// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mdl/mdl_dialect.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <set>

#include "scene/mdl/mdl_macros.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kBufferWords = 3;  // a name, X and Y behind a module of the older language

/// Arguments of a module without a gravity of its own; 0: the keyword is none of a module.
std::size_t moduleArguments(const std::string& keyword) {
  static const std::map<std::string, std::size_t> kCounts = {
      {"mass", 3}, {"massG", 4}, {"osc", 5}, {"ground", 1}, {"posInput", 1}};
  const auto found = kCounts.find(keyword);
  return found == kCounts.end() ? 0 : found->second;
}

/// A number of arguments that both languages give to no module.
bool hasBuffer(const MdlLine& line) {
  const std::size_t count = moduleArguments(line.keyword.text);
  if (count == 0 || line.arguments.size() != count + kBufferWords) {
    return false;
  }
  const std::string& name = line.arguments[count].text;
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0;
}

/// Names what only the older language has in a line; empty: nothing.
std::string olderSign(const MdlLine& line) {
  const std::string& keyword = line.keyword.text;
  const std::size_t count = line.arguments.size();
  if (keyword == "massG" || keyword == "nlSpring" || keyword == "detent") {
    return quoted(keyword);
  }
  if (keyword == "spring" && count == 4) {
    return "a 'spring' with a damping";
  }
  if (hasBuffer(line)) {
    return "a module with a buffer of the display";
  }
  const MdlMacro* const macro = findMacro(keyword);
  return macro != nullptr && count == macro->numbers() + 1 ? quoted(keyword) + " with one position"
                                                           : "";
}

/// Names what only the newer language has in a line; empty: nothing.
std::string newerSign(const MdlLine& line) {
  const std::string& keyword = line.keyword.text;
  const std::size_t count = line.arguments.size();
  if (keyword == kBeginGroup || keyword == kEndGroup || keyword == "nlContact" ||
      keyword == "nlSpringDamper") {
    return quoted(keyword);
  }
  if (std::any_of(line.arguments.begin(), line.arguments.end(),
                  [](const MdlToken& token) { return token.kind == MdlToken::Kind::kBracket; })) {
    return "brackets";
  }
  if ((keyword == "mass" && count == 4) || (keyword == "osc" && count == 6)) {
    return quoted(keyword) + " with gravity";
  }
  const MdlMacro* const macro = findMacro(keyword);
  return macro != nullptr && count >= macro->numbers() + 2 ? quoted(keyword) + " with a velocity"
                                                           : "";
}

/// How many of the first arguments of a line are modules.
std::size_t endsOf(const MdlLine& line) {
  const std::string& keyword = line.keyword.text;
  if (keyword == "frcInput" || keyword == "posOutput" || keyword == "frcOutput") {
    return 1;
  }
  return !line.arguments.empty() && line.arguments.front().text.compare(0, 1, "@") == 0 &&
                 keyword != "audioParam"
             ? 2
             : 0;
}

/// `0.3` or `0.3:0.7`
std::vector<MdlToken> coordinates(const MdlToken& token) {
  std::vector<MdlToken> parts;
  for (std::size_t begin = 0; begin <= token.text.size();) {
    const std::size_t end = std::min(token.text.find(':', begin), token.text.size());
    parts.push_back({MdlToken::Kind::kBare,
                     token.text.substr(begin, end - begin),
                     {token.place.line, token.place.column + static_cast<int>(begin)}});
    begin = end + 1;
  }
  return parts;
}

/// Gives the macros at the ends of a line the coordinates at its end.
void takeCoordinates(const SceneBuilder& builder,
                     const std::set<std::string>& macros,
                     MdlLine& line) {
  std::vector<MdlToken>& arguments = line.arguments;
  const std::size_t ends = std::min(endsOf(line), arguments.size());
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < ends; ++i) {
    if (macros.count(arguments[i].text) > 0) {
      points.push_back(i);
    }
  }
  if (arguments.size() < ends + points.size()) {
    const MdlToken& point = arguments[points.front()];
    builder.fail(point.place, quoted(point.text) +
                                  " is a macro without its place, allowed: a coordinate at the "
                                  "end of the line, 0.3, or 0.3:0.7 of a mesh");
  }
  const std::size_t rest = arguments.size() - points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    arguments[points[i]].at = coordinates(arguments[rest + i]);
  }
  arguments.resize(rest);
}

}  // namespace

MdlDialect dialectOf(const std::vector<MdlLine>& lines) {
  MdlDialect dialect;
  for (const MdlLine& line : lines) {
    const std::string newer = newerSign(line);
    if (!newer.empty()) {
      return {MdlDialect::Age::kNewer, line.place, newer};
    }
    const std::string older = dialect.isOld() ? "" : olderSign(line);
    if (!older.empty()) {
      dialect = {MdlDialect::Age::kOlder, line.place, older};
    }
  }
  return dialect;
}

std::string olderNote(const MdlLine& line, const MdlDialect& dialect) {
  const std::string older = olderSign(line);
  if (older.empty() || dialect.age != MdlDialect::Age::kNewer) {
    return "";
  }
  return "; " + older + " is of the older language, " + dialect.sign + " in line " +
         std::to_string(dialect.place.line) + " of the newer";
}

void expectArguments(const SceneBuilder& builder,
                     const MdlLine& line,
                     const MdlDialect& dialect,
                     std::size_t least,
                     std::size_t most,
                     const std::string& usage) {
  const std::size_t count = line.arguments.size();
  if (count < least || count > most) {
    builder.fail(count > most ? line.arguments[most].place : line.keyword.place,
                 quoted(line.keyword.text) + " has " + std::to_string(count) +
                     " arguments, allowed: " + line.keyword.text + " " + usage +
                     olderNote(line, dialect));
  }
}

void renew(const SceneBuilder& builder, std::vector<MdlLine>& lines) {
  std::set<std::string> macros;
  for (const MdlLine& line : lines) {
    if (findMacro(line.keyword.text) != nullptr) {
      macros.insert("@" + line.name);
    }
  }
  for (MdlLine& line : lines) {
    if (hasBuffer(line)) {
      line.arguments.resize(line.arguments.size() - kBufferWords);
    }
    takeCoordinates(builder, macros, line);
    if (line.keyword.text == "spring" && line.arguments.size() == 4) {
      line.keyword.text = "springDamper";
    }
  }
}

void checkGroups(SceneBuilder& builder, const std::vector<MdlLine>& lines) {
  std::map<std::string, Place> open;
  for (const MdlLine& line : lines) {
    const bool is_new =
        line.keyword.text == kBeginGroup && open.emplace(line.name, line.place).second;
    const bool is_ended = line.keyword.text == kEndGroup && open.erase(line.name) > 0;
    if (line.keyword.text == kBeginGroup && !is_new) {
      builder.warn(line.place, "group " + quoted(line.name) + " begins twice");
    } else if (line.keyword.text == kEndGroup && !is_ended) {
      builder.warn(line.place, "group " + quoted(line.name) + " ends, and did not begin");
    }
  }
  for (const auto& [name, place] : open) {
    builder.warn(place, "group " + quoted(name) + " does not end");
  }
}

}  // namespace ergotic::scene
