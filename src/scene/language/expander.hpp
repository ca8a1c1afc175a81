// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/language/library.hpp"
#include "scene/language/writer.hpp"

namespace ergotic::scene {

/// Writes a scene out, part by part, and then the instances that it uses. \see expand()
class Expander {
 public:
  explicit Expander(SceneBuilder& builder);
  Node run(const Node& scene);

 private:
  void writeParts(const Node& body, const Frame& frame);
  void writeElements(const std::string& part, const Node& elements, const Frame& frame);
  void writeElement(const std::string& part,
                    const Node* name,
                    const Node& element,
                    const Frame& frame,
                    const Scope& scope);
  Node written(const Node& element, const Frame& frame, const Scope& scope);
  void findHeads(const Node& body, Frame& frame);

  void writeInstances(const Node& body, const Frame& frame);
  void writeInstance(const Node& use, const Frame& frame, const Scope& scope);
  void setParameters(const Definition& definition,
                     const Node& use,
                     const Frame& outer,
                     const Scope& scope,
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
  void resolve(Node& node, bool is_reference) const;

  SceneBuilder& builder_;
  Writer writer_;
  Library library_;
  std::map<std::string, Node> parts_;          // maps; generators: a list
  std::set<std::string> prefixes_;             // of instances
  std::map<std::string, std::string> public_;  // names of instances, and what they stand for
};

}  // namespace ergotic::scene
