// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/render.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include <CLI/CLI.hpp>

#include "constants.hpp"
#include "ergotic/bag/recording.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/precision.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/rt/build_id.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/station/health.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "files/read_file.hpp"
#include "scene/limits.hpp"
#include "tools/lib/end_effectors.hpp"
#include "tools/lib/frame_writer.hpp"
#include "tools/lib/player.hpp"
#include "tools/lib/progress.hpp"
#include "tools/lib/render_energies.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/shipped.hpp"
#include "tools/lib/target.hpp"

namespace ergotic::tools {
namespace {

void say(const std::string& line) {
  std::cerr << line << '\n';
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Prints warnings without notes; `check --verbose` prints the notes.
void sayWarnings(const station::Performer& performer) {
  for (const std::string& line : performer.warnings) {
    if (line.find(": note: ") == std::string::npos) {
      say(line);
    }
  }
}

station::PerformerPolicy policyOf(const RenderOptions& options) {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  policy.allow_unstable = options.allow_unstable;
  return policy;
}

/// Changes a scene and how it is played as far as the target asks for it, and says so. Sounds and
/// recorded positions come at rates of their own, so these stay.
void meetTarget(const RenderOptions& options,
                scene::Scene& scene,
                physics::Rates& rates,
                physics::CompileOptions& compile) {
  const physics::Target target = physics::targetOf(options.target);
  physics::Freedom freedom = freedomOf(options.scene, options.compile);
  const bool has_positions = !options.gesture.empty() &&
                             tgr::gestureKindOf(options.gesture) == tgr::GestureKind::kPositions;
  freedom.audio_rate = freedom.audio_rate && options.inputs.empty() && !has_positions;
  freedom.gestural_rate = freedom.gestural_rate && !has_positions;
  const physics::Precision now =
      withPrecision(compile, physics::settle(scene, rates).scene).precision;
  physics::Proposal proposal = physics::propose(scene, rates, now, target, freedom);
  for (const std::string& line : targetLines(target, proposal)) {
    say(line);
  }
  scene = std::move(proposal.scene);
  rates = proposal.rates;
  compile.precision = proposal.precision;
}

/// Makes the player of the command line's scene: a CSV file, a song, or neither of them.
std::unique_ptr<Player> playScene(const RenderOptions& options) {
  if (options.scene.scene.empty()) {
    throw CLI::ValidationError("SCENE", "needed without a recording");
  }
  const Song song = options.midi.empty() ? Song() : readSong(options.midi);
  StageLine stages;
  stages.show("read " + options.scene.scene);
  scene::Scene scene = readScene(options.scene);
  physics::Rates rates = chosenRates(scene, options.scene);
  physics::CompileOptions compile = chosenOptions(options.compile);
  compile.metered = options.energies;
  if (!options.target.empty()) {
    stages.clear();
    meetTarget(options, scene, rates, compile);
  }
  SoundInputs inputs(options.inputs, scene, rates.audio_hz);
  const std::string note = conversionNote(scene, rates);
  station::PerformerPolicy policy = policyOf(options);
  policy.end_effectors = readEndEffectors(options.end_effectors);
  policy.on_stage = [&](const std::string& stage) { stages.show(stage); };
  auto performer = station::makePerformer(std::move(scene), rates, compile, policy);
  stages.clear();
  sayWarnings(*performer);
  for (const std::string& warning : inputs.warnings()) {
    say(warning);
  }
  if (performer->certificate.verdict != physics::Verdict::kPassive &&
      performer->certificate.verdict != physics::Verdict::kBounded) {
    say(std::string("warning: the verdict on this scene is ") +
        physics::toString(performer->certificate.verdict));
  }
  if (!note.empty()) {
    say(note);
  }
  if (!options.midi.empty()) {
    return makeSongPlayer(std::move(performer), std::move(inputs), policy.end_effectors, song,
                          options.map);
  }
  return options.gesture.empty()
             ? makeFreePlayer(std::move(performer), std::move(inputs))
             : makeHandPlayer(std::move(performer), std::move(inputs), options.gesture);
}

/// Probes the slices of a scene; there is no sound and no other player.
int feelScene(const RenderOptions& options) {
  if (options.scene.scene.empty() || !options.gesture.empty() || !options.midi.empty() ||
      !options.out.empty() || !options.inputs.empty() || !options.target.empty()) {
    throw CLI::ValidationError(
        "--feel", "takes a scene, and no --gesture, --midi, --out, --input or --target beside it");
  }
  scene::Scene scene = readScene(options.scene);
  const physics::Rates rates = chosenRates(scene, options.scene);
  station::PerformerPolicy policy = policyOf(options);
  policy.end_effectors = readEndEffectors(options.end_effectors);
  const auto performer =
      station::makePerformer(std::move(scene), rates, chosenOptions(options.compile), policy);
  sayWarnings(*performer);
  printText(feelReport(*performer, policy.device, policy.end_effectors, options.feel), std::cout);
  return kSuccess;
}

#ifdef ERGOTIC_HAVE_BAG
void compareScene(const std::string& path, const bag::Keyframe& keyframe) {
  if (path.empty()) {
    return;
  }
  if (files::readFile(path, scene::kMaxTextBytes) != keyframe.scene_text) {
    say("warning: " + path + " is not the scene of the recording (" + keyframe.scene_name +
        "); the recording's is played");
  }
}

/// Notes that the recording used other kernels; they do not change the sound, so that a recording
/// may come from any machine.
void compareIsa(const bag::Keyframe& keyframe, rt::Isa isa, bool asked_for) {
  if (!asked_for && keyframe.isa != nameOf(isa)) {
    say("note: recorded with kernels for " + keyframe.isa +
        ", which this processor lacks; those for " + nameOf(isa) + " play the same samples");
  }
}

void requireEnergies(const RenderOptions& options, const bag::Keyframe& keyframe) {
  if (options.energies && !keyframe.metered) {
    throw Exception(options.gesture +
                    ": recorded without energy accounts (energies: false), "
                    "--energies has nothing to say");
  }
}

/// A recording was played with its own rates, precision and parameters, or it is another one.
void requireNothingElse(const RenderOptions& options) {
  const SceneOptions& scene = options.scene;
  if (!scene.set.empty() || scene.rate_hz > 0.0 || scene.gestural_rate_hz > 0.0 ||
      !options.compile.precision.empty() || !options.inputs.empty() || !options.target.empty() ||
      !options.end_effectors.empty()) {
    throw CLI::ValidationError("--gesture",
                               "a recording says itself what --set, --rate, --gestural-rate, "
                               "--precision, --target, --end-effectors and --input would");
  }
}

std::unique_ptr<Player> playRecording(const RenderOptions& options) {
  requireNothingElse(options);
  const auto choose = [&](const physics::CompileOptions& recorded) {
    return chosenOptions(options.compile, recorded);
  };
  auto replay = std::make_unique<replay::Replay>(
      bag::readRecording(options.gesture, options.station), policyOf(options), choose);
  requireEnergies(options, replay->start());
  compareScene(options.scene.scene, replay->start());
  compareIsa(replay->start(), replay->instrument().options().isa, !options.compile.isa.empty());
  if (!endsWith(replay->start().build, rt::buildId())) {
    say("warning: recorded by build " + replay->start().build + ", played by build " +
        rt::buildId() + ": the sound may differ");
  }
  return makeRecordedPlayer(std::move(replay));
}
#else
std::unique_ptr<Player> playRecording(const RenderOptions& options) {
  throw Exception(options.gesture + ": this build has no ROS and reads no bags");
}
#endif

std::int64_t framesOf(const RenderOptions& options, const Player& player) {
  const double rate = player.rates().audio_hz;
  const std::int64_t recorded = player.ticksLeft() * player.rates().ratio;
  if (options.seconds > 0.0) {
    const std::int64_t wanted = std::max(1LL, std::llround(options.seconds * rate));
    return player.ticksLeft() < 0 ? wanted : std::min(wanted, recorded);
  }
  return player.ticksLeft() < 0 ? std::llround(player.usualSeconds() * rate) : recorded;
}

/// Warns of the part of a gesture that is not played. With --seconds the begin of a gesture may be
/// wanted, but hardly a tenth of it: a longer file was probably written in milliseconds.
void sayWhatOfTheGestureIsLost(const RenderOptions& options, const Player& player) {
  constexpr double kHardlyWanted = 9.0;
  const bool is_chosen = options.seconds > 0.0;
  const double seconds = is_chosen ? options.seconds : player.usualSeconds();
  for (const std::string& warning :
       player.gestureWarnings(seconds, is_chosen ? kHardlyWanted * seconds : 0.0)) {
    say(warning);
  }
}

/// Plays `frames` frames, or as many as there are. \return seconds of work
double playFrames(Player& player, std::int64_t frames, FrameWriter& writer) {
  const rt::FlushDenormals fast;
  const int ratio = player.rates().ratio;
  std::vector<double> tick(static_cast<std::size_t>(ratio * player.outputChannels()));
  Progress progress(frames);
  const auto begin = std::chrono::steady_clock::now();
  while (writer.frames() < frames && player.next(tick.data())) {
    writer.write(tick.data(), std::min<std::int64_t>(ratio, frames - writer.frames()));
    progress.show(writer.frames());
  }
  if (const std::int64_t stalled = player.instrument().stalledTicks(); stalled > 0) {
    throw Exception(std::to_string(stalled) +
                    " ticks are silent: another thread did not finish its share within " +
                    std::to_string(player.instrument().options().wait_limit_ns / 1'000'000) +
                    " ms. Use fewer threads");
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string summary(const Player& player, const FrameWriter& writer, double work_s) {
  const physics::Rates& rates = player.rates();
  const double length_s = static_cast<double>(writer.frames()) / rates.audio_hz;
  std::ostringstream line;
  line << player.instrument().scene().mats.size() << " modules ("
       << toString(player.instrument().options()) << "), " << rates.audio_hz << " Hz, gestures "
       << rates.gesturalHz() << " Hz (R = " << rates.ratio << "), " << writer.frames()
       << " frames (" << length_s << " s) in " << work_s << " s (" << length_s / work_s
       << " times real time), peak " << writer.peak() << ", all finite";
  if (writer.clippedSamples() > 0) {
    line << ", " << writer.clippedSamples() << " samples clipped to full scale";
  }
  return line.str();
}

/// Prints the level of the file, and the option that gives the usual loudness.
void sayLevel(const FrameWriter& writer, const std::string& out) {
  if (!writer.level()) {
    return;
  }
  std::ostringstream line;
  line.precision(3);
  line << out << ": " << describe(*writer.level());
  if (writer.gain() != 1.0) {
    line << "; normalized by a gain of " << writer.gain();
  } else if (writer.level()->loudness) {
    line << "; a gain of " << normalizingGain(*writer.level(), kUsualLoudness)
         << " would bring it towards " << kUsualLoudness << " LUFS, below " << kHighestPeakDb
         << " dBTP (--normalize)";
  }
  say(line.str());
}

SoundWish wishOf(const RenderOptions& options) {
  SoundWish wish;
  if (options.loudness != 0.0) {
    wish.loudness = options.loudness;
  }
  wish.fade_s = options.fade_s;
  return wish;
}

void sayHowLinksFared(const physics::Instrument& instrument) {
  std::vector<physics::TankReport> tanks = instrument.makeTankReports();
  instrument.readTanks(tanks);
  for (const std::string& warning :
       station::tankWarnings(instrument.scene(), instrument.rates(), tanks)) {
    say(warning);
  }
}

}  // namespace

void addOptions(CLI::App& app, RenderOptions& options) {
  addScene(app, options.scene.scene);
  addOptions(app, options.scene);
  addOptions(app, options.compile);
  app.add_option("--seconds", options.seconds,
                 "length (default: 10, that of the recording, or of the song and 3 s)")
      ->check(CLI::PositiveNumber)
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--out", options.out, "WAV file to write")->type_name("F.wav");
  app.add_option("--out-format", options.out_format, "format of the samples")
      ->check(CLI::IsMember({"float", "double", "24"}))
      ->capture_default_str();
  app.add_flag("--normalize{-18}", options.loudness,
               "make the file as loud as this, LUFS, with its true peak at -1 dBTP at most "
               "(default: -18)")
      ->check(CLI::Range(-60.0, -1.0));
  app.add_option("--fade", options.fade_s, "how long the end of the file fades away, s")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--input", options.inputs, "sound file for an input of the scene")
      ->type_name("NAME=F.wav")
      ->allow_extra_args(false);
  CLI::Option* const gesture =
      app.add_option(
             "--gesture", options.gesture,
             "who plays: targets of a hand or recorded positions (CSV), or a recording (bag)")
          ->type_name("F.csv|F.bag");
  CLI::Option* const midi =
      app.add_option("--midi", options.midi, "who plays: a MIDI file, by a map of notes")
          ->type_name("SONG.mid")
          ->excludes(gesture);
  app.add_option("--map", options.map,
                 "how the notes of --midi move hands (default: maps/NAME.yaml beside the scene, "
                 "else each slice is a key, from middle C on)")
      ->type_name("MAP.yaml")
      ->needs(midi);
  app.add_option("--station", options.station, "whose performance, of a bag with several stations");
  addEndEffectorsOption(app, options.end_effectors);
  addTargetOption(app, options.target,
                  "play it in the cheapest way that is this accurate, within --rate, "
                  "--gestural-rate and --precision if they are given");
  app.add_flag("--energies", options.energies, "say where the energy went");
  app.add_flag("--allow-unstable", options.allow_unstable, "play what is known to blow up, too");
  addOptions(app, options.feel);
  app.add_flag("--allow-gaps", options.allow_gaps, "accept a recording that cannot be exact");
}

int render(const RenderOptions& options) {
  if (options.out.empty() && wishOf(options).isAny()) {
    throw CLI::ValidationError("--normalize and --fade", "change a file, so they need --out");
  }
  if (!options.feel.slice.empty()) {
    return feelScene(options);
  }
  const std::unique_ptr<Player> player =
      endsWith(options.gesture, ".bag") ? playRecording(options) : playScene(options);
  FrameWriter writer(options.out, player->rates().audio_hz, player->outputChannels(),
                     audio::wavFormatOf(options.out_format), wishOf(options));
  const std::int64_t frames = framesOf(options, *player);
  sayWhatOfTheGestureIsLost(options, *player);
  const double work_s = playFrames(*player, frames, writer);
  const std::vector<std::string> flaws = player->flaws();
  for (const std::string& flaw : flaws) {
    say(flaw);
  }
  if (!flaws.empty() && !options.allow_gaps) {
    say("nothing is kept; --allow-gaps keeps it all the same");
    return kRefused;
  }
  writer.finish();
  say(summary(*player, writer, work_s));
  sayLevel(writer, options.out);
  sayHowLinksFared(player->instrument());
  if (const std::string trouble = player->trouble(); !trouble.empty()) {
    say(trouble);
  }
  if (options.energies) {
    printEnergies(player->instrument(), std::cerr);
  }
  return kSuccess;
}

}  // namespace ergotic::tools
