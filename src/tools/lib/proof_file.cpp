// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/proof_file.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "files/read_file.hpp"
#include "scene/laws/law.hpp"
#include "scene/limits.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/sha256.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

constexpr const char* kModules[] = {"mass", "ground", "cell", "driven", "slice", "point"};
constexpr const char* kGeometries[] = {"scalar", "line", "plane", "space"};

Json valueOf(const Scene& scene, const scene::Value& value) {
  if (value.parameter < 0) {
    return value.factor;
  }
  return {{"parameter", scene.parameters[at(value.parameter)].name}, {"times", value.factor}};
}

Json provenParameters(const Scene& scene) {
  Json all = Json::array();
  for (const scene::Parameter& parameter : scene.parameters) {
    all.push_back({{"name", parameter.name}, {"range", {parameter.minimum, parameter.maximum}}});
  }
  return all;
}

/// Those along which it moves, in the frame of the scene; space has them all, however it is turned.
Json axesOf(const scene::Section& section) {
  Json all = Json::array();
  const bool is_space = section.geometry == scene::Geometry::kSpace;
  const Eigen::Matrix3d axes =
      is_space ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(section.pose.linear());
  for (int k = 0; k < dimensionsOf(section.geometry); ++k) {
    all.push_back({axes(0, k), axes(1, k), axes(2, k)});
  }
  return all;
}

/// \param frame  one of audio, in time units
Json provenSections(const Scene& scene, const physics::Rates& rates, double frame) {
  Json all = Json::array();
  const bool is_turned = std::any_of(
      scene.sections.begin(), scene.sections.end(),
      [](const scene::Section& section) { return !section.pose.linear().isIdentity(0.0); });
  for (const scene::Section& section : scene.sections) {
    all.push_back({{"name", section.name},
                   {"divisor", physics::divisorOf(section, rates)},
                   {"step", physics::divisorOf(section, rates) * frame},
                   {"geometry", kGeometries[static_cast<std::size_t>(section.geometry)]},
                   {"medium", valueOf(scene, section.medium)}});
    if (section.modes != scene::kNoModes && section.modes != scene::kAllModes) {
      all.back()["modes"] = "some";
    }
    if (is_turned) {
      all.back()["axes"] = axesOf(section);
    }
  }
  return all;
}

Json moduleOf(const Scene& scene, const scene::Mat& mat) {
  Json module = {{"name", std::string(mat.name)},
                 {"type", kModules[static_cast<std::size_t>(mat.type)]},
                 {"section", mat.section}};
  if (mat.type == scene::MatType::kMass || mat.type == scene::MatType::kCell) {
    module["mass"] = valueOf(scene, mat.mass);
  }
  if (mat.type == scene::MatType::kCell) {
    module["stiffness"] = valueOf(scene, mat.stiffness);
    module["damping"] = valueOf(scene, mat.damping);
    module["matched"] = mat.matched;
  }
  return module;
}

Json provenModules(const Scene& scene) {
  Json all = Json::array();
  for (const scene::Mat& mat : scene.mats) {
    all.push_back(moduleOf(scene, mat));
  }
  return all;
}

Json pointsOf(const Scene& scene, const physics::Proof& proof) {
  Json all = Json::array();
  for (const scene::Connection& point : scene.connections) {
    all.push_back(
        {{"module", point.mat}, {"power", point.power}, {"places", proof.places[all.size()]}});
  }
  for (const scene::Tap& tap : scene.taps) {  // one that stays never brings its power
    all.push_back({{"module", tap.mat},
                   {"power", scene::Connection{}.power},
                   {"places", proof.places[all.size()]}});
  }
  return all;
}

/// What presses friction, and mu where no table says it.
void addFriction(const scene::LiaLaw& law, Json& link) {
  if (!law.pressed_by.empty()) {
    link["normal"] = law.pressed_by.str();
  }
  if (law.table.empty()) {
    link["steady"] = law.steady;
    link["parts"] = Json::array();
    for (const scene::LiaLaw::Fall& fall : law.falls) {
      if (fall.share > 0.0) {
        link["parts"].push_back({fall.share, fall.width});
      }
    }
  }
}

/// What a law has, by the words of scenes.
void addLaw(const Scene& scene, const scene::Lia& lia, Json& link) {
  const scene::Law& law = scene::lawOf(lia.type);
  link["type"] = law.words.items[law.words.count - 1].word;
  for (const scene::LiaField& field : law.fields) {
    link[field.key] = valueOf(scene, scene::memberOf(lia, field.member));
  }
  const bool has_parts = law.tables == scene::LawText::Tables::kParts;
  for (const auto& [key, table] : {std::pair(has_parts ? "elastic" : "table", &lia.law->table),
                                   std::pair("viscous", &lia.law->viscous_table)}) {
    if (!table->empty()) {
      link[key] = {{"points", table->points},
                   {"interpolation", table->smooth ? "monotone" : "linear"}};
    }
  }
  if (law.tables == scene::LawText::Tables::kCoefficient) {
    addFriction(*lia.law, link);
  }
  if (law.has_release) {
    link["release"] = lia.law->release;
  }
  if (lia.law->tipping_point > 0.0) {
    link["tipping_point"] = lia.law->tipping_point;
    link["limit_damping"] = valueOf(scene, lia.law->limit_damping);
  }
  for (const scene::Relaxation& branch : lia.law->relaxations) {
    link["branches"].push_back({valueOf(scene, branch.stiffness), branch.time});
  }
  if (law.kind != scene::Law::Kind::kGap && law.kind != scene::Law::Kind::kFriction) {
    link["rest_length"] = lia.rest_length;
  }
}

Json linkOf(const Scene& scene, const scene::Lia& lia) {
  const bool is_guarded = lia.scheme == scene::Scheme::kGuarded;
  Json link = {{"name", std::string(lia.name)},
               {"scheme", is_guarded ? "guarded" : "explicit"},
               {"between", {lia.a, lia.b}}};
  addLaw(scene, lia, link);
  return link;
}

/// One load, whatever it is stepped as.
Json linkOf(const Scene& scene, const scene::Bend& bend) {
  Json link = {{"name", std::string(bend.name)},
               {"scheme", "explicit"},
               {"type", "bend"},
               {"stiffness", valueOf(scene, bend.stiffness)},
               {"damping", valueOf(scene, bend.damping)},
               {"rest_length", bend.rest_length}};
  for (const scene::Bend::End& end : bend.ends) {
    link["between"].push_back(end.mat);
    link["weights"].push_back(end.weight);
  }
  return link;
}

/// Parts of bends are left out; the bends come last.
Json provenLinks(const Scene& scene) {
  Json all = Json::array();
  for (const scene::Lia& lia : scene.lias) {
    if (lia.bend < 0) {
      all.push_back(linkOf(scene, lia));
    }
  }
  for (const scene::Bend& bend : scene.bends) {
    all.push_back(linkOf(scene, bend));
  }
  return all;
}

Json factorOf(const physics::Factor& factor) {
  Json below = Json::array();
  for (const physics::Factor::Entry& entry : factor.below) {
    below.push_back({entry.row, entry.column, entry.value});
  }
  return {{"modules", factor.modules}, {"pivots", factor.pivots}, {"below", std::move(below)}};
}

Json ratesOf(const physics::Proof& proof) {
  Json all = Json::array();
  for (const physics::RateProof& rate : proof.rates) {
    Json entry = {{"divisor", rate.divisor}, {"limit", factorOf(rate.limit)}};
    if (rate.signs.stiffness) {
      entry["stiffness"] = factorOf(*rate.signs.stiffness);
    }
    if (rate.signs.damping) {
      entry["damping"] = factorOf(*rate.signs.damping);
    }
    all.push_back(std::move(entry));
  }
  return all;
}

/// [row, column, number] of what is not 0.
Json entriesOf(const Eigen::MatrixXd& matrix) {
  Json all = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (matrix(i, j) != 0.0) {
        all.push_back({i, j, matrix(i, j)});
      }
    }
  }
  return all;
}

Json periodsOf(const physics::Proof& proof) {
  Json all = Json::array();
  for (const physics::PeriodProof& period : proof.periods) {
    all.push_back({{"parameters", period.parameters},
                   {"frames", period.frames},
                   {"modules", period.modules},
                   {"rows", period.form.rows()},
                   {"form", entriesOf(period.form)},
                   {"turn", entriesOf(period.turn)}});
  }
  return all;
}

Json lossesOf(const physics::Proof& proof) {
  Json all = Json::array();
  for (const physics::Factor& loss : proof.losses) {
    all.push_back(factorOf(loss));
  }
  return all;
}

Json rulesOf(const Scene& scene, const physics::Proof& proof) {
  std::vector<int> written;  // [lias] before each
  int count = 0;
  for (const scene::Lia& lia : scene.lias) {
    written.push_back(count);
    count += lia.bend < 0 ? 1 : 0;
  }
  Json all = Json::array();
  for (const physics::LinkProof& link : proof.links) {
    all.push_back({{"link", written[at(link.link)]}, {"rule", link.rule}});
  }
  return all;
}

/// Of numbers their bits, of texts their bytes and a 0: what does not depend on how they are
/// written.
void digest(const Json& tree, Sha256& to) {
  if (tree.is_structured()) {
    for (const auto& [name, child] : tree.items()) {
      if (tree.is_object()) {
        to.add(name + '\0');
      }
      digest(child, to);
    }
  } else if (tree.is_string()) {
    to.add(tree.get<std::string>() + '\0');
  } else {
    const double number = tree.is_boolean() ? (tree.get<bool>() ? 1.0 : 0.0) : tree.get<double>();
    char bits[sizeof number];
    std::memcpy(bits, &number, sizeof number);
    to.add(std::string(bits, sizeof number));
  }
}

std::string digestOf(const Json& tree) {
  Sha256 sum;
  digest(tree, sum);
  return sum.digest();
}

std::string digestOf(const std::string& text) {
  Sha256 sum;
  sum.add(text);
  return sum.digest();
}

/// One line for each part.
void print(const Json& parts, std::ostream& out) {
  const char* before = "{";
  for (const auto& [name, part] : parts.items()) {
    out << before << Json(name).dump() << ": " << part.dump();
    before = ",\n";
  }
  out << "}\n";
}

}  // namespace

void writeProof(const std::string& file,
                const Scene& scene,
                const physics::Rates& rates,
                physics::Verdict verdict,
                const physics::Proof& proof) {
  if (verdict > physics::Verdict::kBounded) {
    throw Exception(file + ": not written: the scene is " + toString(verdict) +
                    ", of which there is no proof");
  }
  if (!scene.tanks.empty()) {
    throw Exception(file + ": not written: link '" + scene.tanks.front().name +
                    "' is one tank of many links, which proofs have no rule for");
  }
  for (const physics::PeriodProof& period : proof.periods) {
    if (period.form.size() == 0) {
      throw Exception(
          file +
          ": not written: no eigenvalue over a period is above 1, but no quadratic form "
          "shows it to 1e-9, as two modes are about to meet");
    }
  }
  const double frame = 1.0 / (rates.audio_hz * scene.time_unit_s);
  Json parts = {{"proof", 1},
                {"scene",
                 {{"file", scene.file},
                  {"sha256", digestOf(files::readFile(scene.file, scene::kMaxTextBytes))}}},
                {"verdict", toString(verdict)},
                {"frame", frame},
                {"parameters", provenParameters(scene)},
                {"sections", provenSections(scene, rates, frame)},
                {"modules", provenModules(scene)},
                {"points", pointsOf(scene, proof)},
                {"links", provenLinks(scene)},
                {"rates", ratesOf(proof)},
                {"periods", periodsOf(proof)},
                {"losses", lossesOf(proof)},
                {"rules", rulesOf(scene, proof)}};
  parts["sha256"] = digestOf(parts);
  std::ofstream out(file, std::ios::binary);
  print(parts, out);
  if (!out.flush()) {
    throw Exception(file + ": cannot be written");
  }
}

}  // namespace ergotic::tools
