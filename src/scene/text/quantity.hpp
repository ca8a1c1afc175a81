// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace ergotic::scene {

/// Why a text is no quantity: to follow the text in a message, as in ` is no finite number`.
struct NoQuantity {
  std::string reason;
};

/// A number with or without a unit, as in `2.5 kN/m`, `12 mm`, `300 ms`, in SI units; exactly what
/// the decimal number would be that says the same without one. Bare numbers are of `unit`.
/// Products of g, m, s, Hz, N, J, W, V, rad, deg with prefixes from n to G, `/` and `^2`. Where
/// `unit` is Hz also notes, as in `A#3` (A4 is 440 Hz, equal temperament); where it is none also
/// `%`, `dB` (of amplitudes) and `cents` (a ratio of pitches).
/// \param unit  of what is asked for, as in Limits
std::variant<double, NoQuantity> parseQuantity(std::string_view text, std::string_view unit);

/// Dimension of a number: powers of m, kg, s, V and rad, each in twelfths, so that a root has one
/// too. All 0: bare, or a ratio.
struct Kind {
  std::array<int, 5> twelfths{};

  bool isBare() const { return twelfths == Kind{}.twelfths; }
  bool operator==(const Kind& other) const { return twelfths == other.twelfths; }
  bool operator!=(const Kind& other) const { return !(*this == other); }
  /// Its unit, as `kg m/s^2`; empty if it is bare, or no product of whole units.
  std::string unit() const;
};

/// A number in SI units.
struct Amount {
  double value = 0.0;
  Kind kind{};
};

/// As parseQuantity(), of whatever kind; of notes nothing.
std::optional<Amount> parseAnyQuantity(std::string_view text);

/// Dimension of a unit as in Limits; bare if it is empty.
Kind kindOfUnit(std::string_view unit);

/// True for a unit whose numbers are written as they are, as `N/m`, `kg`, `Hz`.
bool isSiUnit(std::string_view unit);

/// False if one is a unit and the other a unit of another kind, or none. \pre `unit` is an SI unit,
/// or empty: not known
bool areOfOneKind(std::string_view unit, std::string_view other);

}  // namespace ergotic::scene
