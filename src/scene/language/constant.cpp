// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/constant.hpp"

#include "scene/language/expression.hpp"
#include "scene/text/number.hpp"

namespace ergotic::scene {
namespace {

Constant constantOfScalar(const std::string& text) {
  const std::optional<Amount> number = parseAnyQuantity(text);
  return number ? Constant(*number) : Constant(text);
}

}  // namespace

Constant constantOf(const Node& node, const Part& owner) {
  return node.isScalar() ? constantOfScalar(node.text()) : Constant(Part(owner, &node));
}

Constant constantOf(Node node) {
  return node.isScalar() ? constantOfScalar(node.text())
                         : Constant(std::make_shared<const Node>(std::move(node)));
}

std::string bareTextOf(const Constant& constant) {
  const auto* const number = std::get_if<Amount>(&constant);
  return number != nullptr ? shortest(number->value) : std::get<std::string>(constant);
}

std::string textOf(const Constant& constant) {
  const auto* const number = std::get_if<Amount>(&constant);
  const std::string unit = number != nullptr ? number->kind.unit() : "";
  return bareTextOf(constant) + (unit.empty() ? "" : " ") + unit;
}

}  // namespace ergotic::scene
