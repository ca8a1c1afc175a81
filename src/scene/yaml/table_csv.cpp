// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/table_csv.hpp"

#include <algorithm>

#include "scene/text/csv_line.hpp"

namespace ergotic::scene {

Table readTableCsv(const std::string& text, const std::string& file) {
  constexpr const char* kTwo = "two numbers in a line";
  Table table;
  const int lines = forEachCsvLine(text, file, [&table](CsvLine& csv) {
    const Limits first =
        table.empty() ? Limits{} : Limits{"", table.points.back().first, kInfinity, true};
    const double x = csv.number("first number of a point", first, kTwo);
    if (table.points.size() == kMaxTablePoints) {
      csv.fail("too many points, allowed: 2..." + std::to_string(kMaxTablePoints));
    }
    csv.skipSeparator();
    table.points.emplace_back(x, csv.number("force of a point", kForceLimits, kTwo));
    csv.expectEnd("more than two numbers in a line, allowed: two");
  });
  if (table.points.size() < 2) {
    throw TextError(file, std::max(lines, 1), 1,
                    "the table has " + std::to_string(table.points.size()) +
                        " points, allowed: 2..." + std::to_string(kMaxTablePoints));
  }
  return table;
}

}  // namespace ergotic::scene
