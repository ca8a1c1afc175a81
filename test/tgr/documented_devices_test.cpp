// SPDX-License-Identifier: BSD-3-Clause
// All that docs/tgr.md shows of device files.
#include <yaml-cpp/yaml.h>

#include "ergotic/tgr/device.hpp"
#include "support/documents.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

TEST(DocumentedDevicesTest, CanBeReadAndOpened) {
  int files = 0;
  for (const std::string& block : test::yamlIn("docs/tgr.md")) {
    YAML::Node file = YAML::Load(block);
    if (!file["devices"]) {
      file["devices"] = YAML::Load("[{driver: virtual, settings: {slices: 12}}]");
    }
    EXPECT_NO_THROW(readDevices(YAML::Dump(file), "docs/tgr.md")) << block;
    ++files;
  }
  EXPECT_EQ(files, 4);
}

}  // namespace
}  // namespace ergotic::tgr
