// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/modal_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/generate/body_modes.hpp"
#include "scene/generate/generated.hpp"
#include "scene/generate/points.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

constexpr double kHighestByItselfHz = 18'000.0;
constexpr double kCellSpacing = 0.01;  // m, of the picture
// Of an outline: so many places show the shape of every mode that is seen.
constexpr int kOutlineColumns = 25;
constexpr int kOutlineRows = 13;

/// The taps of a network, between the modules around each place.
void addPlaces(SceneBuilder& builder, const std::string& name, const BodyForm& form, Place place) {
  if (form.places.empty()) {
    return;
  }
  const Grid grid = builder.scene().grids[at(builder.grid(name, place))];
  for (const BodyPlace& wanted : form.places) {
    const GridPlace there = placeOn(grid, wanted.along, wanted.across);
    Tap tap;
    tap.place = wanted.place;
    for (std::size_t i = 0; i < at(there.count); ++i) {
      if (there.weights[i] != 0.0) {
        tap.shares.push_back({there.mats[i], there.weights[i]});
      }
    }
    addTap(builder, name + "." + wanted.name, std::move(tap));
  }
}

/// T60 of a partial between those that are asked for: sigma straight over the frequency.
double t60At(const std::vector<double>& hz, const BodyWish& wish, double frequency_hz) {
  if (wish.t60.empty()) {
    return 0.0;
  }
  const auto& [low, low_s] = wish.t60.front();
  const auto& [high, high_s] = wish.t60.back();
  if (low == high) {
    return low_s;
  }
  const double from = hz[at(low - 1)];
  const double share = (frequency_hz - from) / (hz[at(high - 1)] - from);
  const double rate = (1.0 - share) / low_s + share / high_s;
  return rate > 0.0 ? 1.0 / rate : std::max(low_s, high_s);
}

/// The highest partial that a decay is asked for.
int highestWanted(const BodyWish& wish) {
  return wish.t60.empty() ? 1 : wish.t60.back().first;
}

/// The modes of a network of its own, which is thrown away.
class NetworkVibrations : public Vibrations {
 public:
  NetworkVibrations(const SceneBuilder& builder,
                    int section,
                    const BodyWish& wish,
                    int wanted,
                    const AddNetwork& network)
      : network_(builder.scene().file, "") {
    network_.scene().origins = builder.scene().origins;
    network_.scene().sections = {builder.scene().sections[at(section)]};
    BodyWish lossless = wish;
    lossless.t60.clear();
    network(network_, 0, lossless);
    const Tuning& body = network_.scene().tunings.back();
    modes_ = lowestModes(network_.scene(), body, wanted);
    for (int m = body.first_mat; m < body.first_mat + body.mats; ++m) {
      const Mat& mat = network_.scene().mats[at(m)];
      mass_ += mat.type == MatType::kGround ? 0.0 : mat.mass.factor;
    }
  }

  int count() const override { return static_cast<int>(modes_.modes.size()); }
  double stiffness(int mode) const override {
    return modes_.modes[at(mode)].springs + modes_.modes[at(mode)].bends;
  }
  double mass() const override { return mass_; }
  Eigen::Vector3d begin() const override {
    return network_.scene().mats[at(network_.scene().tunings.back().first_mat)].rest;
  }

  double shape(int mode, double along, double across) const override {
    const GridPlace there = placeOn(grid(), along, across);
    double shape = 0.0;
    for (std::size_t i = 0; i < at(there.count); ++i) {
      shape += there.weights[i] * modes_.shapes(there.mats[i] - grid().first, mode);
    }
    return shape * std::sqrt(mass_);
  }
  Eigen::Vector3d rest(double along, double across) const override {
    const GridPlace there = placeOn(grid(), along, across);
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < at(there.count); ++i) {
      rest += there.weights[i] * network_.scene().mats[at(there.mats[i])].rest;
    }
    return rest;
  }

  /// What moves, and the rim around it: the corners beyond a round edge are left out.
  Drawn drawn(int modes) const override {
    const int columns = std::min(grid().columns, kOutlineColumns);
    const int rows = std::min(grid().rows, kOutlineRows);
    const auto placeAt = [&](int row, int column) {
      return Eigen::Vector2d(column / std::max(columns - 1.0, 1.0),
                             row / std::max(rows - 1.0, 1.0));
    };
    std::vector<unsigned char> moving(at(rows * columns));
    for (int place = 0; place < rows * columns; ++place) {
      const Eigen::Vector2d there = placeAt(place / columns, place % columns);
      for (int j = 0; j < modes; ++j) {
        if (shape(j, there.x(), there.y()) != 0.0) {
          moving[at(place)] = 1;
        }
      }
    }
    const auto moves = [&](int row, int column) {
      return row >= 0 && row < rows && column >= 0 && column < columns &&
             moving[at(row * columns + column)] != 0;
    };
    Drawn drawn;
    std::vector<int> numbers(at(rows * columns), -1);  // of those that are drawn
    for (int place = 0; place < rows * columns; ++place) {
      const int row = place / columns;
      const int column = place % columns;
      if (!moves(row, column) && !moves(row - 1, column) && !moves(row + 1, column) &&
          !moves(row, column - 1) && !moves(row, column + 1)) {
        continue;
      }
      const int number = numbers[at(place)] = static_cast<int>(drawn.places.size());
      drawn.places.push_back(placeAt(row, column));
      for (const int other : {column > 0 ? numbers[at(place - 1)] : -1,
                              row > 0 ? numbers[at(place - columns)] : -1}) {
        if (other >= 0) {
          drawn.lines.emplace_back(other, number);
        }
      }
    }
    return drawn;
  }

 private:
  const Grid& grid() const { return network_.scene().grids.back(); }

  SceneBuilder network_;
  BodyModes modes_;
  double mass_ = 0.0;
};

/// Makes cells of the vibrations of a body.
class Modes {
 public:
  Modes(const SceneBuilder& builder,
        const BodyWish& wish,
        const BodyForm& form,
        Place place,
        const Vibrations& body)
      : builder_(builder), wish_(wish), form_(form), place_(place), body_(body) {}

  ModalSpec found(const std::string& name, int section) {
    spec_.name = name;
    spec_.section = section;
    spec_.place = place_;
    spec_.at = body_.begin();
    setFrequencies();
    checkDecays();
    for (const BodyPlace& each : form_.places) {
      spec_.places.push_back(each.name);
      spec_.seen_at.push_back(body_.rest(each.along, each.across));
    }
    const int wanted = form_.partials > 0 ? form_.partials : kMaxPartials;
    for (int j = 0; j < std::min(wanted, static_cast<int>(hz_.size())); ++j) {
      if (!addPartial(j)) {
        break;
      }
    }
    setOutline();
    return std::move(spec_);
  }

 private:
  void setFrequencies() {
    if (body_.count() < std::max({highestWanted(wish_), wish_.pitch_of, form_.partials})) {
      builder_.fail(place_, "the network of body " + quoted(spec_.name) + " has " +
                                std::to_string(body_.count()) +
                                " partials, allowed: no more. Give it more masses");
    }
    const double unit = body_.stiffness(wish_.pitch_of - 1);
    for (int j = 0; j < body_.count(); ++j) {
      hz_.push_back(wish_.is_string ? wish_.pitch_hz * stretched(j + 1) / stretched(wish_.pitch_of)
                                    : wish_.pitch_hz * std::sqrt(body_.stiffness(j) / unit));
    }
  }
  /// Between two of one frequency nothing says how the decay changes.
  void checkDecays() const {
    constexpr double kApart = 1e-6;
    if (wish_.t60.size() < 2) {
      return;
    }
    const int low = wish_.t60.front().first;
    const int high = wish_.t60.back().first;
    if (!(hz_[at(high - 1)] > (1.0 + kApart) * hz_[at(low - 1)])) {
      builder_.fail(place_, "'t60' of body " + quoted(spec_.name) + " names partials " +
                                std::to_string(low) + " and " + std::to_string(high) +
                                ", which both sound at " + numberText(hz_[at(low - 1)]) +
                                " Hz, allowed: partials of two frequencies");
    }
  }
  double stretched(int partial) const {
    return partial * std::sqrt(1.0 + std::max(0.0, wish_.inharmonicity) * partial * partial);
  }

  /// \return false if it and those above are too high, and nobody counted them
  bool addPartial(int j) {
    const double hz = hz_[at(j)];
    if (form_.partials == 0 && j > 0 && hz > kHighestByItselfHz) {
      return false;
    }
    if (hz > kHighestPartialHz) {
      builder_.fail(place_, "partial " + std::to_string(j + 1) + " of body " + quoted(spec_.name) +
                                " would be at " + numberText(hz) + " Hz, allowed: at most " +
                                numberText(kHighestPartialHz) + " Hz. Ask for fewer 'partials'");
    }
    Partial partial;
    partial.frequency_hz = hz;
    partial.t60_s = t60At(hz_, wish_, hz);
    partial.mass = body_.mass();
    for (const BodyPlace& wanted : form_.places) {
      partial.weights.push_back(body_.shape(j, wanted.along, wanted.across));
    }
    spec_.partials.push_back(std::move(partial));
    return true;
  }

  void setOutline() {
    Outline& outline = spec_.outline;
    outline.name = spec_.name;
    outline.modes = static_cast<int>(spec_.partials.size());
    Vibrations::Drawn drawn = body_.drawn(outline.modes);
    outline.lines = std::move(drawn.lines);
    for (const Eigen::Vector2d& there : drawn.places) {
      outline.rest.push_back(body_.rest(there.x(), there.y()));
      for (int j = 0; j < outline.modes; ++j) {
        outline.weights.push_back(body_.shape(j, there.x(), there.y()));
      }
    }
  }

  const SceneBuilder& builder_;
  const BodyWish& wish_;
  const BodyForm& form_;
  Place place_;
  const Vibrations& body_;
  ModalSpec spec_;
  std::vector<double> hz_;
};

}  // namespace

void addModalBody(SceneBuilder& builder, const ModalSpec& spec) {
  constexpr double kNothing = 1e-12;  // of a weight: a node
  builder.reserve(spec.partials.size() + spec.places.size(), 0, spec.place);
  const auto first = static_cast<int>(builder.scene().mats.size());
  const Name stem(spec.name + ".");
  for (std::size_t j = 0; j < spec.partials.size(); ++j) {
    const Partial& partial = spec.partials[j];
    const double omega = 2.0 * M_PI * partial.frequency_hz;
    const double sigma = partial.t60_s > 0.0 ? std::log(1000.0) / partial.t60_s : 0.0;
    const Eigen::Vector3d rest =
        spec.at + Eigen::Vector3d(0.0, kCellSpacing * static_cast<double>(j), 0.0);
    Mat cell =
        generatedMat(builder, spec.section, stem.numbered(static_cast<int>(j)), rest, spec.place);
    cell.type = MatType::kCell;
    cell.matched = true;
    cell.mass.factor = partial.mass;
    cell.stiffness.factor = partial.mass * (omega * omega + sigma * sigma);
    cell.damping.factor = 2.0 * partial.mass * sigma;
    builder.add(std::move(cell));
  }
  for (std::size_t p = 0; p < spec.places.size(); ++p) {
    Tap tap;
    tap.place = spec.place;
    for (std::size_t j = 0; j < spec.partials.size(); ++j) {
      const double weight = spec.partials[j].weights[p];
      if (std::abs(weight) > kNothing) {
        tap.shares.push_back({first + static_cast<int>(j), weight});
      }
    }
    if (tap.shares.empty()) {
      builder.fail(spec.place, "place " + quoted(spec.places[p]) + " of body " + quoted(spec.name) +
                                   " does not move in any of its partials, allowed: one that does");
    }
    const int point = addTap(builder, spec.name + "." + spec.places[p], std::move(tap));
    if (p < spec.seen_at.size()) {  // a picture shows it there; along x it rests as it did
      builder.scene().mats[at(point)].rest.tail<2>() = spec.seen_at[p].tail<2>();
    }
  }
  if (!spec.outline.rest.empty()) {
    builder.scene().outlines.push_back(spec.outline);
    builder.scene().outlines.back().first_mat = first;
  }
}

int partialsOf(const BodyWish& wish, const BodyForm& form) {
  return std::max(form.partials > 0 ? form.partials : kMaxPartials, highestWanted(wish));
}

void addVibratingBody(SceneBuilder& builder,
                      const std::string& name,
                      int section,
                      const BodyWish& wish,
                      const BodyForm& form,
                      Place place,
                      const Vibrations& body) {
  addModalBody(builder, Modes(builder, wish, form, place, body).found(name, section));
}

void addBody(SceneBuilder& builder,
             const std::string& name,
             int section,
             const BodyWish& wish,
             const BodyForm& form,
             Place place,
             const AddNetwork& network) {
  if (form.is_modal) {
    const NetworkVibrations body(builder, section, wish, partialsOf(wish, form), network);
    addVibratingBody(builder, name, section, wish, form, place, body);
  } else {
    network(builder, section, wish);
    addPlaces(builder, name, form, place);
  }
}

}  // namespace ergotic::scene
