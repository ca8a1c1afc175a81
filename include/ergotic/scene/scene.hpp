// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "ergotic/scene/about.hpp"
#include "ergotic/scene/lia_type.hpp"
#include "ergotic/scene/name.hpp"
#include "ergotic/scene/rare.hpp"
#include "ergotic/scene/tuning.hpp"
#include "ergotic/scene/value.hpp"

/// A scene: what the instrument is made of, before any rate or precision is chosen.
///
/// Plain data. Everything is in SI units when `Scene::time_unit_s` is 1. Scenes read from `.mdl`
/// files count time in samples of 44.1 kHz instead (`time_unit_s = 1 / 44100`): a stiffness is then
/// in kg/sample^2, a velocity in m/sample. `compile` turns both into steps of the rate it is asked
/// for, so that either kind keeps its pitch at any rate.
///
/// A section declares its geometry. Scalar motion (the default) is along the x axis of the section;
/// the y-z plane is then the workbench, on which only the picture depends. In the Euclidean
/// geometries modules move along x, in the x-y plane or in space, and links act along the line that
/// joins their ends.
namespace ergotic::scene {

/// How modules of a section move and what a link's elongation is.
enum class Geometry : std::uint8_t {
  kScalar,  ///< along x; e = x_a - x_b, signed
  kLine,    ///< along x; e from the distance |x_a - x_b|
  kPlane,   ///< in x-y, distances in the plane
  kSpace,   ///< in x-y-z
};
/// Coordinates that move: 1, 1, 2, 3.
int dimensionsOf(Geometry geometry);

/// Section::modes: how many modes of vibration may stand in for the linear part of a section.
constexpr int kNoModes = 0;
constexpr int kAllModes = std::numeric_limits<int>::max();
constexpr int kAutomaticModes =
    -1;  ///< all, where they take fewer products per step than the network has modules

/// Modules that are stepped together, at one rate, in one frame.
struct Section {
  std::string name;
  bool gestural = false;        ///< stepped once per tick; otherwise `divisor` holds
  bool automatic_rate = false;  ///< `settle` chooses the rate by the section's highest mode
  int divisor = 1;              ///< audio frames per step, 1: the audio rate
  Geometry geometry = Geometry::kScalar;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< section frame in frame `model`
  /// Acceleration of free modules, m/time_unit^2, along the coordinates that move.
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  /// Damping of every mass and cell to the ground, kg/time_unit. It adds to the cells' own before
  /// these are matched; that of masses always is.
  Value medium{};
  double sleep_energy = 0.0;       ///< kg m^2/time_unit^2, below which it may rest at 0; 0: never
  bool starts_in_balance = false;  ///< `settle` moves what forces move to where it is at rest
  int modes = kNoModes;            ///< most modes that it is played by; scalar sections only
  Place place;
};

enum class MatType : std::uint8_t {
  kMass,    ///< (MAS) free inertia
  kGround,  ///< (SOL) fixed point
  kCell,  ///< (CEL) mass with a spring and a damper to x = 0, or in Euclidean sections to its rest
  kDriven,  ///< its position is an input (`.mdl` posInput)
  kSlice,   ///< moved from outside by ports, which feel its force; along x unless they say more
  kPoint,   ///< massless: lies between the modules of a grid, or on any; see Connection and Tap
};

/// How faster sections see a slice. `settle` turns the last two into the others.
enum class Coupling : std::uint8_t {
  kHold,     ///< zero-order hold: its position at the start of the tick
  kSmooth,   ///< gliding: its positions interpolated, two ticks late
  kChaplet,  ///< held, with a chaplet before each of its links to them
  kAuto,     ///< the one of these with the least predicted error that the hand bears
};

/// Initial velocity and forces of a module beside its links. Only the coordinates that move count.
struct Push {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     ///< m/time_unit, at the start
  Eigen::Vector3d force = Eigen::Vector3d::Zero();        ///< constant, kg m/time_unit^2
  Eigen::Vector3d first_force = Eigen::Vector3d::Zero();  ///< force in the very first step only
};

/// (MAT) A material point: takes a force, gives a position.
struct Mat {
  Name name;
  Value mass{1.0};    ///< kg, > 0; mass and cell
  Value stiffness{};  ///< kg/time_unit^2, cell only
  Value damping{};    ///< kg/time_unit, cell only
  /// m; displacements are stored and displayed from here. Scalar sections: y and z are the place on
  /// the workbench.
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();
  /// m, absolute (not from rest), at the start; the coordinates that move, the others are ignored.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Rare<Push> push;
  Place place;
  int section = 0;
  MatType type = MatType::kMass;
  Coupling coupling = Coupling::kHold;  ///< slices only
  /// Cells: coefficients whose pole is that of the continuous oscillator, not its first order.
  bool matched = false;
};

/// Gives a module a velocity at the start; none takes no memory.
inline void setVelocity(Mat& mat, const Eigen::Vector3d& velocity) {
  if (velocity != mat.push->velocity) {
    mat.push.edit().velocity = velocity;
  }
}

/// How the force of a link is worked out in time.
enum class Scheme : std::uint8_t {
  kExplicit,      ///< CORDIS-ANIMA, from the present positions
  kEnergyStable,  ///< never gives more energy than it took; contact, two-sided springs and friction
  kAuto,          ///< `settle` chooses by the rules of the certificate
  /// `settle` chooses: explicit, as `.mdl` files mean it, unless it is too stiff for that.
  kExplicitIfStable,
};

/// Points (x, y) of a function, sorted by x, at least two if there are any.
struct Table {
  std::vector<std::pair<double, double>> points;
  bool smooth = false;  ///< monotone cubic between the points; otherwise straight lines
  bool empty() const { return points.empty(); }
};

/// Memory of a relaxing link: a spring that follows the elongation and decays.
struct Relaxation {
  Value stiffness{};  ///< K_r >= 0, kg/time_unit^2
  double time = 1.0;  ///< time in which it decays, time units
};
constexpr std::size_t kMaxRelaxations = 3;

/// Coefficients that only some laws of links need.
struct LiaLaw {
  Value nonlinearity{};     ///< Q, kg/(m time_unit^2) or kg/(m^2 time_unit^2)
  Value stiffness_limit{};  ///< K_limit, kg/time_unit^2
  Value limit_damping{};    ///< extra damping beyond the tipping point, kg/time_unit
  /// Contacts: threshold, m. Pluck: width of the plectrum, m. Bow: width of the friction curve,
  /// m/time_unit.
  Value width{};
  Value exponent{1.0};  ///< exponent of the power contact, 1...5
  /// Clipped cubic laws: |e| at which the slope K_limit takes over, m. It is
  /// sqrt((K_limit - K) / Q), where the force is continuous, or as Faust has it, which `.mdl` files
  /// may ask for, sqrt(K_limit - K) / Q.
  double tipping_point = 0.0;
  double release = 0.0;  ///< conditional: |e| at which it lets go, m, >= width
  /// (e, force): pluck and LNL; (v, force): bow; (|v|, mu): friction. Pluck and bow are 0 outside,
  /// the others hold their ends.
  Table table;
  Table viscous_table;                  ///< (v, force): LNL
  std::vector<Relaxation> relaxations;  ///< relaxing: 1...kMaxRelaxations
  /// Friction: the normal force, kg m/time_unit^2, unless a contact gives it.
  Value normal{};
  Name pressed_by;  ///< the contact whose force, where it pushes, is the normal force
  /// Friction: mu = steady + sum of share e^(-|v|/width), or the table of mu over |v|.
  struct Fall {
    double share = 0.0;
    double width = 1.0;  ///< m/time_unit
  };
  double steady = 0.0;
  std::array<Fall, 2> falls{};
};

/// (LIA) An interaction: takes two positions, gives one force, -f to `a` and +f to `b`,
/// with e = x_a - x_b - rest_length and v = v_a - v_b.
/// The laws are written out in docs/physics/elements.md.
struct Lia {
  Name name;
  int a = 0;  ///< index in Scene::mats
  int b = 0;
  Value stiffness{};         ///< K, kg/time_unit^2
  Value damping{};           ///< Z, kg/time_unit
  double rest_length = 0.0;  ///< m; scalar: along x; not for contacts
  Rare<LiaLaw> law;          ///< the rest of its coefficients
  Place place;
  LiaType type = LiaType::kSpringDamper;
  Scheme scheme = Scheme::kExplicit;
  bool filtered = false;  ///< `settle` puts a chaplet between the slower end and this link
  int bend = -1;          ///< index in Scene::bends of what it is a part of, -1: none
  int tank = -1;          ///< index in Scene::tanks of the one that it shares, -1: none
};

/// A link of three to five ends, with e = sum u x - rest_length and -u (K e + Z v) on each; the
/// weights u add up to 0. It is stepped as a spring between any two of them (`addBend`), some of
/// which are negative; what judges sees one load.
struct Bend {
  struct End {
    int mat = 0;          ///< index in Scene::mats: a mass, a cell or a ground, all of one section
    double weight = 0.0;  ///< u, a whole number, not 0
  };
  Name name;
  std::vector<End> ends;
  Value stiffness{};         ///< K >= 0, kg/time_unit^2
  Value damping{};           ///< Z >= 0, kg/time_unit; 0 in a plane and in space
  double rest_length = 0.0;  ///< m; scalar sections only
  int first_lia = 0;         ///< first of its springs, index in Scene::lias
  Place place;
};

/// One energy tank for many hardening links: cubic, without K and Z, sharing its energy. Either
/// each of them hardens by itself, or all by the mean of what they are stretched (`addStretch`).
struct Tank {
  Name name;
  bool is_mean = false;      ///< (sum Q e^2)^2 / (4 sum Q) is stored, not sum Q e^4 / 4
  std::vector<int> springs;  ///< mean: indices in Scene::lias of what is stretched
  int first_lia = 0;         ///< mean: of its own links, one beside each spring
  Value hardening{};         ///< mean: c >= 0; every spring gets K (1 + c S)
  double spacing = 1.0;      ///< mean: a, m, of the springs at rest; S is the mean of (e/a)^2/2
  Place place;
};

/// Modules in rows and columns between which points can lie: a string is one row.
struct Grid {
  std::string name;
  int first = 0;    ///< index of the first mat; the others follow, row by row
  int columns = 2;  ///< mats of a row
  int rows = 1;
  Place place{};
};

/// Position of a kPoint on a grid. It is the weighted mean of the modules around it, and these
/// receive its force with the same weights: a finger, the place of a bow, a fret, a bridge.
/// along = 0 is the first column, 1 the last; across = 0 the first row, 1 the last.
struct Connection {
  /// A fraction: that asked for, plus scale times the displacement of a module.
  struct Way {
    Value at{};
    int guide = -1;        ///< module, no point; -1: none
    int axis = 0;          ///< axis along which its displacement counts; 0: x
    double scale = 0.0;    ///< 1/m
    double minimum = 0.0;  ///< the fraction never leaves this range, whatever asks for it
    double maximum = 1.0;
  };
  int mat = 0;   ///< a kPoint, in the section of the grid
  int grid = 0;  ///< index in Scene::grids
  Way along{};
  Way across{};        ///< without effect on a grid of one row
  double speed = 0.0;  ///< largest change of along and across per time_unit; 0: at once
  double power = 1.0;  ///< W, the most that moving it may bring; it waits where it owes more
  Place place;
};

/// A kPoint on any modules of its section, with weights of any size and sign that stay: x = sum of
/// weight x, counted from where these rest, and each receives weight times its force. A lever, the
/// mean of several places, the hair of a bow, a place on a body that is played by its modes.
struct Tap {
  struct Share {
    int mat = 0;  ///< a mass, cell or ground
    double weight = 1.0;
  };
  int mat = 0;  ///< a kPoint
  std::vector<Share> shares;
  Place place;
  double offset = 0.0;  ///< where its modules are at rest, along x from its own rest, m
};

/// A hand inside the scene that is not the player's: its target position over time. Its stiffness
/// and damping are links of the scene.
struct Agent {
  std::string name;
  /// (s since the model began to play, m), in increasing time, at least one: straight lines
  /// between, the first and the last value outside.
  std::vector<std::pair<double, double>> knots;
  double period_s = 0.0;  ///< period after which it repeats; 0: once
  Place place;
  /// Target position. Realtime: yes (binary search)
  double at(double time_s) const noexcept;
};

/// One coordinate of a module that is moved from outside, where its force is felt: a slice of the
/// device by itself, an end-effector of several, or an agent. Model and hand may be scaled:
/// x_model = (x_hand - offset) / position_scale, F_hand = force_scale * F_model.
struct Port {
  std::string name;
  int mat = 0;   ///< a kSlice
  int axis = 0;  ///< the coordinate: 0 x, 1 y, 2 z; one that moves
  int slice =
      -1;  ///< of the device, from 0, that moves it by itself; -1: an end-effector or nothing
  int agent = -1;  ///< index in Scene::agents, -1: none
  int filter =
      -1;  ///< the mass that all links of `mat` are attached to against sensor noise, -1: none
  double offset = 0.0;  ///< m
  double position_scale = 1.0;
  double force_scale = 1.0;
  Place place;
};

enum class Quantity : std::uint8_t { kPosition, kVelocity, kForce };

/// A point of a line of modules: (1 - fraction) of `mat` and fraction of `next`.
struct Point {
  int mat = 0;
  int next = -1;  ///< -1: `mat` alone
  double fraction = 0.0;
};

/// An audio-rate input: position of a kDriven, or force on any other module.
struct Input {
  std::string name;
  Quantity quantity = Quantity::kForce;
  int mat = 0;
  int channel = 0;  ///< audio channel, from 0
  int axis = 0;     ///< the coordinate: 0 x, 1 y, 2 z; one that moves
  Value gain{1.0};  ///< m or kg m/time_unit^2 per unit of the channel
  Place place;
};

/// An audio-rate output. Force is the sum of the forces of all links on the module.
struct Output {
  std::string name;
  Quantity quantity = Quantity::kPosition;
  Point point;
  int channel = 0;  ///< audio channel, from 0; outputs on one channel add up
  int axis = 0;     ///< the coordinate: 0 x, 1 y, 2 z; one that moves
  Value gain{1.0};  ///< per m, m/time_unit or kg m/time_unit^2
  /// > 0: corner of a high pass of first order, Hz: a body radiates in proportion to its velocity
  /// above it, and to its acceleration below. Of velocities only.
  double radiation_hz = 0.0;
  Place place;
};

/// A generated string: what its closed-form pitch is computed from, and how it is named.
struct StringInfo {
  std::string name;
  int first = 0;    ///< index of the first mat (an end point)
  int count = 0;    ///< mats, both fixed ends included
  Value mass;       ///< of one mass, kg
  Value stiffness;  ///< of one link
  Value damping;    ///< of one link
  Value loss;       ///< of one mass to the ground
  /// > 0: the wanted fundamental, Hz. `settle` tunes the links to it, and leaves 0.
  double frequency_hz = 0.0;
  bool keeps_pitch = false;  ///< on what it ends on, too: `settle` tunes both together
  /// Its links also go to the second and third neighbours, in the order of addString; `settle` fits
  /// them to the partials of an ideal string.
  bool coarse = false;
  double rest_length_ratio = 0.0;  ///< rest length of a link / its length at rest; not scalar
  int first_lia = 0;               ///< index of its first link
};

/// Why a generated body cannot be stepped at its rate, and what to do about it, in the words in
/// which it was asked for. `settle` finds it.
struct BodyLimit {
  int first_mat = 0;
  int mats = 0;
  int first_lia = 0;
  int lias = 0;
  Place place;
  std::string text;
};

/// How many modules a text such as `plate/rim` has meant.
struct Selected {
  std::string text;
  std::size_t count = 0;
  Place place;
};

/// The shape of a body that is played by its modes, for pictures: places, each of which moves along
/// x by the weighted sum of its modes.
struct Outline {
  std::string name;
  int first_mat = 0;  ///< its first mode; the others follow
  int modes = 0;
  std::vector<Eigen::Vector3d> rest;       ///< [places] m, in the section
  std::vector<double> weights;             ///< [places][modes]
  std::vector<std::pair<int, int>> lines;  ///< between places
};

/// True if `settle` has still to choose.
inline bool isOpen(Scheme scheme) {
  return scheme == Scheme::kAuto || scheme == Scheme::kExplicitIfStable;
}

/// A whole scene.
/// \invariant after `validate`: every index is legal, names are unique, masses are positive.
struct Scene {
  std::string name;
  std::string file;                  ///< where it came from, for messages
  std::string text;                  ///< the source text, kept with every recording
  double time_unit_s = 1.0;          ///< see the top of this file
  double gestural_rate_hz = 3000.0;  ///< wanted; the real one is the audio rate over an integer
  std::vector<Parameter> parameters;
  std::vector<AudioParameter> audio_parameters;
  std::vector<Section> sections;
  std::vector<Mat> mats;
  std::vector<Lia> lias;
  std::vector<Bend> bends;
  std::vector<Tank> tanks;
  std::vector<Agent> agents;
  std::vector<Port> ports;
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<StringInfo> strings;
  std::vector<Tuning> tunings;
  std::vector<BodyLimit> body_limits;
  std::vector<Outline> outlines;
  std::vector<Grid> grids;
  std::vector<Connection> connections;
  std::vector<Tap> taps;
  std::vector<Selected> selections;  ///< each once, in the order of the text
  About about;
  std::vector<std::string> variants;  ///< names of all that the text has
  std::vector<Origin> origins;        ///< origins of places, see Place::origin
  std::vector<std::string> warnings;  ///< warnings of the readers, `file:line:col: warning: ...`

  double valueOf(const Value& v) const {
    if (v.audio >= 0) {
      return v.factor * audio_parameters[static_cast<std::size_t>(v.audio)].value;
    }
    return v.parameter < 0 ? v.factor
                           : v.factor * parameters[static_cast<std::size_t>(v.parameter)].value;
  }
  const Section& sectionOf(const Mat& mat) const {
    return sections[static_cast<std::size_t>(mat.section)];
  }
  /// Numbers that say where all modules are: the coordinates that move, module by module.
  int coordinates() const;
  /// 1 + the highest channel, 0 if there is none.
  int inputChannels() const;
  int outputChannels() const;
};

/// True if the link may be energy-stable, see `Law::explicitOnly`; a damper without a rest length
/// only where its line may turn. \pre the ends of the link exist
bool canBeEnergyStable(const Scene& scene, const Lia& lia);

/// True if the scene leaves nothing open: no rate, scheme, chaplet or pitch is still to
/// be chosen (physics::settle does); `compile` and `certify` need that.
bool isSettled(const Scene& scene);

/// Checks every rule that does not depend on how the scene was written.
/// \throws TextError with the place of the first offence, its value and the allowed range
void validate(const Scene& scene);

}  // namespace ergotic::scene
