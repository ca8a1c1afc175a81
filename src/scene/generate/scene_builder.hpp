// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {

/// A scene while it is being read: adds elements, finds them by name, says what is wrong where.
class SceneBuilder {
 public:
  SceneBuilder(const std::string& file, const std::string& text);

  /// The text has no folder in which to look for files.
  void forbidFiles() noexcept { may_read_files_ = false; }
  bool mayReadFiles() const noexcept { return may_read_files_; }

  Scene& scene() noexcept { return scene_; }
  const Scene& scene() const noexcept { return scene_; }
  /// The whole valid scene. \throws TextError from `validate`
  Scene finish();

  /// \return the index of what was added
  /// \throws TextError if the name is taken, or if there are too many modules
  int add(Parameter parameter);
  int add(Section section);
  int add(Mat mat);
  int add(Lia lia);
  /// The next link must be the first of its springs: they share the place of its name.
  int add(Bend bend);
  int add(StringInfo string);
  int add(Grid grid);
  /// \throws TextError if that many modules more would be more than kMaxMats
  void expectRoom(std::size_t mats, Place place) const;
  /// Makes room for that many modules and links more.
  /// \throws TextError as `expectRoom` does
  void reserve(std::size_t mats, std::size_t lias, Place place);

  /// \return index of what was defined under that name
  /// \throws TextError naming the nearest that exists
  int parameter(const std::string& name, Place place) const;
  int section(const std::string& name, Place place) const;
  int mat(const std::string& name, Place place) const;
  int grid(const std::string& name, Place place) const;
  int lia(const std::string& name, Place place) const;
  /// \return -1 if there is no such module
  int findMat(const std::string& name) const { return mats_.find(name); }
  /// \return -1 if there is no such string or mesh
  int findGrid(const std::string& name) const { return grids_.find(name); }
  /// \return -1 if there is no such link
  int findLia(const std::string& name) const { return lias_.find(name); }

  /// Counts what selections look at, and what they mean. \throws TextError if that is too much
  void expectToLookAt(std::size_t mats, Place place);
  void addSelected(const std::string& text, std::size_t count, Place place);

  /// \return Place::origin of what comes from there
  int addOrigin(Origin origin);
  [[noreturn]] void fail(Place place, const std::string& what) const;
  void warn(Place place, const std::string& what);

 private:
  int find(const NameTable& table, const char* kind, const std::string& name, Place place) const;
  /// Takes a name for the next of a list. \return its index
  template <class T, class Item>
  int name(const std::vector<T>& list, NameTable& table, const char* kind, const Item& item) const;
  template <class T>
  int append(std::vector<T>& list, NameTable& table, const char* kind, T item);

  Scene scene_;
  bool may_read_files_ = true;
  std::size_t looked_at_ = 0;
  std::size_t selected_ = 0;
  std::unordered_set<std::string> selections_;
  NameTable parameters_;
  NameTable sections_;
  NameTable mats_;
  NameTable lias_;
  NameTable strings_;
  NameTable grids_;
};

}  // namespace ergotic::scene
