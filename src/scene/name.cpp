// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/name.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstring>
#include <new>
#include <utility>

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxDigits = 24;  // two numbers and a dot

/// FNV-1a: can be carried on behind a text.
constexpr std::uint32_t kHashStart = 2166136261U;
std::uint32_t hashOn(std::uint32_t hash, std::string_view text) noexcept {
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  }
  return hash;
}

}  // namespace

/// A text that names share; its characters follow it.
struct Name::Stem {
  std::atomic<std::uint32_t> uses{1};
  std::uint32_t hash;
  std::uint32_t size;

  char* text() noexcept { return reinterpret_cast<char*>(this + 1); }

  static Stem* make(std::string_view text) {
    auto* stem = new (::operator new(sizeof(Stem) + text.size())) Stem;
    stem->hash = hashOn(kHashStart, text);
    stem->size = static_cast<std::uint32_t>(text.size());
    std::memcpy(stem->text(), text.data(), text.size());
    return stem;
  }
};

Name::Name(std::string_view text) : stem_(text.empty() ? nullptr : Stem::make(text)) {}

Name::Name(const Name& other) noexcept
    : stem_(other.stem_), first_(other.first_), second_(other.second_) {
  if (stem_ != nullptr) {
    stem_->uses.fetch_add(1, std::memory_order_relaxed);
  }
}

Name::Name(Name&& other) noexcept
    : stem_(std::exchange(other.stem_, nullptr)),
      first_(std::exchange(other.first_, -1)),
      second_(std::exchange(other.second_, -1)) {}

Name& Name::operator=(Name other) noexcept {
  std::swap(stem_, other.stem_);
  std::swap(first_, other.first_);
  std::swap(second_, other.second_);
  return *this;
}

Name::~Name() {
  if (stem_ != nullptr && stem_->uses.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    stem_->~Stem();
    ::operator delete(stem_);
  }
}

Name Name::numbered(int number) const {
  Name name = *this;
  name.first_ = number;
  return name;
}

Name Name::numbered(int row, int column) const {
  Name name = numbered(row);
  name.second_ = column;
  return name;
}

std::string_view Name::stem() const noexcept {
  return stem_ == nullptr ? std::string_view() : std::string_view(stem_->text(), stem_->size);
}

std::string_view Name::digits(char* buffer) const noexcept {
  char* end = buffer;
  if (first_ >= 0) {
    end = std::to_chars(end, buffer + kMaxDigits, first_).ptr;
  }
  if (second_ >= 0) {
    *end++ = '.';
    end = std::to_chars(end, buffer + kMaxDigits, second_).ptr;
  }
  return {buffer, static_cast<std::size_t>(end - buffer)};
}

std::string Name::str() const {
  char buffer[kMaxDigits];
  std::string text(stem());
  return text.append(digits(buffer));
}

std::uint32_t Name::hash() const noexcept {
  char buffer[kMaxDigits];
  return hashOn(stem_ == nullptr ? kHashStart : stem_->hash, digits(buffer));
}

std::uint32_t Name::hashOf(std::string_view text) noexcept {
  return hashOn(kHashStart, text);
}

bool Name::isText(std::string_view text) const noexcept {
  char buffer[kMaxDigits];
  const std::string_view front = stem();
  return text.substr(0, front.size()) == front &&
         text.substr(std::min(front.size(), text.size())) == digits(buffer);
}

bool operator==(const Name& a, const Name& b) noexcept {
  if (a.stem_ == b.stem_) {
    return a.first_ == b.first_ && a.second_ == b.second_;
  }
  char buffer[kMaxDigits];
  const std::string_view front = b.stem();
  const std::string_view back = b.digits(buffer);
  // Different stems may still spell one text: "s." with 7, and "s.7".
  char whole[kMaxDigits];
  const std::string_view own = a.stem();
  const std::string_view tail = a.digits(whole);
  if (own.size() + tail.size() != front.size() + back.size()) {
    return false;
  }
  const auto letter = [](std::string_view first, std::string_view second, std::size_t i) {
    return i < first.size() ? first[i] : second[i - first.size()];
  };
  for (std::size_t i = 0; i < own.size() + tail.size(); ++i) {
    if (letter(own, tail, i) != letter(front, back, i)) {
      return false;
    }
  }
  return true;
}

}  // namespace ergotic::scene
