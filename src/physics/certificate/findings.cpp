// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/findings.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace ergotic::physics {

void Findings::worsen(Verdict verdict) {
  worst_ = std::max(worst_, verdict);
}

void Findings::add(Verdict verdict, const scene::Place& place, const std::string& text) {
  worsen(verdict);
  const char* kind = verdict == Verdict::kUnstable ? "error" : "warning";
  findings_.push_back({verdict, locate(place, kind, text)});
}

std::string Findings::locate(const scene::Place& place,
                             const std::string& kind,
                             const std::string& text) const {
  return file_ + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": " +
         kind + ": " + text;
}

void Findings::giveTo(Certificate& certificate) {
  std::stable_sort(findings_.begin(), findings_.end(),
                   [](const Finding& a, const Finding& b) { return a.verdict > b.verdict; });
  certificate.verdict = worst_;
  for (Finding& finding : findings_) {
    certificate.findings.push_back(std::move(finding.text));
  }
  findings_.clear();
}

std::string describe(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

std::string wholeHz(double hz) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << std::ceil(hz);
  return text.str();
}

}  // namespace ergotic::physics
