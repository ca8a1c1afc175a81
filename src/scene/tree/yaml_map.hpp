// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scene/generate/scene_builder.hpp"
#include "scene/limits.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// Position at which a node begins; `fallback` if it is empty or its position is not known.
Place placeOf(const Node& node, Place fallback);

/// Describes a node for messages, as in `a list of 3`.
std::string kindOf(const Node& node);

/// Text of a scalar. \throws TextError if it is not one
std::string wordOf(const SceneBuilder& builder,
                   const Node& node,
                   const std::string& what,
                   Place fallback);

/// A constant, with a unit of the kind of the limits or without: \see parseQuantity().
/// \throws TextError at `place` if it is no finite number within the limits
double numberIn(const SceneBuilder& builder,
                const std::string& text,
                const std::string& what,
                const Limits& limits,
                Place place);

/// The constant in a scalar. \throws TextError as `wordOf` and `numberIn`
double numberOf(const SceneBuilder& builder,
                const Node& node,
                const std::string& what,
                const Limits& limits,
                Place fallback);

/// A number, `$name` or `number*$name`, legal over the parameter's whole range.
/// \throws TextError as `numberOf`, or if there is no such parameter
Value valueOf(const SceneBuilder& builder,
              const Node& node,
              const std::string& what,
              const Limits& limits,
              Place fallback);

/// Calls `entry` for every pair of a map in the order of the text.
/// \throws TextError if it is not a map, or a key is not a scalar or comes twice
using MapEntry = std::function<void(const std::string& key, Place place, const Node& value)>;
void forEachEntry(const SceneBuilder& builder,
                  const Node& node,
                  const std::string& what,
                  Place fallback,
                  const MapEntry& entry);

/// A legal name: a letter or `_`, then letters, digits, `_`, `.`, `-`; at most 64.
/// \throws TextError at `place`
void checkName(const SceneBuilder& builder, const std::string& name, Place place);

/// A map with known keys. Every getter throws TextError at the offending scalar, or at the place of
/// the whole element if a key is missing.
class YamlMap {
 public:
  struct Entry {
    std::string key;
    Place place;
    const Node* value = nullptr;
  };
  /// \param node   must outlive it
  /// \param what   for messages, as in `module 'm'`
  /// \param place  of the element
  YamlMap(const SceneBuilder& builder, const Node& node, std::string what, Place place);

  /// A map of entries that were read elsewhere. \pre no key comes twice
  YamlMap(const SceneBuilder& builder, std::vector<Entry> entries, std::string what, Place place);

  /// \throws TextError at the first key that is not among these
  void allow(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return find(key) != nullptr; }
  const Node& at(const std::string& key) const;
  Place placeAt(const std::string& key) const;  ///< position of the value
  /// Position of an item of a list, or of the number in place of a list.
  Place placeAt(const std::string& key, std::size_t index) const;
  Place keyPlaceAt(const std::string& key) const;
  Place place() const { return place_; }
  const std::string& what() const { return what_; }

  std::string word(const std::string& key) const;
  /// Index of the word among `words`.
  std::size_t choice(const std::string& key, const std::vector<std::string>& words) const;
  double number(const std::string& key, const Limits& limits) const;
  double number(const std::string& key, const Limits& limits, double otherwise) const;
  int integer(const std::string& key, const Limits& limits) const;
  /// `[a, b, ...]` of exactly `count` constants; zeros if the key is missing.
  std::vector<double> vector(const std::string& key, std::size_t count, const Limits& limits) const;
  /// `[a, b, ...]` of `fewest` to `most` constants; where one is enough, it may stand alone.
  std::vector<double> numbers(const std::string& key,
                              std::size_t fewest,
                              std::size_t most,
                              const Limits& limits) const;
  /// The same of whole numbers.
  std::vector<int> integers(const std::string& key,
                            std::size_t fewest,
                            std::size_t most,
                            const Limits& limits) const;
  /// `true` or `false`.
  bool flag(const std::string& key, bool otherwise) const;
  /// As `valueOf`.
  Value value(const std::string& key, const Limits& limits) const;
  Value value(const std::string& key, const Limits& limits, const Value& otherwise) const;
  /// The map under a key.
  YamlMap map(const std::string& key) const;

  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  const Entry* find(const std::string& key) const;
  const Entry& require(const std::string& key) const;
  std::string named(const std::string& key) const;
  std::vector<double> list(const std::string& key,
                           std::size_t fewest,
                           std::size_t most,
                           const Limits& limits) const;

  const SceneBuilder& builder_;
  std::string what_;
  Place place_;
  std::vector<Entry> entries_;
};

/// A place and a direction: `{position: [x, y, z], rotation: [roll, pitch, yaw]}`, m and rad, about
/// fixed axes, x first. What is missing is zero. \throws TextError as the getters
Eigen::Isometry3d poseOf(const YamlMap& pose);

}  // namespace ergotic::scene
