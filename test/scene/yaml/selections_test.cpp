// SPDX-License-Identifier: BSD-3-Clause
// Many modules by a few words, in links, taps and outputs.
#include <cmath>
#include <set>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const std::string kSelectionsHead =
    "ergotic: 1\n"
    "sections: {a: {}, h: {rate: gestural}, p: {geometry: plane}}\n"
    "generators:\n"
    "  - {type: mesh, name: net, section: a, rows: 5, columns: 7, spacing: 0.1, mass: 1, "
    "stiffness: 1}\n"
    "  - {type: mesh, name: flat, section: p, rows: 3, columns: 3, spacing: 0.1, edges: free, "
    "mass: 1,\n"
    "     stiffness: 1, rest_length_ratio: 1}\n"
    "  - {type: string, name: s, section: a, masses: 9, mass: 1, stiffness: 1, to: [1, 0]}\n"
    "  - {type: membrane, name: skin, section: a, shape: round, cells: 5, mass: 0.1, pitch: 100}\n"
    "mats: {m: {type: mass, section: a, mass: 1}, b_1: {type: mass, section: a, mass: 1},\n"
    "  b_10: {type: mass, section: a, mass: 1}, b_2: {type: mass, section: a, mass: 1},\n"
    "  q: {type: mass, section: p, mass: 1, at: [0.21, 0.08]}}\n";

Scene linked(const std::string& a, const std::string& b) {
  return readYaml(kSelectionsHead + "lias: {l: {type: spring, between: [" + a + ", " + b +
                      "], stiffness: 1}}\n",
                  "s.yaml");
}

std::string nameAt(const Scene& scene, int mat) {
  return scene.mats[static_cast<std::size_t>(mat)].name;
}

/// What a selection means, in its order, by the links that it makes.
std::vector<std::string> meant(const std::string& text) {
  const bool is_plane = text.find("flat") != std::string::npos;
  const Scene scene = linked(text, is_plane ? "q" : "m");
  std::vector<std::string> names;
  for (const Lia& lia : scene.lias) {
    const std::string name = lia.name;
    if (name == "l" || name.compare(0, 2, "l.") == 0) {
      names.push_back(nameAt(scene, lia.a));
    }
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(SelectionsTest, MeanWhatMovesOnAGrid) {
  EXPECT_EQ(meant("net/row(1)"), (Names{"net.1.1", "net.1.2", "net.1.3", "net.1.4", "net.1.5"}));
  EXPECT_EQ(meant("net/column(3)"), (Names{"net.1.3", "net.2.3", "net.3.3"}));
  EXPECT_EQ(meant("net/corners"), (Names{"net.1.1", "net.1.5", "net.3.1", "net.3.5"}));
  EXPECT_EQ(meant("net/middle"), (Names{"net.2.3"}));
  EXPECT_EQ(meant("'net/box(0, 0, 0.34, 0.5)'"),
            (Names{"net.1.1", "net.1.2", "net.2.1", "net.2.2"}));
  EXPECT_EQ(meant("'net/disc(0.5, 0.5, 0.17)'"),
            (Names{"net.1.3", "net.2.2", "net.2.3", "net.2.4", "net.3.3"}));
  EXPECT_EQ(meant("net/all").size(), 15U);
  EXPECT_EQ(meant("flat/all").size(), 9U);
  EXPECT_EQ(meant("'s/range(0.8, 1)'"), (Names{"s.8", "s.9"}));
  EXPECT_EQ(meant("s/rim"), (Names{"s.1", "s.9"}));
}

TEST(SelectionsTest, ARimGoesRoundAndARingIsEven) {
  const Names rim = meant("net/rim");
  EXPECT_EQ(rim.size(), 12U);
  EXPECT_EQ(rim.front(), "net.2.5") << "from along on";
  EXPECT_EQ(meant("net/ring(4)"), (Names{"net.2.5", "net.3.3", "net.2.1", "net.1.3"}));
  EXPECT_EQ(meant("'net/ring(2, 0.5)'"), (Names{"net.2.4", "net.2.2"}));
  // Of a round skin they are those beside its grounds.
  const Names skin = meant("skin/rim");
  EXPECT_GT(skin.size(), 20U);
  EXPECT_EQ(std::set<std::string>(skin.begin(), skin.end()).size(), skin.size());
}

TEST(SelectionsTest, TheNearestIsByMetresOrByAModule) {
  EXPECT_EQ(meant("'net/near(0.31, 12 cm)'"), (Names{"net.1.3"}));
  EXPECT_EQ(meant("'flat/near(0.09, 0.2)'"), (Names{"flat.2.1"}));
  EXPECT_EQ(meant("flat/near(q)"), (Names{"flat.1.2"}));
  EXPECT_EQ(meant("s/near(0.42)"), (Names{"s.4"}));
}

TEST(SelectionsTest, NamesWithAStarMeanAllByTheirNumbers) {
  EXPECT_EQ(meant("'b_*'"), (Names{"b_1", "b_2", "b_10"}));
  EXPECT_EQ(meant("[b_10, 'b_*', net.1.1]"), (Names{"b_10", "b_1", "b_2", "net.1.1"}));
  EXPECT_EQ(meant("'net.2.*'").size(), 7U) << "grounds by their names, too";
  EXPECT_EQ(meant("'n*/middle'"), (Names{"net.2.3"}));
}

TEST(SelectionsTest, SetsOfOneSizeAreLinkedInPairs) {
  const Scene scene = linked("net/ring(4)", "net/corners");
  Names pairs;
  for (const Lia& lia : scene.lias) {
    const std::string name = lia.name;
    if (name.compare(0, 2, "l.") == 0) {
      pairs.push_back(name + " " + nameAt(scene, lia.a) + " " + nameAt(scene, lia.b));
    }
  }
  EXPECT_EQ(pairs, (Names{"l.0 net.2.5 net.1.1", "l.1 net.3.3 net.1.5", "l.2 net.2.1 net.3.1",
                          "l.3 net.1.3 net.3.5"}));
  ASSERT_EQ(scene.selections.size(), 2U);
  EXPECT_EQ(scene.selections[0].text, "net/ring(4)");
  EXPECT_EQ(scene.selections[0].count, 4U);
}

TEST(SelectionsTest, TheMeanIsOneTap) {
  const Scene scene =
      readYaml(kSelectionsHead +
                   "lias: {l: {type: spring, between: ['mean(net/row( 1 ))', m], stiffness: 1},\n"
                   "  k: {type: spring, between: ['mean(net/row(1))', m], stiffness: 1}}\n",
               "s.yaml");
  ASSERT_EQ(scene.taps.size(), 1U);
  ASSERT_EQ(scene.taps[0].shares.size(), 5U);
  for (const Tap::Share& share : scene.taps[0].shares) {
    EXPECT_EQ(share.weight, 0.2);
  }
}

TEST(SelectionsTest, TapsAndOutputsTakeThem) {
  const Scene scene =
      readYaml(kSelectionsHead +
                   "outputs:\n"
                   "  all: {at: net/ring(4), quantity: velocity, channels: 1..2, gain: -6 dB}\n"
                   "  one: {at: 'net/near(0.1, 0.1)', quantity: velocity, channel: 3}\n"
                   "  far: {at: 'b_*', quantity: position, speakers: stereo, pan: 'spread(-30 deg, "
                   "30 deg)'}\n"
                   "  both: {at: m, quantity: position, channels: [5, 6]}\n",
               "s.yaml");
  std::vector<std::pair<std::string, int>> heard;
  for (const Output& output : scene.outputs) {
    heard.emplace_back(output.name + " " + nameAt(scene, output.point.mat), output.channel + 1);
  }
  const std::vector<std::pair<std::string, int>> expected = {
      {"all.0 net.2.5", 1}, {"all.1 net.3.3", 2}, {"all.2 net.2.1", 1}, {"all.3 net.1.3", 2},
      {"one net.1.1", 3},   {"far.0 b_1", 2},     {"far.1 b_2", 1},     {"far.2 b_2", 2},
      {"far.3 b_10", 1},    {"both.0 m", 5},      {"both.1 m", 6}};
  EXPECT_EQ(heard, expected);
  EXPECT_NEAR(scene.outputs[6].gain.factor, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(scene.outputs[5].gain.factor, 1.0);
}

TEST(SelectionsTest, ASingleModuleIsNotSpread) {
  const std::string output =
      "outputs: {o: {at: m, quantity: position, speakers: stereo, pan: 'spread(-30 deg, 30 "
      "deg)'}}\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(kSelectionsHead + output, "s.yaml"); }),
              HasSubstr("allowed of a single module: a direction"));
}

TEST(SelectionsTest, MeanTheSameInThePlainText) {
  const std::string brief =
      kSelectionsHead +
      "let: {n: 4}\n"
      "lias: {l: {type: spring, between: ['net/ring({n})', m], stiffness: 1}}\n"
      "outputs: {o: {at: 'net/ring({n})', quantity: force, channels: '1..{n}'}}\n";
  const Scene scene = readYaml(brief, "s.yaml");
  const Scene again = readYaml(scene.text, "s.yaml");
  EXPECT_EQ(again.text, scene.text);
  ASSERT_EQ(again.lias.size(), scene.lias.size());
  ASSERT_EQ(again.outputs.size(), 4U);
  EXPECT_EQ(again.outputs[3].point.mat, scene.outputs[3].point.mat);
}

TEST(SelectionsTest, PublicNamesOfInstancesAreMeantByAStar) {
  const Scene scene = readYaml(
      "ergotic: 1\n"
      "sections: {a: {}}\n"
      "define:\n"
      "  note:\n"
      "    needs: {s: audio}\n"
      "    mats: {body: {type: mass, section: s, mass: 1}, spare: {type: mass, section: s, mass: "
      "1}}\n"
      "    gives: {bridge: body}\n"
      "mats: {board: {type: mass, section: a, mass: 1}, n_x.bridge: {type: mass, section: a, mass: "
      "1}}\n"
      "use: [{for: {i: 0..10}, is: note, as: 'n_{i}', in: {s: a}}]\n"
      "lias: {feet: {type: spring, between: ['n_*.bridge', board], stiffness: 1}}\n",
      "s.yaml");
  ASSERT_EQ(scene.lias.size(), 12U);
  EXPECT_EQ(nameAt(scene, scene.lias[2].a), "n_2.body");
  EXPECT_EQ(nameAt(scene, scene.lias[10].a), "n_10.body");
  EXPECT_EQ(nameAt(scene, scene.lias[11].a), "n_x.bridge");
}

TEST(SelectionsTest, SpeakersOfAFileAreThoseThatItLists) {
  const test::ScratchFile room(
      "Azimuth,elevation,channel\r\n0, 0, 3\n90, 0, 5\n180, 0, 6\n-90, 0, 7\n");
  const std::string file = "speakers: {file: " + room.path().substr(5) + "}";
  const std::string mass =
      "ergotic: 1\nsections: {a: {rate: audio}}\nmats: {m: {type: mass, mass: 1}}\n";
  for (const std::string& text :
       {mass + file + "\noutputs: {o: {at: m, quantity: velocity, pan: 90 deg}}\n",
        mass + "outputs: {o: {at: m, quantity: velocity, pan: 90 deg, " + file + "}}\n"}) {
    const Scene scene = readYaml(text, "/tmp/s.yaml");
    ASSERT_EQ(scene.outputs.size(), 1U) << text;
    EXPECT_EQ(scene.outputs[0].channel, 4);
    const Scene again = readYaml(scene.text, "/nowhere/s.yaml");
    EXPECT_EQ(again.outputs.size(), 1U) << "a recording needs no file";
  }
}

TEST(SelectionsTest, AStretchIsOfAllSpringsAndBodiesThatAPatternMeans) {
  const auto springsOf = [](const std::string& of) {
    const Scene scene = readYaml(kSelectionsHead +
                                     "lias:\n"
                                     "  t: {type: stretch, of: " +
                                     of +
                                     ", spacing: 1, hardening: 1}\n"
                                     "  c_1: {type: spring, between: [m, b_1], stiffness: 1}\n"
                                     "  c_2: {type: spring, between: [m, b_2], stiffness: 1}\n"
                                     "  c_3: {type: damper, between: [m, b_2], damping: 1}\n"
                                     "  pull: {type: spring, between: [m, b_10], stiffness: 1}\n",
                                 "s.yaml");
    std::vector<std::string> names;
    for (const int spring : scene.tanks.at(0).springs) {
      names.push_back(scene.lias[static_cast<std::size_t>(spring)].name);
    }
    return names;
  };
  EXPECT_THAT(springsOf("['c_*', pull]"), ElementsAre("c_1", "c_2", "pull")) << "no damper";
  EXPECT_EQ(springsOf("['s*']").size(), springsOf("s").size() + springsOf("skin").size());
}

}  // namespace
}  // namespace ergotic::scene
