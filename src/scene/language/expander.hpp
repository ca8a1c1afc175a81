// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/language/library.hpp"
#include "scene/language/variant.hpp"
#include "scene/language/writer.hpp"

namespace ergotic::scene {

/// Writes a scene out, part by part, and then the instances that it uses. \see expand()
class Expander {
 public:
  explicit Expander(SceneBuilder& builder);
  Node run(const Node& scene, const std::string& variant);

 private:
  void writeParts(const Node& body, const Frame& frame);
  void writeElements(const std::string& part, const Node& elements, const Frame& frame);
  void writeElement(const std::string& part,
                    const Node* name,
                    const Node& element,
                    const Frame& frame,
                    const Scope& scope);
  Node written(const Node& element, const Frame& frame, const Scope& scope);
  void addDefaults(const Node& element, const Frame& frame, const Scope& scope, Node& to);
  void addKey(const Node& key, const Node& value, const Frame& frame, const Scope& scope, Node& to);
  void set(const std::string& name, Node& element);
  void setParameters(Node& parameters);
  std::string geometryOf(const Node& element) const;
  void findHeads(const Node& body, Frame& frame);

  void writeInstances(const Node& body, const Frame& frame);
  void writeInstance(const Node& use, const Frame& frame, const Scope& scope);
  Pose poseOf(const Node& use, const Frame& frame, const Scope& scope);
  /// A value that an instance is given, and where it is looked up.
  struct GivenValue {
    Place place;
    const Node* value = nullptr;
    const Frame* frame = nullptr;
    const Scope* scope = nullptr;
  };
  using Given = std::map<std::string, GivenValue>;
  [[noreturn]] void refuseParameter(const Definition& definition, const Given& given) const;
  void setParameters(const Definition& definition,
                     const Node& use,
                     const Frame& outer,
                     const Scope& scope,
                     const std::string& name,
                     Frame& inner);
  Constant parameter(const std::string& name,
                     const Node& spec,
                     const Node* given,
                     const Frame& outer,
                     const Scope& scope);
  void setSections(const Definition& definition,
                   const Node& use,
                   const Frame& outer,
                   const Scope& scope,
                   Frame& inner);
  void publish(const Definition& definition, const Frame& frame);
  void resolve(Node& node, bool is_reference);
  void resolvePattern(Node& node);

  SceneBuilder& builder_;
  Writer writer_;
  Variant variant_;
  Library library_;
  Frame frame_;                                // of the scene
  std::map<std::string, Node> parts_;          // maps; generators: a list
  std::set<std::string> prefixes_;             // of instances
  std::map<std::string, std::string> public_;  // names of instances, and what they stand for
};

}  // namespace ergotic::scene
