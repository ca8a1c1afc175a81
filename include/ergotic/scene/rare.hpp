// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace ergotic::scene {

/// A T that most of its owners leave as it is by default: these keep 8 bytes only. Read it with `*`
/// and `->`, change it with `edit`. Copies are independent.
template <class T>
class Rare {
 public:
  Rare() noexcept = default;
  Rare(const Rare& other) : value_(other.copy()) {}
  Rare(Rare&&) noexcept = default;
  Rare& operator=(const Rare& other) {
    value_ = other.copy();
    return *this;
  }
  Rare& operator=(Rare&&) noexcept = default;
  ~Rare() = default;

  const T& operator*() const noexcept { return value_ ? *value_ : usual(); }
  const T* operator->() const noexcept { return &**this; }

  /// The value, to be changed; it takes memory of its own from then on.
  T& edit() {
    if (!value_) {
      value_ = std::make_unique<T>();
    }
    return *value_;
  }

 private:
  static const T& usual() noexcept {
    static const T kUsual;
    return kUsual;
  }
  std::unique_ptr<T> copy() const { return value_ ? std::make_unique<T>(*value_) : nullptr; }

  std::unique_ptr<T> value_;
};

}  // namespace ergotic::scene
