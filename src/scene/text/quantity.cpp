// SPDX-License-Identifier: BSD-3-Clause
#include "scene/text/quantity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "constants.hpp"
#include "scene/text/number.hpp"

namespace ergotic::scene {
namespace {
constexpr int kMaxPower = 4;
constexpr int kTwelve = 12;

/// A product of units: 10^decimals times `factor` of m^a kg^b s^c V^d rad^e.
struct Unit {
  std::array<int, 5> powers{};
  int decimals = 0;
  double factor = 1.0;

  void multiply(const Unit& by, int power) {
    for (std::size_t i = 0; i < powers.size(); ++i) {
      powers[i] += power * by.powers[i];
    }
    decimals += power * by.decimals;
    factor *= std::pow(by.factor, power);
  }
};

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

constexpr NamedUnit kUnits[] = {
    {"m", {{1, 0, 0, 0, 0}}},   {"g", {{0, 1, 0, 0, 0}, -3}},
    {"s", {{0, 0, 1, 0, 0}}},   {"Hz", {{0, 0, -1, 0, 0}}},
    {"N", {{1, 1, -2, 0, 0}}},  {"J", {{2, 1, -2, 0, 0}}},
    {"W", {{2, 1, -3, 0, 0}}},  {"V", {{0, 0, 0, 1, 0}}},
    {"rad", {{0, 0, 0, 0, 1}}}, {"deg", {{0, 0, 0, 0, 1}, 0, kPi / 180.0}}};

struct Prefix {
  std::string_view name;
  int decimals;
};

constexpr Prefix kPrefixes[] = {{"n", -9}, {"u", -6}, {"\xC2\xB5", -6}, {"m", -3},
                                {"c", -2}, {"k", 3},  {"M", 6},         {"G", 9}};

std::optional<Unit> knownUnit(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(kUnits), std::end(kUnits),
                   [name](const NamedUnit& known) { return known.name == name; });
  return found == std::end(kUnits) ? std::nullopt : std::optional(found->unit);
}

/// Parses a unit without powers, as `m`, `mm`, `kN`.
std::optional<Unit> simpleUnit(std::string_view name) {
  if (const std::optional<Unit> known = knownUnit(name)) {
    return known;
  }
  for (const Prefix& prefix : kPrefixes) {
    if (name.substr(0, prefix.name.size()) != prefix.name) {
      continue;
    }
    if (std::optional<Unit> known = knownUnit(name.substr(prefix.name.size()))) {
      known->decimals += prefix.decimals;
      return known;
    }
  }
  return std::nullopt;
}

/// Multiplies a product by a factor, as `m`, `m^2`; `1` is nothing.
bool multiply(Unit& product, std::string_view factor, int sign) {
  const std::size_t hat = factor.find('^');
  const std::optional<int> power =
      hat == std::string_view::npos ? 1 : parseInteger(factor.substr(hat + 1));
  const std::optional<Unit> unit =
      factor == "1" ? std::optional(Unit()) : simpleUnit(factor.substr(0, hat));
  if (!unit || !power || *power < 1 || *power > kMaxPower) {
    return false;
  }
  product.multiply(*unit, sign * *power);
  return true;
}

/// Parses a unit, as `N s/m`, `m/s^2`, `1/s`: what follows a slash divides, up to the next blank or
/// slash.
std::optional<Unit> parseUnit(std::string_view text) {
  Unit product;
  int sign = 1;
  while (true) {
    const std::size_t end = std::min(text.find_first_of(" /*"), text.size());
    if (!multiply(product, text.substr(0, end), sign)) {
      return std::nullopt;
    }
    if (end == text.size()) {
      return product;
    }
    sign = text[end] == '/' ? -1 : 1;
    text.remove_prefix(end + 1);
  }
}

/// Powers of ten go into the text of the number: one rounding. \pre it is a number
std::optional<double> scaled(std::string_view number, const Unit& unit) {
  const std::size_t end = std::min(number.find_first_of("eE"), number.size());
  constexpr int kLargestExponent = 100'000;  // beyond it is 0 or no finite number anyway
  const int exponent = end == number.size()
                           ? 0
                           : std::clamp(parseInteger(number.substr(end + 1)).value_or(0),
                                        -kLargestExponent, kLargestExponent);
  const std::optional<double> value = parseNumber(std::string(number.substr(0, end)) + "e" +
                                                  std::to_string(exponent + unit.decimals));
  return value ? std::optional(*value * unit.factor) : std::nullopt;
}

/// Frequency of a note, as `A4`, `C#3`, `Eb-1`, Hz.
std::optional<double> parseNote(std::string_view text) {
  constexpr std::string_view kLetters = "C D EF G A B";
  const std::size_t letter =
      text.empty() || text[0] == ' ' ? std::string_view::npos : kLetters.find(text[0]);
  if (letter == std::string_view::npos) {
    return std::nullopt;
  }
  int semitone = static_cast<int>(letter);
  text.remove_prefix(1);
  if (!text.empty() && (text[0] == '#' || text[0] == 'b')) {
    semitone += text[0] == '#' ? 1 : -1;
    text.remove_prefix(1);
  }
  const std::optional<int> octave = parseInteger(text);
  if (!octave || *octave < -1 || *octave > 10) {
    return std::nullopt;
  }
  constexpr int kA4 = 57;  // semitones above C0
  return 440.0 * std::exp2((12 * *octave + semitone - kA4) / 12.0);
}

/// Value of a ratio in %, dB or cents; nullopt for other units.
std::optional<double> parseRatio(double number, std::string_view unit) {
  if (unit == "%") {
    return number / 100.0;
  }
  if (unit == "dB") {
    return std::pow(10.0, number / 20.0);
  }
  return unit == "cents" ? std::optional(std::exp2(number / 1200.0)) : std::nullopt;
}

std::string inQuotes(std::string_view text) {
  return "'" + std::string(text) + "'";
}

/// \param number  text of one
/// \param unit    nothing: any
std::variant<double, NoQuantity> withUnit(std::string_view number,
                                          std::string_view given,
                                          std::optional<std::string_view> unit) {
  const std::optional<double> ratio = parseRatio(parseNumber(number).value_or(0.0), given);
  const std::optional<Unit> known = parseUnit(given);
  if (!ratio && !known) {
    return NoQuantity{" has the unit " + inQuotes(given) + ", which is not known"};
  }
  const std::optional<Unit> wanted = unit ? parseUnit(*unit) : known;
  const bool fits = ratio ? !unit || unit->empty() : wanted && wanted->powers == known->powers;
  if (!fits) {
    return NoQuantity{" is of another kind"};
  }
  const std::optional<double> value = ratio ? ratio : scaled(number, *known);
  return value && std::isfinite(*value) ? std::variant<double, NoQuantity>(*value)
                                        : NoQuantity{" is not a finite number"};
}

std::variant<double, NoQuantity> parse(std::string_view text,
                                       std::optional<std::string_view> unit) {
  if (const std::optional<double> bare = parseNumber(text)) {
    return *bare;
  }
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789eE"), text.size());
  // An exponent ends with a digit: what follows may be a unit with a small e.
  const std::string number = trimmed(text.substr(0, end));
  if (!parseNumber(number) || end == text.size()) {
    return NoQuantity{" is not a finite number"};
  }
  return withUnit(number, trimmed(text.substr(end)), unit);
}

}  // namespace

std::variant<double, NoQuantity> parseQuantity(std::string_view text, std::string_view unit) {
  if (const std::optional<double> note = parseNote(text)) {
    return unit == "Hz" ? std::variant<double, NoQuantity>(*note)
                        : NoQuantity{" is a note, which is of another kind"};
  }
  return parse(text, unit);
}

std::optional<Amount> parseAnyQuantity(std::string_view text) {
  const auto quantity = parse(text, std::nullopt);
  const auto* const number = std::get_if<double>(&quantity);
  if (number == nullptr) {
    return std::nullopt;
  }
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789eE"), text.size());
  return Amount{*number, kindOfUnit(trimmed(text.substr(end)))};
}

Kind kindOfUnit(std::string_view unit) {
  Kind kind;
  if (const std::optional<Unit> known = parseUnit(unit)) {
    std::transform(known->powers.begin(), known->powers.end(), kind.twelfths.begin(),
                   [](int power) { return kTwelve * power; });
  }
  return kind;
}

std::string Kind::unit() const {
  constexpr std::array<const char*, 5> kNames = {"m", "kg", "s", "V", "rad"};
  std::string above;
  std::string below;
  for (std::size_t i = 0; i < twelfths.size(); ++i) {
    if (twelfths[i] % kTwelve != 0) {
      return "";
    }
    int left = std::abs(twelfths[i] / kTwelve);
    std::string& text = twelfths[i] > 0 ? above : below;
    while (left > 0) {
      const int power = std::min(left, kMaxPower);
      text += twelfths[i] > 0 ? (text.empty() ? "" : " ") : "/";
      text += kNames[i] + (power > 1 ? "^" + std::to_string(power) : std::string());
      left -= power;
    }
  }
  return (above.empty() && !below.empty() ? "1" : above) + below;
}

bool isSiUnit(std::string_view unit) {
  const std::optional<Unit> known = parseUnit(unit);
  return known && known->decimals == 0 && known->factor == 1.0;
}

bool areOfOneKind(std::string_view unit, std::string_view other) {
  const std::optional<Unit> one = parseUnit(unit);
  const std::optional<Unit> two = parseUnit(other);
  return !one || (two && one->powers == two->powers);
}

}  // namespace ergotic::scene
