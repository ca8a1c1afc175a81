// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/build_id.hpp"

#include <dlfcn.h>

#include <cstdio>

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

TEST(BuildIdTest, IsWhatTheLinkerWroteIntoTheLibrary) {
  Dl_info library = {};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&buildId), &library), 0);
  const std::string command = std::string("readelf -n '") + library.dli_fname + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  ASSERT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 256> line{};
  while (fgets(line.data(), line.size(), pipe.get()) != nullptr) {
    text += line.data();
  }
  ASSERT_FALSE(buildId().empty());
  EXPECT_THAT(text, HasSubstr("Build ID: " + buildId() + "\n"));
}

}  // namespace
}  // namespace ergotic::rt
