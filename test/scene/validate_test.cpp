// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "scene/laws/clipped_cubic.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

using test::kNan;

/// One element of every kind, legal.
Scene legal() {
  return readYaml(
      "ergotic: 1\nparameters: {p: {value: 1, range: [1, 2]}}\n"
      "sections: {a: {}, h: {rate: gestural}}\n"
      "mats: {m: {type: cell, section: a, mass: $p}, k: {type: slice, section: h},\n"
      "  d: {type: driven, section: a},\n"
      "  u: {type: point, along: s, at: 0.3, guide: {mat: k, scale: 1}}}\n"
      "generators: [{type: string, name: s, section: a, masses: 1, mass: 1, stiffness: 1,\n"
      "  to: [1, 0]}]\n"
      "lias: {l: {type: bow, between: [m, k], damping: 1, width: 1},\n"
      "  t: {type: bow, between: [m, k], table: [[0, 0], [1, 1]]}}\n"
      "ports: {o: {mat: k, slice: 0}}\n"
      "inputs: {i: {mat: d, quantity: position, channel: 1}}\n"
      "outputs: {q: {at: s@0.3, quantity: force, channel: 1}}\n",
      "legal.yaml");
}

struct Damage {
  const char* message;
  std::function<void(Scene&)> apply;
};

const Damage kDamages[] = {
    {"time unit", [](Scene& s) { s.time_unit_s = 0.0; }},
    {"gestural_rate", [](Scene& s) { s.gestural_rate_hz = kNan; }},
    {"value of parameter 'p' = 3", [](Scene& s) { s.parameters[0].value = 3.0; }},
    {"maximum of parameter 'p'", [](Scene& s) { s.parameters[0].maximum = 0.5; }},
    {"mass of module 'm' = -1", [](Scene& s) { s.parameters[0].minimum = -1.0; }},
    {"divisor of section 'a' = 0", [](Scene& s) { s.sections[0].divisor = 0; }},
    {"gravity of section 'a'", [](Scene& s) { s.sections[0].gravity.x() = kNan; }},
    {"pose of section 'h'", [](Scene& s) { s.sections[1].pose.translation().x() = kNan; }},
    {"section 'a' is defined twice", [](Scene& s) { s.sections[1].name = "a"; }},
    {"a module has no name", [](Scene& s) { s.mats[1].name.clear(); }},
    {"section of module 'm' = 2 does not exist", [](Scene& s) { s.mats[0].section = 2; }},
    {"stiffness of module 'm'", [](Scene& s) { s.mats[0].stiffness.factor = -1.0; }},
    {"parameter of damping of module 'm'", [](Scene& s) { s.mats[0].damping.parameter = 1; }},
    {"force of module 'm'", [](Scene& s) { s.mats[0].push.edit().force.x() = kNan; }},
    {"a coordinate of module 'k'", [](Scene& s) { s.mats[1].rest.y() = kNan; }},
    {"velocity of module 'm'", [](Scene& s) { s.mats[0].push.edit().velocity.x() = kNan; }},
    {"slice 'k' is in section 'a'", [](Scene& s) { s.mats[1].section = 0; }},
    {"first module of link 't' = -1", [](Scene& s) { s.lias.back().a = -1; }},
    {"second module of link 't' = 99", [](Scene& s) { s.lias.back().b = 99; }},
    {"joins module 'k' to itself", [](Scene& s) { s.lias.back().a = s.lias.back().b; }},
    {"width of link 'l'",
     [](Scene& s) { s.lias[s.lias.size() - 2].law.edit().width.factor = 0.0; }},
    {"damping of link 'l'", [](Scene& s) { s.lias[s.lias.size() - 2].damping.factor = -1.0; }},
    {"rest_length of link 't'", [](Scene& s) { s.lias.back().rest_length = kNan; }},
    {"one point in the table", [](Scene& s) { s.lias.back().law.edit().table.points.resize(1); }},
    {"first number in the table",
     [](Scene& s) { s.lias.back().law.edit().table.points[1].first = 0.0; }},
    {"has a table", [](Scene& s) { s.lias.back().type = LiaType::kCubic; }},
    {"slice of port 'o' = -2", [](Scene& s) { s.ports[0].slice = -2; }},
    {"axis of port 'o' = 1 is out of range, allowed: 0...0", [](Scene& s) { s.ports[0].axis = 1; }},
    {"slice of port 'o' = 64", [](Scene& s) { s.ports[0].slice = 64; }},
    {"allowed: modules of type slice", [](Scene& s) { s.ports[0].mat = 0; }},
    {"is on slice 0, which port 'o' has",
     [](Scene& s) {
       s.ports.push_back(s.ports[0]);
       s.ports[1].name = "second";
     }},
    {"allowed: modules of type driven", [](Scene& s) { s.inputs[0].mat = 0; }},
    {"quantity of input 'i' is velocity",
     [](Scene& s) { s.inputs[0].quantity = Quantity::kVelocity; }},
    {"channel of input 'i' = 0", [](Scene& s) { s.inputs[0].channel = -1; }},
    {"channel of output 'q' = 65", [](Scene& s) { s.outputs[0].channel = 64; }},
    {"fraction of output 'q'", [](Scene& s) { s.outputs[0].point.fraction = 1.5; }},
    {"next module of output 'q'", [](Scene& s) { s.outputs[0].point.next = 99; }},
    {"axis of output 'q' = 1 is out of range, allowed: 0...0",
     [](Scene& s) { s.outputs[0].axis = 1; }},
    {"axis of input 'i' = -1", [](Scene& s) { s.inputs[0].axis = -1; }},
    {"gain of output 'q'", [](Scene& s) { s.outputs[0].gain.factor = kNan; }},
    {"last module of string 's'", [](Scene& s) { s.strings[0].count = 9; }},
    {"last link of string 's'", [](Scene& s) { s.strings[0].first_lia = 3; }},
    {"frequency of string 's'", [](Scene& s) { s.strings[0].frequency_hz = -1.0; }},
    {"masses of string 's' = 1 is out of range, allowed: >= 3",
     [](Scene& s) { s.strings[0].coarse = true; }},
    {"gravity of section 'a'", [](Scene& s) { s.sections[0].gravity.z() = kNan; }},
    {"medium of section 'a'", [](Scene& s) { s.sections[0].medium.factor = -1.0; }},
    {"sleep of section 'a'", [](Scene& s) { s.sections[0].sleep_energy = -1.0; }},
    {"modes of section 'a' are of no use there, allowed: in sections of geometry scalar",
     [](Scene& s) {
       s.sections[0].modes = 5;
       s.sections[0].geometry = Geometry::kLine;
     }},
    {"which may sleep", [](Scene& s) { s.sections[1].sleep_energy = 1.0; }},
    {"both gestural and auto", [](Scene& s) { s.sections[1].automatic_rate = true; }},
    {"a coordinate of module 'm'", [](Scene& s) { s.mats[0].position.z() = kNan; }},
    {"first module of string or mesh 's'", [](Scene& s) { s.grids[0].first = -1; }},
    {"columns of string or mesh 's'", [](Scene& s) { s.grids[0].columns = 1; }},
    {"rows of string or mesh 's'", [](Scene& s) { s.grids[0].rows = 0; }},
    {"'s' ends at module 9", [](Scene& s) { s.grids[0].rows = 2; }},
    {"of string or mesh 's' is a point or in another section",
     [](Scene& s) { s.grids[0].columns = 4; }},
    {"point of a connection = 99", [](Scene& s) { s.connections[0].mat = 99; }},
    {"module 'm' has a connection, allowed: points", [](Scene& s) { s.connections[0].mat = 0; }},
    {"point 'u' has 0 connections", [](Scene& s) { s.connections.clear(); }},
    {"point 'u' has 2 connections", [](Scene& s) { s.connections.push_back(s.connections[0]); }},
    {"string or mesh of point 'u'", [](Scene& s) { s.connections[0].grid = 1; }},
    {"section of point 'u' is another", [](Scene& s) { s.mats.back().section = 1; }},
    {"place along of point 'u' = 0.3 is out of range, allowed: 0.4...1",
     [](Scene& s) { s.connections[0].along.minimum = 0.4; }},
    {"upper end of the range along of point 'u'",
     [](Scene& s) { s.connections[0].along.maximum = 2; }},
    {"place across of point 'u'", [](Scene& s) { s.connections[0].across.at.factor = 2.0; }},
    {"speed of point 'u'", [](Scene& s) { s.connections[0].speed = -1.0; }},
    {"power of point 'u'", [](Scene& s) { s.connections[0].power = 0.0; }},
    {"guide along of point 'u' = 99", [](Scene& s) { s.connections[0].along.guide = 99; }},
    {"guide along of point 'u' is a point", [](Scene& s) { s.connections[0].along.guide = 6; }},
    {"guide across of point 'u', allowed: none, 's' has one row",
     [](Scene& s) { s.connections[0].across.guide = 0; }},
    {"axis of the guide along of point 'u' = 1 does not exist, there are 1",
     [](Scene& s) {
       s.connections[0].along.guide = 0;
       s.connections[0].along.axis = 1;
     }},
    {"scale of the guide along of point 'u'",
     [](Scene& s) { s.connections[0].along.scale = kNan; }},
};
TEST(ValidateTest, AcceptsWhatTheReaderMakes) {
  EXPECT_NO_THROW(validate(legal()));
}

TEST(ValidateTest, AcceptsNegativeStiffnessAndDampingOfLinearLinks) {
  Scene scene = legal();
  scene.lias[0].stiffness.factor = -1.0;
  scene.lias[0].damping.factor = -1.0;
  EXPECT_NO_THROW(validate(scene));
}

TEST(ValidateTest, FindsEveryDamage) {
  for (const Damage& damage : kDamages) {
    Scene scene = legal();
    damage.apply(scene);
    EXPECT_THAT(complaintOf<TextError>([&] { validate(scene); }),
                AllOf(HasSubstr(damage.message), StartsWith("legal.yaml:")));
  }
}

Lia clipped(LiaType type, double k, double q, double limit, ClippedLaw law) {
  Lia lia;
  lia.type = type;
  lia.stiffness = {k};
  lia.law.edit().nonlinearity = {q};
  lia.law.edit().stiffness_limit = {limit};
  completeClippedLaw(lia, law);
  return lia;
}

TEST(ClippedLawTest, IsContinuousAtItsTippingPointInYaml) {
  const Lia lia = clipped(LiaType::kClippedCubic, 2.0, 5.0, 22.0, ClippedLaw::kContinuous);
  const double e = lia.law->tipping_point;
  EXPECT_DOUBLE_EQ(e, 2.0);
  EXPECT_DOUBLE_EQ(2.0 * e + 5.0 * e * e * e, 22.0 * e);
  EXPECT_EQ(lia.law->limit_damping.factor, 0.0);
}

TEST(ClippedLawTest, TipsWhereMiGenSaysAndItsSpringsAreMoreDampedThere) {
  const Lia contact = clipped(LiaType::kCubicContact, 0.01, 0.16, 0.05, ClippedLaw::kMiGen);
  EXPECT_DOUBLE_EQ(contact.law->tipping_point, 0.5);
  EXPECT_EQ(contact.law->limit_damping.factor, 0.0);
  EXPECT_EQ(contact.type, LiaType::kCubicContact);
  const Lia spring = clipped(LiaType::kClippedCubic, 0.01, 0.16, 0.05, ClippedLaw::kMiGen);
  EXPECT_DOUBLE_EQ(spring.law->tipping_point, 0.5);
  EXPECT_DOUBLE_EQ(spring.law->limit_damping.factor, 0.015);
}

TEST(ClippedLawTest, TipsWhereFaustSaysAndIsMoreDampedThere) {
  const Lia lia = clipped(LiaType::kCubicContact, 0.01, 0.4, 0.05, ClippedLaw::kFaust);
  EXPECT_DOUBLE_EQ(lia.law->tipping_point, 0.5);
  EXPECT_DOUBLE_EQ(lia.law->limit_damping.factor, 0.015);
  EXPECT_EQ(lia.type, LiaType::kCubicContact);
}

TEST(ClippedLawTest, IsStraightWithoutACube) {
  const Lia lia = clipped(LiaType::kClippedCubic, 0.01, 0.0, 0.05, ClippedLaw::kMiGen);
  EXPECT_EQ(lia.type, LiaType::kSpringDamper);
  EXPECT_EQ(lia.stiffness.factor, 0.01);
}

TEST(ClippedLawTest, IsStraightWhenStifferThanItsLimit) {
  const Lia lia = clipped(LiaType::kCubicContact, 0.06, 0.4, 0.05, ClippedLaw::kFaust);
  EXPECT_EQ(lia.type, LiaType::kContact);
  EXPECT_EQ(lia.stiffness.factor, 0.05);
  EXPECT_EQ(lia.law->limit_damping.factor, 0.0);
  const Lia contact = clipped(LiaType::kCubicContact, 0.06, 0.4, 0.05, ClippedLaw::kMiGen);
  EXPECT_EQ(contact.stiffness.factor, 0.06) << "mi-gen raises the limit of a contact";
  const Lia spring = clipped(LiaType::kClippedCubic, 0.06, 0.4, 0.05, ClippedLaw::kMiGen);
  EXPECT_EQ(spring.stiffness.factor, 0.05);
}

TEST(ClippedLawTest, IsNotAParametersBusiness) {
  const std::string text =
      "ergotic: 1\nname: s\nparameters:\n  p: {value: 1, range: [1, 2]}\n"
      "sections:\n  s: {rate: audio}\n"
      "mats:\n  m: {type: mass, section: s, mass: 1}\n  g: {type: ground, section: s}\n"
      "lias:\n  l: {type: clipped_cubic, between: [m, g], stiffness: $p, nonlinearity: 2,\n"
      "      stiffness_limit: 9}\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "s.yaml"); }),
              AllOf(StartsWith("s.yaml:11:"), HasSubstr("'stiffness'")));
}

}  // namespace
}  // namespace ergotic::scene
