// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/writer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "scene/language/expression.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxWritten = 500'000;  // scalars, lists and maps
constexpr std::size_t kMaxText = 8U << 20U;   // bytes in them and in what is evaluated
constexpr std::size_t kLongestWord = 4096;    // bytes, of what is put together
constexpr double kMaxTurns = 1e5;             // of a loop
constexpr double kLargestTurn = 1e15;         // whole numbers beyond have no next one
constexpr const char* kReferences[] = {"between", "at",   "mat",   "of",  "along",
                                       "normal",  "from", "guide", "ends"};

bool isExpression(const Node& node) {
  return node.isScalar() && !node.text().empty() && node.text()[0] == '=';
}

}  // namespace

bool Writer::isReference(const std::string& key) {
  return std::find(std::begin(kReferences), std::end(kReferences), key) != std::end(kReferences);
}

Place Writer::placeIn(const Node& node, const Frame& frame) const {
  return placeIn(node.place(), frame);
}

Place Writer::placeIn(Place place, const Frame& frame) {
  place.origin = frame.origin > 0 && place.origin == frame.text ? frame.origin : place.origin;
  return place;
}

void Writer::fail(const Node& node, const Frame& frame, const std::string& what) const {
  builder_.fail(placeIn(node, frame), what);
}

void Writer::count(const Node& node, const Frame& frame, std::size_t nodes) {
  if ((written_ += nodes) > kMaxWritten) {
    fail(node, frame,
         "with all its loops and definitions expanded the scene has more than " +
             std::to_string(kMaxWritten) + " scalars, lists and maps");
  }
}

void Writer::countText(std::size_t bytes, const Node& node, const Frame& frame) {
  if ((text_ += bytes) > kMaxText) {
    fail(node, frame,
         "with all its loops and definitions expanded the scene has more than " +
             std::to_string(kMaxText) + " bytes of words and expressions");
  }
}

/// Counts a list that is written in place of its name, before it takes room.
void Writer::countAll(const Node& list, const Node& asked, const Frame& frame) {
  count(asked, frame);
  countText(list.text().size(), asked, frame);
  for (const Node& part : list) {
    countAll(part, asked, frame);
  }
}

std::string Writer::renamed(const std::string& name, const Frame& frame) {
  if (frame.prefix.empty()) {
    return name;
  }
  const std::string head = name.substr(0, name.find_first_of(".@/"));
  return frame.heads.count(head) > 0 ? frame.prefix + name : name;
}

Constant Writer::evaluated(const Node& node,
                           std::size_t from,
                           std::string_view expression,
                           const Frame& frame,
                           const Scope& scope) {
  countText(expression.size(), node, frame);
  try {
    return evaluate(expression, scope);
  } catch (const ExpressionError& error) {
    builder_.fail(placeIn(node.placeOf(from + error.at()), frame),
                  "in " + quoted(node.text()) + ": " + error.what());
  }
}

std::string Writer::word(const Node& node, const Frame& frame, const Scope& scope) {
  if (!node.isScalar()) {
    fail(node, frame, "a name is no single word");
  }
  const std::string& text = node.text();
  std::string result;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = text.find('{', at);
    result += text.substr(at, open - at);
    if (at > 0 && result.size() > kLongestWord) {
      fail(node, frame,
           quoted(text) + " becomes more than " + std::to_string(kLongestWord) + " bytes");
    }
    if (open == std::string::npos) {
      countText(frame.prefix.size() + result.size(), node, frame);
      return result;
    }
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      fail(node, frame, quoted(text) + " has a '{' without '}'");
    }
    const Constant value =
        evaluated(node, open + 1, text.substr(open + 1, close - open - 1), frame, scope);
    if (std::holds_alternative<Part>(value)) {
      fail(node, frame, quoted(text) + " has a list in braces, allowed: numbers and words");
    }
    result += bareTextOf(value);
    at = close + 1;
  }
}

Constant Writer::constant(const Node& node, const Frame& frame, const Scope& scope) {
  if (isExpression(node)) {
    Constant value = evaluated(node, 1, std::string_view(node.text()).substr(1), frame, scope);
    if (const auto* const list = std::get_if<Part>(&value)) {
      countAll(**list, node, frame);
    }
    return value;
  }
  return constantOf(write(node, frame, scope));
}

Node Writer::placed(const Node& value, Place place) {
  Node copy(value.kind(), place, value.text());
  for (const Node& part : value.parts()) {
    copy.add(placed(part, place));
  }
  return copy;
}

Node Writer::writeScalar(const Node& node,
                         const Frame& frame,
                         const Scope& scope,
                         bool is_reference) {
  const Place place = placeIn(node, frame);
  const std::string& said = node.text();
  if (isExpression(node)) {
    const Constant value = constant(node, frame, scope);
    const Part* const list = std::get_if<Part>(&value);
    if (list != nullptr) {
      return placed(**list, place);
    }
    const Amount* const number = std::get_if<Amount>(&value);
    if (number != nullptr && !number->kind.isBare() && number->kind.unit().empty()) {
      fail(node, frame, quoted(said) + " is in a power of units that no key has");
    }
    return {Node::Kind::kScalar, place, textOf(value)};
  }
  const std::string text = word(node, frame, scope);
  return {Node::Kind::kScalar, place, is_reference ? renamed(text, frame) : text};
}

/// The section that plays a role.
Node Writer::sectionOf(Node role, const Frame& frame) {
  const auto found = frame.sections.find(role.text());
  return found == frame.sections.end() ? std::move(role)
                                       : Node(Node::Kind::kScalar, role.place(), found->second);
}

Node Writer::write(const Node& node, const Frame& frame, const Scope& scope, bool is_reference) {
  count(node, frame);
  if (node.isScalar()) {
    return writeScalar(node, frame, scope, is_reference);
  }
  Node result(node.kind(), placeIn(node, frame));
  for (std::size_t i = 0; i < node.parts().size(); ++i) {
    const bool is_key = node.isMap() && i % 2 == 0;
    const bool names = node.isMap() && !is_key ? isReference(node[i - 1].text()) : is_reference;
    Node part = write(node[i], frame, scope, !is_key && names);
    const bool is_section = node.isMap() && !is_key && node[i - 1].text() == "section";
    result.add(is_section ? sectionOf(std::move(part), frame) : std::move(part));
  }
  return result;
}

/// `0..11`, `0..n-1`, or a list.
std::vector<Constant> Writer::itemsOf(const Node& values, const Frame& frame, const Scope& scope) {
  std::vector<Constant> items;
  const std::size_t dots = values.isScalar() ? values.text().find("..") : std::string::npos;
  if (dots == std::string::npos) {
    const Constant list = constant(values, frame, scope);
    const Part* const part = std::get_if<Part>(&list);
    if (part == nullptr || !(*part)->isList()) {
      fail(values, frame, "a loop goes over a range as 0..11 or over a list");
    }
    std::transform((*part)->begin(), (*part)->end(), std::back_inserter(items),
                   [&](const Node& item) { return constantOf(item, *part); });
    return items;
  }
  const std::string_view text = values.text();
  double ends[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t from = i == 0 ? 0 : dots + 2;
    const Constant end =
        evaluated(values, from, i == 0 ? text.substr(0, dots) : text.substr(from), frame, scope);
    const Amount* const number = std::get_if<Amount>(&end);
    if (number == nullptr || !number->kind.isBare() || number->value != std::floor(number->value) ||
        std::abs(number->value) > kLargestTurn) {
      fail(values, frame,
           "an end of " + quoted(values.text()) + " is no whole number from -1e15 to 1e15");
    }
    ends[i] = number->value;
  }
  if (ends[1] - ends[0] > kMaxTurns) {
    fail(values, frame, "a loop of more than " + std::to_string(static_cast<int>(kMaxTurns)));
  }
  for (double i = ends[0]; i <= ends[1]; ++i) {
    items.emplace_back(Amount{i});
  }
  return items;
}

void Writer::loop(const Node& loops,
                  std::size_t variable,
                  const Frame& frame,
                  const Scope& scope,
                  const Each& each) {
  if (2 * variable == loops.parts().size()) {
    each(scope);
    return;
  }
  const std::string name = loops[2 * variable].text();
  const std::vector<Constant> items = itemsOf(loops[2 * variable + 1], frame, scope);
  for (std::size_t i = 0; i < items.size(); ++i) {
    count(loops, frame);
    Scope inner(&scope);
    inner.set(name, items[i]);
    inner.set(name + "#", Amount{static_cast<double>(i)});
    loop(loops, variable + 1, frame, inner, each);
  }
}

void Writer::forEach(const Node& element,
                     const Frame& frame,
                     const Scope& scope,
                     const Each& each) {
  const Node* const when = element.find("when");
  const auto ifTrue = [&](const Scope& inner) {
    if (when == nullptr) {
      each(inner);
      return;
    }
    const Constant value = constant(*when, frame, inner);
    const Amount* const number = std::get_if<Amount>(&value);
    if (number == nullptr) {
      fail(*when, frame, "'when' is no number, allowed: an expression, 0 is false");
    }
    if (number->value != 0.0) {
      each(inner);
    }
  };
  const Node* const loops = element.find("for");
  if (loops == nullptr) {
    ifTrue(scope);
    return;
  }
  if (!loops->isMap()) {
    fail(*loops, frame, "'for' is no map, allowed: {i: 0..11}");
  }
  loop(*loops, 0, frame, scope, ifTrue);
}

}  // namespace ergotic::scene
