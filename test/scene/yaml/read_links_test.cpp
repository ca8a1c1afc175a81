// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/bad_text.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define LINK_HEAD                                                                               \
  "ergotic: 1\n"                                                                                \
  "parameters: {p: {value: 2, range: [1, 4]}, n: {value: 0, range: [-1, 1]}}\n"                 \
  "sections: {a: {}, b: {}, c: {rate: {divisor: 4}}, h: {rate: gestural},\n"                    \
  "  v: {geometry: space}, w: {geometry: plane}}\n"                                             \
  "mats:\n"                                                                                     \
  "  m: {type: mass, section: a, mass: 1}\n"                                                    \
  "  n: {type: mass, section: a, mass: 1}\n"                                                    \
  "  o: {type: mass, section: b, mass: 1}\n"                                                    \
  "  q: {type: mass, section: c, mass: 1}\n"                                                    \
  "  k: {type: slice, section: h}\n"                                                            \
  "  l: {type: slice, section: h}\n"                                                            \
  "  v: {type: mass, section: v, mass: 1}\n"                                                    \
  "  w: {type: mass, section: w, mass: 1}\n"                                                    \
  "generators: [{type: string, name: s, section: a, masses: 3, mass: 1, stiffness: 1, to: [1, " \
  "0]}]\n"
#define LINK LINK_HEAD "lias: {x: {"

Lia last(const std::string& text) {
  return readYaml(text, "links.yaml").lias.back();
}

TEST(ReadLinksTest, PowerContactIsReadFieldByField) {
  const Lia l = last(LINK
                     "type: power_contact, between: [m, n], stiffness: 1e5, exponent: 2.3, "
                     "damping: 4, threshold: -0.1}}\n");
  EXPECT_EQ(l.type, LiaType::kPowerContact);
  EXPECT_EQ(l.stiffness.factor, 1e5);
  EXPECT_EQ(l.law->exponent.factor, 2.3);
  EXPECT_EQ(l.law->exponent.parameter, -1);
  EXPECT_EQ(l.damping.factor, 4.0);
  EXPECT_EQ(l.law->width.factor, -0.1);
}

TEST(ReadLinksTest, ExponentMayFollowAParameter) {
  const Lia l = last(LINK "type: power_contact, between: [m, n], stiffness: 1, exponent: $p}}\n");
  EXPECT_EQ(l.law->exponent.parameter, 0);
  EXPECT_EQ(l.law->exponent.factor, 1.0);
}

TEST(ReadLinksTest, APluckMayHaveAReleaseForceInPlaceOfItsWidth) {
  const Lia usual = last(LINK "type: pluck, between: [m, n], release_force: 1.8 N}}\n");
  EXPECT_EQ(usual.type, LiaType::kPluck);
  EXPECT_NEAR(usual.stiffness.factor, 2000.0, 1e-9);
  EXPECT_NEAR(usual.law->width.factor, 0.01, 1e-15);
  const Lia stiff = last(LINK
                         "type: pluck, between: [m, n], release_force: 1.8, stiffness: 5000, "
                         "damping: 0.1}}\n");
  EXPECT_EQ(stiff.stiffness.factor, 5000.0);
  EXPECT_NEAR(stiff.law->width.factor, 1.8 / (0.09 * 5000.0), 1e-15);
  EXPECT_EQ(stiff.damping.factor, 0.1);
  const Lia live =
      last(LINK "type: pluck, between: [m, n], release_force: 0.9*$p, stiffness: 5000}}\n");
  EXPECT_EQ(live.law->width.parameter, 0);
  EXPECT_NEAR(live.law->width.factor, 0.9 / (0.09 * 5000.0), 1e-15);
  const Lia live_usual = last(LINK "type: pluck, between: [m, n], release_force: $p}}\n");
  EXPECT_EQ(live_usual.stiffness.parameter, 0);
  EXPECT_EQ(live_usual.law->width.parameter, -1);
}

TEST(ReadLinksTest, AOneWayPluckLetsGoWhereItsSpringHasItsReleaseForce) {
  const Lia usual = last(LINK "type: one_way_pluck, between: [m, n], release_force: 1.8 N}}\n");
  EXPECT_EQ(usual.type, LiaType::kOneWayPluck);
  EXPECT_NEAR(usual.stiffness.factor, 1800.0, 1e-9);
  EXPECT_NEAR(usual.law->width.factor, 1e-3, 1e-15);
  const Lia stiff = last(LINK
                         "type: one_way_pluck, between: [m, n], release_force: 2*$p, "
                         "stiffness: 5000, rest_length: 3 mm}}\n");
  EXPECT_EQ(stiff.law->width.parameter, 0);
  EXPECT_NEAR(stiff.law->width.factor, 2.0 / 5000.0, 1e-15);
  EXPECT_EQ(stiff.rest_length, 3e-3);
  const Lia wide = last(LINK "type: one_way_pluck, between: [m, n], stiffness: 9, width: 2 mm}}\n");
  EXPECT_EQ(wide.stiffness.factor, 9.0);
  EXPECT_EQ(wide.law->width.factor, 2e-3);
}

TEST(ReadLinksTest, SaysWhatDoesNotGoWithAReleaseForce) {
  const auto refusal = [](const std::string& keys) {
    return complaintOf<TextError>(
        [&] { last(std::string(LINK "type: pluck, between: [m, n], ") + keys + "}}\n"); });
  };
  EXPECT_THAT(refusal("release_force: 0"), HasSubstr("= 0 N is out of range, allowed: > 0 N"));
  EXPECT_THAT(refusal("release_force: $n"), HasSubstr("allowed: > 0 N"));
  EXPECT_THAT(refusal("release_force: 1, stiffness: 0"), HasSubstr("allowed: > 0 N/m"));
  EXPECT_THAT(refusal("release_force: 1, stiffness: $p"),
              HasSubstr("'stiffness' of link 'x' is a parameter, allowed beside 'release_force': a "
                        "number"));
  EXPECT_THAT(refusal("release_force: 1, width: 0.01"), HasSubstr("'width'"));
  EXPECT_THAT(refusal("stiffness: 1"), HasSubstr("'width'"));
}

TEST(ReadLinksTest, TableLinkHasAnElasticAndAViscousLaw) {
  const Lia both = last(LINK
                        "type: table, between: [m, n], elastic: [[-1, -2], [1, 3]], "
                        "viscous: {points: [[-4, -5], [0, 0], [6, 7]], interpolation: monotone}, "
                        "rest_length: 0.5}}\n");
  EXPECT_EQ(both.type, LiaType::kTable);
  ASSERT_EQ(both.law->table.points.size(), 2U);
  EXPECT_EQ(both.law->table.points[1], std::make_pair(1.0, 3.0));
  EXPECT_FALSE(both.law->table.smooth);
  ASSERT_EQ(both.law->viscous_table.points.size(), 3U);
  EXPECT_EQ(both.law->viscous_table.points[0], std::make_pair(-4.0, -5.0));
  EXPECT_TRUE(both.law->viscous_table.smooth);
  EXPECT_EQ(both.rest_length, 0.5);
  const Lia viscous = last(LINK "type: table, between: [m, n], viscous: [[0, 0], [1, 1]]}}\n");
  EXPECT_TRUE(viscous.law->table.empty());
  EXPECT_EQ(viscous.law->viscous_table.points.size(), 2U);
}

TEST(ReadLinksTest, ConditionalLinkLetsGoWhereItEngagesUnlessTold) {
  const std::string start = LINK "type: conditional, between: [m, n], stiffness: 3, ";
  const Lia told = last(start + "damping: 4, engage: 0.1, release: 0.2, rest_length: 1}}\n");
  EXPECT_EQ(told.type, LiaType::kConditional);
  EXPECT_EQ(told.stiffness.factor, 3.0);
  EXPECT_EQ(told.damping.factor, 4.0);
  EXPECT_EQ(told.law->width.factor, 0.1);
  EXPECT_EQ(told.law->release, 0.2);
  EXPECT_EQ(told.rest_length, 1.0);
  EXPECT_EQ(last(start + "engage: 0.1}}\n").law->release, 0.1);
  const Lia moving = last(start + "engage: 0.5*$p, release: 2}}\n");
  EXPECT_EQ(moving.law->width.parameter, 0);
  EXPECT_EQ(moving.law->release, 2.0);
}

TEST(ReadLinksTest, LinearLinksMayBeNegative) {
  const Lia spring = last(LINK "type: spring, between: [m, n], stiffness: -5}}\n");
  EXPECT_EQ(spring.stiffness.factor, -5.0);
  EXPECT_EQ(last(LINK "type: damper, between: [m, n], damping: -6}}\n").damping.factor, -6.0);
  const Lia both =
      last(LINK "type: spring_damper, between: [m, n], stiffness: 2*$n, damping: $n}}\n");
  EXPECT_EQ(both.stiffness.factor, 2.0);
  EXPECT_EQ(both.damping.parameter, 1);
}

/// What may stand after `between` of every type, and whether the link may be energy-stable.
struct Kind {
  const char* fields;
  bool guardable;
};
const Kind kKinds[] = {
    {"type: spring, stiffness: 1", false},
    {"type: damper, damping: 1", false},
    {"type: spring_damper, stiffness: 1, damping: 1", false},
    {"type: contact, stiffness: 1", true},
    {"type: power_contact, stiffness: 1, exponent: 1.5", true},
    {"type: quadratic, stiffness: 1, nonlinearity: 1", true},
    {"type: cubic, stiffness: 1, nonlinearity: 1", true},
    {"type: clipped_cubic, stiffness: 1, nonlinearity: 1, stiffness_limit: 2", true},
    // Without a cube this is a straight spring.
    {"type: clipped_cubic, stiffness: 1, nonlinearity: 0, stiffness_limit: 2", false},
    {"type: cubic_contact, stiffness: 1, nonlinearity: 1, stiffness_limit: 2", true},
    {"type: pluck, stiffness: 1, width: 1", true},
    {"type: pluck, table: [[0, 0], [1, 1]]", true},
    {"type: bow, damping: 1, width: 1", true},
    {"type: bow, table: [[0, 0], [1, 1]]", true},
    {"type: smooth_bow, damping: 1, width: 1", true},
    {"type: table, elastic: [[0, 0], [1, 1]]", true},
    {"type: table, viscous: [[0, 0], [1, 1]]", true},
    {"type: table, viscous: [[-1, 1], [0, 2], [1, 4], [2, 3]]", true},
    {"type: table, elastic: [[0, 0], [1, 1]], viscous: [[0, 0], [1, 1]]", true},
    {"type: conditional, stiffness: 1, engage: 1", true},
};

TEST(ReadLinksTest, SchemeIsLeftToBeChosenWhereThereIsAChoice) {
  for (const Kind& kind : kKinds) {
    const std::string start = std::string(LINK "between: [m, n], ") + kind.fields;
    const Scheme open = kind.guardable ? Scheme::kAuto : Scheme::kExplicit;
    EXPECT_EQ(last(start + "}}\n").scheme, open) << kind.fields;
    EXPECT_EQ(last(start + ", scheme: auto}}\n").scheme, open) << kind.fields;
    EXPECT_EQ(last(start + ", scheme: explicit}}\n").scheme, Scheme::kExplicit) << kind.fields;
    const Scene scene = readYaml(start + "}}\n", "links.yaml");
    EXPECT_EQ(canBeEnergyStable(scene, scene.lias.back()), kind.guardable) << kind.fields;
  }
}

/// What drives may be split into parts of which one is energy-stable.
TEST(ReadLinksTest, SchemeOfATableThatDrivesIsOpen) {
  const std::string start =
      LINK "between: [m, n], type: table, viscous: [[-1, 1], [0, 2], [1, 4], [2, 1]]";
  const Scene scene = readYaml(start + "}}\n", "links.yaml");
  EXPECT_EQ(scene.lias.back().scheme, Scheme::kAuto);
  EXPECT_FALSE(canBeEnergyStable(scene, scene.lias.back()));
  EXPECT_EQ(last(start + ", scheme: explicit}}\n").scheme, Scheme::kExplicit);
}

/// Where their lines may turn, dampers are not linear.
TEST(ReadLinksTest, SchemeOfADamperIsOpenInAPlane) {
  for (const std::string geometry : {"line", "plane", "space"}) {
    const std::string start = "ergotic: 1\nsections: {s: {rate: audio, geometry: " + geometry +
                              "}}\nmats: {m: {type: mass, section: s, mass: 1}, "
                              "n: {type: ground, section: s}}\nlias: {x: {between: [m, n], type: ";
    const Scheme open = geometry == "line" ? Scheme::kExplicit : Scheme::kAuto;
    EXPECT_EQ(last(start + "damper, damping: 1}}\n").scheme, open) << geometry;
    EXPECT_EQ(last(start + "spring, stiffness: 1}}\n").scheme, Scheme::kExplicit) << geometry;
  }
}

TEST(ReadLinksTest, TheOldWordGuardedIsReadWithOneWarning) {
  const Scene scene =
      readYaml(LINK
               "between: [m, n], type: contact, stiffness: 1, scheme: guarded}, "
               "y: {between: [m, n], type: contact, stiffness: 2, scheme: guarded}}\n",
               "old.yaml");
  const std::size_t links = scene.lias.size();
  EXPECT_EQ(scene.lias[links - 2].scheme, Scheme::kEnergyStable);
  EXPECT_EQ(scene.lias[links - 1].scheme, Scheme::kEnergyStable);
  EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                          [](const std::string& warning) {
                            return warning.find("is the old word for 'scheme: energy_stable'") !=
                                   std::string::npos;
                          }),
            1);
}

TEST(ReadLinksTest, SchemeIsTakenOrRefusedAsTheTypeAllows) {
  for (const Kind& kind : kKinds) {
    const std::string text =
        std::string(LINK "between: [m, n], ") + kind.fields + ", scheme: <!>energy_stable}}\n";
    if (!kind.guardable) {
      expectRefused({text.c_str(), "link 'x' cannot be energy-stable, it is "}, "bad.yaml");
      continue;
    }
    std::string whole = text;
    whole.erase(whole.find("<!>"), 3);
    EXPECT_EQ(last(whole).scheme, Scheme::kEnergyStable) << kind.fields;
  }
}

TEST(ReadLinksTest, LinksOfMdlFilesAreNeverNegative) {
  EXPECT_THROW(readMdl("@a mass 1 0 0\n@b ground 0\n@c spring @a @b -0.1\n", "a.mdl"), TextError);
  EXPECT_THROW(readMdl("@a mass 1 0 0\n@b ground 0\n@c damper @a @b -0.1\n", "a.mdl"), TextError);
}

TEST(ReadLinksTest, FilterIsAskedForBetweenHandAndStructure) {
  const std::string start = LINK "type: contact, stiffness: 1, between: ";
  EXPECT_FALSE(last(start + "[m, k]}}\n").filtered);
  EXPECT_FALSE(last(start + "[m, k], filter: none}}\n").filtered);
  EXPECT_TRUE(last(start + "[m, k], filter: auto}}\n").filtered);
  EXPECT_TRUE(last(start + "[k, m], filter: auto}}\n").filtered);
}

TEST(ReadLinksTest, EndsMayBePointsOfAString) {
  const Scene s = readYaml(LINK
                           "type: spring, between: [s@0.3, m], stiffness: 1},\n"
                           "  y: {type: spring, between: [n, s@0.3], stiffness: 1},\n"
                           "  z: {type: spring, between: [s@0.3, s@0.7], stiffness: 1}}\n",
                           "links.yaml");
  const Lia& x = s.lias[s.lias.size() - 3];
  const Lia& y = s.lias[s.lias.size() - 2];
  const Lia& z = s.lias[s.lias.size() - 1];
  EXPECT_EQ(s.mats[static_cast<std::size_t>(x.a)].type, MatType::kPoint);
  EXPECT_EQ(s.mats[static_cast<std::size_t>(x.a)].name, "s@0.3");
  EXPECT_EQ(s.mats[static_cast<std::size_t>(x.b)].name, "m");
  EXPECT_EQ(y.b, x.a);
  EXPECT_EQ(z.a, x.a);
  EXPECT_NE(z.b, x.a);
  EXPECT_EQ(s.connections.size(), 2U);
}

TEST(ReadLinksTest, RestLengthIsSignedOnlyAlongAnAxis) {
  const std::string start = LINK "type: spring, stiffness: 1, ";
  EXPECT_EQ(last(start + "between: [m, n], rest_length: -1}}\n").rest_length, -1.0);
  EXPECT_EQ(last(start + "between: [v, m], rest_length: -1}}\n").rest_length, -1.0);
  EXPECT_EQ(last(start + "between: [v, w], rest_length: 1}}\n").rest_length, 1.0);
}

struct Damage {
  const char* message;
  void (*apply)(Scene&, Lia&);
};
const Damage kDamages[] = {
    {"exponent of link 'x' = 0.5", [](Scene&, Lia& l) { l.law.edit().exponent = {0.5}; }},
    {"parameter of exponent of link 'x' = 7",
     [](Scene&, Lia& l) { l.law.edit().exponent.parameter = 7; }},
    {"exponent of link 'x' = 8",
     [](Scene&, Lia& l) {
       l.law.edit().exponent = {2.0, 0};
     }},
    {"stiffness of link 'x' = -1 N/m^exponent", [](Scene&, Lia& l) { l.stiffness = {-1.0}; }},
    {"link 'x' has a table, allowed: pluck, bow and table only",
     [](Scene&, Lia& l) {
       l.law.edit().viscous_table.points = {{0.0, 0.0}, {1.0, 1.0}};
     }},
    {"link 'x' has no table", [](Scene&, Lia& l) { l.type = LiaType::kTable; }},
    {"one point in the table of link 'x'",
     [](Scene&, Lia& l) {
       l.type = LiaType::kTable;
       l.law.edit().viscous_table.points = {{0.0, 0.0}};
     }},
    {"release of link 'x' = 0 m is out of range, allowed: >= 1 m",
     [](Scene&, Lia& l) {
       l.type = LiaType::kConditional;
       l.law.edit().width = {1.0};
     }},
    {"engage of link 'x' = 0 m",
     [](Scene&, Lia& l) {
       l.type = LiaType::kConditional;
       l.law.edit().width = {0.0};
     }},
    {"link 'x' cannot be energy-stable",
     [](Scene&, Lia& l) {
       l.type = LiaType::kSpringDamper;
       l.scheme = Scheme::kEnergyStable;
     }},
    {"link 'x' cannot be filtered", [](Scene&, Lia& l) { l.filtered = true; }},
    {"rest_length of link 'x' = -1 m is out of range, allowed: >= 0 m",
     [](Scene& s, Lia& l) {
       s.sections[0].geometry = Geometry::kLine;
       l.rest_length = -1.0;
     }},
};
TEST(ReadLinksTest, ValidateFindsEveryDamageOfALink) {
  for (const Damage& damage : kDamages) {
    Scene scene = readYaml(
        LINK "type: power_contact, between: [m, n], stiffness: 1, exponent: 2}}\n", "links.yaml");
    damage.apply(scene, scene.lias.back());
    EXPECT_THAT(complaintOf<TextError>([&] { validate(scene); }),
                AllOf(HasSubstr(damage.message), StartsWith("links.yaml:15:8: error: ")));
  }
}

}  // namespace
}  // namespace ergotic::scene
