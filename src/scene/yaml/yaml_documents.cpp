// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_documents.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <sstream>

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxNodes = 2'000'000;  // scalars, lists and maps

Place placeOfMark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// Reads a text and keeps nothing of it. Fails at a document that is one too many: where one begins
/// with a comma, yaml-cpp 0.7 goes on for ever with empty ones. Fails at a node that is one too
/// many: each takes hundreds of bytes, whatever it takes in the text.
class Counter final : public YAML::EventHandler {
 public:
  Counter(const SceneBuilder& builder, int most_documents)
      : builder_(builder), most_documents_(most_documents) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > most_documents_) {
      builder_.fail(placeOfMark(mark), most_documents_ == 1
                                           ? "a second document, allowed: one"
                                           : "a third document, allowed: at most two");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark,
                const std::string&,
                YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  void count(const YAML::Mark& mark) {
    if (++nodes_ > kMaxNodes) {
      builder_.fail(placeOfMark(mark), "the text has more than " + std::to_string(kMaxNodes) +
                                           " scalars, lists and maps; generators make " +
                                           "more modules of less text");
    }
  }

  const SceneBuilder& builder_;
  const int most_documents_;
  int documents_ = 0;
  std::size_t nodes_ = 0;
};

void count(const SceneBuilder& builder, const std::string& text, int most_documents) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Counter counter(builder, most_documents);
  while (parser.HandleNextDocument(counter)) {
  }
}

/// A map in lines that begin at the margin goes on to the end of the text or to a line that says
/// so: what is usual, and may be large, need not be read twice.
bool isWholeText(const YAML::Node& first, const std::string& text) {
  const auto hasLine = [&](const std::string& line) {
    return text.compare(0, line.size(), line) == 0 || text.find("\n" + line) != std::string::npos;
  };
  return first.IsMap() && first.Style() == YAML::EmitterStyle::Block && first.Mark().column == 0 &&
         !hasLine("---") && !hasLine("...");
}

std::vector<YAML::Node> load(const SceneBuilder& builder, const std::string& text, int most) {
  const bool is_long = text.size() > kMaxNodes;  // others cannot have so many nodes
  if (is_long) {
    count(builder, text, most);
  }
  const YAML::Node first = YAML::Load(text);
  if (isWholeText(first, text)) {
    return {first};
  }
  if (!is_long) {
    count(builder, text, most);
  }
  return YAML::LoadAll(text);
}

}  // namespace

std::vector<YAML::Node> readDocuments(const SceneBuilder& builder,
                                      const std::string& text,
                                      int most,
                                      const std::string& needs) {
  try {
    return load(builder, text, most);
  } catch (const YAML::DeepRecursion& e) {
    builder.fail(placeOfMark(e.mark), "nested too deeply, allowed: as deep as " + needs);
  } catch (const YAML::Exception& e) {
    builder.fail(placeOfMark(e.mark), "not valid YAML: " + e.msg);
  }
}

}  // namespace ergotic::scene
