// SPDX-License-Identifier: BSD-3-Clause
// Variants of a scene, what it says of itself, where instances stand, of what kind constants are.
#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

const char* const kScene = R"(ergotic: 1
about:
  title: Two strings
  author: Somebody
  licence: MIT OR CC-BY-4.0
  description: "What {it} is = this"
  hands: {0..1: plectra, 2: a finger}
  play: two.csv
  sources: [a book]
  picture: {from: [1, 2, 3], at: [0, 0, 1]}
parameters: {tension: {value: 1, range: [0.5, 2]}}
sections: {a: {}, p: {geometry: plane}}
let: {weight: 1 g, stiff: 1 kN/m}
define:
  pair:
    params: {ring: {default: 1}}
    needs: {s: audio}
    mats: {one: {type: mass, section: s, mass: =weight}, two: {type: mass, section: s, mass: =2*weight}}
    lias: {tie: {type: spring, between: [one, two], stiffness: =stiff*ring}}
use:
  - {for: {i: 0..1}, is: pair, as: 'p_{i}', in: {s: a}}
mats: {m: {type: mass, section: a, mass: 5}}
variants:
  heavy: {let: {weight: 3 g}, set: {'p_*.ring': 2, m.mass: =weight, tension: 1.5, p_1.two.mass: 7}}
  light: {doc: a feather, set: {m.mass: 1 g, m.x: 2 mm}}
)";

Scene variant(const std::string& name) {
  return readYaml(kScene, "s.yaml", {}, {name});
}

const Mat& mat(const Scene& scene, const std::string& name) {
  for (const Mat& each : scene.mats) {
    if (each.name == name) {
      return each;
    }
  }
  throw Exception("no module " + name);
}

TEST(VariantsTest, ChangeConstantsParametersAndKeys) {
  const Scene plain = variant("");
  EXPECT_EQ(plain.variants, (std::vector<std::string>{"heavy", "light"}));
  EXPECT_EQ(mat(plain, "p_0.two").mass.factor, 0.002);
  EXPECT_EQ(mat(plain, "m").mass.factor, 5.0);
  EXPECT_EQ(plain.lias[0].stiffness.factor, 1000.0);
  const Scene heavy = variant("heavy");
  EXPECT_EQ(mat(heavy, "p_0.one").mass.factor, 0.003);
  EXPECT_EQ(mat(heavy, "p_0.two").mass.factor, 0.006);
  EXPECT_EQ(mat(heavy, "p_1.two").mass.factor, 7.0);
  EXPECT_EQ(mat(heavy, "m").mass.factor, 0.003);
  EXPECT_EQ(heavy.lias[1].stiffness.factor, 2000.0);
  EXPECT_EQ(heavy.parameters[0].value, 1.5);
  EXPECT_EQ(mat(variant("light"), "m").position.x(), 0.002);
}

TEST(VariantsTest, AreInTheTextThatIsKept) {
  const Scene heavy = variant("heavy");
  const Scene again = readYaml(heavy.text, "s.yaml");
  EXPECT_EQ(again.text, heavy.text);
  EXPECT_EQ(mat(again, "m").mass.factor, 0.003);
  EXPECT_TRUE(again.variants.empty());
}

TEST(VariantsTest, WhatNothingAsksForIsRefused) {
  EXPECT_THAT(complaintOf<Exception>([] { variant("hevy"); }),
              HasSubstr("no variant 'hevy'; did you mean 'heavy'?"));
  EXPECT_THAT(complaintOf<Exception>([] { readScene("", "a.mdl", {}, {"heavy"}); }),
              HasSubstr("a MIMS model has none"));
  const auto refusal = [](const std::string& says) {
    return complaintOf<TextError>([&] {
      readYaml(
          "ergotic: 1\nsections: {a: {}}\nlet: {w: 1}\nmats: {m: {type: mass, mass: 1}}\n"
          "variants: {v: {" +
              says + "}}\n",
          "s.yaml", {}, {"v"});
    });
  };
  EXPECT_THAT(refusal("let: {ww: 1}"),
              HasSubstr("s.yaml:5:22: error: the scene has no constant 'ww'"));
  EXPECT_THAT(refusal("set: {n.mass: 1}"), HasSubstr("nothing of the scene is meant by 'n.mass'"));
  EXPECT_THAT(refusal("set: {m.mas: 1}"), HasSubstr("unknown key 'mas' of module 'm'"));
  EXPECT_THAT(refusal("set: {m.mass: 1 m}"), HasSubstr("of another kind"));
}

TEST(AboutTest, IsReadAndKept) {
  for (const std::string& text : {std::string(kScene), variant("").text}) {
    const Scene scene = readYaml(text, "s.yaml");
    const About& about = scene.about;
    EXPECT_EQ(scene.name, "Two strings");
    EXPECT_EQ(about.author, "Somebody");
    EXPECT_EQ(about.licence, "MIT OR CC-BY-4.0");
    EXPECT_EQ(about.description, "What {it} is = this");
    ASSERT_EQ(about.hands.size(), 2U);
    EXPECT_EQ(about.hands[0], std::pair(std::string("0..1"), std::string("plectra")));
    EXPECT_EQ(about.play, "two.csv");
    EXPECT_EQ(about.sources, std::vector<std::string>{"a book"});
    ASSERT_TRUE(about.picture);
    EXPECT_EQ(about.picture->from, Eigen::Vector3d(1, 2, 3));
  }
}

TEST(PoseTest, InstancesStandWhereTheyAreTold) {
  const Scene scene = readYaml(R"(ergotic: 1
sections: {a: {}, p: {geometry: plane}, s: {geometry: space}}
define:
  part:
    needs: {a: audio, p: audio, s: audio}
    generators: [{type: string, name: s, section: a, masses: 1, mass: 1, stiffness: 1, to: [1, 0]},
                 {type: mesh, name: n, section: a, rows: 3, columns: 3, spacing: 1, mass: 1, stiffness: 1}]
    mats:
      m: {type: mass, section: a, mass: 1}
      q: {type: mass, section: p, mass: 1, at: [1, 0], x: [2, 0], v: [1, 0]}
      r: {type: mass, section: s, mass: 1, at: [1, 0, 0]}
  around:
    needs: {a: audio, p: audio, s: audio}
    use: [{is: part, as: i, at: [1, 0, 0], in: {a: a, p: p, s: s}}]
  bare:
    needs: {a: audio, p: audio, s: audio}
    generators: [{type: string, name: s, section: a, masses: 1, mass: 1, stiffness: 1, to: [1, 0]}]
    mats:
      q: {type: mass, section: p, mass: 1, at: [1, 0], x: [2, 0], v: [1, 0]}
      r: {type: mass, section: s, mass: 1, at: [1, 0, 0]}
use:
  - {is: part, as: moved, at: [10 cm, =2*0.1], in: {a: a, p: p, s: s}}
  - {is: around, as: deep, at: [0, 1, 2], in: {a: a, p: p, s: s}}
  - {is: bare, as: turned, at: [1, 1, 0], rotate: 90 deg, in: {a: a, p: p, s: s}}
  - {is: part, as: still, in: {a: a, p: p, s: s}}
)",
                               "s.yaml");
  const auto at = [&](const std::string& name) { return mat(scene, name).rest; };
  const auto expectAt = [&](const std::string& name, double x, double y, double z) {
    EXPECT_LT((at(name) - Eigen::Vector3d(x, y, z)).norm(), 1e-12)
        << name << " " << at(name).transpose();
  };
  expectAt("moved.m", 0, 0.1, 0.2);
  expectAt("moved.s.0", 0, 0.1, 0.2);
  expectAt("moved.s.2", 0, 1.1, 0.2);
  expectAt("moved.n.0.0", 0, 0.1, 0.2);
  expectAt("moved.q", 1.1, 0.2, 0);
  EXPECT_LT((mat(scene, "moved.q").position.head<2>() - Eigen::Vector2d(2.1, 0.2)).norm(), 1e-12);
  expectAt("deep.i.r", 2, 1, 2);
  expectAt("deep.i.m", 0, 1, 2);
  expectAt("turned.q", 1, 2, 0);
  EXPECT_LT((mat(scene, "turned.q").push->velocity.head<2>() - Eigen::Vector2d(0, 1)).norm(),
            1e-12);
  expectAt("turned.r", 1, 2, 0);
  expectAt("turned.s.2", 0, 1, 1);
  expectAt("still.m", 0, 0, 0);
}

TEST(KindsTest, ConstantsKeepTheirUnits) {
  const auto refusal = [](const std::string& mass) {
    return complaintOf<TextError>([&] {
      readYaml(
          "ergotic: 1\nsections: {a: {}}\nlet: {L: 650 mm, w: 2 g, n: 3, f: 100 Hz, "
          "k: 10 N/m}\nmats: {m: {type: mass, mass: '" +
              mass + "'}}\n",
          "s.yaml");
    });
  };
  for (const char* const wrong : {"=L", "=2*L", "=L*w", "=w/L", "=f", "=k*L", "=max(L, 0)", "=w^2",
                                  "=n > 2 ? L : w", "=note(A4)"}) {
    EXPECT_THAT(refusal(wrong), HasSubstr("of another kind")) << wrong;
  }
  EXPECT_THAT(refusal("=L + w"), HasSubstr("m and kg are of different kinds"));
  EXPECT_THAT(refusal("=L > w"), HasSubstr("m and kg are of different kinds"));
  EXPECT_THAT(refusal("=exp(L)"), HasSubstr("is in m, allowed: a number"));
  EXPECT_THAT(refusal("=2^L"), HasSubstr("an exponent is in m"));
  EXPECT_THAT(refusal("=w^0.31"), HasSubstr("no unit has such a power"));
  EXPECT_THAT(refusal("=sqrt(L)"), HasSubstr("a power of units that no key has"));
  for (const char* const right :
       {"=w", "=2*w", "=n", "=n*w/2 + 1", "=k*L/(L*f^2)", "=w*L/L", "=sqrt(w*w)", "=pow(w, 2)/w",
        "=L/(1 mm)", "=sin(30 deg)", "=mod(w, 1 g) + w"}) {
    EXPECT_EQ(refusal(right), "") << right;
  }
}

}  // namespace
}  // namespace ergotic::scene
