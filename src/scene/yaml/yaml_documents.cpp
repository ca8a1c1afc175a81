// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_documents.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <sstream>

namespace ergotic::scene {
namespace {

Place placeOfMark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// Fails at a document that is one too many. Where one begins with a comma, yaml-cpp 0.7 goes on
/// for ever with empty ones.
class DocumentCounter final : public YAML::EventHandler {
 public:
  DocumentCounter(const SceneBuilder& builder, int most) : builder_(builder), most_(most) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++count_ > most_) {
      builder_.fail(placeOfMark(mark), most_ == 1 ? "a second document, allowed: one"
                                                  : "a third document, allowed: at most two");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&,
                const std::string&,
                YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  const SceneBuilder& builder_;
  const int most_;
  int count_ = 0;
};

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
  const YAML::Node first = YAML::Load(text);
  if (isWholeText(first, text)) {
    return {first};
  }
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentCounter counter(builder, most);
  while (parser.HandleNextDocument(counter)) {
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
