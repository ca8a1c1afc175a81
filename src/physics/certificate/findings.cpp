// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/findings.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace ergotic::physics {
namespace {

/// The text without the names in it, which is the same for many links of a net.
std::string unnamed(const std::string& text) {
  std::string rest;
  bool is_name = false;
  for (const char c : text) {
    is_name = is_name != (c == '\'');
    if (!is_name) {
      rest += c;
    }
  }
  return rest;
}

}  // namespace

void Findings::worsen(Verdict verdict) {
  worst_ = std::max(worst_, verdict);
}

void Findings::add(Verdict verdict, const scene::Place& place, const std::string& text) {
  worsen(verdict);
  const char* kind = verdict == Verdict::kUnstable ? "error" : "warning";
  const auto [known, is_new] = alike_.emplace(kind + unnamed(text), findings_.size());
  if (is_new) {
    findings_.push_back({verdict, locate(place, kind, text)});
  } else {
    ++findings_[known->second].more;
  }
}

std::string Findings::locate(const scene::Place& place,
                             const std::string& kind,
                             const std::string& text) const {
  return file_ + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": " +
         kind + ": " + text;
}

void Findings::giveTo(Certificate& certificate) {
  alike_.clear();
  std::stable_sort(findings_.begin(), findings_.end(),
                   [](const Finding& a, const Finding& b) { return a.verdict > b.verdict; });
  certificate.verdict = worst_;
  for (const Finding& finding : findings_) {
    const std::string more =
        finding.more > 0 ? " (" + std::to_string(finding.more) + " more like it)" : "";
    certificate.findings.push_back(finding.text + more);
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
