// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/emit.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace ergotic::scene {
namespace {

/// True for a text that needs no quotes anywhere: no sign of YAML, and no word for null.
bool isPlain(const std::string& text) {
  constexpr std::string_view kFirst = "_.$+/=";
  constexpr std::string_view kOthers = "_.$+-/=@ ^*";
  const auto isOneOf = [](char c, std::string_view signs) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || signs.find(c) != signs.npos;
  };
  return !text.empty() && (isOneOf(text[0], kFirst) || (text[0] == '-' && text.size() > 1)) &&
         text.back() != ' ' && text != "null" && text != "Null" && text != "NULL" &&
         std::all_of(text.begin() + 1, text.end(), [&](char c) { return isOneOf(c, kOthers); }) &&
         text.compare(0, 2, "- ") != 0 && text.compare(0, 3, "---") != 0 &&
         text.compare(0, 3, "...") != 0;
}

class Emitter {
 public:
  std::string run(const Node& scene) {
    for (std::size_t i = 0; i + 1 < scene.parts().size(); i += 2) {
      const Node& value = scene[i + 1];
      scalar(scene[i].text());
      text_ += ':';
      const bool is_block = (value.isMap() || value.isList()) && value.size() > 0;
      if (is_block) {
        block(value);
      } else {
        text_ += ' ';
        flow(value);
        text_ += '\n';
      }
    }
    return std::move(text_);
  }

 private:
  void block(const Node& part) {
    text_ += '\n';
    const std::size_t step = part.isMap() ? 2 : 1;
    for (std::size_t i = 0; i < part.parts().size(); i += step) {
      text_ += "  ";
      if (part.isMap()) {
        scalar(part[i].text());
        text_ += ": ";
      } else {
        text_ += "- ";
      }
      flow(part[i + step - 1]);
      text_ += '\n';
    }
  }

  void flow(const Node& node) {
    if (node.isNull()) {
      text_ += '~';
    } else if (node.isScalar()) {
      scalar(node.text());
    } else {
      text_ += node.isMap() ? '{' : '[';
      for (std::size_t i = 0; i < node.parts().size(); ++i) {
        const bool is_value = node.isMap() && i % 2 == 1;
        text_ += i == 0 ? "" : is_value ? ": " : ", ";
        flow(node[i]);
      }
      text_ += node.isMap() ? '}' : ']';
    }
  }

  void scalar(const std::string& text) {
    if (isPlain(text)) {
      text_ += text;
      return;
    }
    text_ += '"';
    for (const char c : text) {
      switch (c) {
        case '"':
        case '\\':
          text_ += {'\\', c};
          break;
        case '\n':
          text_ += "\\n";
          break;
        case '\t':
          text_ += "\\t";
          break;
        case '\r':
          text_ += "\\r";
          break;
        default:
          text_ += c;
      }
    }
    text_ += '"';
  }

  std::string text_;
};

}  // namespace

std::string emit(const Node& scene) {
  return Emitter().run(scene);
}

}  // namespace ergotic::scene
