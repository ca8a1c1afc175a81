// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

/// The steps by which settle() resolves the defaults of a scene, each in the source of its name:
/// first the rates and how faster sections see a slice, which try candidates, then everything else
/// in the order in which it is written here. All of them: Realtime: no.
namespace ergotic::physics {

/// lambda = (w h)^2 of the highest mode that a section with `rate: auto` may have: 2.9 cents.
constexpr double kSlowEnough = 0.04;

/// Rise of a mode with h^2 K/M = lambda < 4 by the explicit scheme, cents; 72.1 lambda to first
/// order.
double raisedCents(double lambda);

/// Makes the other choices for a scene whose rates are known.
using Complete = std::function<scene::Scene(scene::Scene)>;

/// Gives every section that leaves its rate to the station the lowest one, among the audio rate
/// over the divisors of R, at which its highest mode stays in tune (everything outside it held) and
/// the verdict on the whole scene is no worse than with the section at the audio rate. A section
/// with slices is gestural. Divisors of sections that links join divide one another.
void chooseAutomaticRates(scene::Scene& scene,
                          const Rates& rates,
                          const Complete& complete,
                          std::vector<std::string>& notes);

/// Chooses how faster sections see every slice that leaves it to the station: of hold, smooth and
/// chaplets that a hand bears in silence, as the certificate judges its ports, what is predicted to
/// err least; where it bears none, what is nearest to it. A slice that no faster section sees is
/// held.
/// Source: docs/physics/multirate.md, "Interpolated hands".
void chooseCouplings(scene::Scene& scene,
                     const Rates& rates,
                     const Complete& complete,
                     std::vector<std::string>& notes);

/// Asks for a chaplet at every link of the slices that want them, to be put there by
/// insertFilters().
void askForChaplets(scene::Scene& scene, const Rates& rates);

/// Nothing is proven of a slower mass beside a link that is not linear: hold and mean make no
/// energy on the average only. Where such a link leaves its scheme open, what forces move in the
/// slower section is stepped at the faster rate, up to some hundred modules, and a note says so: a
/// hammer, a bridge, a key. Slices stay; so do sections behind a chaplet, which is there for that.
/// \param scene     whose rates are chosen
/// \param complete  settles everything else of a candidate
/// Realtime: no. Source: docs/physics/schemes.md, "Defaults that are resolved".
void raiseRates(scene::Scene& scene,
                const Rates& rates,
                const Complete& complete,
                std::vector<std::string>& notes);

/// Gives every string that asks for a frequency the springs with which it sounds there at the rate
/// of its own section, with its damping: exactly, by itself, and at the present values of the
/// parameters; the upper partials of coarse strings as near as three springs can.
/// \throws TextError if a string cannot sound there, with what would help
void tuneStrings(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// Gives every body that asks for a pitch the springs, bends, dampers and losses with which it
/// sounds there and decays as asked at the rate of its section, exactly: a mode of the eigenvalue
/// lambda and the damping D of its links has kappa = h^2 lambda and, with the loss Y to the ground,
/// zeta = 1 - e^(-Y h/M) + h D, and rings with e^(-sigma t) where zeta = 1 - e^(-2 sigma h). Says
/// which partials it has then. None is left open; what has no modes is no body, but stops.
/// \throws TextError if a body cannot sound or decay so, with what would help
void tuneBodies(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// Makes frets and barriers as stiff as what they stop bears at its rate: K = c M/h^2, M the mass
/// that a contact meets, c = 3, or 0.8 of what the springs of the string leave of 4 if that is
/// less. Frets between two masses are moved until the string sounds as if it ended there, whatever
/// they yield. Leaves none open.
/// \pre strings and bodies are tuned: what is left of Scene::tunings are stops
void settleStops(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// Puts a C2 between the slower end and every link with Lia::filtered, which then starts at the
/// last mass: modules `<link>.filter.0` and `.1`, links `<link>.filter.link.0` and `.1`, added last
/// and stepped as often as the faster end. A slower end that is a mass with springs of its own also
/// gets the small dashpot `<link>.filter.dashpot` to `<link>.filter.ground`.
///
/// The chaplet is as heavy as the structure at the faster end asks for, at the present values of
/// the parameters (docs/physics/multirate.md, "Chaplets: mechanical low-passes"). One note for
/// each. \pre        the rates of all sections are chosen \throws TextError at the link if the
/// rates are too close for C2, if the chaplet would be too
///         heavy for the slower mass, or if there is nothing to filter for
/// Realtime: no.
void insertFilters(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// A table of which an end, with what its viscous part gives at rest, pushes outwards has a
/// potential without a floor, and what drives no damper of its own takes: only the springs and
/// dampers around hold it. With k and z less than these do, it is the sum of a linear link,
/// -k (e - e0) - z v, explicit and appended as `<name>.push`, and of a rest with a floor that
/// brakes, which is energy-stable. Where nothing holds it so far it stays as it is, and with a
/// viscous part explicit. \param scene  whose schemes may be open Realtime: no. Source:
/// docs/physics/schemes.md, "Energy-stable links".
void splitTables(scene::Scene& scene, const Rates& rates);

/// Cubic links with Scheme::kAuto that harden one body share one tank of energy, which costs about
/// as much as explicit links; energy-stable one by one they cost as much as so many contacts. What
/// of them is linear becomes a spring and damper beside, `<name>.linear`, which stays explicit. Not
/// where the rules of a tank forbid it, nor a single link.
void shareTanks(scene::Scene& scene, std::vector<std::string>& notes);

/// Makes every link with Scheme::kAuto explicit or energy-stable. Links onto a slower mass stay
/// explicit, because the energy-stable scheme is not proven there; so do links whose ends no force
/// moves. Those with Scheme::kExplicitIfStable stay explicit while the network is stable with all
/// of them at their steepest; the stiffest of them are made energy-stable until it is.
void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// A spring of stiffness K and rest length L that is l > L long where its ends rest is the sum of
/// two: one of stiffness K (1 - L/l) without a rest length, which is linear, and one of K L/l with
/// the rest length l, which then pushes nothing. Energy-stable ones become these two, the first of
/// them explicit and appended as `<name>.tension`: what moves across the line is held by the
/// tension alone, so it keeps its pitch at any stiffness, and the tank has nothing to hold at rest.
/// The damper is that of the energy-stable one, but in a line, where it never turns, that of the
/// other. One without a rest length is energy-stable for its damper only. \param scene  whose
/// schemes are chosen Realtime: no. Source: docs/physics/schemes.md, "Energy-stable links".
void splitSprings(scene::Scene& scene);

/// Moves the masses and cells of sections that are to start in equilibrium to where springs,
/// contacts, gravity and constant forces balance, to 1e-11 of the largest force on a module, with
/// hands at 0 and agents as they begin. What plucks or snaps in is taken as open. Newton's
/// method on the energy; other sections stay as they are.
/// \throws TextError if nothing holds a module, if one is linked to a plane or to space, or if a
/// stretch stiffens it
void startInEquilibrium(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

/// Warns of what surprises who plays a scene: of every pluck that already holds what it plucks when
/// the scene starts, so that it sounds in the first millisecond, before anybody plays; and of a
/// scene that nothing can set into motion.
/// \param warnings  gets `file:line:col: warning: ...`, with what to do about it
void warnAboutPlaying(const scene::Scene& scene, std::vector<std::string>& warnings);

}  // namespace ergotic::physics
