// SPDX-License-Identifier: BSD-3-Clause
// What a scene says briefly, written out.
#include <filesystem>
#include <fstream>

#include <sys/resource.h>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define HEAD "ergotic: 1\nsections: {a: {}, h: {rate: gestural}}\n"

std::string complaint(const std::string& text) {
  return complaintOf<TextError>([&] { readYaml(text, "s.yaml"); });
}

TEST(LanguageTest, ConstantsStandForNumbersWordsAndLists) {
  const Scene scene =
      readYaml(HEAD
               "let: {L: 650 mm, n: =round(L/10 cm), kind: spring, to: [=L, 0]}\n"
               "mats: {m: {type: mass, section: a, mass: =n/1000}, g: {type: ground, section: a}}\n"
               "lias: {l: {type: =kind, between: [m, g], stiffness: =2*n*1 kN/m}}\n",
               "s.yaml");
  EXPECT_EQ(scene.mats[0].mass.factor, 0.007);
  EXPECT_EQ(scene.lias[0].stiffness.factor, 14000.0);
}

TEST(LanguageTest, LoopsRepeatElementsAndConditionsLeaveThemOut) {
  const Scene scene =
      readYaml(HEAD
               "let: {names: [low, high]}\n"
               "mats:\n"
               "  g: {type: ground, section: a}\n"
               "  'm{i}_{name}': {for: {i: 0..2, name: =names}, when: =i + name# > 0, type: mass,\n"
               "                  section: a, mass: =i + 1}\n",
               "s.yaml");
  ASSERT_EQ(scene.mats.size(), 6U);
  EXPECT_EQ(scene.mats[1].name, "m0_high");
  EXPECT_EQ(scene.mats[5].name, "m2_high");
  EXPECT_EQ(scene.mats[5].mass.factor, 3.0);
}

TEST(LanguageTest, DefaultsAreByTypeAndClass) {
  const Scene scene = readYaml(
      HEAD
      "defaults: {spring_damper: {damping: 0.1}, spring_damper.hard: {stiffness: 5 kN/m}}\n"
      "mats: {m: {type: mass, section: a, mass: 1}, g: {type: ground, section: a}}\n"
      "lias:\n"
      "  a: {type: spring_damper, between: [m, g], stiffness: 1}\n"
      "  b: {type: spring_damper, between: [m, g], stiffness: 1, damping: 2}\n"
      "  c: {type: spring_damper, class: hard, between: [m, g]}\n",
      "s.yaml");
  EXPECT_EQ(scene.lias[0].damping.factor, 0.1);
  EXPECT_EQ(scene.lias[1].damping.factor, 2.0);
  EXPECT_EQ(scene.lias[2].stiffness.factor, 5000.0);
  EXPECT_EQ(scene.lias[2].damping.factor, 0.1);
}

const char* const kPairs = R"(ergotic: 1
parameters: {k: {value: 10, range: [1, 100], unit: N/m}}
sections: {a: {}, h: {rate: gestural}}
define:
  key:
    doc: A slice that touches a place.
    params: {on: {kind: place}, slice: {range: [0, 63]}}
    needs: {keys: gestural}
    mats: {key: {type: slice, section: keys}}
    lias: {touch: {type: contact, between: [=on, key], stiffness: 100}}
    ports: {port: {mat: key, slice: =slice}}
    gives: {hand: key}
  pair:
    params: {mass: {unit: kg, default: 1 g, range: [1 mg, 1 kg]}, k: {}, slice: {default: 0}}
    needs: {s: audio, keys: gestural}
    let: {heavy: =2*mass}
    mats: {one: {type: mass, section: s, mass: =mass}, two: {type: mass, section: s, mass: =heavy}}
    lias: {tie: {type: spring, between: [one, two], stiffness: =k}}
    use: [{is: key, as: key, in: {keys: keys}, with: {on: two, slice: =slice}}]
    gives: {end: two, hand: key.hand}
mats: {g: {type: ground, section: a}}
use:
  - {for: {i: 0..1}, is: pair, as: 'p{i}', in: {s: a, keys: h}, with: {k: $k, slice: =i}}
lias: {link: {type: spring, between: [p0.end, p1.end], stiffness: 7}, held: {type: spring, between: [p0.hand, g], stiffness: 3}}
)";

TEST(LanguageTest, DefinitionsAreWrittenOutWithNamesOfTheirOwn) {
  const Scene scene = readYaml(kPairs, "pairs.yaml");
  ASSERT_EQ(scene.mats.size(), 7U);
  EXPECT_EQ(scene.mats[2].name, "p0.two");
  EXPECT_EQ(scene.mats[2].mass.factor, 0.002);
  EXPECT_EQ(scene.mats[6].name, "p1.key.key");
  EXPECT_EQ(scene.mats[6].section, 1);
  EXPECT_EQ(scene.lias[0].name, "link");
  EXPECT_EQ(scene.mats[static_cast<std::size_t>(scene.lias[0].b)].name, "p1.two");
  EXPECT_EQ(scene.mats[static_cast<std::size_t>(scene.lias[1].a)].name, "p0.key.key");
  EXPECT_EQ(scene.lias[2].name, "p0.tie");
  EXPECT_EQ(scene.lias[2].stiffness.parameter, 0);
  EXPECT_EQ(scene.ports[1].slice, 1);
}

TEST(LanguageTest, WhatIsKeptIsThePlainText) {
  const Scene scene = readYaml(kPairs, "pairs.yaml");
  EXPECT_EQ(scene.text.find("define"), std::string::npos);
  const Scene again = readYaml(scene.text, "pairs.yaml");
  EXPECT_EQ(again.text, scene.text);
  ASSERT_EQ(again.mats.size(), scene.mats.size());
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    EXPECT_EQ(again.mats[m].name, scene.mats[m].name);
    EXPECT_EQ(again.mats[m].mass.factor, scene.mats[m].mass.factor);
  }
  ASSERT_EQ(again.lias.size(), scene.lias.size());
}

TEST(LanguageTest, ScenesWithoutItStayAsTheyAre) {
  const std::string text =
      HEAD "# a remark\nname: a {b} =c\nmats: {m: {type: mass, section: a, mass: 1}}\n";
  EXPECT_EQ(readYaml(text, "s.yaml").text, text);
}

TEST(LanguageTest, ErrorsTellPlaceAndInstances) {
  std::string text = kPairs;
  text.replace(text.find("stiffness: 100"), 14, "stiffness: -10");
  EXPECT_EQ(complaint(text),
            "s.yaml:10:67: error: 'stiffness' of link 'p0.key.touch' = -10 N/m is out of range, "
            "allowed: >= 0 N/m\n  in p0.key (key), used at s.yaml:19:11\n"
            "  in p0 (pair), used at s.yaml:23:5");
  text = kPairs;
  text.replace(text.find("slice: =i"), 9, "mass: 2 t");
  EXPECT_THAT(complaint(text), StartsWith("s.yaml:23:85: error: 'mass' = '2 t' has the unit 't'"));
}

struct Bad {
  const char* text;
  const char* says;
};

TEST(LanguageTest, WhatIsWrongIsToldWithItsPlace) {
  const Bad cases[] = {
      {HEAD "let: {x: =1/0}\n", "s.yaml:3:12: error: in '=1/0': division by zero"},
      {HEAD "let: {x: =y}\n", "s.yaml:3:11: error: in '=y': unknown name 'y'"},
      {HEAD "let: [1]\n", "s.yaml:3:6: error: 'let' is a list of 1, allowed: a map"},
      {HEAD "define: {d: 1}\n", "definition 'd' is a single value, allowed: a map"},
      {HEAD "use: [{is: d, as: x}]\n", "s.yaml:3:12: error: no definition above has the name 'd'"},
      {HEAD "define: {d: {use: [{is: d, as: x}]}}\nuse: [{is: d, as: y}]\n",
       "no definition above has the name 'd'"},
      {HEAD "define: {d: {mat: {}}}\nuse: [{is: d, as: y}]\n",
       "unknown key 'mat' of definition 'd'"},
      {HEAD "define: {d: {params: {x: {}}}}\nuse: [{is: d, as: y}]\n", "'x' of 'd' is missing"},
      {HEAD "define: {d: {params: {x: {}}}}\nuse: [{is: d, as: y, with: {x: 1, z: 2}}]\n",
       "'d' has no parameter 'z'"},
      {HEAD "define: {d: {needs: {s: audio}}}\nuse: [{is: d, as: y}]\n",
       "section 's' of 'd' is missing"},
      {HEAD "define: {d: {}}\nuse: {is: d, as: y}\n", "'use' is a map, allowed: a list"},
      {HEAD "define: {d: {}}\nuse: [{is: d}]\n", "missing key 'as' of an instance"},
      {HEAD "define: {d: {}}\nuse: [{is: d, as: '1'}]\n", "name '1' is not legal"},
      {HEAD "mats: {'m{i': {for: {i: 0..1}, type: ground, section: a}}\n", "has a '{' without '}'"},
      {HEAD "mats: {m: {for: {i: 0..1}, type: ground, section: a}}\n",
       "key 'm' of 'mats' comes twice"},
      {HEAD "mats: {'m{i}': {for: {i: 0..x}, type: ground, section: a}}\n", "unknown name 'x'"},
      {HEAD "mats: {'m{i}': {for: {i: 0..0.5}, type: ground, section: a}}\n", "no whole number"},
      {HEAD "mats: {'m{i}': {for: {i: 3}, type: ground, section: a}}\n",
       "a loop goes over a range"},
      {HEAD "mats: {'m{i}': {for: [1], type: ground, section: a}}\n", "'for' is no map"},
      {HEAD "mats: {m: {when: x, type: ground, section: a}}\n", "'when' is no number"},
      {HEAD "mats: {m: {class: soft, type: ground, section: a}}\n",
       "there are no defaults of 'ground.soft'"},
      {HEAD "include: [../x.yaml]\n",
       "file '../x.yaml' is elsewhere, allowed: below the scene's folder"},
      {HEAD "include: [/etc/passwd]\n", "is elsewhere"},
      {HEAD "include: x.yaml\n", "'include' is a single value, allowed: a list of files"},
      {HEAD "include: [nothing_there.yaml]\n", "nothing_there.yaml"},
      {HEAD "mats: {'m{i}': {for: {i: 1e17..1e17}, type: ground, section: a}}\n",
       "no whole number from -1e15 to 1e15"},
      {HEAD "define: {d: {gives: {a: b}, mats: {a: {type: ground}, b: {type: ground}}}}\n"
            "use: [{is: d, as: y}]\n",
       "'a' of 'gives' is a part of 'd' itself"},
      {HEAD "define: {d: {gives: {a: c}, mats: {b: {type: ground}}}}\nuse: [{is: d, as: y}]\n",
       "'d' has no 'c' to give"},
      {HEAD "define: {d: {needs: {s: audio}}}\nuse: [{is: d, as: y, in: {s: a, t: a}}]\n",
       "'d' needs no section 't'"},
      {HEAD "define: {d: {needs: {s: fast}}}\nuse: [{is: d, as: y, in: {s: a}}]\n",
       "allowed: audio, gestural"},
      {HEAD "define: {d: {}}\nuse: [{is: d, as: y}, {is: d, as: y}]\n",
       "s.yaml:4:35: error: instance 'y' is there already"},
      {HEAD "define: {d: {}}\nuse: [{is: d, as: y.}]\n", "ends with a dot"},
      {HEAD "define: {d: {typo: {}}}\n", "unknown key 'typo' of definition 'd'"},
      {HEAD "define: {d: {params: {x: {unit: bananas}}}}\nuse: [{is: d, as: y, with: {x: 1}}]\n",
       "is 'bananas', allowed: an SI unit"},
      {HEAD "define: {d: {params: {x: {kind: place}}}}\nuse: [{is: d, as: y, with: {x: [1]}}]\n",
       "'x' is a list of 1, allowed: the name of a place"},
      {HEAD "name: \"a\\x01b\"\n", "s.yaml:3:7: error: a word with a control character"},
      {HEAD "name: \"a\\Nb\"\n", "s.yaml:3:7: error: a word with a control character"},
  };
  for (const Bad& bad : cases) {
    EXPECT_THAT(complaint(bad.text), HasSubstr(bad.says)) << bad.text;
  }
}

TEST(LanguageTest, DefaultsOfParametersKnowTheConstantsOfTheirFileAndNoOthers) {
  const Scene scene = readYaml(HEAD
                               "let: {n: 1}\ndefine:\n"
                               "  c: {params: {y: {default: =2*n}, x: {default: =y}},\n"
                               "      mats: {m: {type: mass, section: a, mass: =x}}}\n"
                               "  d: {let: {n: 5}, use: [{is: c, as: k}]}\n"
                               "use: [{is: d, as: i}, {is: c, as: j}]\n",
                               "s.yaml");
  ASSERT_EQ(scene.mats.size(), 2U);
  EXPECT_EQ(scene.mats[0].mass.factor, 2.0);
  EXPECT_EQ(scene.mats[1].mass.factor, 2.0);
}

TEST(LanguageTest, DefaultsAreBlamedWhereTheyStand) {
  const std::string folder = "/tmp/ergotic_defaults_" + std::to_string(::getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/d.yaml")
      << "define: {d: {needs: {s: audio}, mats: {m: {type: mass, section: s}}}}\n";
  const std::string text = HEAD
      "include: [d.yaml]\n"
      "defaults: {mass: {mass: -1}}\n"
      "use: [{is: d, as: i, in: {s: a}}]\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, folder + "/s.yaml"); }),
              StartsWith(folder + "/s.yaml:4:25: error: 'mass' of module 'i.m' = -1 kg"));
  std::filesystem::remove_all(folder);
}

TEST(LanguageTest, FilesBringDefinitionsOnce) {
  const std::string folder = "/tmp/ergotic_language_" + std::to_string(::getpid());
  std::filesystem::create_directories(folder + "/lib");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder + "/" + name) << text;
  };
  write("lib/a.yaml", "about: {title: a}\ninclude: [lib/b.yaml]\nlet: {x: =2*y}\n");
  write("lib/b.yaml",
        "include: [lib/a.yaml]\nlet: {y: 4}\ndefine:\n"
        "  d: {needs: {s: audio}, mats: {m: {type: mass, section: s, mass: =y - 5}}}\n");
  const std::string text = HEAD
      "include: [lib/a.yaml]\n"
      "mats: {m: {type: mass, section: a, mass: =x}}\n";
  EXPECT_EQ(readYaml(text, folder + "/s.yaml").mats[0].mass.factor, 8.0);
  EXPECT_EQ(complaintOf<TextError>([&] {
              readYaml(text + "use: [{is: d, as: i, in: {s: a}}]\n", folder + "/s.yaml");
            }),
            folder +
                "/lib/b.yaml:4:67: error: 'mass' of module 'i.m' = -1 kg is out of range, "
                "allowed: > 0 kg\n  in i (d), used at " +
                folder + "/s.yaml:5:7");
  std::filesystem::remove_all(folder);
}

TEST(LanguageTest, ShippedDefinitionsAreThereForScenesAnywhere) {
  const std::string folder = "/tmp/ergotic_shipped_" + std::to_string(::getpid());
  std::filesystem::create_directories(folder + "/lib");
  const std::string text = HEAD
      "include: [lib/keys.yaml]\n"
      "use: [{is: touch_key, as: k, in: {keys: h}, with: {on: m}}]\n"
      "mats: {m: {type: mass, section: a, mass: 1}}\n";
  const Scene scene = readYaml(text, folder + "/s.yaml");
  EXPECT_EQ(scene.mats.size(), 2U);
  // Recordings keep what was played: they need no library.
  EXPECT_EQ(readYaml(scene.text, "s.yaml", {}, {"", false}).mats.size(), 2U);
  // A text that was sent has no folder, and may include them, too.
  EXPECT_EQ(readYaml(text, "s.yaml", {}, {"", false}).mats.size(), 2U);

  // A file of one's own comes first, though a shipped one has its name.
  std::ofstream(folder + "/lib/keys.yaml") << "let: {x: 1}\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, folder + "/s.yaml"); }),
              HasSubstr("no definition above has the name 'touch_key'"));
  std::filesystem::remove_all(folder);
}

TEST(LanguageTest, NothingElseIsIncludedFromTheFolderOfShippedModels) {
  const auto refusal = [](const std::string& name) {
    return complaintOf<TextError>([&] {
      readYaml(HEAD "include: ['" + name + "']\n", "s.yaml", {}, {"", false});
    });
  };
  EXPECT_THAT(refusal("../README.md"), HasSubstr("has no folder"));
  EXPECT_THAT(refusal("lib/../../README.md"), HasSubstr("has no folder"));
  EXPECT_THAT(refusal("lib"), HasSubstr("has no folder"));
  EXPECT_THAT(refusal("guitar.yaml"), HasSubstr("known: about, include, let, defaults, define"));
}

}  // namespace
}  // namespace ergotic::scene
