// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <list>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/language/variant.hpp"
#include "scene/language/writer.hpp"

namespace ergotic::scene {

struct Definition {
  std::string name;
  const Node* body = nullptr;
  int origin = 0;
  std::size_t above = 0;  ///< so many definitions stand above it
};

/// Contents of a scene and of the files that it includes: constants, default keys, definitions.
class Library {
 public:
  Library(SceneBuilder& builder, Writer& writer, Variant& variant)
      : builder_(builder), writer_(writer), variant_(variant) {}

  /// Reads `include`, `let`, `defaults` and `define` of a scene, in this order.
  void read(const Node& scene, Frame& frame);

  /// \throws TextError if there is none, or none above the frame
  const Definition& definition(const Node& name, const std::string& word, const Frame& frame) const;
  std::size_t size() const noexcept { return definitions_.size(); }
  /// Constants of the scene and of what it includes.
  const Scope& constants() const noexcept { return constants_; }
  /// Reads `let` of a scene, where a variant may say otherwise, or of a definition.
  void let(const Node& body, Frame& frame);

  /// Keys of elements of this class, if one is said, and then of this type.
  /// \param kind  where the class is said, nullptr: nowhere. \param word  what it is
  /// \throws TextError if there is no such class
  std::vector<const Node*> defaultsOf(const std::string& type,
                                      const Node* kind,
                                      const std::string& word,
                                      const Frame& frame) const;

 private:
  void include(const Node& files, Frame& frame);
  void readFile(const Node& name, Frame& frame);

  SceneBuilder& builder_;
  Writer& writer_;
  Variant& variant_;
  std::list<Node> files_;                // what definitions point into
  std::vector<std::string> included_;    // paths
  std::vector<Definition> definitions_;  // in the order of the texts
  std::unordered_map<std::string, std::vector<std::size_t>> by_name_;  // of these, in order
  std::map<std::string, const Node*> defaults_;                        // by type, or type.class
  Scope constants_;
  int depth_ = 0;
};

}  // namespace ergotic::scene
