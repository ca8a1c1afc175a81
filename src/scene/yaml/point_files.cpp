// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/point_files.hpp"

#include <algorithm>

#include "ergotic/exception.hpp"
#include "files/read_file.hpp"
#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

using Part = PointFiles::Part;

constexpr std::size_t kMaxFileNameBytes = 255;

const char* keyOf(Part part) {
  return part == Part::kTables ? "tables" : "gestures";
}

bool isPart(const std::string& key) {
  return key == keyOf(Part::kTables) || key == keyOf(Part::kGestures);
}

/// A map of parts, of one at least.
bool isDocument(const Node& node) {
  bool is_document = node.isMap() && node.size() > 0;
  for (std::size_t i = 0; is_document && i < node.parts().size(); i += 2) {
    is_document = node[i].isScalar() && isPart(node[i].text());
  }
  return is_document;
}

bool isFileName(const std::string& name) {
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < 0x20U || c == '\x7F';
  };
  return !name.empty() && name.size() <= kMaxFileNameBytes && name.front() != '/' &&
         std::none_of(name.begin(), name.end(), is_control);
}

/// `"name": [[x, y], ...]`
void appendPoints(std::string& text, const std::string& name, const PointList& points) {
  text += '"';
  for (const char c : name) {
    text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  text += "\": [";
  const char* comma = "";
  for (const auto& [x, y] : points) {
    text += std::string(comma) + "[" + shortest(x) + ", " + shortest(y) + "]";
    comma = ", ";
  }
  text += ']';
}

}  // namespace

PointFiles::PointFiles(SceneBuilder& builder, const Node* document) : builder_(builder) {
  if (document == nullptr) {
    return;
  }
  self_contained_ = true;
  const Place place = placeOf(*document, {1, 1});
  if (!isDocument(*document)) {
    builder_.fail(place,
                  "a second document, allowed: one in each file, and one after it that "
                  "begins with 'tables:' or 'gestures:'");
  }
  forEachEntry(builder_, *document, "the second document", place,
               [&](const std::string& key, Place, const Node& entries) {
                 const Part part = key == keyOf(Part::kTables) ? Part::kTables : Part::kGestures;
                 forEachEntry(builder_, entries, quoted(key) + " of the second document", place,
                              [&](const std::string& name, Place at, const Node& points) {
                                appended_[{part, name}] = {&points, at};
                              });
               });
}

const PointFiles::Appended* PointFiles::find(Part part, const std::string& key) {
  const auto found = appended_.find({part, key});
  if (found == appended_.end()) {
    return nullptr;
  }
  found->second.used = true;
  return &found->second;
}

std::string PointFiles::nameOf(const YamlMap& spec) {
  std::string name = spec.word("file");
  if (!isFileName(name)) {
    spec.fail("file", "file " + quoted(name) + " of " + spec.what() +
                          " is no path from the scene's folder, allowed: 1..." +
                          std::to_string(kMaxFileNameBytes) + " bytes that do not begin with '/'");
  }
  return name;
}

PointFiles::File PointFiles::open(const YamlMap& spec) const {
  const std::string path = besideFile(nameOf(spec), builder_.scene().file);
  // Errors in a file tell what it says, and a scene may be a stranger's.
  if (!files::isBelow(path, besideFile(".", builder_.scene().file))) {
    spec.fail("file", "file " + quoted(path) + " of " + spec.what() +
                          " is elsewhere, allowed: below the scene's folder");
  }
  try {
    return {files::readFile(path, kMaxTextBytes), path};
  } catch (const Exception& refusal) {
    spec.fail("file", spec.what() + ": " + refusal.what());
  }
}

void PointFiles::keep(Part part, const std::string& key, PointList points) {
  kept_[{part, key}] = std::move(points);
}

void PointFiles::finish() {
  for (const auto& [id, appended] : appended_) {
    if (!appended.used) {
      const bool is_table = id.first == Part::kTables;
      builder_.fail(appended.place, (is_table ? "table " : "gesture ") + quoted(id.second) +
                                        " is used by no " + (is_table ? "link" : "agent"));
    }
  }
  if (!kept_.empty()) {
    append();
  }
}

void PointFiles::append() {
  std::string& text = builder_.scene().text;
  const std::size_t written = text.size();
  text += text.empty() || text.back() == '\n' ? "---\n" : "\n---\n";
  const std::pair<const std::pair<Part, std::string>, PointList>* last = nullptr;
  for (const auto& entry : kept_) {
    const Part part = entry.first.first;
    if (last != nullptr && last->first.first == part) {
      text += ",\n  ";
    } else {
      text += std::string(last != nullptr ? "}\n" : "") + keyOf(part) + ": {";
    }
    appendPoints(text, entry.first.second, entry.second);
    last = &entry;
  }
  text += "}\n";
  if (text.size() > kMaxTextBytes) {
    builder_.fail({1, 1}, "the text has " + std::to_string(written) + " bytes and its tables " +
                              std::to_string(text.size() - written) + ", allowed: at most " +
                              std::to_string(kMaxTextBytes) + " in all");
  }
}

}  // namespace ergotic::scene
