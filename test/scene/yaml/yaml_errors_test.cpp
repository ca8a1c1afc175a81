// SPDX-License-Identifier: BSD-3-Clause
#include "scene/bad_text.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define HEAD "ergotic: 1\nsections: {a: {}}\n"
#define TWO_RATES "ergotic: 1\nsections: {a: {}, h: {rate: gestural}}\n"
#define TWO_MASSES HEAD "mats: {m: {type: mass, mass: 1}, n: {type: mass, mass: 1}}\n"
#define SLICES                                    \
  "ergotic: 1\nsections: {h: {rate: gestural}}\n" \
  "mats: {k: {type: slice}, l: {type: slice}, m: {type: mass, mass: 1}}\n"
#define STRING \
  HEAD "generators: [{type: string, name: s, masses: 3, mass: 1, stiffness: 1, to: [1, 0]}]\n"
#define PARAMETER HEAD "parameters: {p: {value: 1, range: [-1, 2]}}\n"

const BadText kTop[] = {
    {"<!>", "the scene is empty"},
    {"<!># nothing\n", "the scene is empty"},
    {"<!>[1, 2]\n", "the scene is a list of 2, allowed: a map"},
    {"<!>hello\n", "the scene is a single value, allowed: a map"},
    {"<!>sections: {a: {}}\n", "missing key 'ergotic'"},
    {"ergotic: <!>2\nsections: {a: {}}\n", "format version 2 is not known, allowed: 1"},
    {"ergotic: <!>one\nsections: {a: {}}\n", "'one' is not a finite number"},
    {"<!>ergotic: 1\n", "missing key 'sections'"},
    {"ergotic: 1\nsections: <!>{}\n", "no section, allowed: at least one"},
    {HEAD "<!>mat: {}\n", "unknown key 'mat' of the scene; did you mean 'mats'?"},
    {HEAD "<!>zzzzzz: {}\n", "known: ergotic, name, gestural_rate"},
    {HEAD "<!>sections: {b: {}}\n", "key 'sections' of the scene comes twice"},
    {HEAD "gestural_rate: <!>499\n", "= 499 Hz is out of range, allowed: 500...48000 Hz"},
    {HEAD "gestural_rate: <!>.nan\n", "'.nan' is not a finite number"},
    {HEAD "gestural_rate: <!>[1]\n", "is a list of 1, allowed: a single value"},
    {HEAD "mats: <!>[1]\n", "'mats' is a list of 1, allowed: a map"},
    {HEAD "<!>mats: \n", "'mats' is empty, allowed: a map"},
    {HEAD "lias: {a: 1\n<!>", "not valid YAML"},
    {HEAD "---\n<!>ergotic: 1\n", "a second document"},
    {HEAD "name: caf<!>\xE9\n", "byte 0xE9 is not UTF-8"},
    {HEAD "name: a<!>\x04z\n", "control character 0x04"},
    {HEAD "name: <!>*nobody\n", "not valid YAML"},
};
const BadText kSections[] = {
    {HEAD "parameters: {p: {<!>valu: 1, range: [0, 1]}}\n", "did you mean 'value'?"},
    {HEAD "parameters: {<!>p: {value: 1}}\n", "missing key 'range' of parameter 'p'"},
    {HEAD "parameters: {p: {value: <!>3, range: [0, 1]}}\n", "= 3 is out of range, allowed: 0...1"},
    {HEAD "parameters: {p: {value: 1, range: <!>[1, 0]}}\n", "allowed: [lowest, highest]"},
    {HEAD "parameters: {p: {value: 1, range: <!>[1]}}\n", "is a list of 1, allowed: a list of 2"},
    {HEAD "parameters: {p: {value: 1, range: [0, <!>x]}}\n", "'x' is not a finite number"},
    {HEAD "parameters: {<!>gestural_rate: {value: 1, range: [0, 1]}}\n", "is reserved"},
    {HEAD "parameters: {<!>1p: {value: 1, range: [0, 1]}}\n", "name '1p' is not legal"},
    {"ergotic: 1\nsections: {a: {rate: <!>audo}}\n",
     "unknown rate 'audo' of section 'a'; did you mean 'audio'?"},
    {"ergotic: 1\nsections: {a: {rate: {divisor: <!>0}}}\n", "allowed: 1...4096 audio frames"},
    {"ergotic: 1\nsections: {a: {rate: {divisor: <!>1.5}}}\n", "'1.5' is not a whole number"},
    {"ergotic: 1\nsections: {a: {rate: {<!>multiple: 2}}}\n", "unknown key 'multiple'"},
    {"ergotic: 1\nsections: {a: {pose: {position: <!>[0, 0]}}}\n", "a list of 3 numbers"},
    {"ergotic: 1\nsections: {a: {gravity: <!>$g}}\n", "cannot follow a parameter"},
    {"ergotic: 1\nsections: {a: {}, <!>a: {}}\n", "key 'a' of 'sections' comes twice"},
    {"ergotic: 1\nsections: {<!>[a]: {}}\n", "a key of 'sections' is a list"},
};
const BadText kMats[] = {
    {HEAD "mats: {<!>m: {mass: 1}}\n", "missing key 'type' of module 'm'"},
    {HEAD "mats: {m: {type: <!>mas, mass: 1}}\n",
     "unknown type 'mas' of module 'm'; did you mean 'mass'?"},
    {HEAD "mats: {<!>m: {type: mass}}\n", "missing key 'mass' of module 'm'"},
    {HEAD "mats: {m: {type: mass, <!>mss: 1}}\n",
     "unknown key 'mss' of module 'm'; did you mean 'mass'?"},
    {HEAD "mats: {m: {type: mass, mass: <!>-1}}\n", "= -1 kg is out of range, allowed: > 0 kg"},
    {HEAD "mats: {m: {type: mass, mass: <!>0}}\n", "allowed: > 0 kg"},
    {HEAD "mats: {m: {type: mass, mass: <!>1e999}}\n", "'1e999' is not a finite number"},
    {HEAD "mats: {m: {type: mass, mass: <!>.inf}}\n", "'.inf' is not a finite number"},
    {HEAD "mats: {m: {type: mass, mass: <!>inf}}\n", "'inf' is not a finite number"},
    {HEAD "mats: {m: {type: mass, mass: <!>0x10}}\n", "'0x10' is not a finite number"},
    {HEAD "mats: {m: {type: mass, mass: <!>1 kg}}\n", "'1 kg' is not a finite number"},
    {HEAD "mats: {m: {type: mass, <!>mass: }}\n", "is empty, allowed: a single value"},
    {HEAD "mats:\n  m:\n    type: mass\n    mass: 1\n    x: <!>nan\n",
     "'nan' is not a finite number"},
    {HEAD "mats: {m: {type: mass, mass: 1, at: <!>[0, 0, 0]}}\n",
     "is a list of 3, allowed: a list of 2"},
    {HEAD "mats: {m: {type: mass, mass: 1, at: <!>0}}\n",
     "is a single value, allowed: a list of 2"},
    {HEAD "mats: {m: {type: ground, <!>mass: 1}}\n", "unknown key 'mass' of module 'm'"},
    {HEAD "mats: {c: {type: cell, mass: 1, stiffness: <!>-2}}\n",
     "= -2 N/m is out of range, allowed: >= 0 N/m"},
    {HEAD "mats: {m: {type: mass, mass: 1, section: <!>b}}\n", "unknown section 'b'"},
    {TWO_RATES "mats: {<!>m: {type: mass, mass: 1}}\n",
     "missing key 'section' of module 'm', allowed: a, h"},
    {TWO_RATES "mats: {k: {type: slice, section: <!>a}}\n", "in a section that is not gestural"},
    {HEAD "mats: {<!>k: {type: slice}}\n", "in a section that is not gestural"},
    {HEAD "mats: {<!>s@1: {type: mass, mass: 1}}\n", "name 's@1' is not legal"},
    {HEAD "mats: {m: {type: ground}, <!>m: {type: ground}}\n", "key 'm' of 'mats' comes twice"},
    {HEAD "mats: {m: <!>1}\n", "module 'm' is a single value, allowed: a map"},
    {PARAMETER "mats: {m: {type: mass, mass: <!>$q}}\n", "unknown parameter 'q'"},
    {PARAMETER "mats: {m: {type: mass, mass: <!>$p}}\n",
     "(where p = -1) = -1 kg is out of range, allowed: > 0 kg"},
    {PARAMETER "mats: {m: {type: mass, mass: <!>2+$p}}\n",
     "allowed: a number, $name or number*$name"},
    {PARAMETER "mats: {m: {type: mass, mass: <!>x*$p}}\n",
     "allowed: a number, $name or number*$name"},
    {PARAMETER "mats: {m: {type: mass, mass: 1, x: <!>$p}}\n", "cannot follow a parameter"},
};
#define GENERATOR HEAD "generators:\n  - {name: s, mass: 1, to: [1, 0], "
const BadText kGenerators[] = {
    {HEAD "generators: <!>{}\n", "'generators' is not a list"},
    {HEAD "generators:\n  - <!>{name: s}\n", "missing key 'type' of generator"},
    {HEAD "generators:\n  - <!>{type: string, masses: 1}\n", "missing key 'name' of generator"},
    {GENERATOR "type: <!>net}\n", "unknown type 'net' of generator; known: string, mesh, chaplet"},
    {GENERATOR "type: string, masses: <!>0, stiffness: 1}\n", "allowed: 1...1999998"},
    {GENERATOR "type: string, masses: <!>99999999999, stiffness: 1}\n", "allowed: 1...1999998"},
    {GENERATOR "type: string, masses: 3, <!>stiffness: 1, frequency: 1}\n",
     "has both 'stiffness' and 'frequency'"},
    {HEAD "generators:\n  - <!>{type: string, name: s, masses: 3, mass: 1}\n",
     "has neither 'stiffness'"},
    {GENERATOR "type: string, masses: 3, frequency: <!>0}\n", "above 0...24000 Hz"},
    {GENERATOR "type: string, masses: 3, frequency: <!>$f}\n", "cannot follow a parameter"},
    {GENERATOR "type: string, masses: 3, stiffness: 1, pluck: {at: <!>1, height: 1}}\n",
     "allowed: 0.001...0.999"},
    {HEAD "generators:\n  - <!>{type: string, name: s, mass: 1, masses: 3, stiffness: 1}\n",
     "missing key 'to'"},
    {HEAD "mats: {s.2: {type: ground}}\ngenerators:\n"
          "  - {type: string, name: <!>s, masses: 3, mass: 1, stiffness: 1, to: [1, 0]}\n",
     "module 's.2' is defined twice, first in line 3"},
    {HEAD
     "generators:\n  - {type: string, name: s, masses: 10, mass: 1, stiffness: 1, to: [1, 0]}\n"
     "  - {type: string, name: <!>t, masses: 1999998, mass: 1, stiffness: 1, to: [1, 0]}\n",
     "would have 2000012 modules, allowed: at most 2000000"},
    {SLICES "generators:\n  - {type: chaplet, name: c, from: k, mass: 1, section: <!>x}\n",
     "unknown section 'x'"},
    {SLICES "generators:\n  - <!>{type: chaplet, name: c, from: k, mass: 1}\n",
     "allowed: scalar sections with rate: audio"},
    {HEAD "generators:\n  - {type: chaplet, name: c, from: <!>k, mass: 1}\n", "unknown module 'k'"},
};
#define LINK TWO_MASSES "lias: {l: {"
#define CLIPPED LINK "type: clipped_cubic, between: [m, n], stiffness: 1, "
const BadText kLias[] = {
    {CLIPPED "nonlinearity: <!>-1, stiffness_limit: 2}}\n",
     "= -1 N/m^3 is out of range, allowed: >= 0"},
    {PARAMETER
     "mats: {m: {type: mass, mass: 1}, n: {type: mass, mass: 1}}\nlias: {l: {type: cubic_contact, "
     "between: [m, n], stiffness: 1, nonlinearity: 1, stiffness_limit: <!>2*$q}}\n",
     "unknown parameter 'q'"},
    {HEAD "parameters: {p: {value: 1, range: [1, 2]}}\nmats: {m: {type: mass, mass: 1}, n: {type: "
          "mass, mass: 1}}\n"
          "lias: {l: {type: cubic_contact, between: [m, n], stiffness: 1, nonlinearity: <!>$p, "
          "stiffness_limit: 2}}\n",
     "is a parameter, allowed in a clipped law: a number"},
    {LINK "type: <!>sprng, between: [m, n], stiffness: 1}}\n", "did you mean 'spring'?"},
    {TWO_MASSES "lias: {<!>l: {type: spring, stiffness: 1}}\n",
     "missing key 'between' of link 'l'"},
    {LINK "type: spring, between: <!>[m], stiffness: 1}}\n", "allowed: [lower, upper]"},
    {LINK "type: spring, between: [m, <!>o], stiffness: 1}}\n", "unknown module 'o'"},
    {LINK "type: spring, between: <!>[m, m], stiffness: 1}}\n", "joins module 'm' to itself"},
    {LINK "type: spring, between: [m, <!>[n]], stiffness: 1}}\n", "an end of link 'l' is a list"},
    {LINK "type: contact, between: [m, n], stiffness: <!>-1}}\n", "= -1 N/m is out of range"},
    {TWO_MASSES "lias: {<!>l: {type: damper, between: [m, n]}}\n",
     "missing key 'damping' of link 'l'"},
    {LINK "type: damper, between: [m, n], damping: 1, <!>stiffness: 1}}\n",
     "unknown key 'stiffness'"},
    {LINK "type: contact, between: [m, n], stiffness: 1, <!>rest_length: 1}}\n",
     "unknown key 'rest_length'"},
    {LINK "type: pluck, between: [m, n], stiffness: 1, width: <!>0}}\n",
     "= 0 m is out of range, allowed: > 0 m"},
    {LINK "type: bow, between: [m, n], damping: 1, width: <!>0}}\n", "= 0 m/s is out of range"},
    {LINK "type: bow, between: [m, n], damping: 1, width: 1, <!>threshold: 1}}\n",
     "unknown key 'threshold'"},
    {LINK "type: bow, between: [m, n], table: <!>[[0, 1]]}}\n", "allowed: 2...4096 pairs"},
    {LINK "type: bow, between: [m, n], table: [[0, 1], <!>[0, 2]]}}\n", "allowed: > 0"},
    {LINK "type: bow, between: [m, n], table: [[0, 1], <!>[0]]}}\n", "is not a pair of numbers"},
    {LINK "type: bow, between: [m, n], table: [[0, 1], [1, <!>x]]}}\n",
     "'x' is not a finite number"},
    {LINK "type: bow, between: [m, n], table: [[0, 1], [1, 1]], <!>width: 1}}\n",
     "unknown key 'width'"},
    {STRING "lias: {<!>s.link.0: {type: spring, between: [s.0, s.1], stiffness: 1}}\n",
     "link 's.link.0' is defined twice, first in line 3"},
};
const BadText kAudio[] = {
    {SLICES "ports: {p: {mat: <!>m, slice: 0}}\n", "allowed: modules of type slice"},
    {SLICES "ports: {p: {mat: k, slice: <!>64}}\n", "allowed: 0...63"},
    {SLICES "ports: {p: {mat: k, slice: <!>-1}}\n", "allowed: 0...63"},
    {SLICES "ports: {p: {mat: k, slice: 0}, <!>q: {mat: l, slice: 0}}\n",
     "is on slice 0, which port 'p' has"},
    {SLICES "ports: {p: {mat: k, slice: 0}, <!>q: {mat: k, slice: 1}}\n",
     "port 'q' moves module 'k' along x, which port 'p' does"},
    {SLICES "ports: {p: {mat: k, axis: <!>y, slice: 0}}\n", "unknown axis 'y' of port 'p'"},
    {SLICES "ports: {p: {mat: k, slice: 0, position_scale: <!>0}}\n", "allowed: 1e-06...1000000"},
    {SLICES "ports: {p: {mat: k, slice: 0, force_scale: <!>-1}}\n", "allowed: 0...1000000"},
    {TWO_MASSES "inputs: {i: {mat: m, quantity: <!>position, channel: 1}}\n",
     "allowed: modules of type driven"},
    {TWO_MASSES "inputs: {i: {mat: m, quantity: <!>velocity, channel: 1}}\n",
     "known: position, force"},
    {TWO_MASSES "inputs: {i: {mat: m, quantity: force, channel: <!>0}}\n", "allowed: 1...64"},
    {STRING "inputs: {i: {mat: s@0.3, quantity: <!>position, channel: 1}}\n",
     "sets the position of module 's@0.3', allowed: modules of type driven"},
    {HEAD "mats: {d: {type: driven}}\ninputs: {i: {mat: d, quantity: position, channel: 1},\n"
          "  <!>j: {mat: d, quantity: position, channel: 2}}\n",
     "which input 'i' does"},
    {TWO_MASSES "outputs: {o: {at: m, quantity: force, channel: <!>65}}\n", "allowed: 1...64"},
    {TWO_MASSES "outputs: {o: {at: <!>mm, quantity: force, channel: 1}}\n",
     "unknown module 'mm'; did you mean 'm'?"},
    {TWO_MASSES "outputs: {<!>o: {at: m, channel: 1}}\n", "missing key 'quantity' of output 'o'"},
    {TWO_MASSES "outputs: {o: {at: m, quantity: force, channel: 1, gain: <!>loud}}\n",
     "'loud' is not a finite number"},
    {STRING "outputs: {o: {at: <!>t@0.5, quantity: force, channel: 1}}\n",
     "unknown string or mesh 't'; did you mean 's'?"},
    {STRING "outputs: {o: {at: <!>s@1.5, quantity: force, channel: 1}}\n",
     "= 1.5 is out of range, allowed: 0...1"},
    {STRING "outputs: {o: {at: <!>s@, quantity: force, channel: 1}}\n",
     "'' is not a finite number"},
    {STRING "outputs: {o: {at: <!>s.5, quantity: force, channel: 1}}\n", "unknown module 's.5'"},
};
TEST(YamlErrorsTest, WhatIsWrongIsRefusedAtItsPlace) {
  expectAllRefused(kTop, "bad.yaml");
  expectAllRefused(kSections, "bad.yaml");
  expectAllRefused(kMats, "bad.yaml");
  expectAllRefused(kGenerators, "bad.yaml");
  expectAllRefused(kLias, "bad.yaml");
  expectAllRefused(kAudio, "bad.yaml");
}

TEST(YamlErrorsTest, NulByteIsRefusedAtItsPlace) {
  const std::string text = std::string("ergotic: 1\nname: a") + '\0' + "b\n";
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "nul.yaml"); }),
              "nul.yaml:2:8: error: control character 0x00 in a text, allowed: tab and line "
              "ends only");
}

TEST(YamlErrorsTest, DeepNestingIsAnErrorNotACrash) {
  for (const char* unit : {"[", "{a: ", "- ", "? "}) {
    std::string text = "ergotic: 1\nname: \n  ";
    for (int i = 0; i < 100000; ++i) {
      text += unit;
    }
    EXPECT_THROW(readYaml(text, "deep.yaml"), TextError) << unit;
  }
}

TEST(YamlErrorsTest, TooLongATextIsRefusedUnread) {
  const std::string text((std::size_t{64} << 20U) + 1, '#');
  EXPECT_THROW(readYaml(text, "long.yaml"), TextError);
}

TEST(YamlErrorsTest, TablesSharedByAliasesAreLimitedInAll) {
  std::string text = TWO_MASSES "lias:\n  l: {type: bow, between: [m, n], table: &t [";
  for (int i = 0; i < 4096; ++i) {
    text += "[" + std::to_string(i) + ", 0],";
  }
  text += "]}\n";
  for (int i = 0; i < 256; ++i) {
    text += "  l" + std::to_string(i) + ": {type: bow, between: [m, n], table: *t}\n";
  }
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, "tables.yaml"); }),
              AllOf(StartsWith("tables.yaml:261:"), HasSubstr("more than 1048576 points")));
}

TEST(YamlErrorsTest, EveryTruncationOfASceneIsReadOrRefusedWithItsPlace) {
  const std::string whole = TWO_MASSES
      "lias:\n  l: {type: spring, between: [m, n], stiffness: 1}\n"
      "outputs:\n  o: {at: m, quantity: force, channel: 1}\n";
  int refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      readYaml(whole.substr(0, size), "cut.yaml");
    } catch (const TextError& e) {
      ++refused;
      EXPECT_GE(e.line(), 1);
      EXPECT_GE(e.column(), 1);
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size()) / 2);
}

}  // namespace
}  // namespace ergotic::scene
