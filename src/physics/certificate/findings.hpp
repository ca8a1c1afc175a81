// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"

namespace ergotic::physics {

/// Collects what the certificate has to say.
class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}

  /// Worsens the verdict, without words.
  void worsen(Verdict verdict);
  /// `file:line:col: error|warning: text`; only what is unstable is an error. What differs from one
  /// before in place and names alone is counted there: nets say the same of a thousand links.
  void add(Verdict verdict, const scene::Place& place, const std::string& text);

  /// `file:line:col: kind: text`
  std::string locate(const scene::Place& place,
                     const std::string& kind,
                     const std::string& text) const;

  /// Moves verdict and texts, worst first.
  void giveTo(Certificate& certificate);

 private:
  struct Finding {
    Verdict verdict;
    std::string text;
    int more = 0;
  };
  std::string file_;
  Verdict worst_ = Verdict::kPassive;
  std::vector<Finding> findings_;
  std::map<std::string, std::size_t> alike_;  // by their words
};

/// A number to four digits.
std::string describe(double value);
/// Rounded up: a rate that is still enough.
std::string wholeHz(double hz);

}  // namespace ergotic::physics
