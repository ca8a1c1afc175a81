// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/parameter_watch.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using XmlRpc::XmlRpcValue;

TEST(ParameterWatchTest, NamesWhatDiffersInTwoMaps) {
  XmlRpcValue before;
  before["force_limit"] = 20.0;
  before["model"] = std::string("string.yaml");
  XmlRpcValue after = before;
  EXPECT_THAT(changedNames(before, after), IsEmpty());
  after["force_limit"] = 5;
  EXPECT_THAT(changedNames(before, after), ElementsAre("force_limit")) << "of another type";
  after["force_limit"] = 20.0;
  after["forse_limit"] = 5.0;
  EXPECT_THAT(changedNames(before, after), ElementsAre("forse_limit")) << "new";
  EXPECT_THAT(changedNames(after, before), ElementsAre("forse_limit")) << "gone";
}

TEST(ParameterWatchTest, WhatIsNoMapHasNoEntries) {
  XmlRpcValue map;
  map["model"] = std::string("string.yaml");
  EXPECT_THAT(changedNames(XmlRpcValue(), map), ElementsAre("model"));
  EXPECT_THAT(changedNames(map, XmlRpcValue(3)), ElementsAre("model"));
  EXPECT_THAT(changedNames(XmlRpcValue(), XmlRpcValue()), IsEmpty());
}

}  // namespace
}  // namespace ergotic::node
