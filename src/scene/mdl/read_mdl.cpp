// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/laws/clipped_cubic.hpp"
#include "scene/limits.hpp"
#include "scene/mdl/mdl_dialect.hpp"
#include "scene/mdl/mdl_lexer.hpp"
#include "scene/mdl/mdl_macros.hpp"
#include "scene/mdl/mdl_numbers.hpp"
#include "scene/text/number.hpp"
#include "scene/text/overrides.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

/// A link: its type and where its arguments go; those past `required` are optional.
struct MdlLink {
  LiaType type;
  std::vector<LiaMember> arguments;
  std::size_t required;
  const char* usage;
};

const std::map<std::string, MdlLink>& mdlLinks() {
  const LiaMember k = &Lia::stiffness;
  const LiaMember z = &Lia::damping;
  const LiaMember q = &LiaLaw::nonlinearity;
  const LiaMember limit = &LiaLaw::stiffness_limit;
  const LiaMember width = &LiaLaw::width;
  static const std::map<std::string, MdlLink> kLinks = {
      {"spring", {LiaType::kSpringDamper, {k}, 1, "@m1 @m2 K"}},
      {"damper", {LiaType::kSpringDamper, {z}, 1, "@m1 @m2 Z"}},
      {"springDamper", {LiaType::kSpringDamper, {k, z}, 2, "@m1 @m2 K Z"}},
      {"contact", {LiaType::kContact, {k, z, width}, 2, "@m1 @m2 K Z [thresh]"}},
      {"detent", {LiaType::kContact, {k, z, width}, 2, "@m1 @m2 K Z [thresh]"}},
      {"nlContact",
       {LiaType::kCubicContact, {k, q, limit, z, width}, 4, "@m1 @m2 K Q Klim Z [thresh]"}},
      {"nlSpring2", {LiaType::kQuadratic, {k, q, z}, 3, "@m1 @m2 K P Z"}},
      {"nlSpring", {LiaType::kQuadratic, {k, q, z}, 3, "@m1 @m2 K P Z"}},
      {"nlSpring3", {LiaType::kCubic, {k, q, z}, 3, "@m1 @m2 K Q Z"}},
      {"nlSpringDamper", {LiaType::kClippedCubic, {k, q, limit, z}, 4, "@m1 @m2 K Q Klim Z"}},
      {"nlPluck", {LiaType::kPluck, {k, width, z}, 2, "@m1 @m2 K scale [Z]"}},
      {"nlBow", {LiaType::kBow, {z, width}, 2, "@m1 @m2 Z vscale [smooth]"}},
  };
  return kLinks;
}

class MdlReader {
 public:
  MdlReader(SceneBuilder& builder,
            const std::vector<MdlLine>& lines,
            MdlNumbers& numbers,
            const MdlDialect& dialect)
      : builder_(builder), lines_(lines), numbers_(numbers), dialect_(dialect) {}

  void read() {
    Section section;
    section.name = "model";
    section.place = {1, 1};
    builder_.add(std::move(section));
    for (const MdlLine& line : lines_) {
      checkKeyword(line);
      noteMacro(line);
      readAudioParameter(line);
    }
    checkGroups(builder_, lines_);
    std::size_t expanded = 0;  // all is counted before any macro takes room
    for (const MdlLine& line : lines_) {
      expanded += macroModules(builder_, numbers_, line, dialect_);
      builder_.expectRoom(expanded, line.place);
    }
    for (const MdlLine& line : lines_) {
      readMat(line);
    }
    if (builder_.scene().mats.empty()) {
      builder_.fail({1, 1}, "no module found, allowed: a text with elements like @m mass 1 0 0");
    }
    for (const MdlLine& line : lines_) {  // every module is known now
      readLink(line);
      readTap(line);
    }
  }

 private:
  void checkKeyword(const MdlLine& line) const {
    const std::string& keyword = line.keyword.text;
    if (keyword == kBeginGroup || keyword == kEndGroup) {
      return;
    }
    const auto& known = mdlKeywords();
    if (line.keyword.kind != MdlToken::Kind::kBare ||
        std::find(known.begin(), known.end(), keyword) == known.end()) {
      builder_.fail(line.keyword.place,
                    "unknown keyword " + quoted(keyword) + suggestion(keyword, known));
    }
    if (!dialect_.isOld() && (keyword == "massG" || keyword == "nlSpring" || keyword == "detent")) {
      builder_.fail(line.keyword.place, "keyword " + quoted(keyword) + " is not allowed here" +
                                            olderNote(line, dialect_));
    }
  }

  void noteMacro(const MdlLine& line) {
    if (findMacro(line.keyword.text) != nullptr) {
      const auto [first, is_new] = macros_.emplace(line.name, line.place.line);
      if (!is_new) {
        builder_.fail(line.place, "macro " + quoted("@" + line.name) +
                                      " is defined twice, first in line " +
                                      std::to_string(first->second));
      }
    }
  }

  void expect(const MdlLine& line, std::size_t least, std::size_t most, const char* usage) const {
    expectArguments(builder_, line, dialect_, least, most, usage);
  }

  void readMat(const MdlLine& line) {
    const std::string& keyword = line.keyword.text;
    if (keyword == "mass" || keyword == "massG" || keyword == "osc") {
      checkName(line);
      readInertia(line);
    } else if (keyword == "ground" || keyword == "posInput") {
      checkName(line);
      readFixed(line);
    } else if (findMacro(keyword) != nullptr) {
      addMacro(builder_, numbers_, line, dialect_);
    }
  }

  void checkName(const MdlLine& line) const {
    const auto macro = macros_.find(line.name);
    if (macro != macros_.end()) {
      builder_.fail(line.place, "module " + quoted("@" + line.name) +
                                    " has the name of the macro in line " +
                                    std::to_string(macro->second));
    }
  }

  /// `mass M [g] pos vel`, `massG M g pos last`, `osc M K Z [g] pos vel`
  void readInertia(const MdlLine& line) {
    const std::string& keyword = line.keyword.text;
    const bool osc = keyword == "osc";
    const std::size_t least = keyword == "massG" ? 4 : osc ? 5 : 3;
    const bool old = dialect_.isOld();
    expect(line, least, least + (old ? 0 : 1),
           keyword == "massG" ? "M g x0 xR"
           : osc              ? (old ? "M K Z x0 xR" : "M K Z [g] pos vel")
                              : (old ? "M x0 xR" : "M [g] pos vel"));
    const std::vector<MdlToken>& arguments = line.arguments;
    Mat mat;
    mat.name = line.name;
    mat.place = line.place;
    mat.mass = numbers_.positiveValue(arguments[0], ofElement("mass", line), kMassLimits);
    if (osc) {
      mat.type = MatType::kCell;
      mat.stiffness = numbers_.value(arguments[1], ofElement("stiffness", line), kStiffnessLimits);
      mat.damping = numbers_.value(arguments[2], ofElement("damping", line), kDampingLimits);
    }
    if (arguments.size() > least || keyword == "massG") {
      // A force for each step, whatever the mass; only the newer language divides it by its rate.
      const double gravity = numbers_.number(arguments[arguments.size() - 3]);
      mat.push.edit().force.x() = -gravity / (old ? 1.0 : kMdlRateHz);
    }
    setPlace(mat, numbers_.vector(arguments[arguments.size() - 2]));
    setVelocity(mat, {velocity(line, mat.position.x()), 0.0, 0.0});
    builder_.add(std::move(mat));
  }

  /// Initial velocity of a module that starts at `position`, m/sample.
  double velocity(const MdlLine& line, double position) {
    const MdlToken& last = line.arguments.back();
    const double value = numbers_.vector(last).z;
    if (dialect_.isOld()) {
      return position - value;
    }
    if (value != 0.0 && dialect_.age == MdlDialect::Age::kUnknown) {
      builder_.warn(last.place, "the last number of " + quoted("@" + line.name) +
                                    " is taken as a velocity per second; older files mean a "
                                    "position, which here is [0 0 " +
                                    numberText((position - value) * kMdlRateHz) + "]");
    }
    return value / kMdlRateHz;
  }

  /// `ground pos`, `posInput pos`
  void readFixed(const MdlLine& line) {
    expect(line, 1, 1, "pos");
    Mat mat;
    mat.name = line.name;
    mat.place = line.place;
    mat.type = line.keyword.text == "ground" ? MatType::kGround : MatType::kDriven;
    setPlace(mat, numbers_.vector(line.arguments[0]));
    if (mat.type == MatType::kGround) {
      mat.rest.x() = mat.position.x();
    }
    const int index = builder_.add(std::move(mat));
    if (line.keyword.text == "posInput") {
      addInput(line, Quantity::kPosition, index);
    }
  }

  /// The z of a text is what moves: x here; its x and y are the workbench.
  static void setPlace(Mat& mat, const MdlNumbers::Vector& at) {
    mat.rest.y() = at.x;
    mat.rest.z() = at.y;
    mat.position.x() = at.z;
  }

  void readLink(const MdlLine& line) {
    const auto found = mdlLinks().find(line.keyword.text);
    if (found == mdlLinks().end()) {
      return;
    }
    const MdlLink& link = found->second;
    const bool bow = link.type == LiaType::kBow;
    expect(line, 2 + link.required, 2 + link.arguments.size() + (bow ? 1 : 0), link.usage);
    Lia lia;
    lia.name = line.name;
    lia.place = line.place;
    lia.type = link.type;
    lia.a = matOf(line.arguments[0]);
    lia.b = matOf(line.arguments[1]);
    if (lia.a == lia.b) {
      builder_.fail(line.arguments[1].place, "link " + quoted("@" + line.name) + " joins module " +
                                                 quoted(line.arguments[1].text) + " to itself");
    }
    if (bow && line.arguments.size() > 4 && numbers_.number(line.arguments[4]) > 0.0) {
      lia.type = LiaType::kSmoothBow;
    }
    for (const LiaField& field : lawOf(lia.type).fields) {
      const auto position = std::find(link.arguments.begin(), link.arguments.end(), field.member);
      const auto index = 2 + static_cast<std::size_t>(position - link.arguments.begin());
      if (position != link.arguments.end() && index < line.arguments.size()) {
        setMember(lia, field.member, linkNumber(line, field, index));
      }
    }
    completeClippedLaw(lia, numbers_.isFaust() ? ClippedLaw::kFaust : ClippedLaw::kMiGen);
    renameDuplicate(lia);
    const bool is_constant = lia.stiffness.audio < 0 && lia.damping.audio < 0 &&
                             lia.law->nonlinearity.audio < 0 && lia.law->width.audio < 0;
    if (is_constant && lawOf(lia.type).switches) {
      lia.scheme = Scheme::kExplicitIfStable;
    }
    builder_.add(std::move(lia));
  }

  /// No line refers to a link, so several may share a name; in a scene names are unique.
  void renameDuplicate(Lia& lia) {
    const std::string name = lia.name.str();
    const auto [first, is_new] = links_.emplace(name, lia.place.line);
    if (is_new) {
      return;
    }
    int number = 2;
    do {
      lia.name = name + "." + std::to_string(number++);
    } while (!links_.emplace(lia.name.str(), lia.place.line).second);
    builder_.warn(lia.place, "link " + quoted("@" + name) + " has the name of that in line " +
                                 std::to_string(first->second) + ", it is called " +
                                 quoted(lia.name.str()) + " here");
  }

  /// The shape of a clipped law is worked out once, so it cannot follow audio.
  Value linkNumber(const MdlLine& line, const LiaField& field, std::size_t argument) {
    const MdlToken& token = line.arguments[argument];
    const std::string what = ofElement(field.key, line);
    const auto is = [&](LiaMember member) { return field.member == member; };
    Limits limits = field.limits;
    if (is(&Lia::stiffness) || is(&Lia::damping)) {
      limits.minimum = 0.0;  // what linear links of published models keep to
    }
    if (field.is_fixed) {
      return {numbers_.number(token, what, limits)};
    }
    return limits.above ? numbers_.positiveValue(token, what, limits)
                        : numbers_.value(token, what, limits);
  }

  /// `@name audioParam @in1`
  void readAudioParameter(const MdlLine& line) {
    if (line.keyword.text != "audioParam") {
      return;
    }
    expect(line, 1, 1, "@inK");
    if (numbers_.isParam(line.name)) {
      builder_.fail(line.place, quoted(line.name) + " is a param and an audioParam, allowed: one");
    }
    AudioParameter parameter;
    parameter.name = line.name;
    parameter.place = line.place;
    const MdlToken& source = line.arguments[0];
    const std::string name = trimmed(source.text);
    const std::string channel = name.compare(0, 3, "@in") == 0 ? name.substr(3) : "";
    parameter.channel = channelNumber(name, channel, source.place, line, "@in") - 1;
    builder_.scene().audio_parameters.push_back(std::move(parameter));
  }

  void readTap(const MdlLine& line) {
    const std::string& keyword = line.keyword.text;
    if (keyword == "frcInput") {
      expect(line, 1, 1, "@m");
      addInput(line, Quantity::kForce, matOf(line.arguments[0]));
    } else if (keyword == "posOutput" || keyword == "frcOutput") {
      expect(line, 1, 1, "@m");
      Output output;
      output.name = line.name;
      output.place = line.place;
      output.channel = channelOf(line, "out");
      output.quantity = keyword == "posOutput" ? Quantity::kPosition : Quantity::kForce;
      output.point.mat = matOf(line.arguments[0]);
      builder_.scene().outputs.push_back(std::move(output));
    }
  }

  /// Several inputs may share a channel, and thus a name in the text; in a scene names are unique.
  void addInput(const MdlLine& line, Quantity quantity, int mat) {
    Input input;
    input.channel = channelOf(line, "in");
    const int times = ++inputs_of_channel_[input.channel];
    input.name = line.name + (times == 1 ? "" : "." + std::to_string(times));
    input.place = line.place;
    input.quantity = quantity;
    input.mat = mat;
    builder_.scene().inputs.push_back(std::move(input));
  }

  /// The channel, from 0, of a name like `@in1`.
  int channelOf(const MdlLine& line, const std::string& prefix) const {
    const bool fits = line.name.compare(0, prefix.size(), prefix) == 0;
    return channelNumber("@" + line.name, fits ? line.name.substr(prefix.size()) : "", line.place,
                         line, "@" + prefix) -
           1;
  }

  int channelNumber(const std::string& said,
                    const std::string& digits,
                    Place place,
                    const MdlLine& line,
                    const std::string& prefix) const {
    const std::optional<int> channel = parseInteger(digits);
    if (!channel) {
      builder_.fail(place, quoted(said) + " is not a channel, allowed for " + line.keyword.text +
                               ": " + prefix + "1 ... " + prefix + "64");
    }
    if (!kChannelLimits.hold(*channel)) {
      builder_.fail(place, outOfRange(ofElement("channel", line), *channel, kChannelLimits));
    }
    return *channel;
  }

  /// A module, or a point of a macro.
  int matOf(const MdlToken& token) const {
    if (!token.at.empty()) {
      return macroPoint(builder_, numbers_, token);
    }
    const std::string name = trimmed(token.text);
    if (token.kind == MdlToken::Kind::kQuoted || name.empty() || name.front() != '@') {
      builder_.fail(token.place, quoted(token.text) + " is not a module, allowed: @name");
    }
    if (macros_.count(name.substr(1)) > 0) {
      builder_.fail(token.place, quoted(name) + " is a macro, allowed: a point of it, as in [" +
                                     name + " 0.3], of a mesh [" + name + " 0.3 0.7]");
    }
    return builder_.mat(name.substr(1), token.place);
  }

  SceneBuilder& builder_;
  const std::vector<MdlLine>& lines_;
  MdlNumbers& numbers_;
  const MdlDialect& dialect_;
  std::map<std::string, int> macros_;  // the line of each
  std::map<std::string, int> links_;   // the same
  std::map<int, int> inputs_of_channel_;
};

/// Texts in which browsers and word processors wrap a model.
void refuseOtherText(const SceneBuilder& builder, const std::string& text) {
  struct Wrapping {
    const char* start;
    const char* kind;
  };
  constexpr std::array<Wrapping, 6> kWrappings{{{"<!doctype", "a page of HTML"},
                                                {"<html", "a page of HTML"},
                                                {"<!--", "a page of HTML"},
                                                {"<?xml", "an XML document"},
                                                {"{\\rtf", "a rich text document"},
                                                {"{", "a JSON document"}}};
  const std::size_t begin = text.find_first_not_of(" \t\r\n", byteOrderMark(text));
  std::string head = begin == std::string::npos ? "" : text.substr(begin, 16);
  std::transform(head.begin(), head.end(), head.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Wrapping& wrapping : kWrappings) {
    if (head.rfind(wrapping.start, 0) == 0) {
      builder.fail(placeAt(text, begin), std::string("this is ") + wrapping.kind +
                                             ", allowed: the plain text of the model itself");
    }
  }
}

}  // namespace

Scene readMdl(const std::string& text, const std::string& name, const Overrides& overrides) {
  checkBytes(text, name, Bytes::kAny);
  SceneBuilder builder(name, text);
  refuseOtherText(builder, text);
  Scene& scene = builder.scene();
  scene.name = stemOf(name);
  scene.time_unit_s = 1.0 / kMdlRateHz;
  scene.gestural_rate_hz = overrideGesturalRate(overrides, scene.gestural_rate_hz, name);
  std::vector<MdlLine> lines = cutMdl(builder, text);
  const MdlDialect dialect = dialectOf(lines);
  if (dialect.isOld()) {
    renew(builder, lines);
  }
  MdlNumbers numbers(builder, lines, overrides);
  numbers.check();
  MdlReader(builder, lines, numbers, dialect).read();
  return builder.finish();
}

}  // namespace ergotic::scene
