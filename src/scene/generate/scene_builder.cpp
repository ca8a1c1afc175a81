// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/scene_builder.hpp"

#include <algorithm>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/scene/origin.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

#ifdef ERGOTIC_FUZZED
constexpr std::size_t kMatLimit = 5000;  // whatever a fuzzer asks for is made in no time
#else
constexpr std::size_t kMatLimit = kMaxMats;
#endif

/// Room for many more; grows by half at least, as one scene may have thousands of generators.
template <class T>
void makeRoom(std::vector<T>& list, std::size_t more) {
  const std::size_t wanted = list.size() + more;
  if (wanted > list.capacity()) {
    list.reserve(std::max(wanted, list.capacity() + list.capacity() / 2));
  }
}

Place placeOf(const StringInfo& string, const Scene& scene) {
  return scene.mats[static_cast<std::size_t>(string.first)].place;
}

Place placeOf(const Grid& grid, const Scene& scene) {
  return scene.mats[static_cast<std::size_t>(grid.first)].place;
}

template <class T>
Place placeOf(const T& item, const Scene&) {
  return item.place;
}

}  // namespace

SceneBuilder::SceneBuilder(const std::string& file, const std::string& text) {
  scene_.file = file;
  scene_.text = text;
}

Scene SceneBuilder::finish() {
  scene_.mats.shrink_to_fit();
  scene_.lias.shrink_to_fit();
  validate(scene_);
  return std::move(scene_);
}

template <class T, class Item>
int SceneBuilder::name(const std::vector<T>& list,
                       NameTable& table,
                       const char* kind,
                       const Item& item) const {
  const int index = static_cast<int>(list.size());
  const int first = table.add(item.name, index);
  if (first >= 0) {
    const int line = placeOf(list[static_cast<std::size_t>(first)], scene_).line;
    fail(placeOf(item, scene_), std::string(kind) + " " + quoted(item.name) +
                                    " is defined twice, first in line " + std::to_string(line));
  }
  return index;
}

template <class T>
int SceneBuilder::append(std::vector<T>& list, NameTable& table, const char* kind, T item) {
  const int index = name(list, table, kind, item);
  list.push_back(std::move(item));
  return index;
}

int SceneBuilder::add(Parameter parameter) {
  return append(scene_.parameters, parameters_, "parameter", std::move(parameter));
}

int SceneBuilder::add(Section section) {
  return append(scene_.sections, sections_, "section", std::move(section));
}

int SceneBuilder::add(Mat mat) {
  if (scene_.mats.size() >= kMatLimit) {
    reserve(1, 0, mat.place);
  }
  return append(scene_.mats, mats_, "module", std::move(mat));
}

int SceneBuilder::add(Lia lia) {
  return append(scene_.lias, lias_, "link", std::move(lia));
}

int SceneBuilder::add(Bend bend) {
  bend.first_lia = name(scene_.lias, lias_, "link", bend);
  scene_.bends.push_back(std::move(bend));
  return static_cast<int>(scene_.bends.size()) - 1;
}

int SceneBuilder::add(StringInfo string) {
  return append(scene_.strings, strings_, "string", std::move(string));
}

int SceneBuilder::add(Grid grid) {
  return append(scene_.grids, grids_, "string or mesh", std::move(grid));
}

void SceneBuilder::expectRoom(std::size_t mats, Place place) const {
  const std::size_t total = scene_.mats.size() + mats;
  if (total > kMatLimit) {
    fail(place, "the scene would have " + std::to_string(total) + " modules, allowed: at most " +
                    std::to_string(kMatLimit));
  }
}

void SceneBuilder::reserve(std::size_t mats, std::size_t lias, Place place) {
  expectRoom(mats, place);
  makeRoom(scene_.mats, mats);
  makeRoom(scene_.lias, lias);
  mats_.reserve(scene_.mats.size() + mats);
  lias_.reserve(scene_.lias.size() + lias);
}

int SceneBuilder::parameter(const std::string& name, Place place) const {
  return find(parameters_, "parameter", name, place);
}

int SceneBuilder::section(const std::string& name, Place place) const {
  return find(sections_, "section", name, place);
}

int SceneBuilder::mat(const std::string& name, Place place) const {
  return find(mats_, "module", name, place);
}

int SceneBuilder::grid(const std::string& name, Place place) const {
  return find(grids_, "string or mesh", name, place);
}

int SceneBuilder::lia(const std::string& name, Place place) const {
  return find(lias_, "link", name, place);
}

int SceneBuilder::find(const NameTable& table,
                       const char* kind,
                       const std::string& name,
                       Place place) const {
  const int index = table.find(name);
  if (index < 0) {
    fail(place,
         std::string("unknown ") + kind + " " + quoted(name) + suggestion(name, table.names()));
  }
  return index;
}

void SceneBuilder::expectToLookAt(std::size_t mats, Place place) {
  constexpr std::size_t kMax = 50'000'000;  // some tenths of a second
  if ((looked_at_ += mats) > kMax) {
    fail(place,
         "the selections of the scene look at more than " + std::to_string(kMax) + " modules");
  }
}

void SceneBuilder::addSelected(const std::string& text, std::size_t count, Place place) {
  constexpr std::size_t kMax = 2'000'000;
  if ((selected_ += count) > kMax) {
    fail(place, "the selections of the scene mean more than " + std::to_string(kMax) + " modules");
  }
  if (selections_.insert(text).second) {
    scene_.selections.push_back({text, count, place});
  }
}

int SceneBuilder::addOrigin(Origin origin) {
  scene_.origins.push_back(std::move(origin));
  return static_cast<int>(scene_.origins.size());
}

void SceneBuilder::fail(Place place, const std::string& what) const {
  throw errorAt(scene_, place, what);
}

void SceneBuilder::warn(Place place, const std::string& what) {
  constexpr std::size_t kMax = 100;  // a status carries them all
  if (scene_.warnings.size() >= kMax) {
    scene_.warnings.resize(kMax, "");
    scene_.warnings.back() = scene_.file + ": warning: there are more of them";
    return;
  }
  scene_.warnings.push_back(textOf(scene_, place) + ": warning: " + what);
}

}  // namespace ergotic::scene
