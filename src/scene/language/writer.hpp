// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scene/generate/scene_builder.hpp"
#include "scene/language/frame.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// Writes values out: expressions, names with `{...}` in them, references to what an instance has.
/// Counts what it writes. \throws TextError as `expand`
class Writer {
 public:
  explicit Writer(const SceneBuilder& builder) : builder_(builder) {}

  /// \param is_reference  whether its words name elements
  Node write(const Node& node, const Frame& frame, const Scope& scope, bool is_reference = false);
  /// A name or a word with `{...}` in it.
  std::string word(const Node& node, const Frame& frame, const Scope& scope);
  /// Value of `= ...`, of a quantity or of words.
  Constant constant(const Node& node, const Frame& frame, const Scope& scope);

  /// Calls `each` for every combination that the `for` of an element asks for, with its variables,
  /// if its `when` is true there.
  using Each = std::function<void(const Scope& scope)>;
  void forEach(const Node& element, const Frame& frame, const Scope& scope, const Each& each);

  static Node sectionOf(Node role, const Frame& frame);
  /// A name of a frame as it is outside of it, if it is one of its own.
  static std::string renamed(const std::string& name, const Frame& frame);
  static bool isReference(const std::string& key);

  /// Counts what is written, or takes as much room. \throws TextError if it is too much
  void count(const Node& node, const Frame& frame, std::size_t nodes = 1);
  void countText(std::size_t bytes, const Node& node, const Frame& frame);
  void countAll(const Node& list, const Node& asked, const Frame& frame);

  [[noreturn]] void fail(const Node& node, const Frame& frame, const std::string& what) const;
  Place placeIn(const Node& node, const Frame& frame) const;
  static Place placeIn(Place place, const Frame& frame);

 private:
  Constant evaluated(const Node& node,
                     std::size_t from,
                     std::string_view expression,
                     const Frame& frame,
                     const Scope& scope);
  Node writeScalar(const Node& node, const Frame& frame, const Scope& scope, bool is_reference);
  Node placed(const Node& value, Place place);
  void loop(const Node& loops,
            std::size_t variable,
            const Frame& frame,
            const Scope& scope,
            const Each& each);
  std::vector<Constant> itemsOf(const Node& values, const Frame& frame, const Scope& scope);
  const SceneBuilder& builder_;
  std::size_t written_ = 0;
  std::size_t text_ = 0;  // bytes
};

}  // namespace ergotic::scene
