// SPDX-License-Identifier: BSD-3-Clause
// What docs/ros.md and launch/station.launch say of parameters, against what the station reads.
#include <yaml-cpp/yaml.h>

#include <map>
#include <regex>
#include <set>

#include "ros/device/parameters.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

using XmlRpc::XmlRpcValue;

std::vector<std::smatch> allOf(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), {}};
}

struct Row {
  std::string value;  ///< by default
  std::string allowed;
};

/// The table of docs/ros.md.
std::map<std::string, Row> documented() {
  const std::string text = textOf(repository("docs/ros.md"));
  const std::string section = text.substr(text.find("\n## Parameters"));
  const std::string table = section.substr(0, section.find("\n## ", 4));
  static const std::regex kRow(R"(\n\| `(\w+)` \| `?([^|`]*)`? \|([^|]*)\|)");
  std::map<std::string, Row> rows;
  for (const std::smatch& row : allOf(table, kRow)) {
    rows[row[1]] = {std::regex_replace(row[2].str(), std::regex(" +$|^empty *$"), ""), row[3]};
  }
  return rows;
}

/// Names that the station reads, from what it says to one that it does not know.
std::set<std::string> known() {
  XmlRpcValue values;
  values["xxxxxxxxxxxx"] = 1;
  const std::string said = complaintOf([&] { readParameters(values, "/station"); });
  const std::string list = said.substr(said.find("allowed: ") + 9);
  static const std::regex kName(R"(\w+)");
  std::set<std::string> names;
  for (const std::smatch& name : allOf(list, kName)) {
    names.insert(name.str());
  }
  names.erase("diagnostic_period");  // of others
  names.erase("num_worker_threads");
  return names;
}

/// Every value as it is when nothing is said.
std::map<std::string, std::string> defaults() {
  const Parameters p = readParameters(XmlRpcValue(), "/station");
  std::map<std::string, std::string> values = {{"model", p.model},
                                               {"device", p.device},
                                               {"driver", p.driver},
                                               {"driver_settings", p.driver_settings},
                                               {"gesture", p.gesture},
                                               {"virtual_shared_memory", p.virtual_shared_memory},
                                               {"end_effectors", p.end_effectors}};
  for (const auto& entry : YAML::Load(toYaml(p, readDevices(p)))) {
    const auto name = entry.first.as<std::string>();
    if (name != "device") {
      values[name] = entry.second.as<std::string>();
    }
  }
  values["isa"] = values["isa"] == nameOf(rt::bestIsa()) ? "best" : values["isa"];
  return values;
}

bool isNumber(const std::string& text, double& number) {
  char* end = nullptr;
  number = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

/// As numbers, if they are some.
bool areEqual(const std::string& a, const std::string& b) {
  double x = 0.0;
  double y = 0.0;
  return isNumber(a, x) && isNumber(b, y) ? x == y : a == b;
}

bool isTaken(const std::string& name, double value) {
  XmlRpcValue values;
  values[name] = value;
  return complaintOf([&] { readParameters(values, "/station"); }).empty();
}

TEST(DocumentedParametersTest, AreAllThatTheStationReads) {
  std::set<std::string> told;
  for (const auto& [name, row] : documented()) {
    told.insert(name);
  }
  EXPECT_EQ(told, known());
}

TEST(DocumentedParametersTest, HaveTheDefaultsOfTheStation) {
  const auto rows = documented();
  for (const auto& [name, value] : defaults()) {
    ASSERT_EQ(rows.count(name), 1U) << name;
    EXPECT_TRUE(areEqual(rows.at(name).value, value))
        << name << " is " << value << ", docs/ros.md: " << rows.at(name).value;
  }
}

/// Both ends are taken, and nothing beyond them.
TEST(DocumentedParametersTest, HaveTheRangesOfTheStation) {
  static const std::regex kRange(R"(([-+0-9.e]*[0-9])\.\.\.([-+0-9.e]+))");
  int ranges = 0;
  for (const auto& [name, row] : documented()) {
    std::smatch range;
    if (!std::regex_search(row.allowed, range, kRange)) {
      continue;
    }
    ++ranges;
    const double low = std::stod(range[1]);
    const double high = std::stod(range[2]);
    EXPECT_TRUE(isTaken(name, low) && isTaken(name, high)) << name << ": " << row.allowed;
    EXPECT_FALSE(isTaken(name, high + std::max(1.0, 1e-3 * high))) << name << ": " << row.allowed;
    EXPECT_FALSE(isTaken(name, low - std::max(1e-6, 1e-3 * std::abs(low)))) << name;
  }
  EXPECT_GT(ranges, 20);
}

/// An argument of the launch file has the name, and the default, of its parameter; the station of
/// the launch file brings a model, and opens no force by itself.
TEST(DocumentedParametersTest, AreThoseOfTheLaunchFile) {
  const std::string launch = textOf(repository("launch/station.launch"));
  static const std::regex kParam(
      R"re(<param name="(\w+)" (?:type="str" )?value="\$\(arg (\w+)\)")re");
  static const std::regex kArg(R"re(<arg name="(\w+)"\s+default="([^"]*)")re");
  std::map<std::string, std::string> arguments;
  for (const std::smatch& arg : allOf(launch, kArg)) {
    arguments[arg[1]] = arg[2];
  }
  auto values = defaults();
  values["model"] = "$(find ergotic)/models/string.yaml";
  int params = 0;
  for (const std::smatch& param : allOf(launch, kParam)) {
    const std::string name = param[1];
    if (values.count(name) == 0 || arguments.count(param[2]) == 0) {
      continue;  // of another node, or made of other arguments
    }
    ++params;
    EXPECT_EQ(param[2], name);
    EXPECT_TRUE(areEqual(arguments.at(name), values.at(name)))
        << name << " is " << values.at(name) << ", launch/station.launch: " << arguments.at(name);
  }
  for (const auto& [name, value] : arguments) {
    EXPECT_EQ(known().count(name),
              launch.find("<param name=\"" + name + "\"") == std::string::npos ? 0U : 1U)
        << name << " of launch/station.launch reaches its parameter";
  }
  EXPECT_GT(params, 15);
}

}  // namespace
}  // namespace ergotic::node
