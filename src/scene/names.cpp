// SPDX-License-Identifier: BSD-3-Clause
#include "scene/names.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "files/printable.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kLongestQuote = 48;
constexpr std::size_t kLongestCompared = 64;  // bounds the cost of a suggestion
constexpr std::size_t kMaxListed = 16;
constexpr std::size_t kFewestSlots = 16;

/// Letters to add, drop or replace to get from one word to the other (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

void NameTable::reserve(std::size_t count) {
  std::size_t slots = std::max<std::size_t>(slots_.size(), kFewestSlots);
  while (slots < 2 * count) {
    slots *= 2;
  }
  if (slots > slots_.size()) {
    resize(slots);
  }
}

void NameTable::resize(std::size_t slots) {
  std::vector<Slot> old(slots);
  old.swap(slots_);
  for (Slot& each : old) {
    if (each.is_taken) {
      std::size_t slot = first(each.hash);
      while (slots_[slot].is_taken) {
        slot = next(slot);
      }
      slots_[slot] = std::move(each);
    }
  }
}

int NameTable::add(const Name& name, int index) {
  reserve(count_ + 1);
  const std::uint32_t hash = name.hash();
  std::size_t slot = first(hash);
  while (slots_[slot].is_taken) {
    if (slots_[slot].hash == hash && slots_[slot].name == name) {
      return slots_[slot].index;
    }
    slot = next(slot);
  }
  slots_[slot] = {name, index, hash, true};
  ++count_;
  return -1;
}

int NameTable::find(std::string_view name) const {
  if (slots_.empty()) {
    return -1;
  }
  const std::uint32_t hash = Name::hashOf(name);
  for (std::size_t slot = first(hash); slots_[slot].is_taken; slot = next(slot)) {
    if (slots_[slot].hash == hash && slots_[slot].name.isText(name)) {
      return slots_[slot].index;
    }
  }
  return -1;
}

std::vector<std::string> NameTable::names() const {
  std::vector<std::string> all;
  all.reserve(count_);
  for (const Slot& each : slots_) {
    if (each.is_taken) {
      all.push_back(each.name);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string quoted(const std::string& text) {
  return "'" + files::printable(text, kLongestQuote) + "'";
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  if (word.size() <= kLongestCompared) {
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : known) {
      const std::size_t shorter = std::min(word.size(), candidate.size());
      if (std::max(word.size(), candidate.size()) - shorter >= best_distance) {
        continue;
      }
      const std::size_t distance = editDistance(word, candidate);
      if (distance < best_distance) {
        best_distance = distance;
        best = candidate;
      }
    }
  }
  if (!best.empty()) {
    return "; did you mean " + quoted(best) + "?";
  }
  if (known.empty() || known.size() > kMaxListed) {
    return "";
  }
  std::string list = "; known: ";
  for (const std::string& name : known) {
    list += (&name == &known.front() ? "" : ", ") + name;
  }
  return list;
}

}  // namespace ergotic::scene
