#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The measures of a performance, on sounds and pictures whose answers are known, and its judges."""
import contextlib
import io
import os
import struct
import sys
import tempfile
import unittest
from types import SimpleNamespace
from unittest import mock

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
import demo_report  # noqa: E402
from report import picture, sound  # noqa: E402

RATE = 44100.0


def decaying_string(pitch, seconds, partials=12):
    """Partials slightly sharp of harmonic, each decaying faster than the one below."""
    time = np.arange(int(seconds * RATE)) / RATE
    tones = [np.exp(-(1.0 + 0.5 * n) * time) / n *
             np.cos(2 * np.pi * n * pitch * (1 + 1e-4 * n * n) * time + n)
             for n in range(1, partials + 1)]
    return np.sum(tones, axis=0)


def first_partial(pitch):
    return pitch * (1 + 1e-4)


def noise(frames, channels=2):
    return np.random.default_rng(7).normal(0.0, 0.1, (frames, channels)).astype(np.float32)


class PitchTest(unittest.TestCase):
    def test_finds_the_lowest_partial_of_a_decaying_string(self):
        for pitch in (82.4069, 110.0, 329.628):
            measured = sound.measure_pitch(decaying_string(pitch, 2.0), RATE, pitch)
            self.assertLess(abs(sound.cents(measured, first_partial(pitch))), 0.05)

    def test_does_not_lean_towards_what_is_expected(self):
        for off in (-40.0, -1.0, 1.0, 40.0):
            expected = first_partial(110.0) * 2.0 ** (off / 1200.0)
            measured = sound.measure_pitch(decaying_string(110.0, 2.0), RATE, expected)
            self.assertAlmostEqual(sound.cents(measured, expected), -off, delta=0.05)

    def test_finds_nothing_where_there_is_no_partial(self):
        tone = decaying_string(220.0, 2.0, partials=1)
        self.assertTrue(np.isnan(sound.measure_pitch(tone, RATE, 180.0)))
        self.assertTrue(np.isnan(sound.measure_pitch(np.zeros(88200), RATE, 110.0)))


class LevelTest(unittest.TestCase):
    def test_is_that_of_a_sine(self):
        sine = np.sin(2 * np.pi * 100 * np.arange(44100) / RATE).astype(np.float32)
        self.assertAlmostEqual(sound.level_dbfs(0.01 * sine), -43.0103, places=3)

    def test_of_silence_is_below_everything(self):
        self.assertEqual(sound.level_dbfs(np.zeros((10, 2), np.float32)), -np.inf)


class ReplayTest(unittest.TestCase):
    def setUp(self):
        self.replay = noise(40000)
        self.replay[:5000] = 0.0
        self.recorded = np.concatenate([np.zeros((1234, 2), np.float32), self.replay[:30000]])

    def test_is_found_where_it_is(self):
        self.assertEqual(sound.find_shift(self.replay, self.recorded), 1234)
        self.assertEqual(sound.find_shift(self.replay, self.replay[7000:]), -7000)

    def test_is_not_found_in_another_sound(self):
        other = np.random.default_rng(8).normal(0.0, 0.1, (40000, 2)).astype(np.float32)
        self.assertIsNone(sound.find_shift(self.replay, other))
        self.assertIsNone(sound.find_shift(np.zeros((100, 2), np.float32), other))

    def test_equals_an_undisturbed_recording(self):
        found = sound.compare(self.replay, self.recorded, 1234, [])
        self.assertEqual((found["equal"], found["different"]), (30000, 0))
        self.assertAlmostEqual(found["share"], 30000 / 31234)

    def test_differs_by_every_changed_frame(self):
        self.recorded[20000, 1] = np.nextafter(self.recorded[20000, 1], np.float32(1))
        self.recorded[20001:20004] = 0.0
        found = sound.compare(self.replay, self.recorded, 1234, [])
        self.assertEqual((found["different"], found["gaps"]), (4, 3))

    def test_excuses_what_was_reported_and_is_silent(self):
        self.recorded[20000:20256] = 0.0
        found = sound.compare(self.replay, self.recorded, 1234, [(20000, 256)])
        self.assertEqual((found["different"], found["noisy"]), (0, 0))
        self.assertEqual(found["equal"], 30000 - 256)

    def test_tells_an_underrun_reported_beside_its_place(self):
        self.recorded[20000:20256] = 0.0
        found = sound.compare(self.replay, self.recorded, 1234, [(19999, 256)])
        self.assertEqual((found["different"], found["noisy"]), (1, 1))


class WavTest(unittest.TestCase):
    def read(self, chunks):
        with tempfile.NamedTemporaryFile(suffix=".wav") as file:
            body = b"WAVE" + b"".join(
                name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)
                for name, data in chunks)
            file.write(b"RIFF" + struct.pack("<I", len(body)) + body)
            file.flush()
            return sound.read_wav(file.name)

    def test_is_read_bit_for_bit(self):
        samples = noise(100)
        form = struct.pack("<HHIIHH", 3, 2, 44100, 44100 * 8, 8, 32)
        read, rate = self.read(
            [(b"fmt ", form), (b"PEAK", b"odd"), (b"data", samples.tobytes())])
        self.assertEqual(rate, RATE)
        self.assertTrue(np.array_equal(read, samples))

    def test_is_refused_if_it_holds_integers(self):
        form = struct.pack("<HHIIHH", 1, 2, 44100, 44100 * 4, 4, 16)
        with self.assertRaisesRegex(ValueError, "expected 32-bit float"):
            self.read([(b"fmt ", form), (b"data", b"\0" * 16)])


class PictureTest(unittest.TestCase):
    def test_changes_where_the_scene_changes(self):
        one = np.full((600, 800, 3), 48, np.uint8)
        other = one.copy()
        other[300, 300:400, 1] += picture.VISIBLE_STEP
        self.assertEqual(picture.changed_pixels(one, other), 100)

    def test_does_not_change_with_the_clock_or_a_shade(self):
        one = np.full((600, 800, 3), 48, np.uint8)
        other = one + np.uint8(picture.VISIBLE_STEP - 1)
        other[580:, :] = 255
        self.assertEqual(picture.changed_pixels(one, other), 0)


def judged(judge, *arguments):
    """Whether a judge of the demo is content."""
    verdict = demo_report.Verdict()
    with contextlib.redirect_stdout(io.StringIO()):
        judge(verdict, *arguments)
    return verdict.passed


class VerdictTest(unittest.TestCase):
    def test_fails_for_good_if_one_check_does(self):
        self.assertTrue(judged(lambda verdict: verdict.check("it", True, "")))
        self.assertFalse(judged(lambda verdict: [verdict.check("it", ok, "") for ok in (False, True)]))

    def test_is_what_the_program_ends_with(self):
        options = ["demo_report"] + [f"--{name}={os.devnull}" for name in (
            "bag", "sound", "capture", "replay", "check", "shots", "picture")]
        for content in (True, False):
            with mock.patch.object(sys, "argv", options), \
                    mock.patch.multiple(demo_report, Performance=mock.DEFAULT, tell_counters=mock.DEFAULT,
                                        check_sound=mock.DEFAULT, check_replay=mock.DEFAULT,
                                        check_pictures=mock.DEFAULT, check_force=mock.DEFAULT) as all_of, \
                    mock.patch.object(sound, "read_wav", return_value=(noise(10), RATE)), \
                    mock.patch.object(demo_report.json, "load",
                                      return_value={"strings": [{"pitch_hz": 110.0}]}), \
                    contextlib.redirect_stdout(io.StringIO()):
                all_of["check_force"].side_effect = (
                    lambda verdict, _: verdict.check("force", content, ""))  # pylint: disable=W0640
                self.assertEqual(demo_report.main(), 0 if content else 1)


class ForceJudgeTest(unittest.TestCase):
    def setUp(self):
        self.positions = np.zeros((3000, 2))
        self.positions[1000:2000, 0] = np.linspace(0.0, 0.02, 1000)
        self.positions[2000:, 0] = 0.02
        self.forces = np.zeros((3000, 2))
        self.forces[1000:2000, 0] = -5.0

    def judge(self):
        return judged(demo_report.check_force, SimpleNamespace(
            positions=self.positions, forces=self.forces, tick_rate=1000.0))

    def test_wants_force_while_a_key_moves(self):
        self.assertTrue(self.judge())
        self.forces[:] = 0.0
        self.assertFalse(self.judge())

    def test_wants_no_force_on_a_key_that_rests(self):
        self.forces[2500:, 0] = -5.0
        self.assertFalse(self.judge())

    def test_wants_more_than_a_touch(self):
        self.forces *= 0.1
        self.assertFalse(self.judge())


class SoundJudgeTest(unittest.TestCase):
    PITCH = 110.0

    def setUp(self):
        self.positions = np.zeros((5000, 1))  # at 1 kHz; touched after 2 s, for 0.2 s
        self.positions[2000:2200, 0] = np.linspace(0.0, 0.02, 200)
        self.positions[2200:, 0] = 0.02
        self.recorded = np.zeros((int(5 * RATE), 1), np.float32)
        begin = int(2.02 * RATE)  # the key has moved by a millimetre
        self.recorded[begin:, 0] = 0.1 * decaying_string(self.PITCH, 3.0)[:len(self.recorded) - begin]

    def judge(self, pitch=None):
        performance = SimpleNamespace(positions=self.positions, ticks=np.arange(5000),
                                      tick_rate=1000.0)
        return judged(demo_report.check_sound, performance, self.recorded, RATE,
                      lambda tick: int(tick * RATE / 1000.0), pitch or first_partial(self.PITCH))

    def test_wants_the_pitch_of_the_closed_form(self):
        self.assertTrue(self.judge())
        self.assertFalse(self.judge(first_partial(self.PITCH) * 2 ** (1.5 / 1200)))

    def test_wants_silence_before_the_touch(self):
        self.recorded[int(RATE)] = 0.1
        self.assertFalse(self.judge())

    def test_wants_sound_after_it(self):
        self.recorded *= 1e-3
        self.assertFalse(self.judge())

    def test_wants_a_hand_that_moves(self):
        self.positions[:] = 0.0
        self.assertFalse(self.judge())


class ReplayJudgeTest(unittest.TestCase):
    def setUp(self):
        self.replay = noise(40000)
        self.recorded = self.replay.copy()
        self.counted = [0, 0]
        self.performance = SimpleNamespace(tick_rate=100.0, underruns=[], silenced=[], audio_stops=0,
                                           frame_of_first_keyframe=lambda: 0)
        self.capture = {"lost": 0, "dropped": 0, "first_jack_frame": 0}

    def judge(self):
        self.performance.statuses = [SimpleNamespace(ticks=tick, underrun_frames=frames)
                                     for tick, frames in zip((0, 1000), self.counted)]
        return judged(demo_report.check_replay, self.performance, self.recorded, self.replay, 0,
                      self.capture)

    def silence(self, noticed=True):
        self.recorded[20000:20256] = 0.0
        if noticed:
            self.performance.silenced = [(20000, 256, 20000)]
            self.performance.underruns = [(500, 256)]
            self.counted = [0, 256]

    def test_wants_every_frame_equal(self):
        self.assertTrue(self.judge())
        self.recorded[7, 0] += 1e-6
        self.assertFalse(self.judge())

    def test_takes_underruns_that_were_reported_and_counted(self):
        self.silence()
        self.assertTrue(self.judge())
        self.counted = [0, 0]
        self.assertFalse(self.judge())
        self.counted = [0, 257]
        self.assertFalse(self.judge())

    def test_takes_no_silence_that_nobody_told_of(self):
        self.silence(noticed=False)
        self.assertFalse(self.judge())
        self.capture["lost"] = 256  # by the recorder
        self.assertTrue(self.judge())

    def test_wants_what_was_reported_silent_and_at_its_place(self):
        self.silence()
        self.recorded[20100] = 0.1
        self.assertFalse(self.judge())
        self.silence()
        self.performance.silenced = [(20000, 256, 20001)]
        self.assertFalse(self.judge())

    def test_wants_nine_of_ten_frames(self):
        self.recorded = np.concatenate([self.recorded, np.zeros((4400, 2), np.float32)])
        self.assertTrue(self.judge())
        self.recorded = np.concatenate([self.recorded, np.zeros((100, 2), np.float32)])
        self.assertFalse(self.judge())

    def test_wants_sound_that_never_stopped(self):
        self.performance.audio_stops = 1
        self.assertFalse(self.judge())


class PictureJudgeTest(unittest.TestCase):
    def judge(self, *greys):
        """Pictures of a vibrating string, one of each grey."""
        with tempfile.TemporaryDirectory() as folder:
            shots = os.path.join(folder, "shots")
            os.mkdir(shots)
            for number, grey in enumerate(greys):
                with open(os.path.join(shots, f"{number + 1}.0.ppm"), "wb") as file:
                    file.write(b"P6\n100 60\n255\n" + bytes([grey]) * (100 * 60 * 3))
            performance = SimpleNamespace(times=np.arange(0.0, 9.0, 0.05),
                                          displacements=np.linspace(1e-3, 2e-3, 180))
            return judged(demo_report.check_pictures, performance, shots,
                          os.path.join(folder, "best.ppm"))

    def test_wants_two_that_differ(self):
        self.assertTrue(self.judge(40, 200))
        self.assertFalse(self.judge(40, 40))
        self.assertFalse(self.judge(40))


if __name__ == "__main__":
    unittest.main()
