// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/engine/orchestra.hpp"
#include "support/physics.hpp"
#include "support/places.hpp"
#include "support/realtime_scope.hpp"
#include "support/small_scene.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

/// All that a tick may ask of an instrument, with room for the answers.
class Playing {
 public:
  Playing(const scene::Scene& scene, const Rates& rates, Precision precision, int threads)
      : instrument_(compile(settle(scene, rates).scene, rates, options(precision, threads))),
        positions_(at(instrument_->ports())),
        forces_(positions_.size()),
        inputs_(at(rates.ratio * instrument_->inputChannels()), 0.1),
        outputs_(at(rates.ratio * instrument_->outputChannels())),
        state_(instrument_->stateSize()),
        displacements_(at(instrument_->scene().coordinates())),
        energies_(instrument_->makeEnergies()),
        tanks_(instrument_->makeTankReports()) {
    for (const scene::Parameter& parameter : instrument_->scene().parameters) {
      values_.push_back(parameter.value);
    }
  }

  void expectRealtimeTicks(int ticks) {
    auto coefficients = instrument_->prepare(values_);
    ergotic::test::expectRealtime([&] {
      for (int n = 0; n < ticks; ++n) {
        std::fill(positions_.begin(), positions_.end(), 1e-3 * std::sin(0.1 * n));
        instrument_->tick({positions_.data(), forces_.data(), inputs_.data(), outputs_.data()});
        if (instrument_->finish()) {
          lookInside(n);
        }
        if (n % 20 == 10) {
          coefficients = instrument_->exchange(std::move(coefficients));
        }
      }
    });
  }

 private:
  static CompileOptions options(Precision precision, int threads) {
    CompileOptions options = liveOptions();
    options.precision = precision;
    options.threads = threads;
    return options;
  }
  void lookInside(int n) noexcept {
    if (!instrument_->isFinite() || n % 50 == 25) {
      instrument_->loadState(state_.data());
    } else if (n % 50 == 0) {
      instrument_->saveState(state_.data());
    }
    instrument_->readDisplacements(displacements_.data());
    instrument_->readEnergies(energies_);
    instrument_->readTanks(tanks_);
  }

  const std::unique_ptr<Instrument> instrument_;
  std::vector<double> positions_;
  std::vector<double> forces_;
  std::vector<double> inputs_;
  std::vector<double> outputs_;
  std::vector<std::byte> state_;
  std::vector<float> displacements_;
  Energies energies_;
  std::vector<TankReport> tanks_;
  std::vector<double> values_;
};

void expectRealtimeTicks(const scene::Scene& scene, const Rates& rates, int ticks) {
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(std::string(nameOf(precision)) + ", threads: " + std::to_string(threads));
      Playing(scene, rates, precision, threads).expectRealtimeTicks(ticks);
    }
  }
}

/// What no small scene has.
const char kTables[] = R"(ergotic: 1
name: tables
sections: {hand: {rate: gestural}, sound: {rate: audio}}
mats:
  key: {type: slice, section: hand}
  cell: {type: cell, section: sound, mass: 1e-3, stiffness: 1e3, damping: 1e-3}
lias:
  pluck: {type: pluck, between: [key, cell], table: [[-1e-3, 0], [0, 1], [1e-3, 0]], scheme: explicit}
  bow: {type: bow, between: [key, cell], table: [[-1, 0], [-0.1, -1], [0.1, 1], [1, 0]],
        scheme: explicit}
  energy_stable_pluck: {type: pluck, between: [key, cell], table: [[-1e-3, 0], [0, 1], [1e-3, 0]],
                  scheme: energy_stable}
  energy_stable_bow: {type: bow, between: [key, cell], table: [[-1, 0], [-0.1, -1], [0.1, 1], [1, 0]],
                scheme: energy_stable}
ports: {key: {mat: key, slice: 0}}
)";

TEST(InstrumentRealtimeTest, EveryLawInEveryScheme) {
  std::set<scene::LiaType> seen;
  const auto play = [&seen](const std::string& text, const Rates& rates) {
    const scene::Scene scene = scene::readYaml(text, "small.yaml");
    for (const scene::Lia& lia : scene.lias) {
      seen.insert(lia.type);
    }
    expectRealtimeTicks(scene, rates, 100);
  };
  play(kTables, kRates);
  for (unsigned seed = 1; seed <= 52 || (seed <= 520 && seen.size() < scene::kLiaTypes); ++seed) {
    SCOPED_TRACE(seed);
    const ergotic::test::SmallScene small = ergotic::test::smallScene(seed);
    play(small.text(), small.rates);
  }
  EXPECT_EQ(seen.size(), scene::kLiaTypes);
}

TEST(InstrumentRealtimeTest, GroupsPointsInputsAndSleepers) {
  Orchestra orchestra(4);
  orchestra.addFollower();
  expectRealtimeTicks(orchestra.scene(), kRates, 500);
}

TEST(InstrumentRealtimeTest, Modes) {
  ergotic::test::SceneBuilder b;
  const int first = b.chain(60, 1e-3, 2e4, 1e-3);
  b.link(scene::LiaType::kContact, first + 20, b.slice(0), 1e3, 0.1);
  b.push(first + 9);
  b.hear(first + 30);
  b.scene.sections[0].modes = scene::kAllModes;
  expectRealtimeTicks(b.scene, kRates, 500);
}

TEST(InstrumentRealtimeTest, TheModelsOfTheHouse) {
  for (const char* const model : {"string", "fretted_string", "drum", "duet"}) {
    SCOPED_TRACE(model);
    const std::string path = repository(std::string("models/") + model + ".yaml");
    expectRealtimeTicks(scene::readSceneFile(path), kRates, 300);
  }
}

}  // namespace
}  // namespace ergotic::physics
