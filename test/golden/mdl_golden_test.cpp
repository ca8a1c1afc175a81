// SPDX-License-Identifier: BSD-3-Clause
// Models of every `.mdl` element, played by the product and by the simulator of test/support.
#include <iterator>
#include <map>
#include <ostream>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/mdl_simulator.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic {
namespace {

using test::Channels;
using test::peakOf;

constexpr std::size_t kFrames = 44100;
constexpr double kTwoPi = 6.283185307179586;

/// A region of a force law that the model must pass through: the difference of two outputs and of
/// their velocities per sample satisfies `holds` for at least 20 samples.
struct Branch {
  const char* name;
  std::size_t first;
  std::size_t second;
  std::function<bool(double dx, double dv)> holds;
};

struct Case {
  const char* model;
  std::function<double(std::size_t channel, std::size_t n)> input;
  std::vector<Branch> branches;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.model;
}

double silence(std::size_t /*channel*/, std::size_t /*n*/) {
  return 0.0;
}

double seconds(std::size_t n) {
  return static_cast<double>(n) / test::kMdlSampleRate;
}

/// Two short pushes, alternating in sign.
double pushes(std::size_t channel, std::size_t n) {
  const double size = channel % 2 == 0 ? 0.02 : 0.05;
  return n == 3 ? -size : (n >= 22050 && n < 22060 ? size / 4.0 : 0.0);
}

/// Presses the hammer onto the oscillator, six times.
double strokes(std::size_t /*channel*/, std::size_t n) {
  return n % 8000 >= 100 && n % 8000 < 1600 ? -0.0015 : 0.0;
}

double mixed(std::size_t channel, std::size_t n) {
  const double t = seconds(n);
  switch (channel) {
    case 0:
      return 0.5 * std::sin(kTwoPi * 7.0 * t);
    case 2:
      return n % 5000 == 0 ? 0.1 : 0.0;
    case 3:
      return 0.2 * std::sin(kTwoPi * 110.0 * t) * std::exp(-2.0 * t);
    default:
      return 0.0;
  }
}

/// A few pushes; a stiffness and a damping that swing.
double swinging(std::size_t channel, std::size_t n) {
  const double t = seconds(n);
  switch (channel) {
    case 0:
      return n % 11025 == 0 ? 0.02 : 0.0;
    case 1:
      return 0.02 + 0.01 * std::sin(kTwoPi * 5.0 * t);
    case 2:
      return 0.001 + 0.0008 * std::sin(kTwoPi * 130.0 * t);
    default:
      return 0.0;
  }
}

/// A few pushes; places that swing, one of them beyond the ends of what it lies on.
double sliding(std::size_t channel, std::size_t n) {
  const double t = seconds(n);
  switch (channel) {
    case 0:
      return n % 11025 == 0 ? 0.02 : 0.0;
    case 1:
      return 0.5 + 0.4 * std::sin(kTwoPi * 1.5 * t);
    case 2:
      return 0.5 + 0.6 * std::sin(kTwoPi * 2.3 * t);
    default:
      return 0.0;
  }
}

double plectrum(std::size_t /*channel*/, std::size_t n) {
  return 0.5 * std::sin(kTwoPi * 2.5 * seconds(n));
}

/// Peak velocity 0.001 per sample.
double bowing(std::size_t /*channel*/, std::size_t n) {
  const double rate = kTwoPi * 20.0 / test::kMdlSampleRate;
  return 0.001 / rate * (1.0 - std::cos(rate * static_cast<double>(n)));
}

/// The same with a place and a pressure that swing.
double drivenBow(std::size_t channel, std::size_t n) {
  const double t = seconds(n);
  switch (channel) {
    case 0:
      return bowing(0, n);
    case 1:
      return 0.3 + 0.1 * std::sin(kTwoPi * 2.0 * t);
    case 2:
      return 0.6 + 0.4 * std::sin(kTwoPi * 3.0 * t);
    default:
      return 0.0;
  }
}

/// Pushes, a mass that swings slowly, a stiffness that does so faster.
double weighed(std::size_t channel, std::size_t n) {
  const double t = seconds(n);
  return channel == 1 ? 0.5 + 0.4 * std::sin(kTwoPi * 3.0 * t)
                      : swinging(channel == 2 ? 1 : channel, n);
}

Branch distance(const char* name, double low, double high) {
  return {name, 0, 1,
          [=](double dx, double) { return std::abs(dx) >= low && std::abs(dx) < high; }};
}

Branch slip(const char* name, double low, double high) {
  return {name, 0, 1,
          [=](double, double dv) { return std::abs(dv) >= low && std::abs(dv) < high; }};
}

/// x1 - x2 in low...high
Branch overlap(const char* name, std::size_t one, std::size_t two, double low, double high) {
  return {name, one, two, [=](double dx, double) { return dx > low && dx < high; }};
}

Branch stretch(const char* name, std::size_t output, double low, double high) {
  // Output 0 against itself is the ground: the other end of these springs.
  return {name, output, output,
          [=](double x, double) { return std::abs(x) > low && std::abs(x) < high; }};
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"inertia", silence, {}},
      {"links", pushes, {}},
      {"inputs", mixed, {}},
      {"params", pushes, {}},
      {"audio_params", swinging, {}},
      {"sliding", sliding, {}},
      {"driven_bow", drivenBow, {}},
      {"weighed", weighed, {}},
      {"macros", pushes, {}},
      {"audio_macros", swinging, {}},
      {"plucked_skin", pushes, {}},
      {"contact",
       strokes,
       {overlap("apart", 0, 1, -9.0, 0.0), overlap("pressed", 0, 1, 0.0, 9.0),
        overlap("beyond the threshold", 2, 0, -9.0, -0.6),
        overlap("held off by the threshold", 2, 0, -0.6, 0.0)}},
      {"cubic_contact",
       strokes,
       {overlap("apart", 0, 1, -9.0, 0.0), overlap("cubic", 0, 1, 0.0, 0.0516),
        overlap("clipped", 0, 1, 0.0517, 9.0), overlap("threshold", 0, 2, -0.1, 0.0)}},
      {"nl_springs", silence, {}},
      {"clipped_springs",
       pushes,
       {stretch("cubic", 2, 0.1, 0.316), stretch("clipped", 2, 0.317, 9.0)}},
      {"pluck",
       plectrum,
       {distance("inner", 0.001, 0.02), distance("outer", 0.02, 0.2), distance("free", 0.2, 9.0)}},
      {"dry_pluck",
       plectrum,
       {distance("inner", 0.0, 0.03), distance("outer", 0.03, 0.3), distance("free", 0.3, 9.0)}},
      {"bow",
       bowing,
       {slip("stick", 0.0, 2e-4), slip("slip", 2e-4, 6e-4), slip("outrun", 6e-4, 9.0)}},
      {"smooth_bow", bowing, {slip("stick", 0.0, 2e-4), slip("slip", 2e-4, 6e-4)}},
  };
  return all;
}

std::string modelText(const std::string& name) {
  return textOf(repository("test/golden/models/" + name + ".mdl"));
}

Channels inputsOf(const Case& c) {
  Channels inputs(4, std::vector<double>(kFrames));
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    for (std::size_t n = 0; n < kFrames; ++n) {
      inputs[k][n] = c.input(k, n);
    }
  }
  return inputs;
}

/// What the product makes of the model. The number of ticks is the least that covers kFrames.
Channels play(const scene::Scene& scene,
              int ratio,
              physics::Precision precision,
              const Channels& in) {
  const physics::Rates rates{test::kMdlSampleRate, ratio};
  const auto instrument = physics::compile(physics::settle(scene, rates).scene, rates, precision);
  const auto ins = static_cast<std::size_t>(instrument->inputChannels());
  const auto outs = static_cast<std::size_t>(instrument->outputChannels());
  const auto r = static_cast<std::size_t>(ratio);
  std::vector<double> input(r * ins);
  std::vector<double> output(r * outs);
  Channels result(outs, std::vector<double>(kFrames));
  for (std::size_t first = 0; first < kFrames; first += r) {
    const std::size_t here = std::min(r, kFrames - first);
    for (std::size_t i = 0; i < here * ins; ++i) {
      input[i] = in[i % ins][first + i / ins];
    }
    instrument->tick({nullptr, nullptr, input.data(), output.data()});
    for (std::size_t i = 0; i < here * outs; ++i) {
      result[i % outs][first + i / outs] = output[i];
    }
  }
  return result;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    // A NaN counts as the largest error there is.
    largest = a[n] - b[n] == a[n] - b[n] ? std::max(largest, std::abs(a[n] - b[n])) : HUGE_VAL;
  }
  return largest;
}

/// Fails unless every channel stays within `tolerance` of its peak.
void expectSame(const Channels& got, const Channels& wanted, double tolerance) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    EXPECT_LE(largestDifference(got[k], wanted[k]), tolerance * peakOf(wanted[k]))
        << "out" << k + 1 << ", peak " << peakOf(wanted[k]);
  }
}

class MdlGoldenTest : public testing::TestWithParam<Case> {
 protected:
  std::string text_ = modelText(GetParam().model);
  Channels inputs_ = inputsOf(GetParam());
  Channels wanted_ = test::simulateMdl(text_, {}, inputs_, kFrames);

  void expectPlayedLikeSimulated(physics::Precision precision, double tolerance) {
    const scene::Scene scene = scene::readMdl(text_, std::string(GetParam().model) + ".mdl");
    for (const int ratio : {1, 4, 14}) {
      SCOPED_TRACE("R = " + std::to_string(ratio));
      expectSame(play(scene, ratio, precision, inputs_), wanted_, tolerance);
    }
  }
};

TEST_P(MdlGoldenTest, IsPlayedLikeTheSimulatorInDouble) {
  expectPlayedLikeSimulated(physics::Precision::kDouble, 1e-11);
}

TEST_P(MdlGoldenTest, IsPlayedLikeTheSimulatorInFloat) {
  expectPlayedLikeSimulated(physics::Precision::kFloat, 1e-3);
}

TEST_P(MdlGoldenTest, PassesThroughEveryBranchOfItsLaws) {
  for (const Branch& branch : GetParam().branches) {
    const std::vector<double>& one = wanted_.at(branch.first);
    std::vector<double> two = wanted_.at(branch.second);
    if (branch.first == branch.second) {
      two.assign(two.size(), 0.0);
    }
    int visits = 0;
    for (std::size_t n = 1; n < kFrames; ++n) {
      const double dx = one[n] - two[n];
      visits += branch.holds(dx, dx - (one[n - 1] - two[n - 1])) ? 1 : 0;
    }
    EXPECT_GE(visits, 20) << branch.name;
  }
}

/// The text without line `number`, and that line.
std::pair<std::string, std::string> withoutLine(const std::string& text, int number) {
  std::istringstream stream(text);
  std::string rest;
  std::string removed;
  std::string line;
  for (int i = 0; std::getline(stream, line); ++i) {
    (i == number ? removed : rest) += line + "\n";
  }
  return {rest, removed};
}

TEST_P(MdlGoldenTest, SoundsDifferentWithoutAnyOfItsLinks) {
  int links = 0;
  const auto lines = std::count(text_.begin(), text_.end(), '\n');
  for (int i = 0; i < lines; ++i) {
    const auto [rest, removed] = withoutLine(text_, i);
    if (removed[0] != '@' || std::count(removed.begin(), removed.end(), '@') != 3) {
      continue;
    }
    ++links;
    const Channels other = test::simulateMdl(rest, {}, inputs_, kFrames);
    double change = 0.0;
    for (std::size_t k = 0; k < other.size(); ++k) {
      const double peak = peakOf(wanted_[k]);
      change = std::max(change, peak > 0.0 ? largestDifference(other[k], wanted_[k]) / peak : 0.0);
    }
    EXPECT_GT(change, 0.01) << removed;
  }
  EXPECT_GT(links, 0);
}

INSTANTIATE_TEST_SUITE_P(Models, MdlGoldenTest, testing::ValuesIn(cases()), [](const auto& model) {
  return std::string(model.param.model);
});

TEST(MdlParameterTest, AsksForTheClippedLawsOfFaust) {
  for (const char* model : {"cubic_contact", "clipped_springs"}) {
    const std::string text = modelText(model);
    const bool is_contact = std::string(model) == "cubic_contact";
    const Channels inputs = inputsOf({model, is_contact ? strokes : pushes, {}});
    const Channels wanted = test::simulateMdl(text, {{"faust_clip", 1.0}}, inputs, kFrames);
    for (const auto& [asked, overrides] :
         {std::pair(text, scene::Overrides{{"faust_clip", 1.0}}),
          std::pair(text + "@faust_clip param 1\n", scene::Overrides{})}) {
      const scene::Scene scene = scene::readMdl(asked, "faust.mdl", overrides);
      expectSame(play(scene, 14, physics::Precision::kDouble, inputs), wanted, 1e-11);
    }
    const Channels other = test::simulateMdl(text, {}, inputs, kFrames);
    const std::size_t k = is_contact ? 0 : 2;  // of what is clipped
    EXPECT_GT(largestDifference(other[k], wanted[k]), 0.01 * peakOf(wanted[k])) << model;
  }
}

TEST(MdlParameterTest, ReplacesTheTextsValueEverywhere) {
  const std::string text = modelText("params");
  const std::map<std::string, double> given = {{"K", 0.08}, {"M", 3.0}};
  const Channels inputs(1, std::vector<double>(kFrames));
  const Channels wanted = test::simulateMdl(text, given, inputs, kFrames);
  const scene::Scene scene = scene::readMdl(text, "params.mdl", {given.begin(), given.end()});
  expectSame(play(scene, 14, physics::Precision::kDouble, inputs), wanted, 1e-11);
  const Channels plain = test::simulateMdl(text, {}, inputs, kFrames);
  EXPECT_GT(largestDifference(plain[0], wanted[0]), 0.1 * peakOf(wanted[0]));
}

}  // namespace
}  // namespace ergotic
