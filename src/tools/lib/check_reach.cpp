// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <CLI/CLI.hpp>

#include "at.hpp"
#include "ergotic/advice/reach.hpp"
#include "ergotic/tgr/players/scene_map.hpp"
#include "ergotic/tgr/rig.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "physics/note.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

using physics::Meeting;
using physics::PortReach;
using physics::shortly;

constexpr double kSamePlace = 1e-9;     // m of the hand: met together
constexpr std::size_t kMaxPushed = 4;   // the nearest of what is pushed on to
constexpr std::size_t kMaxCarried = 8;  // of names; a slice may carry hundreds

/// Metres of the port's own hand as those of an end-effector's coordinate.
void scaleBy(double scale, PortReach& reach) {
  const auto scaled = [scale](double& m) { m *= scale; };
  for (Meeting& meeting : reach.meetings) {
    scaled(meeting.at_m);
    std::for_each(meeting.ends_m.begin(), meeting.ends_m.end(), scaled);
    for (physics::PushedMeeting& one : meeting.then) {
      scaled(one.at_m);
    }
  }
  for (physics::Guide& guide : reach.guides) {
    guide.per_m /= scale;
    std::for_each(guide.ends_m.begin(), guide.ends_m.end(), scaled);
  }
}

std::string millimetres(double m) {
  return shortly(1e3 * m) + " mm";
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxCarried); ++i) {
    list += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kMaxCarried
             ? list + " and " + std::to_string(names.size() - kMaxCarried) + " more"
             : list;
}

/// Lists everything that the slice meets at the position of the first contact.
std::string firstText(const PortReach& reach, const Meeting& first, double stroke_m) {
  std::vector<std::string> things;
  const physics::PushedMeeting* then = nullptr;
  std::string pressed;
  for (const Meeting& meeting : reach.meetings) {
    if (!meeting.touches && !meeting.is_missed &&
        std::abs(meeting.at_m - first.at_m) <= kSamePlace) {
      things.push_back(meeting.thing + " (" + meeting.law + ")");
      if (then == nullptr && !meeting.then.empty() &&
          std::abs(meeting.then.front().at_m) <= stroke_m) {
        then = &meeting.then.front();
      }
      if (!meeting.presses.empty()) {
        const physics::Rubbing& rub = meeting.presses.front();
        pressed = ", which presses " + rub.thing + " on " + rub.on;
      }
    }
  }
  std::string text = listed(things) + " at " + millimetres(first.at_m) + pressed;
  if (then != nullptr) {
    text += ", pushed on to " + then->thing + " (" + then->law + ") at " + millimetres(then->at_m);
  }
  return text;
}

/// Describes the effect of a slice that meets nothing by distance.
std::string otherwiseText(const PortReach& reach, double stroke_m) {
  if (!reach.guides.empty()) {
    return "nothing (it leads " + reach.guides.front().point + " along " +
           reach.guides.front().along + ")";
  }
  for (const Meeting& meeting : reach.meetings) {
    if (!meeting.waits_for.empty()) {
      return meeting.thing + " (" + meeting.law + ") while " + meeting.waits_for + " presses";
    }
    if (meeting.touches) {
      return meeting.thing + " (" + meeting.law + "), which it touches at rest";
    }
  }
  if (!reach.holds.empty()) {
    return "nothing (it holds " + reach.holds.front().thing + " by a spring)";
  }
  if (reach.meetings.empty()) {
    return "nothing (no link leads to anything)";
  }
  return reach.meetings.front().is_missed
             ? "nothing on its way"
             : "nothing within its stroke of +-" + millimetres(stroke_m);
}

void addPlace(double m, double stroke_m, Json& entry) {
  entry["at_m"] = m;
  if (std::isfinite(stroke_m)) {
    entry["of_stroke"] = std::abs(m) / stroke_m;
  }
}

Json meetingReport(const Meeting& meeting, const std::string& module, double stroke_m) {
  Json entry = {{"thing", meeting.thing}, {"law", meeting.law}, {"link", meeting.link}};
  if (meeting.by != module) {
    entry["by"] = meeting.by;
  }
  if (meeting.touches) {
    entry["touches"] = "at rest";
  } else if (!meeting.waits_for.empty()) {
    entry["while_it_presses"] = meeting.waits_for;
  } else if (meeting.is_missed) {
    entry["never"] = "passes by";
    entry["missed_by_m"] = meeting.missed_by_m;
  } else {
    addPlace(meeting.at_m, stroke_m, entry);
  }
  if (!meeting.ends_m.empty()) {
    entry["until_m"] = meeting.ends_m.size() == 1 ? Json(meeting.ends_m[0]) : Json(meeting.ends_m);
  }
  if (!meeting.presses.empty()) {
    std::vector<std::string> pressed;
    for (const physics::Rubbing& one : meeting.presses) {
      pressed.push_back(one.link);
    }
    entry["presses"] = listed(pressed);
  }
  Json then = Json::array();
  for (const physics::PushedMeeting& one : meeting.then) {
    if (then.size() < kMaxPushed && std::abs(one.at_m) <= stroke_m) {
      then.push_back({{"thing", one.thing}, {"law", one.law}, {"link", one.link}});
      addPlace(one.at_m, stroke_m, then.back());
    }
  }
  if (!then.empty()) {
    entry["pushed_on"] = std::move(then);
  }
  return entry;
}

/// Adds what is met within the stroke, and apart from it what is not.
void addMeetings(const PortReach& reach, const std::string& module, double stroke_m, Json& entry) {
  Json within = Json::array();
  Json beyond = Json::array();
  for (const Meeting& meeting : reach.meetings) {
    const bool is_within = meeting.touches || !meeting.waits_for.empty() ||
                           (!meeting.is_missed && std::abs(meeting.at_m) <= stroke_m);
    (is_within ? within : beyond).push_back(meetingReport(meeting, module, stroke_m));
  }
  if (!within.empty()) {
    entry["meets"] = std::move(within);
  }
  if (!beyond.empty()) {
    entry["not_within_its_stroke"] = std::move(beyond);
  }
}

void addOthers(const PortReach& reach, Json& entry) {
  if (!reach.holds.empty()) {
    Json holds = Json::array();
    for (const physics::Hold& hold : reach.holds) {
      holds.push_back({{"thing", hold.thing},
                       {"link", hold.link},
                       {"n_per_m", hold.stiffness},
                       {"goes_with_it", hold.follows}});
    }
    entry["holds"] = std::move(holds);
  }
  if (!reach.guides.empty()) {
    Json guides = Json::array();
    for (const physics::Guide& guide : reach.guides) {
      guides.push_back({{"point", guide.point},
                        {"along", guide.along},
                        {"fraction", guide.fraction},
                        {"per_m", guide.per_m},
                        {"until_m", guide.ends_m}});
    }
    entry["leads"] = std::move(guides);
  }
  if (!reach.carries.empty()) {
    entry["carries"] = listed(reach.carries);
  }
}

/// Displacements of each slice by notes, from the map beside the scene; empty without a map.
std::map<int, std::set<double>> movedByNotes(const scene::Scene& scene) {
  std::map<int, std::set<double>> moved;
  const std::string file = tgr::mapBeside(scene.file);
  if (file.empty()) {
    return moved;
  }
  for (const tgr::KeyLine& line : tgr::readPlayMapFile(file).keys) {
    const auto notes = static_cast<std::size_t>(line.last_note - line.first_note + 1);
    for (const tgr::KeyMove& move : line.moves) {
      for (std::size_t i = 0; move.end_effector.empty() && i < notes; ++i) {
        std::set<double>& places = moved[move.handOf(i).second];
        places.insert(move.toOf(i));
        if (move.legato == tgr::Legato::kTurns) {
          places.insert(move.from_m);
        }
      }
    }
  }
  return moved;
}

/// Notes that end before anything is met that way.
bool fallShort(const std::set<double>& notes, const PortReach& reach) {
  const auto isMet = [&](double to_m) {
    return std::any_of(reach.meetings.begin(), reach.meetings.end(), [to_m](const Meeting& m) {
      return m.touches || !m.waits_for.empty() ||
             (!m.is_missed && m.at_m * to_m >= 0.0 && std::abs(m.at_m) <= std::abs(to_m));
    });
  };
  return !reach.meetings.empty() && reach.guides.empty() && reach.holds.empty() &&
         std::none_of(notes.begin(), notes.end(), isMet);
}

Json portReport(const scene::Scene& scene, const PortReach& reach, double stroke_m) {
  const scene::Port& port = scene.ports[at(reach.port)];
  const std::string module = scene.mats[at(port.mat)].name.str();
  Json entry = {{"port", port.name}, {"module", module}};
  const Meeting* const first = reach.first(stroke_m);
  entry["meets_first"] =
      first != nullptr ? firstText(reach, *first, stroke_m) : otherwiseText(reach, stroke_m);
  addMeetings(reach, module, stroke_m, entry);
  addOthers(reach, entry);
  return entry;
}

Json slicesOf(const scene::Scene& scene, const std::vector<PortReach>& found, double stroke_m) {
  const std::map<int, std::set<double>> notes = movedByNotes(scene);
  Json report = Json::array();
  for (const PortReach& reach : found) {
    const int slice = scene.ports[at(reach.port)].slice;
    Json entry = {{"slice", slice}};
    entry.update(portReport(scene, reach, stroke_m));
    const auto moved = notes.find(slice);
    if (moved != notes.end()) {
      entry["notes_move_it_to_m"] = std::vector<double>(moved->second.begin(), moved->second.end());
      if (fallShort(moved->second, reach)) {
        entry["notes_meet"] = "nothing";
      }
    }
    report.push_back(std::move(entry));
  }
  return report;
}

Json coordinatesOf(const scene::Scene& scene,
                   const tgr::EndEffectors& end_effectors,
                   std::vector<std::string>& notes) {
  Json report = Json::array();
  for (const tgr::EndEffectorConfig& config : end_effectors.list) {
    std::vector<int> ports;
    for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
      if (std::find(config.ports.begin(), config.ports.end(), scene.ports[at(p)].name) !=
          config.ports.end()) {
        ports.push_back(p);
      }
    }
    for (PortReach& reach : physics::reachOf(scene, ports, true, notes)) {
      scaleBy(config.position_scale, reach);
      Json entry = {{"end_effector", config.name}};
      entry.update(portReport(scene, reach, std::numeric_limits<double>::infinity()));
      report.push_back(std::move(entry));
    }
  }
  return report;
}

std::vector<int> portsBut(const scene::Scene& scene, const std::vector<int>& taken) {
  std::vector<int> ports = physics::portsOfSlices(scene);
  ports.erase(std::remove_if(ports.begin(), ports.end(),
                             [&taken](int port) {
                               return std::find(taken.begin(), taken.end(), port) != taken.end();
                             }),
              ports.end());
  std::sort(ports.begin(), ports.end(),
            [&scene](int a, int b) { return scene.ports[at(a)].slice < scene.ports[at(b)].slice; });
  return ports;
}

}  // namespace

ReachChoice::ReachChoice() : stroke_m(tgr::VirtualSliceConfig{}.stop) {}

void addOptions(CLI::App& app, ReachChoice& choice) {
  app.add_flag("--reach", choice.is_wanted,
               "say what each slice meets and where in its stroke, and nothing else");
  app.add_option("--device-stroke", choice.stroke_m,
                 "of a slice to either side of its rest, m (default: 0.03)")
      ->check(CLI::PositiveNumber);
}

void checkReach(const scene::Scene& scene,
                const tgr::EndEffectors& end_effectors,
                const ReachChoice& choice,
                bool json) {
  std::vector<std::string> notes;
  const std::vector<int> ports = portsBut(scene, tgr::takenPorts(scene, end_effectors));
  const std::vector<PortReach> found = physics::reachOf(scene, ports, true, notes);
  Json report = {{"scene", scene.name},
                 {"stroke_m", {-choice.stroke_m, choice.stroke_m}},
                 {"slices", slicesOf(scene, found, choice.stroke_m)}};
  if (!end_effectors.list.empty()) {
    report["coordinates"] = coordinatesOf(scene, end_effectors, notes);
  }
  report["warnings"] = physics::reachWarnings(scene, found, choice.stroke_m);
  report["notes"] = notes;
  tell(report, json);
}

std::vector<std::string> reachFindings(const scene::Scene& scene,
                                       const std::vector<int>& taken_ports,
                                       const ReachChoice& choice) {
  std::vector<std::string> notes;
  const std::vector<PortReach> found =
      physics::reachOf(scene, portsBut(scene, taken_ports), false, notes);
  return physics::reachWarnings(scene, found, choice.stroke_m);
}

}  // namespace ergotic::tools
