// SPDX-License-Identifier: BSD-3-Clause
// What every test is written with.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "at.hpp"
#include "ergotic/exception.hpp"

namespace ergotic {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

namespace test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What `act` complains of in an `Error`; "" if it does not.
template <class Error = Exception, class Act>
std::string complaintOf(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace test

using test::complaintOf;

}  // namespace ergotic
