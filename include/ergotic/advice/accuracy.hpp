// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/generate/cut_string.hpp"
#include "ergotic/scene/scene.hpp"

/// Predicted errors of what is played: closed forms where there are any, else power laws of the
/// step, fitted to what `accuracy` measures. All errors are relative: 1 is as much as the right
/// value.
/// Realtime: no. Thread: any. Source: docs/physics/accuracy.md, "Speed against accuracy".
namespace ergotic::physics {

constexpr int kJudgedPartials = 10;

/// The first ten partials of an undamped string under the explicit scheme, cycles per step; NaN
/// where it has no such mode, and all of them if it is unstable or cannot be fitted at this step.
/// \param pitch     its fundamental, cycles per step
/// \param is_tuned  to that pitch as it sounds, as coarse ones always are; else it is the pitch in
///                  continuous time
std::vector<double> partialsOf(const scene::StringCut& cut, double pitch, bool is_tuned);

/// The worst of the first ten partials against the ideal string; infinity if one is missing.
double stringError(const scene::StringCut& cut, double pitch, bool is_tuned);

/// A mode of a linear network that is stepped explicitly, against continuous time.
/// \param angle  w h, rad; infinity from 2 on, where it is unstable
double modeError(double angle);

/// A mass thrown at F = K p^a so that it goes `depth` deep: how long they touch.
/// \param mass   reduced, kg
double contactDuration(double exponent, double stiffness, double mass, double depth);

/// Quantity of a contact that is judged.
enum class ContactFigure { kDuration, kPeakForce };

/// \param steps  number of steps in the duration of the contact
double contactError(ContactFigure figure, scene::Scheme scheme, double exponent, double steps);

/// Contact across two rates whose slower end is held (zero-order hold), bare or behind a chaplet.
/// \param slow_steps  in the duration of the contact
double heldContactError(bool filtered, double slow_steps);

/// Error of the sound by the steps of a hand's motion at this frequency.
/// \param slow_steps  in a period
double handError(scene::Coupling coupling, double slow_steps);

/// Pitch of stick and slip.
/// \param steps  in a period
double bowError(scene::Scheme scheme, double steps);

/// Errors by single precision, of a pitch or a duration, and of a whole sound.
constexpr double kFloatPitchError = 1e-6;
constexpr double kFloatSoundError = 2e-4;

}  // namespace ergotic::physics
