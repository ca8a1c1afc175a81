// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expression.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "constants.hpp"
#include "scene/language/functions.hpp"
#include "scene/language/kinds.hpp"
#include "scene/language/measured.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "scene/text/quantity.hpp"

namespace ergotic::scene {
namespace {

constexpr int kDeepestExpression = 100;
constexpr std::size_t kLongest = 4096;

constexpr const char* kNote = "note";
constexpr const char* kPiName = "pi";

class Parser {
 public:
  Parser(std::string_view text, const Scope& scope) : text_(text), scope_(scope) {}

  Constant run() {
    Constant value = choice();
    skip();
    if (at_ != text_.size()) {
      fail("'" + std::string(text_.substr(at_, 1)) + "' is not expected here");
    }
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw ExpressionError(what, at_); }

  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
    }
  }
  /// True, and beyond it, if that comes next.
  bool takes(std::string_view token) {
    skip();
    if (text_.substr(at_, token.size()) != token) {
      return false;
    }
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token) {
    if (!takes(token)) {
      fail("'" + std::string(token) + "' is missing");
    }
  }

  Amount number(const Constant& value) const {
    const auto* const number = std::get_if<Amount>(&value);
    if (number == nullptr) {
      if (unused_ > 0) {
        return {};
      }
      if (const std::optional<double> hz = noteIn(value)) {
        return {*hz, kindOfUnit("Hz")};
      }
      fail((std::holds_alternative<Part>(value) ? std::string("a list")
                                                : quoted(std::get<std::string>(value))) +
           " is no number");
    }
    return *number;
  }
  /// The frequency of a word that is the name of a note, as `A4`, Hz.
  static std::optional<double> noteIn(const Constant& value) {
    const auto* const word = std::get_if<std::string>(&value);
    const auto hz = parseQuantity(word == nullptr ? std::string() : *word, "Hz");
    const auto* const found = std::get_if<double>(&hz);
    return found == nullptr ? std::nullopt : std::optional(*found);
  }
  /// Value of a number without a unit.
  double bare(const Constant& value, const char* what) const {
    const Amount given = number(value);
    if (unused_ == 0 && !isPlainNumber(given.kind)) {
      fail(std::string(what) + " is in " + nameOf(given.kind) + ", allowed: a number");
    }
    return given.value;
  }
  Kind common(const Amount& a, const Amount& b) const {
    const std::optional<Kind> kind = commonKind(a.kind, b.kind);
    if (!kind && unused_ == 0) {
      fail(nameOf(a.kind) + " and " + nameOf(b.kind) + " are of different kinds");
    }
    return kind.value_or(Kind{});
  }
  Kind known(const std::optional<Kind>& kind) const {
    if (!kind && unused_ == 0) {
      fail("no unit has such a power");
    }
    return kind.value_or(Kind{});
  }
  /// \param from  where what has this value begins
  double finite(double value, std::size_t from) const {
    if (std::isfinite(value)) {
      return value;
    }
    if (unused_ == 0) {
      throw ExpressionError("it is not a finite number", from);
    }
    return 0.0;
  }

  Constant choice() {
    if (++depth_ > kDeepestExpression) {
      fail("it is nested too deeply");
    }
    Constant value = comparison();
    if (takes("?")) {
      const bool holds = number(value).value != 0.0;
      Constant first = branch(holds);
      expect(":");
      Constant second = branch(!holds);
      value = holds ? std::move(first) : std::move(second);
    }
    --depth_;
    return value;
  }

  /// Evaluates one branch; one that is not chosen need have no value, as in `n > 0 ? 1/n : 0`.
  Constant branch(bool is_used) {
    unused_ += is_used ? 0 : 1;
    Constant value = choice();
    unused_ -= is_used ? 0 : 1;
    return value;
  }

  Constant comparison() {
    Constant value = sum();
    for (const char* const sign : {"==", "!=", "<=", ">=", "<", ">"}) {
      if (takes(sign)) {
        return Amount{compared(value, sign, sum()) ? 1.0 : 0.0};
      }
    }
    return value;
  }
  bool compared(const Constant& a, const std::string& sign, const Constant& b) const {
    const bool are_words =
        std::holds_alternative<std::string>(a) && std::holds_alternative<std::string>(b);
    if (are_words && (sign == "==" || sign == "!=")) {
      return (std::get<std::string>(a) == std::get<std::string>(b)) == (sign == "==");
    }
    const Amount first = number(a);
    const Amount second = number(b);
    common(first, second);
    const double difference = first.value - second.value;
    return sign == "=="   ? first.value == second.value
           : sign == "!=" ? first.value != second.value
           : sign == "<"  ? difference < 0.0
           : sign == ">"  ? difference > 0.0
           : sign == "<=" ? difference <= 0.0
                          : difference >= 0.0;
  }

  Constant sum() {
    Constant value = product();
    while (true) {
      skip();
      const std::size_t operation = at_;
      const bool adds = takes("+");
      if (!adds && !takes("-")) {
        return value;
      }
      const Amount a = number(value);
      const Amount b = number(product());
      value = Amount{finite(adds ? a.value + b.value : a.value - b.value, operation), common(a, b)};
    }
  }

  Constant product() {
    Constant value = sign();
    while (true) {
      skip();
      const std::size_t operation = at_;
      const bool multiplies = takes("*");
      if (!multiplies && !takes("/")) {
        return value;
      }
      const Amount a = number(value);
      const Amount b = number(sign());
      if (!multiplies && b.value == 0.0 && unused_ == 0) {
        throw ExpressionError("division by zero", operation);
      }
      value = Amount{finite(multiplies ? a.value * b.value : a.value / b.value, operation),
                     known(productKind(a.kind, b.kind, multiplies ? 1 : -1))};
    }
  }

  Constant sign() {
    int minuses = 0;
    for (bool is_minus = takes("-"); is_minus || takes("+"); is_minus = takes("-")) {
      minuses += is_minus ? 1 : 0;
    }
    skip();
    const std::size_t operand = at_;
    const bool is_negative = minuses % 2 != 0;
    negative_at_ = is_negative ? operand : std::string_view::npos;
    Constant value = power();
    if (minuses == 0) {
      return value;
    }
    const Amount result = number(value);
    return is_negative && taken_at_ != operand ? Amount{-result.value, result.kind} : result;
  }

  /// Binds to the right, and more than a sign before it.
  Constant power() {
    Constant base = primary();
    skip();
    const std::size_t operation = at_;
    if (!takes("^")) {
      return base;
    }
    if (++depth_ > kDeepestExpression) {
      fail("it is nested too deeply");
    }
    const double exponent = bare(sign(), "an exponent");
    --depth_;
    const Amount of = number(base);
    return Amount{finite(std::pow(of.value, exponent), operation),
                  known(powerKind(of.kind, exponent))};
  }

  Constant primary() {
    if (takes("(")) {
      Constant value = choice();
      expect(")");
      return value;
    }
    skip();
    if (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) {
      return quantity();
    }
    if (at_ < text_.size() && isLetter(text_[at_])) {
      return named();
    }
    fail(at_ < text_.size() ? "'" + std::string(text_.substr(at_, 1)) + "' is not expected here"
                            : "it ends too soon");
  }

  /// A number, and its unit if one follows.
  Amount quantity() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (isDigit(text_[at_]) || text_[at_] == '.')) {
      ++at_;
    }
    if (at_ + 1 < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E') &&
        (isDigit(text_[at_ + 1]) ||
         (at_ + 2 < text_.size() && (text_[at_ + 1] == '-' || text_[at_ + 1] == '+') &&
          isDigit(text_[at_ + 2])))) {
      at_ += 2;
      while (at_ < text_.size() && isDigit(text_[at_])) {
        ++at_;
      }
    }
    const std::string_view number = text_.substr(first, at_ - first);
    if (const std::optional<Measured> found = measuredAt(text_, at_, number)) {
      at_ = found->end;
      if (first == negative_at_ && (found->unit == "dB" || found->unit == "cents")) {
        taken_at_ = first;  // -6 dB is a half, not minus two
        return parseAnyQuantity("-" + std::string(number) + " " + found->unit).value_or(Amount{});
      }
      return found->value;
    }
    const std::optional<double> bare = parseNumber(number);
    if (!bare) {
      throw ExpressionError("'" + std::string(number) + "' is not a finite number", first);
    }
    return {*bare};
  }

  Constant named() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (isLetter(text_[at_]) || isDigit(text_[at_]))) {
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '#') {
      ++at_;  // the index of what goes through a list
    }
    const std::string name(text_.substr(first, at_ - first));
    if (takes("(")) {
      return called(name, first);
    }
    const Constant* const known = scope_.find(name);
    if (known == nullptr && name == kPiName) {
      return Amount{kPi};
    }
    if (known == nullptr) {
      at_ = first;
      fail("unknown name " + quoted(name) + suggestion(name, scope_.names()));
    }
    Constant value = *known;
    while (takes("[")) {
      value = item(value);
    }
    return value;
  }

  Constant item(const Constant& list) {
    const auto* const part = std::get_if<Part>(&list);
    if ((part == nullptr || !(*part)->isList()) && unused_ == 0) {
      fail("what is no list has no items");
    }
    const double index = bare(choice(), "an index");
    expect("]");
    if (unused_ > 0) {
      return Amount{};
    }
    const Node& items = **part;
    if (index != std::floor(index) || index < 0.0 || index >= static_cast<double>(items.size())) {
      fail("item " + shortest(index) + " of a list of " + std::to_string(items.size()) +
           (items.size() > 0 ? ", allowed: 0..." + std::to_string(items.size() - 1)
                             : ", which has none"));
    }
    return constantOf(items[static_cast<std::size_t>(index)], *part);
  }

  Constant called(const std::string& name, std::size_t first) {
    if (name == kNote) {
      return note();
    }
    const Function* const function = findFunction(name);
    if (function == nullptr) {
      std::vector<std::string> names = functionNames();
      names.emplace_back(kNote);
      throw ExpressionError("unknown function " + quoted(name) + suggestion(name, names), first);
    }
    Amount arguments[2] = {};
    for (std::size_t i = 0; i < function->arguments; ++i) {
      if (i > 0) {
        expect(",");
      }
      const Constant value = choice();
      const bool is_bare = function->kinds == Function::Kinds::kBare ||
                           (function->kinds == Function::Kinds::kPower && i > 0);
      arguments[i] =
          is_bare ? Amount{bare(value, ("what " + name + " takes").c_str())} : number(value);
    }
    expect(")");
    return applied(*function, arguments, first);
  }
  Amount applied(const Function& function, const Amount* arguments, std::size_t first) const {
    const double values[] = {arguments[0].value, arguments[1].value};
    Kind kind;
    switch (function.kinds) {
      case Function::Kinds::kBare:
        break;
      case Function::Kinds::kSame:
        kind = common(arguments[0], arguments[1]);
        break;
      case Function::Kinds::kRoot:
        kind = known(powerKind(arguments[0].kind, 0.5));
        break;
      case Function::Kinds::kPower:
        kind = known(powerKind(arguments[0].kind, values[1]));
        break;
    }
    return {finite(function.value(values), first), kind};
  }

  /// `note(A4)`, or of a name that stands for one.
  Constant note() {
    skip();
    const std::size_t end = std::min(text_.find(')', at_), text_.size());
    const std::string word = trimmed(text_.substr(at_, end - at_));
    const Constant* const known = scope_.find(word);
    const auto* const words = known == nullptr ? &word : std::get_if<std::string>(known);
    if (words == nullptr) {
      fail(quoted(word) + " is no note");
    }
    const auto hz = parseQuantity(*words, "Hz");
    if (std::holds_alternative<NoQuantity>(hz)) {
      fail(quoted(*words) + " is no note");
    }
    at_ = end;
    expect(")");
    return Amount{std::get<double>(hz), kindOfUnit("Hz")};
  }

  std::string_view text_;
  const Scope& scope_;
  std::size_t at_ = 0;
  std::size_t negative_at_ = std::string_view::npos;  // where what a minus stands before begins
  std::size_t taken_at_ = std::string_view::npos;     // that is a number that took the minus
  int depth_ = 0;
  int unused_ = 0;  // branches around
};

}  // namespace

Constant evaluate(std::string_view expression, const Scope& scope) {
  if (expression.size() > kLongest) {
    throw ExpressionError("it has " + std::to_string(expression.size()) +
                              " bytes, allowed: at most " + std::to_string(kLongest),
                          0);
  }
  return Parser(expression, scope).run();
}

}  // namespace ergotic::scene
