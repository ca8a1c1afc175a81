// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"

/// How wrong an instrument plays and what it costs, setting by setting: six problems whose right
/// answer is known (docs/physics/accuracy.md, "Speed against accuracy").
namespace ergotic::tools {

constexpr double kRateHz = 44100.0;  // of what is played
constexpr double kPitchHz = 110.0;   // of the strings
constexpr int kStringMasses = 40;    // of a string that is struck or plucked

/// What playing costs.
struct PlayCost {
  double cpu_s = 0.0;  ///< thread CPU time per second of sound, median of five runs
  double steps = 0.0;  ///< moving modules and links, each times its steps per second
};

/// One setting of a problem and one figure of what became of it.
struct Measurement {
  std::string problem;  ///< string, barrier, bow, hammer, hand, wall
  std::string measure;  ///< what the error is one of
  std::string family;   ///< of settings that differ in rates and sizes only
  physics::Precision precision = physics::Precision::kDouble;
  physics::Rates rates;
  int masses = 0;         ///< of a string; 0: none
  double exponent = 0.0;  ///< of a contact; 0: none
  double error = 0.0;     ///< smaller is better; infinite: the certificate refuses the setting
  std::string unit;
  PlayCost cost;
};

using Sink = std::function<void(const Measurement&)>;

/// The first ten partials of plain, lossy and coarse strings of 110 Hz against the ideal string,
/// cents, the worst of them.
void measureStrings(const Sink& sink);

/// A mass that meets a wall F = K p^a for 1 ms, against the closed form: relative errors of
/// duration, peak force and rebound, rms over the phase between two samples.
void measureBarriers(const Sink& sink);

/// Stick and slip of a bowed oscillator and of a bowed string, cents, against the same played
/// energy-stable at 16 times 88.2 kHz.
void measureBows(const Sink& sink);

/// A hammer at the gestural rate on a string, bare and through a chaplet, against R = 1: the whole
/// sound and its worst partial, dB.
void measureHammers(const Sink& sink);

/// A stiff plectrum in a hand that moves the same way at every gestural rate, as the string sees it
/// with each coupling of a slice: the worst partial against R = 1, dB.
void measureHands(const Sink& sink);

/// The stiffest wall that a hand does not set off, as compliance, mm/N: found by playing, and what
/// the certificate says.
void measureWalls(const Sink& sink);

/// One instrument of a problem.
class Experiment {
 public:
  /// \param yaml  scene text, valid
  Experiment(const std::string& yaml, const physics::Rates& rates, physics::Precision precision);

  /// Plays from the start on. \return [output channels][frames], whole ticks
  /// \param hand  where all slices are at a time, m of s; none: at 0
  std::vector<std::vector<double>> play(double seconds,
                                        const std::function<double(double)>& hand = {});

  /// Plays so much from the start on, again and again. Quiet machines give the best figures.
  PlayCost cost(double seconds);

  physics::Instrument& instrument() { return *instrument_; }

 private:
  std::unique_ptr<physics::Instrument> instrument_;
  std::vector<unsigned char> start_;
  std::vector<double> positions_, forces_, inputs_, outputs_;
};

/// The error of a setting that the certificate refuses.
constexpr double kNotPlayed = std::numeric_limits<double>::infinity();

/// True if the certificate does not foresee that this blows up.
bool isPlayable(const std::string& yaml, const physics::Rates& rates);

/// The first ten partials of a string cut into so many masses and tuned, as it sounds, Hz.
std::vector<double> stringPartials(int masses, double pitch_hz, double rate_hz);

/// Rates at which everything is measured that depends on the audio rate, Hz.
const std::vector<double>& measuredRates();

}  // namespace ergotic::tools
