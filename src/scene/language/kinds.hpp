// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scene/text/quantity.hpp"

/// Kinds of the results of calculations.
namespace ergotic::scene {

/// Common kind of numbers that are added or compared; a bare one is of the kind of the other.
/// Nothing: they are of different kinds.
std::optional<Kind> commonKind(const Kind& one, const Kind& other);

/// \param power  of `by`: -1 divides. Nothing: no unit has such a power
std::optional<Kind> productKind(const Kind& kind, const Kind& by, int power);

/// Nothing: no unit has such a power.
std::optional<Kind> powerKind(const Kind& kind, double power);

/// A number or an angle.
bool isPlainNumber(const Kind& kind);

/// Describes a kind for messages, as in `m` or `a number`.
std::string nameOf(const Kind& kind);

}  // namespace ergotic::scene
