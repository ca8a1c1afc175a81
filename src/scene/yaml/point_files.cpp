// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/point_files.hpp"

#include <algorithm>
#include <iterator>

#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"
#include "scene/tree/near_file.hpp"

namespace ergotic::scene {
namespace {

using Part = PointFiles::Part;

constexpr std::size_t kMaxFileNameBytes = 255;

/// Words for each Part, in the order of Part.
struct PartWords {
  const char* key;
  const char* one;
  const char* user;
};
constexpr PartWords kParts[] = {{"tables", "table", "link"},
                                {"gestures", "gesture", "agent"},
                                {"partials", "list", "resonator"}};

const PartWords& wordsOf(Part part) {
  return kParts[static_cast<std::size_t>(part)];
}

const PartWords* findPart(const std::string& key) {
  const auto* const found = std::find_if(std::begin(kParts), std::end(kParts),
                                         [&](const PartWords& part) { return key == part.key; });
  return found == std::end(kParts) ? nullptr : found;
}

/// True for a map of parts, with at least one.
bool isDocument(const Node& node) {
  bool is_document = node.isMap() && node.size() > 0;
  for (std::size_t i = 0; is_document && i < node.parts().size(); i += 2) {
    is_document = node[i].isScalar() && findPart(node[i].text()) != nullptr;
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

std::string quotedKey(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  }
  return text + '"';
}

std::string listOf(const RowList& rows) {
  std::string text = "[";
  const char* between_rows = "[";
  for (const std::vector<double>& row : rows) {
    text += between_rows;
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i > 0 ? ", " : "") + shortest(row[i]);
    }
    text += ']';
    between_rows = ", [";
  }
  return text + ']';
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
                  "begins with 'tables:', 'gestures:' or 'partials:'");
  }
  forEachEntry(builder_, *document, "the second document", place,
               [&](const std::string& key, Place, const Node& entries) {
                 const auto part = static_cast<Part>(findPart(key) - std::begin(kParts));
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
  const Place place = spec.placeAt("file");
  const std::string path = pathOfNear(builder_, nameOf(spec), spec.what(), place);
  return {readNear(builder_, path, kMaxTextBytes, spec.what(), place), path};
}

void PointFiles::keep(Part part, const std::string& key, const PointList& points) {
  RowList rows;
  rows.reserve(points.size());
  for (const auto& [x, y] : points) {
    rows.push_back({x, y});
  }
  keep(part, key, rows);
}

void PointFiles::keep(Part part, const std::string& key, const RowList& rows) {
  kept_[{part, key}] = listOf(rows);
}

void PointFiles::finish() {
  for (const auto& [id, appended] : appended_) {
    if (!appended.used) {
      const PartWords& words = wordsOf(id.first);
      builder_.fail(appended.place, std::string(words.one) + " " + quoted(id.second) +
                                        " is used by no " + words.user);
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
  const std::pair<const std::pair<Part, std::string>, std::string>* last = nullptr;
  for (const auto& entry : kept_) {
    const Part part = entry.first.first;
    if (last != nullptr && last->first.first == part) {
      text += ",\n  ";
    } else {
      text += std::string(last != nullptr ? "}\n" : "") + wordsOf(part).key + ": {";
    }
    text += quotedKey(entry.first.second) + ": " + entry.second;
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
