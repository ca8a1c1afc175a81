// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

namespace ergotic::scene {

/// The name of a module or link, in 16 bytes: a text, or a text with one or two numbers after it
/// (`s.7`, `plate.3.12`). Copies share the text, so that the many names of a generator cost next to
/// nothing; otherwise it is used like a string. Thread: any (copies are independent).
class Name {
 public:
  Name() noexcept = default;
  Name(std::string_view text);  // NOLINT(google-explicit-constructor)
  Name(const std::string& text) : Name(std::string_view(text)) {}  // NOLINT
  Name(const char* text) : Name(std::string_view(text)) {}         // NOLINT
  Name(const Name& other) noexcept;
  Name(Name&& other) noexcept;
  Name& operator=(Name other) noexcept;
  ~Name();

  /// This text with a number behind it, or with two that a dot separates.
  /// \pre it has no numbers yet; number, row, column >= 0
  Name numbered(int number) const;
  Name numbered(int row, int column) const;

  std::string str() const;
  operator std::string() const { return str(); }  // NOLINT(google-explicit-constructor)
  bool empty() const noexcept { return stem_ == nullptr; }
  void clear() noexcept { *this = Name(); }

  /// Equal texts have equal hashes, however they are made up.
  std::uint32_t hash() const noexcept;
  static std::uint32_t hashOf(std::string_view text) noexcept;

  bool isText(std::string_view text) const noexcept;
  friend bool operator==(const Name& a, const Name& b) noexcept;
  friend bool operator!=(const Name& a, const Name& b) noexcept { return !(a == b); }
  friend bool operator==(const Name& a, const std::string& b) noexcept { return a.isText(b); }
  friend bool operator!=(const Name& a, const std::string& b) noexcept { return !a.isText(b); }
  friend bool operator==(const Name& a, const char* b) noexcept { return a.isText(b); }
  friend bool operator!=(const Name& a, const char* b) noexcept { return !a.isText(b); }
  friend std::string operator+(const std::string& a, const Name& b) { return a + b.str(); }
  friend std::string operator+(const char* a, const Name& b) { return a + b.str(); }
  friend std::string operator+(const Name& a, const std::string& b) { return a.str() + b; }
  friend std::string operator+(const Name& a, const char* b) { return a.str() + b; }

 private:
  struct Stem;
  /// The numbers as text, in a buffer of at least kMaxDigits.
  std::string_view digits(char* buffer) const noexcept;
  std::string_view stem() const noexcept;

  Stem* stem_ = nullptr;     // null: empty
  std::int32_t first_ = -1;  // -1: none
  std::int32_t second_ = -1;
};

inline std::ostream& operator<<(std::ostream& to, const Name& name) {
  return to << name.str();
}

}  // namespace ergotic::scene
