#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The measures of a performance, on sounds and pictures whose answers are known."""
import os
import struct
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
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


if __name__ == "__main__":
    unittest.main()
