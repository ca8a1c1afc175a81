// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/table_csv.hpp"

#include <sstream>

#include "scene/text/csv.hpp"

namespace ergotic::scene {

Table readTableCsv(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  CsvReader csv(in, file, "two numbers in a line");
  Table table;
  while (csv.next()) {
    if (csv.isHeader()) {
      continue;
    }
    if (table.points.size() == kMaxTablePoints) {
      csv.fail(0, "too many points, allowed: 2..." + std::to_string(kMaxTablePoints));
    }
    const Limits first =
        table.empty() ? Limits{} : Limits{"", table.points.back().first, kInfinity, true};
    const double x = csv.number(0, "first number of a point", first);
    table.points.emplace_back(x, csv.number(1, "force of a point", kForceLimits));
    csv.expectEnd(2);
  }
  if (table.points.size() < 2) {
    csv.failAtLine("the table has " + std::to_string(table.points.size()) +
                   " points, allowed: 2..." + std::to_string(kMaxTablePoints));
  }
  return table;
}

}  // namespace ergotic::scene
