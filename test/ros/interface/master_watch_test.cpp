// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/master_watch.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(RepeatedFailureTest, ForgivesOneFailureAmongSuccesses) {
  RepeatedFailure failure;
  for (int n = 0; n < 3; ++n) {
    EXPECT_FALSE(failure.note(true));
    EXPECT_FALSE(failure.note(false));
  }
}

TEST(RepeatedFailureTest, LastsFromTheSecondFailureInARowToTheNextSuccess) {
  RepeatedFailure failure;
  EXPECT_FALSE(failure.note(true));
  for (int n = 0; n < 5; ++n) {
    EXPECT_TRUE(failure.note(true));
  }
  EXPECT_FALSE(failure.note(false));
  EXPECT_FALSE(failure.note(true));
}

XmlRpc::XmlRpcValue answer(int code, const XmlRpc::XmlRpcValue& address) {
  XmlRpc::XmlRpcValue told;
  told[0] = code;
  told[1] = "rosrpc URI: [...]";
  told[2] = address;
  return told;
}

TEST(TellsOfTest, IsTrueOfTheVeryAddressOnly) {
  const std::string here = "rosrpc://localhost:40000";
  EXPECT_TRUE(tellsOf(answer(1, here), here));
  EXPECT_FALSE(tellsOf(answer(1, "rosrpc://localhost:40001"), here)) << "another node";
  EXPECT_FALSE(tellsOf(answer(1, "rosrpc://elsewhere:40000"), here));
  EXPECT_FALSE(tellsOf(answer(1, ""), here));
  EXPECT_FALSE(tellsOf(answer(-1, here), here)) << "unknown to the master";
}

TEST(TellsOfTest, IsFalseOfWhatNoMasterAnswers) {
  EXPECT_FALSE(tellsOf(XmlRpc::XmlRpcValue(), ""));
  EXPECT_FALSE(tellsOf(answer(1, 5), ""));
  XmlRpc::XmlRpcValue brief;
  brief[0] = 1;
  EXPECT_FALSE(tellsOf(brief, ""));
  brief[1] = "";
  EXPECT_FALSE(tellsOf(brief, ""));
}

/// \param topics  who listens to what
XmlRpc::XmlRpcValue state(const std::vector<std::pair<std::string, std::string>>& topics) {
  XmlRpc::XmlRpcValue answer;
  answer[0] = 1;
  answer[1] = "current system state";
  answer[2].setSize(3);
  answer[2][0].setSize(0);
  answer[2][1].setSize(static_cast<int>(topics.size()));
  for (int i = 0; i < static_cast<int>(topics.size()); ++i) {
    answer[2][1][i][0] = topics[static_cast<std::size_t>(i)].first;
    answer[2][1][i][1][0] = "/other";
    answer[2][1][i][1][1] = topics[static_cast<std::size_t>(i)].second;
  }
  answer[2][2].setSize(0);
  return answer;
}

TEST(TellsOfListenerTest, IsTrueWhereThisNodeHearsThisTopic) {
  EXPECT_TRUE(tellsOfListener(state({{"/x", "/n"}, {"/stop", "/station"}}), "/stop", "/station"));
  EXPECT_FALSE(tellsOfListener(state({{"/x", "/station"}, {"/stop", "/n"}}), "/stop", "/station"));
  EXPECT_FALSE(tellsOfListener(state({}), "/stop", "/station"));
}

TEST(TellsOfListenerTest, IsFalseOfWhatNoMasterAnswers) {
  for (XmlRpc::XmlRpcValue odd : {XmlRpc::XmlRpcValue(), XmlRpc::XmlRpcValue(5), answer(1, "text"),
                                  answer(-1, XmlRpc::XmlRpcValue())}) {
    EXPECT_FALSE(tellsOfListener(odd, "/stop", "/station"));
  }
  XmlRpc::XmlRpcValue broken = state({{"/stop", "/station"}});
  broken[2][1][0][1] = 3;
  EXPECT_FALSE(tellsOfListener(broken, "/stop", "/station"));
  broken[2][1][0] = "/stop";
  EXPECT_FALSE(tellsOfListener(broken, "/stop", "/station"));
}

}  // namespace
}  // namespace ergotic::node
