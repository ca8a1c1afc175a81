#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The instruments that come along: judged, played by the virtual hand, and measured. With ERGOTIC_LONG their whole
demos, else their beginnings.
usage: instruments_test.py FOLDER_OF_TOOLS"""
import functools
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy
import scipy.io.wavfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MODELS = ROOT / "models"
TOOLS = pathlib.Path(sys.argv.pop())
IS_LONG = "ERGOTIC_LONG" in os.environ
MOST_LINES = 60
SLICES_OF_A_DEVICE = 12
BEGINNING_S = 1.5
LEVEL = re.compile(r": (-?[0-9.]+) LUFS, true peak (-?[0-9.]+) dBTP")
OLDER = {"string", "fretted_string", "duet", "drum"}  # shipped before levels were asked for


def read_script():
    """scripts/instrument, with the tools that are tested."""
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("instrument", str(ROOT / "scripts/instrument"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("instrument", loader))
    loader.exec_module(module)
    module.TOOLS = TOOLS
    return module


script = read_script()


def instruments():
    """Names of the scenes that come with a gesture."""
    return sorted(path.stem for path in MODELS.glob("*.yaml") if (MODELS / f"{path.stem}_demo.csv").exists())


def last_row_s(name):
    rows = (MODELS / f"{name}_demo.csv").read_text().splitlines()
    return max(float(row.split(",")[0]) for row in rows if row[:1].isdigit())


def run(tool, *arguments):
    return subprocess.run([TOOLS / tool, *map(str, arguments)], cwd=ROOT, check=True, capture_output=True, text=True)


@functools.lru_cache(maxsize=None)
def report_of(name):
    return json.loads(run("check", MODELS / f"{name}.yaml", "--json").stdout)


class InstrumentsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "out.wav"

    def play(self, name, *options):
        """What render says of the demo, and the sound."""
        hands = MODELS / "hands" / f"{name}.yaml"
        if hands.exists():
            options += ("--end-effectors", hands)
        said = run("render", MODELS / f"{name}.yaml", "--gesture", MODELS / f"{name}_demo.csv", "--out", self.out,
                   *options).stderr
        return said, scipy.io.wavfile.read(self.out)

    def test_there_are_twelve_and_more(self):
        self.assertGreaterEqual(len(set(instruments()) - OLDER), 12)

    def test_each_is_short_certified_and_has_a_map_and_a_page(self):
        for name in instruments():
            with self.subTest(name):
                text = (MODELS / f"{name}.yaml").read_text()
                self.assertLessEqual(len(text.splitlines()), MOST_LINES)
                report = report_of(name)
                self.assertIn(report["stability"]["verdict"], ("passive", "bounded"))
                self.assertLess(max(port.get("slice") or 0 for port in report["ports"]), SLICES_OF_A_DEVICE)
                self.assertTrue((MODELS / "maps" / f"{name}.yaml").exists())
                if name not in OLDER:
                    self.assertNotEqual(report["about"], {})
                    self.assertTrue((ROOT / "docs" / "instruments" / f"{name}.md").exists())

    def test_pages_tell_what_slices_meet(self):
        told = 0
        for path in (ROOT / "docs" / "instruments").glob("*.md"):
            text = path.read_text()
            if script.SLICES in text:
                told += 1
                with self.subTest(path.stem):
                    rows = script.slices_of(path.stem, report_of(path.stem)["ports"])
                    self.assertIn("\n" + "\n".join(rows) + "\n\n", text)
        self.assertGreaterEqual(told, 11)

    def test_what_the_library_plucks_with_begins_out_of_reach(self):
        for definition in ("plectrum", "quill"):
            scene = self.out.parent / f"{definition}.yaml"
            scene.write_text("ergotic: 1\ninclude: [lib/plectra.yaml, lib/strings.yaml]\n"
                             "sections: {s: {rate: audio}, k: {rate: gestural}}\nuse:\n"
                             "  - {is: limp_string, as: a, in: {s: s}}\n"
                             f"  - {{is: {definition}, as: p, in: {{keys: k}}, with: {{on: a.body@0.2}}}}\n")
            self.assertNotIn("as soon as the scene starts", run("check", scene).stdout, definition)

    def test_each_is_silent_until_it_is_played_and_then_sounds(self):
        for name in set(instruments()) - OLDER:
            with self.subTest(name):
                _, (rate, sound) = self.play(name, "--seconds", BEGINNING_S)
                sound = sound.reshape(len(sound), -1)
                first = int(0.01 * rate)
                self.assertLess(numpy.max(numpy.abs(sound[:first])), 1e-4, "it begins with a click")
                self.assertGreater(numpy.max(numpy.abs(sound)), 0.01)
                self.assertLess(numpy.max(numpy.abs(numpy.mean(sound, axis=0))), 0.01, "it has an offset")

    @unittest.skipUnless(IS_LONG, "the whole demos take a minute")
    def test_whole_demos_are_as_loud_as_is_usual(self):
        for name in instruments():
            for rate in () if name in OLDER else (44100, 48000):
                with self.subTest(name, rate=rate):
                    said, _ = self.play(name, "--seconds", last_row_s(name) + 2, "--rate", rate)
                    loudness, peak = map(float, LEVEL.search(said).groups())
                    self.assertAlmostEqual(loudness, -18, delta=3)
                    self.assertLessEqual(peak, -1)
                    self.assertNotRegex(said, r"link 'tension[^']*': its force was cut")  # what is rounded is no cut


if __name__ == "__main__":
    unittest.main()
