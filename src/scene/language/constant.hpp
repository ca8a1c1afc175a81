// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// What a name of the language stands for: a number in SI units, words (a note, a name, `$name` of
/// a parameter) or a part of the text, as a list.
using Constant = std::variant<double, std::string, Node>;

/// What a value of a text stands for: a quantity of any kind is a number.
Constant constantOf(const Node& node);

/// Names that may be used in expressions, those of the innermost definition last.
class Scope {
 public:
  Scope() = default;
  /// \param outer  must outlive it
  explicit Scope(const Scope* outer) : outer_(outer) {}

  void set(const std::string& name, Constant value) { names_[name] = std::move(value); }
  /// nullptr if nothing has this name.
  const Constant* find(const std::string& name) const {
    const auto found = names_.find(name);
    if (found != names_.end()) {
      return &found->second;
    }
    return outer_ == nullptr ? nullptr : outer_->find(name);
  }
  /// Of this scope alone.
  bool has(const std::string& name) const { return names_.count(name) > 0; }
  std::vector<std::string> names() const {
    std::vector<std::string> all = outer_ == nullptr ? std::vector<std::string>() : outer_->names();
    for (const auto& [name, value] : names_) {
      all.push_back(name);
    }
    return all;
  }

 private:
  const Scope* outer_ = nullptr;
  std::map<std::string, Constant> names_;
};

}  // namespace ergotic::scene
