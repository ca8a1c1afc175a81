// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/groups.hpp"

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// One mass in each of several sections of some divisors; 0: gestural. Those of the builder are
/// empty.
class Sections {
 public:
  explicit Sections(const std::vector<int>& divisors) {
    for (const int divisor : divisors) {
      scene::Section section = b.scene.sections[0];
      section.gestural = divisor == 0;
      section.divisor = divisor == 0 ? 1 : divisor;
      section.name = std::string(1, static_cast<char>('a' + masses_));
      b.scene.sections.push_back(section);
      b.mass(1.0, 0.0, 0.0, 2 + masses_++);
    }
  }

  void energy_stable(int a, int other) {
    b.scene.lias[at(b.link(scene::LiaType::kContact, a, other, 1.0))].scheme =
        scene::Scheme::kEnergyStable;
  }

  /// A string of two masses in section b, and a point on it that module 0 leads: of section a.
  void leadPointOfB() {
    const int first = b.mass(1.0, 0.0, 0.0, 3);
    b.mass(1.0, 0.0, 0.0, 3);
    b.point(b.grid(first, 2), 0.0);
    b.scene.connections[0].along.guide = 0;
  }

  Groups split(const Rates& rates = kRates) {
    layout = makeLayout(b.scene, rates);
    return makeGroups(b.scene, rates, layout);
  }

  /// Names of what runs together, and after a colon of what is held.
  std::string told(const Rates& rates = kRates) {
    const Groups groups = split(rates);
    std::vector<std::string> all;
    for (const Group& group : groups.running) {
      all.push_back(namesOf(group));
    }
    std::sort(all.begin(), all.end());
    std::string text;
    for (const std::string& names : all) {
      text += names + ' ';
    }
    return text + ": " + namesOf(groups.held);
  }

  SceneBuilder b;
  Layout layout;

 private:
  std::string namesOf(const Group& group) const {
    std::string names;
    for (const int section : group.sections) {
      names += b.scene.sections[at(section)].name;
    }
    return names;
  }

  int masses_ = 0;
};

TEST(GroupsTest, LinksJoinWhatRunsAndNothingToWhatIsHeld) {
  EXPECT_EQ(Sections({1, 1, 2, 0, 28}).told(), "a b c : de");
  Sections sections({1, 1, 2, 1, 0});
  sections.b.spring(0, 1, 1.0);
  sections.b.spring(2, 1, 1.0);
  sections.b.spring(3, 4, 1.0);
  sections.energy_stable(0, 4);
  EXPECT_EQ(sections.told(), "abc d : e");
  EXPECT_EQ(sections.told({44100.0, 1}), "abcde : ") << "nothing is held where a tick is one frame";
}

TEST(GroupsTest, WhatIsHeardBetweenTwoSectionsOrFollowsAudioJoinsThem) {
  Sections heard({1, 1, 1});
  heard.b.hear(0);
  heard.b.scene.outputs[0].point.next = 2;
  EXPECT_EQ(heard.told(), "ac b : ");
  Sections followers({1, 1, 1});
  followers.b.scene.audio_parameters.push_back({"audio", 0, 1.0, {}});
  for (const int m : {1, 2}) {
    Lia& lia =
        followers.b.scene.lias[at(followers.b.spring(m, followers.b.ground(0.0, 2 + m), 1.0))];
    lia.stiffness.audio = 0;
  }
  EXPECT_EQ(followers.told(), "a bc : ");
}

TEST(GroupsTest, EachGroupSeesHeldModulesInSlotsOfItsOwn) {
  Sections sections({1, 1, 0});
  sections.b.spring(0, 2, 1.0);
  sections.b.spring(2, 0, 1.0);
  sections.b.spring(1, 2, 1.0);
  const Groups groups = sections.split();
  const int held = sections.layout.slot_of_mat[2];
  std::vector<int> slots;
  for (const Group& group : groups.running) {
    ASSERT_EQ(group.proxies.size(), 1U) << "one for both links";
    EXPECT_EQ(group.proxies[0].of, held);
    slots.push_back(group.proxies[0].slot);
  }
  EXPECT_GE(std::abs(slots[0] - slots[1]), 16) << "on one cache line";
  for (const LinkRun& run : sections.layout.runs) {
    const int seen = run.section_a == 4 ? run.ends[0].a : run.ends[0].b;
    EXPECT_EQ(seen, groups.running[at(run.group)].proxies[0].slot);
  }
}

TEST(GroupsTest, PlacesRunWithWhatLeadsThem) {
  for (const bool is_held : {false, true}) {
    Sections sections({1, is_held ? 0 : 1, 0});
    sections.leadPointOfB();
    EXPECT_EQ(sections.told(), "ab : c") << "even if it would be held otherwise";
    sections.b.scene.connections[0].along.guide = 2;
    EXPECT_EQ(sections.told(), is_held ? "a : bc" : "a b : c");
  }
}

TEST(GroupsTest, EnergyStableLinksThatEndTheirStepsTogetherRunTogether) {
  Sections sections({1, 0, 0});
  sections.leadPointOfB();
  EXPECT_EQ(sections.told(), "ab : c");
  sections.energy_stable(1, 2);
  EXPECT_EQ(sections.told(), "abc : ") << "what is linked to one that runs now";
}

TEST(GroupsTest, DescriptionTellsWhatThreadsCanShare) {
  Sections sections({1, 1, 0});
  std::vector<std::string> lines = describeGroups(sections.b.scene, sections.split(), 2);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "held while the others run: 'c', 1 modules");
  EXPECT_EQ(lines[1], "stepped together: 'a', 1 modules");
  EXPECT_EQ(lines[3], "threads: 2 for 2 independent groups");
  sections.b.spring(0, 1, 1.0);
  const Groups groups = Sections({7, 1, 1}).split();
  EXPECT_EQ(groups.running[0].cost, 14) << "the expensive ones come first";
  EXPECT_EQ(groups.running[2].cost, 2);
  lines = describeGroups(sections.b.scene, sections.split(), 1);
  EXPECT_EQ(lines.back(), "threads: 1, as all that runs is one group; a section is never divided");
}

}  // namespace
}  // namespace ergotic::physics
