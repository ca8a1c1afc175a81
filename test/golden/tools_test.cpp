// SPDX-License-Identifier: BSD-3-Clause
// The command-line tools, run as a person runs them.
#include <sndfile.h>
#include <unistd.h>

#include <cstdio>
#include <iterator>

#include "ergotic/audio/wav.hpp"
#include "support/mdl_simulator.hpp"
#include "support/places.hpp"
#include "support/struck_bar.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::exists;
using test::Outcome;
using test::peakOf;
using test::run;

std::vector<double> soundOf(const std::string& path) {
  return audio::WavReader(path).readAll();
}

const char* const kSpring = R"(# one mass, thrown
@K param 0.04
@m mass 1 0 882
@g ground 0
@s springDamper @m @g K 0.0001
@in1 frcInput @m
@out1 posOutput @m
)";

const char* const kUnstable =
    "@m mass 1 0.1 0\n@g ground 0\n@s spring @m @g 4.5\n@out1 posOutput @m\n";
const std::string kDrum = test::struckBar("{quantity: position, at: bar, channel: 1, gain: 100}");

class ToolsTest : public testing::Test {
 protected:
  ToolsTest() {
    std::string pattern = "/tmp/ergotic_tools_XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~ToolsTest() override {
    for (const std::string& file : files_) {
      std::remove(file.c_str());
    }
    // Fails, and is seen below, if a tool left something behind.
    EXPECT_EQ(rmdir(folder_.c_str()), 0) << folder_ << " is not empty";
  }

  std::string path(const std::string& name) {
    files_.push_back(folder_ + "/" + name);
    return files_.back();
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(path(name)) << text;
    return files_.back();
  }
  std::string writeSound(const std::string& name,
                         const std::vector<double>& samples,
                         double rate_hz = 44100.0) {
    audio::WavWriter writer(path(name), rate_hz, 1, audio::WavFormat::kDouble);
    writer.write(samples.data(), static_cast<std::int64_t>(samples.size()));
    writer.finish();
    return files_.back();
  }

 private:
  std::string folder_;
  std::vector<std::string> files_;
};

using RenderTest = ToolsTest;
using CheckTest = ToolsTest;

TEST_F(RenderTest, WritesWhatTheSimulatorPlays) {
  const std::string scene = write("spring.mdl", kSpring);
  std::vector<double> push(2000);
  push[1000] = 0.05;
  const std::string input = writeSound("push.wav", push);
  const std::string out = path("out.wav");
  const Outcome outcome =
      run("render", scene + " --seconds 0.1 --out " + out +
                        " --out-format double --precision double --input in1=" + input +
                        " --set K=0.09");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const auto wanted = test::simulateMdl(kSpring, {{"K", 0.09}}, {push}, 4410).at(0);
  const std::vector<double> got = soundOf(out);
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t n = 0; n < got.size(); ++n) {
    ASSERT_NEAR(got[n], wanted[n], 1e-11 * peakOf(wanted)) << n;
  }
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("2 modules"), HasSubstr("4410 frames"), HasSubstr("real time")));
}

TEST_F(RenderTest, RoundsToTheFormatAskedFor) {
  const std::string scene = write("spring.mdl", kSpring);
  const std::string exact = path("double.wav");
  const std::string single = path("float.wav");
  const std::string integer = path("24.wav");
  const std::string common = scene + " --seconds 0.05 --precision double --out ";
  ASSERT_EQ(run("render", common + exact + " --out-format double").code, 0);
  ASSERT_EQ(run("render", common + single).code, 0);
  ASSERT_EQ(run("render", common + integer + " --out-format 24").code, 0);
  const std::vector<double> reference = soundOf(exact);
  const std::vector<double> as_float = soundOf(single);
  const std::vector<double> as_integer = soundOf(integer);
  ASSERT_EQ(reference.size(), as_float.size());
  ASSERT_EQ(reference.size(), as_integer.size());
  bool rounded = false;
  for (std::size_t n = 0; n < reference.size(); ++n) {
    rounded = rounded || as_float[n] != reference[n];
    ASSERT_EQ(as_float[n], static_cast<double>(static_cast<float>(reference[n])));
    ASSERT_NEAR(as_integer[n], reference[n], std::ldexp(0.5001, -23));
  }
  EXPECT_TRUE(rounded);
}

/// Python's module knows format tag 1 alone.
TEST_F(RenderTest, WritesIntegersThatEveryProgramReads) {
  const std::string scene = write("spring.mdl", kSpring);
  const std::string out = path("24.wav");
  ASSERT_EQ(run("render", scene + " --seconds 0.1 --out-format 24 --out " + out +
                              " && /usr/bin/python3 -c 'import wave; w = wave.open(\"" + out +
                              "\"); assert (w.getsampwidth(), w.getnframes()) == (3, 4410)'")
                .code,
            0);
}

TEST_F(RenderTest, SaysWhichSoundsAreEmptyOrWereNotFinished) {
  const std::string scene = write("spring.mdl", kSpring);
  const std::string empty = writeSound("empty.wav", {});
  EXPECT_THAT(run("render", scene + " --seconds 0.01 --input in1=" + empty).text,
              HasSubstr("empty.wav: warning: the file has no frames, so the input is silent"));
  const std::string whole = writeSound("killed.wav", std::vector<double>(300, 0.05));
  const std::string sound = scene + " --seconds 0.01 --out-format double --input in1=" + whole;
  ASSERT_EQ(run("render", sound + " --out " + path("whole_out.wav")).code, 0);
  const std::vector<double> wanted = soundOf(path("whole_out.wav"));
  {
    std::fstream file(whole, std::ios::binary | std::ios::in | std::ios::out);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    file.seekp(4).write("\0\0\0\0", 4);
    file.seekp(static_cast<std::streamoff>(text.find("data") + 4)).write("\0\0\0\0", 4);
  }
  const Outcome killed = run("render", sound + " --out " + path("killed_out.wav"));
  EXPECT_THAT(killed.text, HasSubstr("killed.wav: warning: the header does not say how long"));
  EXPECT_EQ(soundOf(path("killed_out.wav")), wanted);
  EXPECT_GT(peakOf(wanted), 0.0);
}

TEST_F(RenderTest, SaysWhereASceneIsWrong) {
  const std::string scene = write("bad.mdl", "@m mass 1 0 0\n@s spring @m @nobody 0.1\n");
  const Outcome outcome = run("render", scene);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("bad.mdl:2:14: error: "), HasSubstr("nobody")));
}

TEST_F(RenderTest, RefusesWhatIsUnstableUnlessToldOtherwise) {
  const std::string scene = write("unstable.mdl", kUnstable);
  const std::string out = path("out.wav");
  const Outcome refused = run("render", scene + " --seconds 0.001 --out " + out);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, AllOf(HasSubstr("unstable"), HasSubstr("unstable.mdl:3:1")));
  EXPECT_FALSE(exists(out));
  const Outcome played = run("render", scene + " --allow-unstable --seconds 0.001 --out " + out);
  EXPECT_EQ(played.code, 0) << played.text;
  EXPECT_GT(peakOf(soundOf(out)), 1e3);
}

TEST_F(RenderTest, LeavesTheOldFileWhenTheSoundBlowsUp) {
  const std::string scene = write("unstable.mdl", kUnstable);
  const std::string out = write("out.wav", "what was there before");
  const Outcome outcome = run("render", scene + " --allow-unstable --seconds 1 --out " + out);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("not finite from frame "));
  EXPECT_EQ(textOf(out), "what was there before");
}

TEST_F(RenderTest, AsksForInputsAtTheRateOfTheInstrument) {
  const std::string scene = write("spring.mdl", kSpring);
  const std::string input = writeSound("push.wav", {0.1, 0.2}, 48000.0);
  const Outcome rate = run("render", scene + " --input in1=" + input);
  EXPECT_EQ(rate.code, 1);
  EXPECT_THAT(rate.text, AllOf(HasSubstr("48000"), HasSubstr("44100")));
  const Outcome name = run("render", scene + " --input in2=" + input);
  EXPECT_EQ(name.code, 1);
  EXPECT_THAT(name.text, AllOf(HasSubstr("in2"), HasSubstr("it has: in1")));
}

TEST_F(RenderTest, RefusesNumbersThatAreNone) {
  const std::string scene = write("spring.mdl", kSpring);
  for (const char* option : {"--rate nan", "--gestural-rate nan", "--seconds nan"}) {
    const Outcome outcome = run("render", scene + ' ' + option + " --out " + path("none.wav"));
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_THAT(outcome.text, HasSubstr("is not a finite number"));
  }
}

TEST_F(RenderTest, RefusesASoundThatIsNoNumber) {
  const std::string scene = write("spring.mdl", kSpring);
  SF_INFO info{};
  info.samplerate = 44100;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_DOUBLE;
  const std::string input = path("push.wav");
  SNDFILE* const file = sf_open(input.c_str(), SFM_WRITE, &info);
  ASSERT_NE(file, nullptr);
  const double samples[] = {0.1, std::nan("")};
  EXPECT_EQ(sf_write_double(file, samples, 2), 2);
  sf_close(file);
  const Outcome sound = run("render", scene + " --input in1=" + input);
  EXPECT_EQ(sound.code, 1);
  EXPECT_THAT(sound.text, HasSubstr("push.wav: frame 1 is nan, allowed: finite numbers"));
}

TEST_F(RenderTest, KeepsThePitchOfAnMdlSceneAtAnotherRateAndSaysSo) {
  const std::string scene = write("spring.mdl", kSpring);
  const auto crossings = [&](double rate) {
    const std::string out = path("at" + std::to_string(static_cast<int>(rate)) + ".wav");
    const Outcome outcome =
        run("render", scene + " --seconds 1 --rate " + std::to_string(rate) + " --out " + out);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const bool converted = outcome.text.find("converted") != std::string::npos;
    EXPECT_EQ(converted, rate != 44100.0) << outcome.text;
    const std::vector<double> sound = soundOf(out);
    int count = 0;
    for (std::size_t n = 1; n < sound.size(); ++n) {
      count += sound[n - 1] < 0.0 && sound[n] >= 0.0 ? 1 : 0;
    }
    return count;
  };
  // Per sample at 44.1 kHz: 2 asin(sqrt(K)/2) / 2 pi = 1406 Hz; at another rate the step differs.
  EXPECT_NEAR(crossings(44100.0), 1406, 1);
  EXPECT_NEAR(crossings(48000.0), 1406, 2);
}

TEST_F(RenderTest, LetsAHandPlayFromACsvFile) {
  const std::string scene = write("drum.yaml", kDrum);
  const std::string gesture =
      write("hand.csv", "time_s,slice,target_m\n0,0,0\n0.2,0,0\n0.3,0,0.01\n");
  const std::string out = path("out.wav");
  const Outcome outcome =
      run("render", scene + " --seconds 0.5 --out " + out + " --gesture " + gesture);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const std::vector<double> sound = soundOf(out);
  ASSERT_EQ(sound.size(), 22050U);
  const std::vector<double> before(sound.begin(), sound.begin() + 8820);
  EXPECT_EQ(peakOf(before), 0.0);
  EXPECT_GT(peakOf(sound), 1e-3);
}

TEST_F(RenderTest, PlaysRecordedPositionsToTheirEnd) {
  const std::string scene = write("drum.yaml", kDrum);
  std::string text = "tick,x0\n";
  for (int tick = 0; tick < 315; ++tick) {
    text += std::to_string(tick) + (tick < 100 ? ",0\n" : ",0.005\n");
  }
  const std::string out = path("out.wav");
  const Outcome outcome =
      run("render", scene + " --out " + out + " --gesture " + write("moves.csv", text));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const std::vector<double> sound = soundOf(out);
  EXPECT_EQ(sound.size(), 4410U);
  const std::vector<double> before(sound.begin(), sound.begin() + 1400);
  EXPECT_EQ(peakOf(before), 0.0);
  EXPECT_GT(peakOf(sound), 1e-3);
}

TEST_F(RenderTest, GivesTheSameBitsTwice) {
  const std::string scene = write("drum.yaml", kDrum);
  const std::string gesture = write("hand.csv", "time_s,slice,target_m\n0,0,0\n0.1,0,0.01\n");
  const std::string common = scene + " --seconds 0.3 --gesture " + gesture + " --out ";
  const std::string one = path("one.wav");
  const std::string two = path("two.wav");
  ASSERT_EQ(run("render", common + one).code, 0);
  ASSERT_EQ(run("render", common + two).code, 0);
  EXPECT_EQ(soundOf(one), soundOf(two));
}

TEST_F(RenderTest, SaysWhereTheEnergyWentIfAsked) {
  const std::string common = write("spring.mdl", kSpring) + " --precision double --seconds 0.1";
  EXPECT_EQ(run("render", common).text.find("energies_j"), std::string::npos);
  const Outcome outcome = run("render", common + " --energies");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const auto numberAfter = [&](const std::string& name) {
    return std::stod(outcome.text.substr(outcome.text.find(name + ": ") + name.size() + 2));
  };
  const double kinetic_at_start = 0.5 * 882.0 * 882.0;  // 1 kg, 882 m/s
  EXPECT_NEAR(numberAfter("stored") + numberAfter("dissipated"), kinetic_at_start,
              1e-3 * kinetic_at_start);
  EXPECT_GT(numberAfter("dissipated"), 0.1 * kinetic_at_start);
  EXPECT_LT(std::abs(numberAfter("balance_residual")), 1e-10 * kinetic_at_start);
}

TEST_F(RenderTest, TellsUsageErrorsFromOthers) {
  const std::string scene = write("spring.mdl", kSpring);
  EXPECT_EQ(run("render", "").code, 2);
  EXPECT_EQ(run("render", scene + " --nonsense").code, 2);
  EXPECT_EQ(run("render", scene + " --precision half").code, 2);
  EXPECT_EQ(run("render", scene + " --seconds -1").code, 2);
  EXPECT_EQ(run("render", scene + " --set K").code, 2);
  EXPECT_EQ(run("render", scene + " --set K=x").code, 2);
  EXPECT_EQ(run("render", scene + " --set nobody=1").code, 1);
  EXPECT_EQ(run("render", "/nonexistent.mdl").code, 1);
  EXPECT_EQ(run("render", scene + " --out /nonexistent/out.wav").code, 1);
  EXPECT_EQ(run("render", "--help").code, 0);
}

/// How alike a sound is to itself `lag` frames later, 1: the same. From frame `first` on, 0.2 s.
double likenessAt(const std::vector<double>& sound, std::size_t first, std::size_t lag) {
  double product = 0.0;
  double power = 0.0;
  double later = 0.0;
  for (std::size_t n = first; n < first + 8820; ++n) {
    product += sound[n] * sound[n + lag];
    power += sound[n] * sound[n];
    later += sound[n + lag] * sound[n + lag];
  }
  return product / std::sqrt(power * later);
}

TEST_F(RenderTest, PlaysTheFrettedStringOpenAndOnAFret) {
  const std::string model = repository("models/fretted_string");
  EXPECT_THAT(run("check", model + ".yaml --verbose").text,
              AllOf(HasSubstr("verdict: bounded"), HasSubstr("geometry: 3D"),
                    HasSubstr("energy_stable: 5")));
  const std::string out = path("out.wav");
  const Outcome outcome =
      run("render", model + ".yaml --gesture " + model +
                        "_demo.csv --seconds 6.2 --out-format double --out " + out);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, Not(HasSubstr("warning:"))) << "links are hardly ever cut";
  const std::vector<double> both = soundOf(out);
  std::vector<double> sound;
  for (std::size_t n = 0; n < both.size(); n += 2) {
    sound.push_back(both[n]);
  }
  EXPECT_GT(peakOf(sound), 0.1);
  EXPECT_LT(peakOf(sound), 1.0);
  const std::size_t open = 450;             // frames of a period of 98 Hz
  const std::size_t fretted = 338;          // five semitones above
  const std::size_t open_from = 127890;     // 2.9 s
  const std::size_t fretted_from = 249165;  // 5.65 s
  EXPECT_GT(likenessAt(sound, open_from, open), 0.9);
  EXPECT_GT(likenessAt(sound, fretted_from, fretted), 0.9);
  EXPECT_LT(likenessAt(sound, fretted_from, open), 0.5);
}

TEST_F(CheckTest, SaysWhatASceneIsMadeOf) {
  const std::string scene = write("drum.yaml", kDrum);
  const Outcome outcome = run("check", scene + " --verbose --set tone=2500");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(
      outcome.text,
      AllOf(HasSubstr("modules: 2\n"), HasSubstr("gestural_rate_hz: 3150\n"),
            HasSubstr("modules: {slice: 1}\n"),
            HasSubstr("types: {contact: 1}, schemes: {energy_stable: 1}"),
            HasSubstr("value: 2500\n    unit: not said\n    minimum: 1000\n    maximum: 8000\n"),
            HasSubstr("verdict: passive\n"), HasSubstr("passive_up_to_n_per_m: 4200\n"),
            HasSubstr("whatever the hands do, as long as its parameters stand still\n"),
            HasSubstr("lowest_stable_audio_rate_hz: "), HasSubstr("state_bytes: "),
            HasSubstr("real_time_factor: ")));
}

TEST_F(CheckTest, GivesTheClosedFormPitchOfEachString) {
  const Outcome outcome = run("check", repository("models/string.yaml") + " --verbose");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("pitch_hz: 110}"));
}

TEST_F(CheckTest, SaysWhatWasChosenForTheScene) {
  std::string text = kDrum;
  text.replace(text.find("rate: audio"), 11, "rate: auto");
  text.replace(text.find("type: cell"), 10, "type: cell, matched: false");
  const Outcome outcome = run("check", write("drum.yaml", text) + " --verbose --set tone=2500");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("note: section 'sound' runs at "),
                    HasSubstr("stepped: every 2 audio frames\n"), HasSubstr("geometry: scalar\n")));
}

TEST_F(CheckTest, WritesJsonThatAProgramReads) {
  const std::string scene = write("drum.yaml", kDrum);
  const Outcome outcome =
      run("check",
          scene +
              " --json | /usr/bin/python3 -c 'import json, sys; r = json.load(sys.stdin);"
              " print(r[\"modules\"], r[\"ports\"][0][\"slice\"], r[\"sections\"][0][\"axis\"],"
              " r[\"outputs\"][0][\"channel\"])'");
  EXPECT_EQ(outcome.text, "2 0 [1.0, 0.0, 0.0] 1\n");
}

TEST_F(CheckTest, LeavesOutRangesThatTakeLong) {
  std::string text = "ergotic: 1\nsections: {a: {rate: audio}}\ngenerators:\n";
  text += "  - {type: mesh, name: s, rows: 60, columns: 60, spacing: 1, mass: 1, stiffness: 1}\n";
  text += "parameters:\n";
  for (int p = 0; p < 90; ++p) {
    text += "  p" + std::to_string(p) + ": {value: 1, range: [1, 2]}\n";
  }
  const Outcome outcome = run("check", write("large.yaml", text) + " --verbose");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("ranges: not judged: "), HasSubstr("--ranges")));
}

TEST_F(CheckTest, RefusesWhatIsUnstable) {
  const Outcome outcome = run("check", write("unstable.mdl", kUnstable) + " --verbose");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("verdict: unstable"), HasSubstr("unstable.mdl:3:1")));
}

TEST_F(CheckTest, SaysWhereASceneIsWrong) {
  const std::string scene = write("bad.yaml", kDrum + "lost: 1\n");
  const Outcome outcome = run("check", scene);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("bad.yaml:18:1: error: "));
  EXPECT_EQ(run("check", "").code, 2);
}

}  // namespace
}  // namespace ergotic
