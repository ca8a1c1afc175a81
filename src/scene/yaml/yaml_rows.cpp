// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_rows.hpp"

#include <unordered_set>
#include <utility>
#include <vector>

namespace ergotic::scene {
namespace {

constexpr const char* kRows = "rows";
constexpr const char* kColumns = "columns";
constexpr const char* kCommon = "with";
constexpr const char* kName = "name";

/// The columns of a table and what all its rows share.
class RowReader {
 public:
  RowReader(const SceneBuilder& builder, const YamlMap& table) : builder_(builder), table_(table) {
    table.allow({kColumns, kCommon, kRows});
    readColumns();
    if (table.has(kCommon)) {
      readCommon(table.at(kCommon));
    }
  }

  void read(const Node& row, const std::string& kind, const ElementReader& element) const {
    const Place place = placeOf(row, table_.placeAt(kRows));
    if (!row.isList() || row.size() != columns_.size()) {
      builder_.fail(place, "a row of " + table_.what() + " has " +
                               (row.isList() ? std::to_string(row.size()) : "no list of") +
                               " cells, allowed: one for each of the " +
                               std::to_string(columns_.size()) + " columns");
    }
    std::string name;
    Place name_place = place;
    std::vector<YamlMap::Entry> entries = common_;
    auto column = columns_.begin();
    for (const Node& cell : row) {
      const Place at = placeOf(cell, place);
      if (*column == kName) {
        name = wordOf(builder_, cell, "the name in a row of " + table_.what(), place);
        name_place = at;
      } else if (!cell.isNull()) {
        entries.push_back({*column, at, &cell});
      }
      ++column;
    }
    checkName(builder_, name, name_place);
    element(name, YamlMap(builder_, std::move(entries), kind + " " + quoted(name), name_place));
  }

 private:
  void readColumns() {
    const Node& list = table_.at(kColumns);
    if (!list.isList()) {
      table_.fail(kColumns, "'columns' of " + table_.what() + " is not a list, allowed: " +
                                "[name, ...], the keys that the cells of a row are for");
    }
    for (const Node& node : list) {
      const Place place = placeOf(node, table_.placeAt(kColumns));
      const std::string column = wordOf(builder_, node, "a column of " + table_.what(), place);
      if (isColumn(column)) {
        builder_.fail(place, "column " + quoted(column) + " of " + table_.what() + " comes twice");
      }
      columns_.push_back(column);
      known_.insert(column);
    }
    if (!isColumn(kName)) {
      table_.fail(kColumns, "'columns' of " + table_.what() +
                                " has no 'name', allowed: lists with that column");
    }
  }

  void readCommon(const Node& common) {
    forEachEntry(builder_, common, "'with' of " + table_.what(), table_.keyPlaceAt(kCommon),
                 [this](const std::string& key, Place place, const Node& value) {
                   if (isColumn(key)) {
                     builder_.fail(place, "key " + quoted(key) + " of 'with' of " + table_.what() +
                                              " is a column, too, allowed: other keys");
                   }
                   common_.push_back({key, place, &value});
                 });
  }

  bool isColumn(const std::string& key) const { return known_.count(key) > 0; }

  const SceneBuilder& builder_;
  const YamlMap& table_;
  std::vector<std::string> columns_;
  std::unordered_set<std::string> known_;  // the same
  std::vector<YamlMap::Entry> common_;
};

}  // namespace

bool isTableOfElements(const Node& node) {
  return node.find(kRows) != nullptr;
}

void forEachRow(const SceneBuilder& builder,
                const YamlMap& table,
                const std::string& kind,
                const ElementReader& element) {
  const RowReader reader(builder, table);
  const Node& rows = table.at(kRows);
  if (!rows.isList()) {
    table.fail(kRows, "'rows' of " + table.what() + " is not a list, allowed: [[...], [...], ...]");
  }
  for (const Node& row : rows) {
    reader.read(row, kind, element);
  }
}

}  // namespace ergotic::scene
