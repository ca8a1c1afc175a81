// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic {

namespace test {

/// What lies at `path` in the repository.
std::string repository(const std::string& path);
/// A built command-line tool.
std::string toolPath(const std::string& name);
/// What is in a file, "" if there is none.
std::string textOf(const std::string& path);

/// Lets pluginlib find what was just built, whatever the shell has sourced: this package, and the
/// device of somebody else.
void findBuiltPackages();

}  // namespace test

using test::repository;
using test::textOf;

}  // namespace ergotic
