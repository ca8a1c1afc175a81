// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/text/quantity.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// A part of a text, or of what was made of it, which nobody changes: taking an item copies
/// nothing.
using Part = std::shared_ptr<const Node>;

/// Value of a name of the language: a number in SI units of a kind, words (a note, a name, `$name`
/// of a parameter) or a part of the text, as a list.
using Constant = std::variant<Amount, std::string, Part>;

/// Value of a node of a text. \param node  of `owner`
Constant constantOf(const Node& node, const Part& owner);
Constant constantOf(Node node);

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
  /// True if this scope itself has the name.
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
