// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/name.hpp"

#include "scene/names.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

TEST(NameTest, IsATextWithUpToTwoNumbers) {
  const Name stem("plate.");
  EXPECT_EQ(stem.str(), "plate.");
  EXPECT_EQ(stem.numbered(0).str(), "plate.0");
  EXPECT_EQ(stem.numbered(2147483647).str(), "plate.2147483647");
  EXPECT_EQ(stem.numbered(3, 12).str(), "plate.3.12");
  EXPECT_EQ("module '" + stem.numbered(3, 12) + "'", "module 'plate.3.12'");
  std::ostringstream out;
  out << stem.numbered(7);
  EXPECT_EQ(out.str(), "plate.7");
}

TEST(NameTest, EqualTextsAreEqualHoweverTheyAreMadeUp) {
  const std::vector<std::pair<Name, Name>> equal = {
      {Name("s.").numbered(7), Name("s.7")},
      {Name("s.1").numbered(2), Name("s.").numbered(12)},
      {Name("s.").numbered(1, 2), Name("s.1.").numbered(2)},
      {Name(), Name("")}};
  for (const auto& [a, b] : equal) {
    EXPECT_EQ(a, b);
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_TRUE(a.isText(b.str()));
  }
  EXPECT_NE(Name("s.").numbered(7), Name("s.").numbered(8));
  EXPECT_NE(Name("s.").numbered(7), Name("s.77"));
  EXPECT_NE(Name("s.").numbered(7), Name("t.").numbered(7));
  EXPECT_FALSE(Name("s.").numbered(7).isText("s."));
  EXPECT_FALSE(Name("s.").numbered(7).isText("s"));
  EXPECT_EQ(Name("s.").numbered(7).hash(), Name::hashOf("s.7"));
}

TEST(NameTest, OutlivesWhereItCameFrom) {
  Name kept;
  EXPECT_TRUE(kept.empty());
  {
    const Name stem("a name that does not fit into a short string.");
    Name moved = stem.numbered(1);
    kept = moved;
    moved = Name("other");
    moved.clear();
    EXPECT_TRUE(moved.empty());
  }
  EXPECT_EQ(kept, "a name that does not fit into a short string.1");
  const Name& self = kept;
  kept = self;
  EXPECT_EQ(kept, "a name that does not fit into a short string.1");
}

TEST(NameTableTest, FindsManyNamesByTheirText) {
  NameTable table;
  EXPECT_EQ(table.find("s.0"), -1);
  const Name stem("s.");
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(table.add(stem.numbered(i), i), -1);
  }
  EXPECT_EQ(table.add(Name("s.4321"), 5000), 4321);
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(table.find("s." + std::to_string(i)), i);
  }
  EXPECT_EQ(table.find("s."), -1);
  EXPECT_EQ(table.find("s.5000"), -1);
  EXPECT_EQ(table.names().size(), 5000U);
  EXPECT_EQ(table.names()[1], "s.1");
}

}  // namespace
}  // namespace ergotic::scene
