// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tree/yaml_documents.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxNodes = 2'000'000;  // scalars, lists and maps

Place placeOfMark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// Of an error: where a text ends within an escape, yaml-cpp counts its end as one character more.
Place placeOfMark(const YAML::Mark& mark, const std::string& text) {
  Place place = placeOfMark(mark);
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  if (place.line >= lines) {
    const std::size_t last = text.size() - (text.rfind('\n') + 1);  // npos + 1 is 0
    place.column = std::min(place.column, static_cast<int>(last) + 1);
  }
  return place;
}

/// Grows documents as yaml-cpp reads them. Fails at one that is one too many: where one begins with
/// a comma, yaml-cpp 0.7 goes on for ever with empty ones. Fails at a value that is one too many:
/// each takes a hundred bytes, whatever it takes in the text. Fails at aliases: some lines of them
/// stand for more than any memory.
class Grower final : public YAML::EventHandler {
 public:
  /// \param keeps  false: only counts
  Grower(const SceneBuilder& builder, std::string_view source, int most_documents, bool keeps)
      : builder_(builder), source_(source), most_documents_(most_documents), keeps_(keeps) {}

  std::vector<Node> documents() { return std::move(documents_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++begun_ > most_documents_) {
      builder_.fail(placeOfMark(mark), most_documents_ == 1
                                           ? "a second document, allowed: one"
                                           : "a third document, allowed: at most two");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    begin(mark, Node::Kind::kNull);
    end();
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    builder_.fail(placeOfMark(mark), "an alias, allowed: what it stands for, written out");
  }
  void OnScalar(const YAML::Mark& mark,
                const std::string&,
                YAML::anchor_t,
                const std::string& text) override {
    // The text itself is UTF-8 without control characters: what is written as "\x01" need not be.
    const auto isControl = [](char c) {
      return (static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t' && c != '\r') ||
             c == '\x7f';
    };
    if (std::any_of(text.begin(), text.end(), isControl) ||
        findNonUtf8(text) != std::string::npos) {
      builder_.fail(placeOfMark(mark),
                    "a word with a control character, allowed: tab and line ends only");
    }
    begin(mark, Node::Kind::kScalar, text);
    if (keeps_) {
      open_.back().setLead(leadOf(mark, text));
    }
    end();
  }
  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    begin(mark, Node::Kind::kList);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    begin(mark, Node::Kind::kMap);
  }
  void OnMapEnd() override { end(); }

 private:
  /// 1 behind a quote, 0 without; -1 where the source is not the same byte for byte, as where it is
  /// folded or has escapes.
  int leadOf(const YAML::Mark& mark, const std::string& text) const {
    const auto at = static_cast<std::size_t>(std::max(mark.pos, 0));
    const bool is_quoted = at < source_.size() && (source_[at] == '"' || source_[at] == '\'');
    const bool is_same = at < source_.size() && text.find('\n') == std::string::npos &&
                         source_.compare(at + (is_quoted ? 1 : 0), text.size(), text) == 0;
    return !is_same ? -1 : is_quoted ? 1 : 0;
  }
  void begin(const YAML::Mark& mark, Node::Kind kind, const std::string& text = {}) {
    if (++nodes_ > kMaxNodes) {
      builder_.fail(placeOfMark(mark), "the text has more than " + std::to_string(kMaxNodes) +
                                           " scalars, lists and maps; generators make " +
                                           "more modules of less text");
    }
    if (keeps_) {
      open_.emplace_back(kind, placeOfMark(mark), text);
    }
  }
  void end() {
    if (!keeps_) {
      return;
    }
    Node node = std::move(open_.back());
    open_.pop_back();
    if (open_.empty()) {
      documents_.push_back(std::move(node));
    } else {
      open_.back().add(std::move(node));
    }
  }

  const SceneBuilder& builder_;
  const std::string_view source_;  // without a byte order mark, as yaml-cpp counts
  const int most_documents_;
  const bool keeps_;
  int begun_ = 0;
  std::size_t nodes_ = 0;
  std::vector<Node> open_;  // from the outermost on
  std::vector<Node> documents_;
};

std::vector<Node> documentsOf(const SceneBuilder& builder,
                              const std::string& text,
                              int most,
                              bool keeps) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view source = text;
  source.remove_prefix(source.substr(0, 3) == kByteOrderMark ? 3 : 0);
  Grower grower(builder, source, most, keeps);
  while (parser.HandleNextDocument(grower)) {
  }
  return grower.documents();
}

}  // namespace

std::vector<Node> readDocuments(const SceneBuilder& builder,
                                const std::string& text,
                                int most,
                                const std::string& needs) {
  try {
    if (text.size() > kMaxNodes) {  // too many are refused before they take room
      documentsOf(builder, text, most, false);
    }
    return documentsOf(builder, text, most, true);
  } catch (const YAML::DeepRecursion& e) {
    builder.fail(placeOfMark(e.mark), "nested too deeply, allowed: as deep as " + needs);
  } catch (const YAML::Exception& e) {
    builder.fail(placeOfMark(e.mark, text), "not valid YAML: " + e.msg);
  }
}

}  // namespace ergotic::scene
