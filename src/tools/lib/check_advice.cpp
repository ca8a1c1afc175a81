// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_advice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <variant>

#include <CLI/CLI.hpp>

#include "ergotic/advice/luthier.hpp"
#include "ergotic/exception.hpp"
#include "physics/note.hpp"
#include "scene/names.hpp"
#include "scene/text/quantity.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

using physics::HeardBody;
using physics::shortly;
using physics::Wish;

constexpr double kOffCents = 2.0;  // that are worth a word
constexpr double kLongS = 60.0;    // of T60
constexpr double kMaxOfLoss = 0.5;

/// Formats a number that is to be written into a scene: exact to a hundredth of a cent.
std::string exactly(double value) {
  std::ostringstream text;
  text.precision(7);
  text << value;
  return text.str();
}

Wish readWish(const std::string& text) {
  const auto refuse = [&](const std::string& reason) {
    throw Exception("--wish " + scene::quoted(text) + ": " + reason +
                    ", allowed: 'pitch BODY 441 Hz', 't60 BODY 3 s', 'margin 0.2'");
  };
  std::istringstream words(text);
  std::string kind;
  words >> kind;
  Wish wish;
  std::string unit;
  if (kind == "margin") {
    wish.kind = Wish::Kind::kMargin;
  } else if (kind == "pitch" || kind == "t60") {
    wish.kind = kind == "pitch" ? Wish::Kind::kPitch : Wish::Kind::kDecay;
    unit = kind == "pitch" ? "Hz" : "s";
    words >> wish.body;
  } else {
    refuse("nothing can be wished of " + scene::quoted(kind));
  }
  std::string amount;
  std::getline(words >> std::ws, amount);
  const auto read = scene::parseQuantity(amount, unit);
  if (const auto* const none = std::get_if<scene::NoQuantity>(&read)) {
    refuse(scene::quoted(amount) + none->reason);
  }
  wish.value = std::get<double>(read);
  const bool is_margin = wish.kind == Wish::Kind::kMargin;
  if (!(wish.value > 0.0) || (is_margin && wish.value >= 1.0)) {
    refuse(amount + " is not " + (is_margin ? "between 0 and 1" : "above 0"));
  }
  return wish;
}

std::string inTuneWith(const HeardBody& body,
                       const scene::Scene& scene,
                       const physics::Rates& rates) {
  const Wish wish{Wish::Kind::kPitch, body.name, body.asked_hz};
  for (const physics::Move& move : physics::movesFor(wish, scene, rates)) {
    if (move.to) {
      return "in tune with " + move.parameter + " = " + exactly(*move.to) + ", or ask for ";
    }
  }
  return "ask for ";
}

std::string adviceOnPitch(const HeardBody& body,
                          const scene::Scene& scene,
                          const physics::Rates& rates) {
  const bool is_sharp = body.cents > 0.0;
  std::string text = scene::quoted(body.name) + " sounds " + shortly(std::abs(body.cents)) +
                     " cents " + (is_sharp ? "sharp" : "flat") + " of " + shortly(body.asked_hz) +
                     " Hz: ";
  if (!body.influences.empty()) {
    const physics::Influence& first = body.influences.front();
    if ((first.cents > 0.0) == is_sharp && std::abs(first.cents) >= 0.5) {
      text += scene::quoted(first.link) + " pulls it by about " + shortly(first.cents) + "; ";
    }
  }
  return text + inTuneWith(body, scene, rates) +
         exactly(body.asked_hz * std::exp2(-body.cents / 1200.0)) + " Hz";
}

/// Adds one line of advice for all bodies that it applies to.
void addOfMany(const std::vector<std::string>& names, const std::string& what, Json& advice) {
  if (!names.empty()) {
    const std::string others =
        names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : "";
    advice.push_back(scene::quoted(names.front()) + others + what);
  }
}

Json adviceOn(const physics::HeardBodies& heard,
              const scene::Scene& scene,
              const physics::Rates& rates) {
  Json advice = Json::array();
  std::vector<std::string> endless;
  std::vector<std::string> long_ones;
  for (const physics::AskedPitch& missing : heard.missing) {
    advice.push_back(scene::quoted(missing.body) + " has no mode within a semitone of " +
                     shortly(missing.hz) + " Hz: see check --modes");
  }
  for (const HeardBody& body : heard.bodies) {
    if (std::abs(body.cents) > kOffCents) {
      advice.push_back(adviceOnPitch(body, scene, rates));
    }
    if (std::isinf(body.t60_s)) {
      endless.push_back(body.name);
    } else if (body.t60_s > kLongS) {
      long_ones.push_back(body.name);
    }
    for (const physics::Influence& one : body.influences) {
      if (one.of_loss >= kMaxOfLoss) {
        advice.push_back(scene::quoted(body.name) + " loses " + shortly(100.0 * one.of_loss) +
                         " % through " + scene::quoted(one.link));
      }
    }
  }
  addOfMany(endless, ": rings without end; a t60, or damping of its links, ends it", advice);
  addOfMany(long_ones, ": T60 above a minute", advice);
  return advice.empty() ? Json(
                              "none: what asks for a pitch has it to 2 cents, and rings for less "
                              "than a minute")
                        : advice;
}

Json bodiesReport(const std::vector<HeardBody>& bodies) {
  Json report = Json::array();
  for (const HeardBody& body : bodies) {
    Json influences = Json::array();
    for (const physics::Influence& one : body.influences) {
      influences.push_back(
          {{"link", one.link}, {"cents", one.cents}, {"percent_of_loss", 100.0 * one.of_loss}});
    }
    Json entry = {
        {"body", body.name}, {"asked_hz", body.asked_hz}, {"hz", body.hz}, {"cents", body.cents}};
    entry["t60_s"] = std::isinf(body.t60_s) ? Json("no loss") : Json(body.t60_s);
    entry["pulled_by"] = std::move(influences);
    report.push_back(std::move(entry));
  }
  return report;
}

/// Modules and links, as often as they are stepped, by sections.
Json workReport(const scene::Scene& scene, const physics::Rates& rates) {
  std::map<int, double> steps;
  const auto add = [&](int section) {
    steps[section] +=
        1.0 / physics::divisorOf(scene.sections[static_cast<std::size_t>(section)], rates);
  };
  for (const scene::Mat& mat : scene.mats) {
    add(mat.section);
  }
  for (const scene::Lia& lia : scene.lias) {
    add(scene.mats[static_cast<std::size_t>(lia.a)].section);
  }
  double whole = 0.0;
  for (const auto& [section, work] : steps) {
    whole += work;
  }
  std::vector<std::pair<int, double>> sorted(steps.begin(), steps.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  Json report = Json::array();
  for (const auto& [section, work] : sorted) {
    report.push_back({{"section", scene.sections[static_cast<std::size_t>(section)].name},
                      {"percent", 100.0 * work / whole}});
  }
  return report;
}

Json wishReport(const std::string& text,
                const scene::Scene& scene,
                const physics::Rates& rates,
                const physics::DeviceTraits& device) {
  Json moves = Json::array();
  for (const physics::Move& move : physics::movesFor(readWish(text), scene, rates, device)) {
    Json entry = {{"parameter", move.parameter}};
    entry["to"] = move.to ? Json(*move.to) : Json("not within its range");
    entry["reaches"] = {move.lowest, move.highest};
    moves.push_back(std::move(entry));
  }
  Json report = {{"wish", text}};
  report["parameters"] =
      moves.empty() ? Json("none of the scene changes it: write one where it is decided") : moves;
  return report;
}

}  // namespace

void addOptions(CLI::App& app, AdviceChoice& choice) {
  CLI::Option* const advise = app.add_flag("--advise", choice.is_wanted,
                                           "say what a maker may want to change, and nothing else");
  app.add_option("--wish", choice.wishes,
                 "'pitch BODY HZ', 't60 BODY S' or 'margin M': which parameters do it (repeatable)")
      ->type_name("WISH")
      ->needs(advise);
}

void checkAdvice(const scene::Scene& scene,
                 const physics::Rates& rates,
                 const physics::DeviceTraits& device,
                 const AdviceChoice& choice,
                 bool json) {
  const physics::HeardBodies heard = physics::listenTo(scene, rates);
  Json report = {{"scene", scene.name}, {"bodies", bodiesReport(heard.bodies)}};
  report["advice"] = adviceOn(heard, scene, rates);
  report["work"] = workReport(scene, rates);
  Json wishes = Json::array();
  for (const std::string& wish : choice.wishes) {
    wishes.push_back(wishReport(wish, scene, rates, device));
  }
  report["wishes"] = std::move(wishes);
  tell(report, json);
}

}  // namespace ergotic::tools
