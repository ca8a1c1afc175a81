#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The scenes of docs/first_instrument.md and docs/recipes.md: judged, played, and measured.
usage: recipes_test.py FOLDER_OF_TOOLS"""
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
import scipy.io.wavfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOOLS = pathlib.Path(sys.argv.pop())
MOST_LINES = 40
A2, C3, E3, G3, C4 = (440.0 * 2 ** (n / 12) for n in (-24, -21, -17, -14, -9))


def blocks(kind):
    """{name: text} of the files that the documents show."""
    found = {}
    for name in ("first_instrument.md", "recipes.md"):
        text = (ROOT / "docs" / name).read_text()
        found.update(re.findall(r"`(\w+)\.%s`:\n\n```%s\n(.*?)```" % (kind, kind), text, re.DOTALL))
        if name == "first_instrument.md":
            found.update({"first": re.search(r"```%s\n(.*?)```" % kind, text, re.DOTALL).group(1)})
    return found


def cents(hz, wanted_hz):
    return 1200 * numpy.log2(hz / wanted_hz)


class Sound:
    """One channel of what a scene sounds like."""

    def __init__(self, rate, samples):
        self.rate = rate
        self.samples = samples

    def pitch(self, near, begin, end):
        """Of the strongest partial within a semitone: the peak of a parabola through the spectrum, Hz."""
        part = self.samples[int(begin * self.rate):int(end * self.rate)]
        padded = 32 * len(part)
        spectrum = numpy.abs(numpy.fft.rfft(part * numpy.blackman(len(part)), padded))
        hz = numpy.arange(len(spectrum)) * self.rate / padded
        inside = numpy.flatnonzero((hz > near / 1.06) & (hz < near * 1.06))
        top = inside[numpy.argmax(spectrum[inside])]
        left, middle, right = numpy.log(spectrum[top - 1:top + 2])
        return (top + 0.5 * (left - right) / (left - 2 * middle + right)) * self.rate / padded

    def level(self, hz, begin, seconds=0.2):
        """Logarithm of the amplitude of a partial."""
        part = self.samples[int(begin * self.rate):][:int(seconds * self.rate)]
        turn = numpy.exp(-2j * numpy.pi * hz * numpy.arange(len(part)) / self.rate)
        return numpy.log(abs(numpy.sum(part * numpy.hanning(len(part)) * turn)))

    def t60(self, hz, begin, end):
        times = numpy.arange(begin, end - 0.2, 0.05)
        slope = numpy.polyfit(times, [self.level(hz, t) for t in times], 1)[0]
        return -numpy.log(1000) / slope


class RecipesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scenes = blocks("yaml")
        for name, text in cls.scenes.items():
            (cls.folder / f"{name}.yaml").write_text(text)
        cls.gestures = blocks("csv")

    def run_tool(self, tool, *arguments):
        done = subprocess.run([TOOLS / tool, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def play(self, name, seconds, gesture=None, more=()):
        arguments = [f"{name}.yaml", "--seconds", str(seconds), "--out", "out.wav", *more]
        if gesture:
            (self.folder / "gesture.csv").write_text(gesture)
            arguments += ["--gesture", "gesture.csv"]
        self.run_tool("render", *arguments)
        rate, samples = scipy.io.wavfile.read(self.folder / "out.wav")
        channels = samples.reshape(len(samples), -1).astype(float).T
        return [Sound(rate, channel) for channel in channels]

    def strike(self, slice_number):
        """The gesture of the bar, by another slice."""
        return re.sub(r"^([\d.]+),\d,", r"\g<1>,%d," % slice_number, self.gestures["bar"], flags=re.MULTILINE)

    def expect(self, sound, hz, t60_s, begin, end):
        heard = sound.pitch(hz, begin, end)
        self.assertLess(abs(cents(heard, hz)), 1)
        self.assertAlmostEqual(sound.t60(heard, begin, end) / t60_s, 1, delta=0.05)

    def test_each_is_short_and_certified(self):
        self.assertEqual(set(self.scenes),
                         {"first", "bar", "drum", "skin", "keys", "bridge", "bow", "gong"})
        for name, text in self.scenes.items():
            self.assertLessEqual(len(text.splitlines()), MOST_LINES, name)
            report = json.loads(self.run_tool("check", f"{name}.yaml", "--json"))
            self.assertIn(report["stability"]["verdict"], ("passive", "bounded"), name)

    def test_the_first_string(self):
        left, right = self.play("first", 3, self.gestures["first"])
        self.expect(left, A2, 5, 0.8, 3)
        self.expect(right, A2, 5, 0.8, 3)

    def test_the_first_map_plucks_there_and_back(self):
        shown = re.findall(r"```yaml\n(keys:.*?)```", (ROOT / "docs/first_instrument.md").read_text(), re.DOTALL)
        (self.folder / "map.yaml").write_text(shown[0])
        one, held, two = (self.play("first", 1.9, more=("--midi", self.song(*song), "--map", "map.yaml"))[0]
                          for song in ((1, 20), (1, 250), (2, 20)))
        self.assertEqual(numpy.count_nonzero(one.samples != held.samples), 0, "a key that is released is not heard")
        first = numpy.abs(one.samples[int(0.6 * one.rate):int(0.9 * one.rate)]).max()
        self.assertLess(numpy.abs(one.samples[:int(0.5 * one.rate)]).max(), 1e-3 * first)
        second = numpy.abs(two.samples - one.samples)[int(one.rate):].max()
        self.assertGreater(second, 0.5 * first)

    def song(self, notes, held):
        """Middle C, this often, from half a second on and half a second apart, each for so many 240ths of a second."""
        wait = 120
        track = b""
        for _ in range(notes):
            track += bytes([wait, 0x90, 60, 100, 0x80 | held >> 7, held & 0x7f, 0x80, 60, 0])
            wait = 120 - held
        track += b"\0\xff\x2f\0"
        path = self.folder / "song.mid"
        path.write_bytes(b"MThd" + struct.pack(">IHHH", 6, 0, 1, 120) + b"MTrk" + struct.pack(">I", len(track)) + track)
        return str(path)

    def test_the_first_key_reaches_its_string(self):
        told = (ROOT / "docs/first_instrument.md").read_text()
        first = re.search(r"`(meets_first: .*?)`", told).group(1)
        self.assertIn(first, self.run_tool("check", "first.yaml", "--reach"))

    def test_a_bar(self):
        self.expect(self.play("bar", 2.5, self.gestures["bar"])[0], C3, 2.2 / (0.008 * C3), 0.5, 2.5)

    def test_a_drum(self):
        self.expect(self.play("drum", 1.4, self.strike(0))[0], 110, 1, 0.4, 1.4)

    def test_one_mallet_reaches_a_whole_skin(self):
        second = 98 * 1.5875
        middle = self.play("skin", 1.4, self.strike(0))[0]
        self.expect(middle, 98, 1, 0.4, 1.4)
        away = "0,1,0\n0.05,1,0.018\n0,2,0\n0.05,2,-0.01\n"
        edge = self.play("skin", 1.4, self.strike(0) + away)[0]
        rise = [sound.level(second, 0.3, 1) - sound.level(98, 0.3, 1) for sound in (middle, edge)]
        self.assertGreater((rise[1] - rise[0]) * 20 / numpy.log(10), 30)

    def test_twelve_keys(self):
        for key in range(12):
            with self.subTest(key=key):
                sounds = self.play("keys", 2, self.strike(key))
                self.expect(sounds[key % 2], C4 * 2 ** (key / 12), 4, 0.5, 2)

    def test_strings_on_a_board(self):
        low, high = self.gestures["bridge"], self.gestures["bridge"].replace(",0,", ",1,")
        self.expect(self.play("bridge", 3, low)[0], A2, 4, 0.8, 3)
        self.expect(self.play("bridge", 3, high)[1], E3, 3.4, 0.8, 3)

    def test_a_bowed_string_open_and_stopped(self):
        bow = self.gestures["bow"]
        finger = "0,1,0\n0.1,1,0\n0.4,1,-0.02\n"
        for gesture, hz in ((bow, G3), (bow + finger, G3 / 0.75)):
            heard = self.play("bow", 2.4, gesture)[0].pitch(hz, 1.3, 2.3)
            self.assertLess(abs(cents(heard, hz)), 10)

    def test_a_gong(self):
        for sound in self.play("gong", 5, self.strike(0)):
            self.expect(sound, 90, 6, 1, 5)


if __name__ == "__main__":
    unittest.main()
