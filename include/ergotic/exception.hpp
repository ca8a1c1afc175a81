// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace ergotic {

/// Base of everything that Ergotic throws, always outside the real-time thread.
/// The text says what is wrong, the value, its unit and the allowed range.
class Exception : public std::runtime_error {
 public:
  explicit Exception(const std::string& what) : std::runtime_error(what) {}
};

/// A text (scene, gesture file, parameter file) cannot be used as it stands.
/// The message starts with `file:line:col: error: `.
class TextError : public Exception {
 public:
  TextError(const std::string& file, int line, int column, const std::string& what);

  int line() const noexcept { return line_; }
  int column() const noexcept { return column_; }

 private:
  int line_;
  int column_;
};

/// A device, an audio server or the operating system refused something.
class DeviceError : public Exception {
 public:
  using Exception::Exception;
};

}  // namespace ergotic
