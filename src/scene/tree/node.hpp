// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ergotic/scene/value.hpp"

namespace ergotic::scene {

/// A value of a YAML text, and where it begins there.
class Node {
 public:
  enum class Kind : unsigned char { kNull, kScalar, kList, kMap };

  Node() = default;
  /// \param text  of a scalar
  Node(Kind kind, Place place, std::string text = {})
      : kind_(kind), place_(place), text_(std::move(text)) {}

  static Node scalar(std::string text, Place place) {
    return {Kind::kScalar, place, std::move(text)};
  }

  Kind kind() const noexcept { return kind_; }
  bool isNull() const noexcept { return kind_ == Kind::kNull; }
  bool isScalar() const noexcept { return kind_ == Kind::kScalar; }
  bool isList() const noexcept { return kind_ == Kind::kList; }
  bool isMap() const noexcept { return kind_ == Kind::kMap; }

  Place place() const noexcept { return place_; }  ///< line 0: not known
  /// Position of a byte in the text of a scalar, if the source has it unchanged; else of the
  /// scalar.
  Place placeOf(std::size_t byte) const noexcept {
    Place place = place_;
    place.column += lead_ < 0 ? 0 : lead_ + static_cast<int>(byte);
    return place;
  }
  /// \param lead  columns before the text, a quote; < 0: the source says it in other words
  void setLead(int lead) noexcept { lead_ = static_cast<signed char>(lead); }
  /// Text of a scalar; empty for other nodes.
  const std::string& text() const noexcept { return text_; }
  /// Items of a list, entries of a map.
  std::size_t size() const noexcept { return isMap() ? parts_.size() / 2 : parts_.size(); }
  /// Items of a list; of a map its keys and values in turn.
  const std::vector<Node>& parts() const noexcept { return parts_; }
  std::vector<Node>& parts() noexcept { return parts_; }
  auto begin() const noexcept { return parts_.begin(); }
  auto end() const noexcept { return parts_.end(); }
  /// \pre there are so many parts
  const Node& operator[](std::size_t part) const { return parts_[part]; }
  /// The value of the first entry of a map with this key; nullptr if there is none.
  const Node* find(const std::string& key) const {
    for (std::size_t i = 0; isMap() && i + 1 < parts_.size(); i += 2) {
      if (parts_[i].isScalar() && parts_[i].text() == key) {
        return &parts_[i + 1];
      }
    }
    return nullptr;
  }
  void setOrigin(int origin) noexcept { place_.origin = origin; }
  void add(Node part) { parts_.push_back(std::move(part)); }

 private:
  Kind kind_ = Kind::kNull;
  signed char lead_ = -1;
  Place place_{0, 0};
  std::string text_;
  std::vector<Node> parts_;
};

}  // namespace ergotic::scene
