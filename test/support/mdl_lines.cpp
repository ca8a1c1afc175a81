// SPDX-License-Identifier: BSD-3-Clause
#include "support/mdl_lines.hpp"

#include <algorithm>
#include <cctype>
#include <functional>
#include <sstream>

namespace ergotic::test {
namespace {

std::vector<std::string> tokens(const std::string& line) {
  std::vector<std::string> result;
  std::size_t i = 0;
  while (i < line.size() && line[i] != '#') {
    if (line[i] == '[') {
      const std::size_t end = line.find(']', i);
      result.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else if (std::isspace(static_cast<unsigned char>(line[i])) != 0) {
      ++i;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r[#", i), line.size());
      result.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return result;
}

/// Writes one macro out.
class Macro {
 public:
  Macro(const MdlElement& line, MdlElements& to) : line_(line), to_(to) {}

  void strings() {
    const bool stiff = line_.keyword == "stiffString";
    const int last = whole(0) - 1;
    net_ = {line_.name, 1, last + 1};
    const bool ends = line_.keyword != "chain";
    modules(stiff ? 5 : 4, 1, [=](int, int i) { return ends && (i == 0 || i == last); });
    const std::string damping = argument(stiff ? 4 : 3);
    for (int i = 0; i < last; ++i) {
      spring(net_.module(0, i), net_.module(0, i + 1), argument(2), damping);
    }
    if (!stiff) {
      return;
    }
    for (int i = 0; i + 1 < last; ++i) {
      spring(net_.module(0, i), net_.module(0, i + 2), argument(3), "0");
    }
    spring(net_.module(0, 0), net_.module(0, 1), argument(3), "0");
    spring(net_.module(0, last - 1), net_.module(0, last), argument(3), "0");
  }

  void meshes() {
    const int rows = whole(0);
    const int columns = whole(1);
    net_ = {line_.name, rows, columns};
    const auto edges = [=](int i, int j) {
      return (i == 0 || i == rows - 1 ? 1 : 0) + (j == 0 || j == columns - 1 ? 1 : 0);
    };
    const int fixed = line_.keyword == "closedMesh" ? 1 : line_.keyword == "cornerMesh" ? 2 : 3;
    modules(5, 2, [=](int i, int j) { return edges(i, j) >= fixed; });
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        if (i + 1 < rows) {
          spring(net_.module(i, j), net_.module(i + 1, j), argument(3), argument(4));
        }
        if (j + 1 < columns) {
          spring(net_.module(i, j), net_.module(i, j + 1), argument(3), argument(4));
        }
      }
    }
  }

 private:
  const std::string& argument(std::size_t i) const { return line_.arguments.at(i); }
  int whole(std::size_t i) const { return std::stoi(argument(i)); }

  /// \param after  index of the argument behind Z
  /// \param mass   that of the mass
  void modules(std::size_t after, std::size_t mass, const std::function<bool(int, int)>& isFixed) {
    const bool damped = line_.arguments.size() == after + 3;
    const std::string& start = argument(after + (damped ? 1 : 0));
    const std::string& end = line_.arguments.back();
    for (int i = 0; i < net_.rows; ++i) {
      for (int j = 0; j < net_.columns; ++j) {
        const std::string zo = damped ? argument(after) : "0";
        const MdlElement fixed{net_.module(i, j), "ground", {start}};
        const MdlElement free{fixed.name, "osc", {argument(mass), "0", zo, start, end}};
        to_.lines.push_back(isFixed(i, j) ? fixed : free);
      }
    }
    to_.nets.push_back(net_);
  }

  void spring(const std::string& a,
              const std::string& b,
              const std::string& k,
              const std::string& z) {
    const std::string name = line_.name + ".link." + std::to_string(links_++);
    to_.lines.push_back({name, "springDamper", {"@" + a, "@" + b, k, z}});
  }

  const MdlElement& line_;
  MdlElements& to_;
  MdlNet net_;
  int links_ = 0;
};

}  // namespace

std::string MdlNet::module(int row, int column) const {
  return name + "." + (rows > 1 ? std::to_string(row) + "." : "") + std::to_string(column);
}

MdlElements readMdlElements(const std::string& text) {
  MdlElements elements;
  std::istringstream stream(text);
  for (std::string raw; std::getline(stream, raw);) {
    const std::vector<std::string> words = tokens(raw);
    if (words.size() < 2 || words[0][0] != '@') {
      continue;
    }
    const MdlElement line{words[0].substr(1), words[1], {words.begin() + 2, words.end()}};
    if (line.keyword == "string" || line.keyword == "chain" || line.keyword == "stiffString") {
      Macro(line, elements).strings();
    } else if (line.keyword == "mesh" || line.keyword == "cornerMesh" ||
               line.keyword == "closedMesh") {
      Macro(line, elements).meshes();
    } else {
      elements.lines.push_back(line);
    }
  }
  return elements;
}

}  // namespace ergotic::test
