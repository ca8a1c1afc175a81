// SPDX-License-Identifier: BSD-3-Clause
#include "integration/fault_table.hpp"

#include <iomanip>
#include <stdexcept>

#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

const char* toString(Start start) {
  switch (start) {
    case Start::kTick:
      return "its first tick";
    case Start::kRequest:
      return "the request";
    case Start::kLastMessage:
      return "the last message";
    case Start::kEnergy:
      return "`energy_limit` given out";
    case Start::kReach:
      return "the hand beyond it";
  }
  return "";
}

}  // namespace

void FaultTable::add(const FaultCase& fault, const Outcome& outcome) {
  const std::string prefix = "fault: ";
  std::ostringstream row;
  row << std::fixed << std::setprecision(1) << "| " << fault.name << " | "
      << outcome.says.substr(std::min(prefix.size(), outcome.says.size())) << " | "
      << toString(fault.start) << " | " << outcome.released_ms << " ms | " << fault.limit_says
      << " | " << 1e3 * outcome.recovered_s << " ms |\n";
  rows_[fault.name] = row.str();
}

void FaultTable::write() const {
  std::string table =
      "| fault | latched as | counted from | force below 1 % at the device after | limit | "
      "recovered in |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const FaultCase& fault : faultCases()) {
    const auto row = rows_.find(fault.name);
    if (row == rows_.end()) {
      throw std::runtime_error("the table of faults is not written: no result of " + fault.name);
    }
    table += row->second;
  }
  const std::string path = repository("docs/safety.md");
  const std::string begin = "<!-- faults: begin -->\n";
  const std::string end = "<!-- faults: end -->";
  std::string page = textOf(path);
  const std::size_t from = page.find(begin);
  const std::size_t to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error(path + " has no place for the table of faults");
  }
  page.replace(from + begin.size(), to - from - begin.size(), table);
  if (!(std::ofstream(path) << page << std::flush)) {
    throw std::runtime_error(path + " cannot be written");
  }
}

}  // namespace ergotic::test
