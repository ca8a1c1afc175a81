// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "scene/text/source_text.hpp"

namespace ergotic::tgr {
namespace {

scene::Place placeOfMark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

YAML::Node parse(const scene::SceneBuilder& builder, const std::string& text) {
  scene::checkBytes(text, builder.scene().file, scene::Bytes::kUtf8);
  try {
    const YAML::Node node = YAML::Load(text);
    return node.IsNull() ? YAML::Node(YAML::NodeType::Map) : node;
  } catch (const YAML::DeepRecursion& e) {
    builder.fail(placeOfMark(e.mark), "nested too deeply, allowed: as deep as settings need");
  } catch (const YAML::Exception& e) {
    builder.fail(placeOfMark(e.mark), "not valid YAML: " + e.msg);
  }
}

/// Writes nodes in flow style, which needs no indentation: any token can be moved down and right.
class FlowText {
 public:
  FlowText(const scene::SceneBuilder& builder, bool in_place)
      : builder_(builder), in_place_(in_place) {}

  void write(const YAML::Node& node) {
    constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
    if (text_.size() > kMaxBytes) {
      builder_.fail(placeOfMark(node.Mark()), "too long with its aliases, allowed: 1 MB");
    }
    // A block begins where its first key does, and the brace comes before it; of a missing value
    // yaml-cpp only knows what comes next.
    if (node.Style() != YAML::EmitterStyle::Block && !node.IsNull()) {
      moveTo(node.Mark());
    }
    if (node.IsMap()) {
      writeMap(node);
    } else if (node.IsSequence()) {
      writeList(node);
    } else if (node.IsScalar()) {
      writeScalar(node.Scalar(), node.Tag() == "?");
    } else {
      put("~");
    }
  }

  const std::string& text() const noexcept { return text_; }

 private:
  void writeMap(const YAML::Node& node) {
    put("{");
    bool first = true;
    for (const auto& pair : node) {
      put(first ? "" : ", ");
      first = false;
      write(pair.first);
      put(": ");
      write(pair.second);
    }
    put("}");
  }

  void writeList(const YAML::Node& node) {
    put("[");
    bool first = true;
    for (const YAML::Node& item : node) {
      put(first ? "" : ", ");
      first = false;
      write(item);
    }
    put("]");
  }

  void writeScalar(const std::string& scalar, bool plain) {
    const auto isSafe = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '.' || c == '+' || c == '-' || c == '/';
    };
    if (plain && std::all_of(scalar.begin(), scalar.end(), isSafe)) {
      put(scalar);
      return;
    }
    std::string quoted = "\"";
    for (const char c : scalar) {
      switch (c) {
        case '\n':
          quoted += "\\n";
          break;
        case '\r':
          quoted += "\\r";
          break;
        case '\t':
          quoted += "\\t";
          break;
        case '"':
        case '\\':
          quoted += '\\';
          [[fallthrough]];
        default:
          quoted += c;
      }
    }
    put(quoted + "\"");
  }

  void moveTo(const YAML::Mark& mark) {
    if (!in_place_ || mark.is_null()) {
      return;
    }
    if (mark.line > line_) {
      text_.append(static_cast<std::size_t>(mark.line - line_), '\n');
      line_ = mark.line;
      column_ = 0;
    }
    if (mark.line == line_ && mark.column > column_) {
      put(std::string(static_cast<std::size_t>(mark.column - column_), ' '));
    }
  }

  void put(const std::string& piece) {
    text_ += piece;
    column_ += static_cast<int>(piece.size());
  }

  const scene::SceneBuilder& builder_;
  bool in_place_;
  std::string text_;
  int line_ = 0;
  int column_ = 0;
};

std::string flowText(const scene::SceneBuilder& builder, const YAML::Node& node, bool in_place) {
  FlowText text(builder, in_place);
  text.write(node);
  return text.text();
}

}  // namespace

Settings::Settings(const std::string& text, const std::string& file, const std::string& what)
    : builder_(file, text), node_(parse(builder_, text)), top_(builder_, node_, what, {1, 1}) {}

std::string textInPlace(const scene::SceneBuilder& builder, const YAML::Node& node) {
  return flowText(builder, node, true);
}

std::string textInLine(const scene::SceneBuilder& builder, const YAML::Node& node) {
  return flowText(builder, node, false);
}

std::string besideFile(const std::string& path, const std::string& file) {
  const std::size_t slash = file.rfind('/');
  const bool is_absolute = !path.empty() && path.front() == '/';
  return is_absolute || slash == std::string::npos ? path : file.substr(0, slash + 1) + path;
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace ergotic::tgr
