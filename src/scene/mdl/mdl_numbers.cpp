// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mdl/mdl_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "scene/language/expression.hpp"
#include "scene/language/kinds.hpp"
#include "scene/text/number.hpp"
#include "scene/text/overrides.hpp"

namespace ergotic::scene {
namespace {

// Params that refer to params that refer to ...: with the nesting of expressions, bounds the stack.
constexpr int kLongestChain = 64;
constexpr double kRounding = 1e-12;    // of the parts of an expression
constexpr double kMinFollowed = 1e-9;  // of what must be above 0 and follows an audio input

bool isDigit(char c) {
  return (c >= '0' && c <= '9') || c == '.';
}
bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// Calls `take` with each name of an expression and where it stands; functions are none.
template <class Take>
void forEachName(const std::string& text, const Take& take) {
  std::size_t at = 0;
  const auto skip = [&](auto&& is_part) {
    const std::size_t first = at;
    while (at < text.size() && is_part(text[at])) {
      ++at;
    }
    return text.substr(first, at - first);
  };
  while (at < text.size()) {
    if (isDigit(text[at])) {
      skip(isDigit);
      const std::size_t sign = at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+');
      if (at + 1 + sign < text.size() && (text[at] == 'e' || text[at] == 'E') &&
          isDigit(text[at + 1 + sign])) {
        at += 1 + sign;
      }
    } else if (isLetter(text[at])) {
      const std::size_t first = at;
      const std::string name = skip([](char c) { return isLetter(c) || isDigit(c); });
      skip([](char c) { return c == ' '; });
      if (at == text.size() || text[at] != '(') {
        take(name, first);
      }
    } else {
      ++at;
    }
  }
}

}  // namespace

MdlNumbers::MdlNumbers(SceneBuilder& builder,
                       const std::vector<MdlLine>& lines,
                       const Overrides& overrides)
    : builder_(builder) {
  for (const MdlLine& line : lines) {
    if (line.keyword.text != "param") {
      continue;
    }
    if (line.name == kGesturalRateName) {
      builder.fail(line.place, "param name 'gestural_rate' is reserved");
    }
    if (line.arguments.size() != 1) {
      builder.fail(line.place, "param " + quoted(line.name) + " has " +
                                   std::to_string(line.arguments.size()) +
                                   " arguments, allowed: 1 (value)");
    }
    const auto [entry, is_new] = params_.emplace(line.name, Param{&line});
    if (!is_new) {
      builder.fail(line.place, "param " + quoted(line.name) + " is defined twice, first in line " +
                                   std::to_string(entry->second.line->place.line));
    }
    names_.push_back(line.name);
  }
  std::vector<std::string> known = names_;
  if (!isParam(kFaustClipName)) {
    known.emplace_back(kFaustClipName);
  }
  checkOverrides(overrides, known, builder.scene().file);
  const auto clip = overrides.find(kFaustClipName);
  is_faust_ = clip != overrides.end() && clip->second != 0.0;
  for (const auto& [name, value] : overrides) {
    const auto param = params_.find(name);
    if (param != params_.end()) {
      param->second.value = value;
      param->second.known = true;
    }
  }
}

void MdlNumbers::check() {
  for (const std::string& name : names_) {
    const double value = paramValue(name, params_.at(name).line->place);
    is_faust_ = name == kFaustClipName ? value != 0.0 : is_faust_;
  }
}

double MdlNumbers::paramValue(const std::string& name, Place place) {
  const auto found = params_.find(name);
  if (found == params_.end()) {
    builder_.fail(place, "unknown param " + quoted(name) + suggestion(name, names_));
  }
  Param& param = found->second;
  if (param.known) {
    return param.value;
  }
  if (param.open) {
    builder_.fail(place, "param " + quoted(name) + " is defined by itself");
  }
  if (++depth_ > kLongestChain) {
    builder_.fail(place, "param " + quoted(name) + " ends a chain of more than " +
                             std::to_string(kLongestChain) + " params");
  }
  param.open = true;
  param.value = evaluateAt(param.line->arguments.front());
  param.open = false;
  param.known = true;
  --depth_;
  return param.value;
}

double MdlNumbers::evaluateAt(const MdlToken& token) {
  const std::string& text = token.text;
  const auto placeOf = [&token](std::size_t offset) {
    return Place{token.place.line, token.place.column + static_cast<int>(offset)};
  };
  // A name may hold characters that no expression takes, so it is tried as a whole first.
  const std::string whole = trimmed(text);
  if (params_.count(whole) > 0) {
    return paramValue(whole, token.place);
  }
  if (const std::optional<double> number = parseNumber(whole)) {
    return *number;
  }
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), '\t', ' ');
  Scope scope;
  forEachName(spaced, [&](const std::string& name, std::size_t offset) {
    scope.set(name, Amount{nameValue(name, placeOf(offset))});
  });
  const std::string what = "expression " + quoted(text) + ": ";
  try {
    const Constant result = evaluate(spaced, scope);
    const auto* const amount = std::get_if<Amount>(&result);
    if (amount != nullptr && isPlainNumber(amount->kind)) {
      return amount->value;
    }
    builder_.fail(token.place, what + "it has a unit, allowed: a plain number");
  } catch (const ExpressionError& e) {
    builder_.fail(placeOf(e.at()), what + e.what());
  }
}

double MdlNumbers::nameValue(const std::string& name, Place place) {
  const std::vector<AudioParameter>& audio = builder_.scene().audio_parameters;
  const auto found = std::find_if(audio.begin(), audio.end(),
                                  [&](const AudioParameter& p) { return p.name == name; });
  if (found == audio.end()) {
    return paramValue(name, place);
  }
  if (!sample_) {
    builder_.fail(place, "audioParam " + quoted(name) +
                             " stands here, allowed only in places on macros, in the mass, "
                             "stiffness and damping of a mass or an osc, and in the stiffness, "
                             "damping, nonlinearity and width of a link");
  }
  const int index = static_cast<int>(found - audio.begin());
  if (followed_ >= 0 && followed_ != index) {
    builder_.fail(place, "two audioParams in one number, allowed: one");
  }
  followed_ = index;
  return *sample_;
}

double MdlNumbers::evaluateWith(const MdlToken& token, double sample) {
  sample_ = sample;
  const double value = number(token);
  sample_.reset();
  return value;
}

Value MdlNumbers::value(const MdlToken& token, const std::string& what, const Limits& limits) {
  const std::optional<AudioParameter> line = straightLine(token, what);
  if (!line) {
    return {number(token, what, limits)};
  }
  return line->offset == 0.0 ? Value{line->scale, -1, followed_} : followed(token, *line);
}

Value MdlNumbers::positiveValue(const MdlToken& token,
                                const std::string& what,
                                const Limits& limits) {
  std::optional<AudioParameter> line = straightLine(token, what);
  if (!line) {
    return {number(token, what, limits)};
  }
  line->minimum = kMinFollowed;
  return followed(token, *line);
}

/// The straight line that an expression is over its audioParam; nullopt if there is none in it.
std::optional<AudioParameter> MdlNumbers::straightLine(const MdlToken& token,
                                                       const std::string& what) {
  followed_ = -1;
  const double one = evaluateWith(token, 1.0);
  if (followed_ < 0) {
    return std::nullopt;
  }
  AudioParameter line = builder_.scene().audio_parameters[static_cast<std::size_t>(followed_)];
  line.offset = evaluateWith(token, 0.0);
  line.scale = one - line.offset;
  if (!isStraight(token, line.offset, line.scale)) {
    builder_.fail(token.place, what + " is '" + token.text +
                                   "', allowed with an audioParam: a constant plus a constant "
                                   "times it");
  }
  return line;
}

/// Whether an expression with an audioParam is a straight line over its samples.
bool MdlNumbers::isStraight(const MdlToken& token, double offset, double scale) {
  constexpr std::array<double, 4> kSamples{-1.0, 0.25, 2.0, 1000.0};
  return std::all_of(kSamples.begin(), kSamples.end(), [&](double sample) {
    const double wanted = offset + scale * sample;
    const double size = std::abs(offset) + std::abs(scale * sample);
    return std::abs(evaluateWith(token, sample) - wanted) <= kRounding * size;
  });
}

/// The audio parameter of an expression, which is made once.
Value MdlNumbers::followed(const MdlToken& token, AudioParameter parameter) {
  std::vector<AudioParameter>& all = builder_.scene().audio_parameters;
  const auto isSame = [&](const AudioParameter& other) {
    return other.channel == parameter.channel && other.scale == parameter.scale &&
           other.offset == parameter.offset && other.minimum == parameter.minimum;
  };
  const auto known = std::find_if(all.begin(), all.end(), isSame);
  if (known != all.end()) {
    return {1.0, -1, static_cast<int>(known - all.begin())};
  }
  parameter.name = trimmed(token.text);
  const auto isNamed = [&](const AudioParameter& other) { return other.name == parameter.name; };
  while (std::any_of(all.begin(), all.end(), isNamed)) {
    parameter.name += "'";
  }
  parameter.place = token.place;
  parameter.value = parameter.at(0.0);
  all.push_back(std::move(parameter));
  return {1.0, -1, static_cast<int>(all.size()) - 1};
}

double MdlNumbers::number(const MdlToken& token) {
  if (!token.text.empty() && token.text.front() == '@') {
    builder_.fail(token.place, quoted(token.text) + " is a module, allowed here: a number");
  }
  return evaluateAt(token);
}

double MdlNumbers::number(const MdlToken& token, const std::string& what, const Limits& limits) {
  const double value = number(token);
  if (!limits.hold(value)) {
    builder_.fail(token.place, outOfRange(what, value, limits, false));
  }
  return value;
}

MdlNumbers::Vector MdlNumbers::vector(const MdlToken& token) {
  constexpr const char* kSeparators = " \t\r,";
  std::array<double, 3> xyz{};
  std::size_t count = 0;
  std::size_t at = token.text.find_first_not_of(kSeparators);
  while (token.kind == MdlToken::Kind::kBracket && at != std::string::npos) {
    const std::size_t end = std::min(token.text.find_first_of(kSeparators, at), token.text.size());
    const std::optional<double> value =
        parseNumber(std::string_view(token.text).substr(at, end - at));
    if (!value || count == xyz.size()) {
      count = 0;
      break;
    }
    xyz[count++] = *value;
    at = token.text.find_first_not_of(kSeparators, end);
  }
  if (count == xyz.size()) {
    return {xyz[0], xyz[1], xyz[2]};
  }
  const bool expression = token.text.find_first_of("+*/(") != std::string::npos ||
                          token.text.find(" - ") != std::string::npos;
  if (token.text.find_first_of(kSeparators) != std::string::npos && !expression) {
    builder_.fail(token.place, "[" + token.text +
                                   "] is not a vector of 3 finite numbers, allowed: [x y z] or a "
                                   "single number");
  }
  return {0.0, 0.0, number(token)};
}

}  // namespace ergotic::scene
