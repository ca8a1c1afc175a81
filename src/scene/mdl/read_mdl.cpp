// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/laws/clipped_cubic.hpp"
#include "scene/limits.hpp"
#include "scene/mdl/mdl_lexer.hpp"
#include "scene/mdl/mdl_numbers.hpp"
#include "scene/text/number.hpp"
#include "scene/text/overrides.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {
namespace {

constexpr double kMdlRateHz = 44100.0;  // the rate that the plain coefficients are meant for

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
      {"nlContact",
       {LiaType::kCubicContact, {k, q, limit, z, width}, 4, "@m1 @m2 K Q Klim Z [thresh]"}},
      {"nlSpring2", {LiaType::kQuadratic, {k, q, z}, 3, "@m1 @m2 K P Z"}},
      {"nlSpring3", {LiaType::kCubic, {k, q, z}, 3, "@m1 @m2 K Q Z"}},
      {"nlSpringDamper", {LiaType::kClippedCubic, {k, q, limit, z}, 4, "@m1 @m2 K Q Klim Z"}},
      {"nlPluck", {LiaType::kPluck, {k, width, z}, 2, "@m1 @m2 K scale [Z]"}},
      {"nlBow", {LiaType::kBow, {z, width}, 2, "@m1 @m2 Z vscale [smooth]"}},
  };
  return kLinks;
}

class MdlReader {
 public:
  MdlReader(SceneBuilder& builder, const std::vector<MdlLine>& lines, MdlNumbers& numbers)
      : builder_(builder), lines_(lines), numbers_(numbers) {}

  void read() {
    Section section;
    section.name = "model";
    section.place = {1, 1};
    builder_.add(std::move(section));
    for (const MdlLine& line : lines_) {
      checkKeyword(line);
      readAudioParameter(line);
    }
    for (const MdlLine& line : lines_) {
      readMat(line);
    }
    for (const MdlLine& line : lines_) {  // every module is known now
      readLink(line);
      readTap(line);
    }
  }

 private:
  void checkKeyword(const MdlLine& line) const {
    static const std::set<std::string> kMacros = {"string", "chain",      "stiffString",
                                                  "mesh",   "cornerMesh", "closedMesh"};
    const std::string& keyword = line.keyword.text;
    if (kMacros.count(keyword) > 0) {
      builder_.fail(line.keyword.place,
                    "macro " + quoted(keyword) + " is not supported yet, allowed: single modules");
    }
    const auto& known = mdlKeywords();
    if (line.keyword.kind != MdlToken::Kind::kBare ||
        std::find(known.begin(), known.end(), keyword) == known.end()) {
      builder_.fail(line.keyword.place,
                    "unknown keyword " + quoted(keyword) + suggestion(keyword, known));
    }
  }

  void expect(const MdlLine& line, std::size_t least, std::size_t most, const char* usage) const {
    const std::size_t count = line.arguments.size();
    if (count < least || count > most) {
      builder_.fail(count > most ? line.arguments[most].place : line.keyword.place,
                    quoted(line.keyword.text) + " has " + std::to_string(count) +
                        " arguments, allowed: " + line.keyword.text + " " + usage);
    }
  }

  std::string named(const char* what, const MdlLine& line) const {
    return std::string(what) + " of " + quoted("@" + line.name);
  }

  void readMat(const MdlLine& line) {
    const std::string& keyword = line.keyword.text;
    if (keyword == "mass" || keyword == "osc") {
      readInertia(line);
    } else if (keyword == "ground" || keyword == "posInput") {
      readFixed(line);
    }
  }

  /// `mass M [g] pos vel`, `osc M K Z [g] pos vel`
  void readInertia(const MdlLine& line) {
    const bool osc = line.keyword.text == "osc";
    const std::size_t least = osc ? 5 : 3;
    expect(line, least, least + 1, osc ? "M K Z [g] pos vel" : "M [g] pos vel");
    const std::vector<MdlToken>& arguments = line.arguments;
    Mat mat;
    mat.name = line.name;
    mat.place = line.place;
    mat.mass = {numbers_.number(arguments[0], named("mass", line), kMassLimits)};
    if (osc) {
      mat.type = MatType::kCell;
      mat.stiffness = numbers_.value(arguments[1], named("stiffness", line), kStiffnessLimits);
      mat.damping = numbers_.value(arguments[2], named("damping", line), kDampingLimits);
    }
    if (arguments.size() > least) {
      // A force for each step, whatever the mass.
      mat.push.edit().force.x() = -numbers_.number(arguments[least - 2]) / kMdlRateHz;
    }
    setPlace(mat, numbers_.vector(arguments[arguments.size() - 2]));
    const double velocity = numbers_.vector(arguments.back()).z / kMdlRateHz;
    if (velocity != 0.0) {
      mat.push.edit().velocity.x() = velocity;
    }
    if (velocity != 0.0 && builder_.scene().text.find('[') == std::string::npos) {
      builder_.warn(arguments.back().place,
                    "the last number of " + quoted("@" + line.name) +
                        " is taken as a velocity per second; older files mean a position");
    }
    builder_.add(std::move(mat));
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
    completeClippedLaw(lia, ClippedLaw::kMdl);
    builder_.add(std::move(lia));
  }

  /// Widths and the shape of a clipped law are worked out once, so they cannot follow audio.
  Value linkNumber(const MdlLine& line, const LiaField& field, std::size_t argument) const {
    const MdlToken& token = line.arguments[argument];
    const std::string what = named(field.key, line);
    const auto is = [&](LiaMember member) { return field.member == member; };
    const bool follows =
        !field.is_fixed && (is(&Lia::damping) || is(&Lia::stiffness) || is(&LiaLaw::nonlinearity));
    Limits limits = field.limits;
    if (is(&Lia::stiffness) || is(&Lia::damping)) {
      limits.minimum = 0.0;  // what linear links of published models keep to
    }
    return follows ? numbers_.value(token, what, limits)
                   : Value{numbers_.number(token, what, limits)};
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
      builder_.fail(place, outOfRange(named("channel", line), *channel, kChannelLimits));
    }
    return *channel;
  }

  int matOf(const MdlToken& token) const {
    const std::string name = trimmed(token.text);
    const bool marked = !name.empty() && name.front() == '@';
    if (token.kind == MdlToken::Kind::kBracket && marked) {
      builder_.fail(token.place, "a point of a macro is not supported yet, allowed: @module");
    }
    if (token.kind != MdlToken::Kind::kBare || !marked) {
      builder_.fail(token.place, quoted(token.text) + " is not a module, allowed: @name");
    }
    return builder_.mat(name.substr(1), token.place);
  }

  SceneBuilder& builder_;
  const std::vector<MdlLine>& lines_;
  MdlNumbers& numbers_;
  std::map<int, int> inputs_of_channel_;
};

}  // namespace

Scene readMdl(const std::string& text, const std::string& name, const Overrides& overrides) {
  checkBytes(text, name, Bytes::kAny);
  SceneBuilder builder(name, text);
  Scene& scene = builder.scene();
  scene.name = stemOf(name);
  scene.time_unit_s = 1.0 / kMdlRateHz;
  scene.gestural_rate_hz = overrideGesturalRate(overrides, scene.gestural_rate_hz, name);
  const std::vector<MdlLine> lines = cutMdl(builder, text);
  MdlNumbers numbers(builder, lines, overrides);
  numbers.check();
  MdlReader(builder, lines, numbers).read();
  return builder.finish();
}

}  // namespace ergotic::scene
