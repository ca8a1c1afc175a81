// SPDX-License-Identifier: BSD-3-Clause
#include "support/mdl_simulator.hpp"

#include <cctype>
#include <stdexcept>

#include "support/mdl_elements.hpp"
#include "support/mdl_lines.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

/// Value of an expression: numbers, names, + - * / ( ), sqrt, exp, pow, abs, sin, cos.
class Expression {
 public:
  using Lookup = std::function<double(const std::string&)>;
  Expression(const std::string& text, const Lookup& lookup) : text_(text), lookup_(lookup) {}

  double value() {
    const double result = sum();
    if (peek() != '\0') {
      throw std::runtime_error("expression '" + text_ + "'");
    }
    return result;
  }

 private:
  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
      ++at_;
    }
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char wanted) {
    if (peek() != wanted) {
      return false;
    }
    ++at_;
    return true;
  }
  double sum() {
    double result = product();
    while (true) {
      if (take('+')) {
        result += product();
      } else if (take('-')) {
        result -= product();
      } else {
        return result;
      }
    }
  }
  double product() {
    double result = factor();
    while (true) {
      if (take('*')) {
        result *= factor();
      } else if (take('/')) {
        result /= factor();
      } else {
        return result;
      }
    }
  }
  double factor() {
    if (take('-')) {
      return -factor();
    }
    if (take('(')) {
      const double result = sum();
      take(')');
      return result;
    }
    const char c = peek();
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
      std::size_t used = 0;
      const double result = std::stod(text_.substr(at_), &used);
      at_ += used;
      return result;
    }
    return named();
  }
  double named() {
    std::string name;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '_') {
      name += text_[at_++];
    }
    return take('(') ? function(name) : lookup_(name);
  }
  double function(const std::string& name) {
    const double first = sum();
    const double second = take(',') ? sum() : 0.0;
    take(')');
    if (name == "pow") {
      return std::pow(first, second);
    }
    static const std::map<std::string, double (*)(double)> kFunctions = {{"sqrt", std::sqrt},
                                                                         {"exp", std::exp},
                                                                         {"abs", std::abs},
                                                                         {"sin", std::sin},
                                                                         {"cos", std::cos}};
    return kFunctions.at(name)(first);
  }

  const std::string& text_;
  const Lookup& lookup_;
  std::size_t at_ = 0;
};

/// `3` is 3, `1 2 3` is 3: only z moves.
double lastNumber(const std::string& vector) {
  std::istringstream stream(vector);
  double value = 0.0;
  while (stream >> value) {
  }
  return value;
}

/// k of `in<k>` or `out<k>`, from 0.
std::size_t channelOf(const std::string& name) {
  return std::stoul(name.substr(name.find_first_of("0123456789"))) - 1;
}

class Model {
 public:
  Model(const MdlElements& elements, const std::map<std::string, double>& params)
      : lines_(elements.lines), nets_(elements.nets), given_(params) {
    for (const MdlElement& line : lines_) {
      if (line.keyword == "audioParam") {
        audio_[line.name] = {channelOf(line.arguments.at(0)), 0.0};
      }
    }
    for (const MdlElement& line : lines_) {
      addMaterial(line);
    }
    for (const MdlElement& line : lines_) {
      addLink(line);
      addTap(line);
    }
  }

  Channels play(const Channels& inputs, std::size_t frames) {
    Channels outputs;
    for (const Tap& tap : outputs_) {
      outputs.resize(std::max(outputs.size(), tap.channel + 1));
    }
    for (std::vector<double>& channel : outputs) {
      channel.assign(frames, 0.0);
    }
    for (std::size_t n = 0; n < frames; ++n) {
      step(inputs, n, outputs);
    }
    return outputs;
  }

 private:
  struct Tap {
    std::size_t channel;
    Material* material;
    bool force;
  };
  struct Drive {
    std::size_t channel;
    DrivenPoint* point;
  };

  static double at(const Channels& inputs, std::size_t channel, std::size_t n) {
    return channel < inputs.size() && n < inputs[channel].size() ? inputs[channel][n] : 0.0;
  }

  void step(const Channels& inputs, std::size_t n, Channels& outputs) {
    for (const Drive& drive : drives_) {
      drive.point->target = at(inputs, drive.channel, n);
    }
    listen(inputs, n);
    for (const auto& material : materials_) {
      material.second->move();
    }
    for (const auto& point : points_) {
      point.second->move();
    }
    for (const Link& link : links_) {
      link.apply();
    }
    for (const Tap& tap : forces_) {
      tap.material->force += at(inputs, tap.channel, n);
    }
    for (const auto& point : points_) {
      point.second->give();
    }
    for (const Tap& tap : outputs_) {
      outputs[tap.channel][n] = tap.force ? tap.material->force : tap.material->x;
    }
  }

  /// What names an audioParam is written anew with the sample of now.
  void listen(const Channels& inputs, std::size_t n) {
    if (audio_.empty()) {
      return;
    }
    for (auto& [name, audio] : audio_) {
      audio.value = at(inputs, audio.channel, n);
    }
    links_.clear();
    for (const MdlElement& line : lines_) {
      if (line.keyword == "osc" || line.keyword == "mass") {
        const bool is_osc = line.keyword == "osc";
        dynamic_cast<Inertia&>(*materials_.at(line.name))
            .set(number(line.arguments.at(0)), is_osc ? number(line.arguments.at(1)) : 0.0,
                 is_osc ? number(line.arguments.at(2)) : 0.0);
      }
      addLink(line);
    }
    for (auto& [reference, point] : points_) {
      point->shares = sharesOf(reference);
    }
  }

  double number(const std::string& text) const {
    const Expression::Lookup lookup = [this](const std::string& name) { return param(name); };
    return Expression(text, lookup).value();
  }
  double param(const std::string& name) const {
    const auto audio = audio_.find(name);
    if (audio != audio_.end()) {
      return audio->second.value;
    }
    const auto given = given_.find(name);
    if (given != given_.end()) {
      return given->second;
    }
    for (const MdlElement& line : lines_) {
      if (line.keyword == "param" && line.name == name) {
        return number(line.arguments.at(0));
      }
    }
    throw std::runtime_error("no param '" + name + "'");
  }
  /// `@name`, or a point of a macro: `@name a`, `@name a b`.
  Material& material(const std::string& reference) {
    const std::size_t blank = reference.find(' ');
    if (blank == std::string::npos) {
      return *materials_.at(reference.substr(1));
    }
    std::unique_ptr<MacroPoint>& point = points_[reference];
    if (!point) {
      point = std::make_unique<MacroPoint>(sharesOf(reference));
    }
    return *point;
  }

  /// What a place on a macro has of each module around it: bilinear.
  MacroPoint::Shares sharesOf(const std::string& reference) {
    std::istringstream words(reference.substr(1));
    std::string name;
    std::string first;
    std::string second = "0";
    words >> name >> first >> second;
    const auto net =
        std::find_if(nets_.begin(), nets_.end(), [&](const MdlNet& n) { return n.name == name; });
    if (net == nets_.end()) {
      throw std::runtime_error("no macro '" + name + "'");
    }
    const auto cut = [this](const std::string& text) { return std::clamp(number(text), 0.0, 1.0); };
    const double row = net->rows > 1 ? cut(first) * (net->rows - 1) : 0.0;
    const double column = cut(net->rows > 1 ? second : first) * (net->columns - 1);
    MacroPoint::Shares shares;
    for (int i = 0; i < net->rows; ++i) {
      for (int j = 0; j < net->columns; ++j) {
        const double share =
            std::max(0.0, 1.0 - std::abs(row - i)) * std::max(0.0, 1.0 - std::abs(column - j));
        if (share > 0.0) {
          shares.emplace_back(materials_.at(net->module(i, j)).get(), share);
        }
      }
    }
    return shares;
  }

  void addMaterial(const MdlElement& line) {
    const auto& a = line.arguments;
    const std::size_t n = a.size();
    std::unique_ptr<Material>& made = materials_[line.name];
    if (line.keyword == "mass") {
      made = std::make_unique<Inertia>(number(a.at(0)), 0.0, 0.0, n == 4 ? number(a[1]) : 0.0,
                                       lastNumber(a.at(n - 2)), lastNumber(a.at(n - 1)));
    } else if (line.keyword == "osc") {
      made = std::make_unique<Inertia>(number(a.at(0)), number(a.at(1)), number(a.at(2)),
                                       n == 6 ? number(a[3]) : 0.0, lastNumber(a.at(n - 2)),
                                       lastNumber(a.at(n - 1)));
    } else if (line.keyword == "ground") {
      made = std::make_unique<FixedPoint>(lastNumber(a.at(0)));
    } else if (line.keyword == "posInput") {
      auto point = std::make_unique<DrivenPoint>(lastNumber(a.at(0)));
      drives_.push_back({channelOf(line.name), point.get()});
      made = std::move(point);
    } else {
      materials_.erase(line.name);
    }
  }

  void addLink(const MdlElement& line) {
    if (line.arguments.size() < 3 || line.arguments[0][0] != '@') {
      return;
    }
    const bool is_faust =
        given_.count("faust_clip") > 0 && laws().count(line.keyword + " of Faust") > 0;
    Link link{&material(line.arguments[0]),
              &material(line.arguments[1]),
              laws().at(line.keyword + (is_faust ? " of Faust" : "")),
              {}};
    for (std::size_t i = 2; i < line.arguments.size(); ++i) {
      link.numbers.at(i - 2) = number(line.arguments[i]);
    }
    links_.push_back(link);
  }

  void addTap(const MdlElement& line) {
    if (line.keyword == "frcInput") {
      forces_.push_back({channelOf(line.name), &material(line.arguments.at(0)), true});
    } else if (line.keyword == "posOutput" || line.keyword == "frcOutput") {
      outputs_.push_back(
          {channelOf(line.name), &material(line.arguments.at(0)), line.keyword == "frcOutput"});
    }
  }

  struct Audio {
    std::size_t channel;
    double value;
  };
  std::map<std::string, Audio> audio_;
  const std::vector<MdlElement>& lines_;
  const std::vector<MdlNet>& nets_;
  const std::map<std::string, double>& given_;
  std::map<std::string, std::unique_ptr<Material>> materials_;
  std::map<std::string, std::unique_ptr<MacroPoint>> points_;
  std::vector<Link> links_;
  std::vector<Drive> drives_;
  std::vector<Tap> forces_;
  std::vector<Tap> outputs_;
};

}  // namespace

Channels simulateMdl(const std::string& text,
                     const std::map<std::string, double>& params,
                     const Channels& inputs,
                     std::size_t frames) {
  const MdlElements elements = readMdlElements(text);
  return Model(elements, params).play(inputs, frames);
}

}  // namespace ergotic::test
