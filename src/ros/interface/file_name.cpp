// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/file_name.hpp"

#include <algorithm>
#include <cctype>

#include "ergotic/exception.hpp"
#include "files/printable.hpp"

namespace ergotic::node {
namespace {

bool isAllowedInFileName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
}

}  // namespace

void requireFileName(const std::string& what, const std::string& name) {
  if (name.empty() || name.size() > kLongestFileName || name.front() == '.' ||
      !std::all_of(name.begin(), name.end(), isAllowedInFileName)) {
    throw Exception("a " + what + " cannot be named '" + files::printable(name, kLongestFileName) +
                    "', allowed: 1...64 letters, digits, '_', '-' and '.', the first no '.'");
  }
}

std::string toFileName(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !isAllowedInFileName(c); }, '_');
  return text.substr(0, kLongestFileName);
}

}  // namespace ergotic::node
