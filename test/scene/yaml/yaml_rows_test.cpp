// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define ROWS_HEAD                                \
  "ergotic: 1\n"                                 \
  "parameters: {k: {value: 2, range: [1, 3]}}\n" \
  "sections: {s: {}, t: {geometry: plane}}\n"

void expectEqual(const Value& a, const Value& b) {
  EXPECT_EQ(a.factor, b.factor);
  EXPECT_EQ(a.parameter, b.parameter);
}

void expectSameScene(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.mats.size(), b.mats.size());
  for (std::size_t i = 0; i < a.mats.size(); ++i) {
    EXPECT_EQ(a.mats[i].name, b.mats[i].name);
    EXPECT_EQ(a.mats[i].type, b.mats[i].type);
    EXPECT_EQ(a.mats[i].section, b.mats[i].section);
    expectEqual(a.mats[i].mass, b.mats[i].mass);
    expectEqual(a.mats[i].damping, b.mats[i].damping);
    EXPECT_EQ(a.mats[i].rest, b.mats[i].rest);
    EXPECT_EQ(a.mats[i].position, b.mats[i].position);
    EXPECT_EQ(a.mats[i].push->velocity, b.mats[i].push->velocity);
  }
  ASSERT_EQ(a.lias.size(), b.lias.size());
  for (std::size_t i = 0; i < a.lias.size(); ++i) {
    EXPECT_EQ(a.lias[i].name, b.lias[i].name);
    EXPECT_EQ(a.lias[i].type, b.lias[i].type);
    EXPECT_EQ(a.lias[i].a, b.lias[i].a);
    EXPECT_EQ(a.lias[i].b, b.lias[i].b);
    EXPECT_EQ(a.lias[i].scheme, b.lias[i].scheme);
    EXPECT_EQ(a.lias[i].rest_length, b.lias[i].rest_length);
    expectEqual(a.lias[i].stiffness, b.lias[i].stiffness);
    expectEqual(a.lias[i].damping, b.lias[i].damping);
    expectEqual(a.lias[i].law->width, b.lias[i].law->width);
  }
  ASSERT_EQ(a.outputs.size(), b.outputs.size());
  for (std::size_t i = 0; i < a.outputs.size(); ++i) {
    EXPECT_EQ(a.outputs[i].name, b.outputs[i].name);
    EXPECT_EQ(a.outputs[i].point.mat, b.outputs[i].point.mat);
    EXPECT_EQ(a.outputs[i].channel, b.outputs[i].channel);
  }
}

TEST(YamlRowsTest, ATableMeansWhatItsRowsWouldWrittenOut) {
  const Scene table = readYaml(ROWS_HEAD
                               "mats:\n"
                               "  ends: {columns: [name], with: {type: ground, section: s},\n"
                               "    rows: [[g], [h]]}\n"
                               "  masses:\n"
                               "    with: {type: mass, section: s}\n"
                               "    columns: [name, mass, at, x, v]\n"
                               "    rows:\n"
                               "      - [a, 0.1, [1, 2], 0.5, 3]\n"
                               "      - [b, 2*$k, ~, ~, ~]\n"
                               "  c: {type: cell, section: s, mass: 1, damping: $k}\n"
                               "  mixed: {columns: [type, name, section, mass],\n"
                               "    rows: [[mass, d, t, 1], [ground, e, t, ~]]}\n"
                               "lias:\n"
                               "  all:\n"
                               "    columns: [name, type, between, stiffness, threshold]\n"
                               "    rows:\n"
                               "      - [l, spring, [g, a], $k, ~]\n"
                               "      - [m, contact, [a, b], 5, -0.1]\n"
                               "outputs: {both: {columns: [name, at, channel],\n"
                               "  with: {quantity: position}, rows: [[x, a, 1], [y, b, 2]]}}\n",
                               "table.yaml");
  const Scene written =
      readYaml(ROWS_HEAD
               "mats:\n"
               "  g: {type: ground, section: s}\n"
               "  h: {type: ground, section: s}\n"
               "  a: {type: mass, section: s, mass: 0.1, at: [1, 2], x: 0.5, v: 3}\n"
               "  b: {type: mass, section: s, mass: 2*$k}\n"
               "  c: {type: cell, section: s, mass: 1, damping: $k}\n"
               "  d: {type: mass, section: t, mass: 1}\n"
               "  e: {type: ground, section: t}\n"
               "lias:\n"
               "  l: {type: spring, between: [g, a], stiffness: $k}\n"
               "  m: {type: contact, between: [a, b], stiffness: 5, threshold: -0.1}\n"
               "outputs: {x: {at: a, quantity: position, channel: 1},\n"
               "  y: {at: b, quantity: position, channel: 2}}\n",
               "written.yaml");
  expectSameScene(table, written);
}

TEST(YamlRowsTest, EveryElementHasThePlaceOfItsName) {
  const Scene s = readYaml(ROWS_HEAD
                           "mats:\n"
                           "  t: {columns: [mass, name], with: {type: mass, section: s}, rows: [\n"
                           "    [1, a],\n"
                           "    [1, b]]}\n",
                           "a.yaml");
  EXPECT_EQ(s.mats[0].place.line, 6);
  EXPECT_EQ(s.mats[1].place.line, 7);
  EXPECT_EQ(s.mats[1].place.column, 9);
}

TEST(YamlRowsTest, ATableMayHaveNoRows) {
  EXPECT_TRUE(
      readYaml(ROWS_HEAD "mats: {t: {columns: [name], rows: []}}\n", "a.yaml").mats.empty());
}

}  // namespace
}  // namespace ergotic::scene
