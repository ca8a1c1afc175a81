#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/compare_builds takes for equal, and the random scenes that it plays.

  compare_builds_test.py TOOLS       (the folder of render and check)
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

import numpy

sys.dont_write_bytecode = True
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/compare_builds"
sys.path.insert(0, str(SCRIPT.parent))
LOADER = importlib.machinery.SourceFileLoader("compare_builds", str(SCRIPT))
compare_builds = importlib.util.module_from_spec(
    importlib.util.spec_from_loader("compare_builds", LOADER))
LOADER.exec_module(compare_builds)
from random_scene.laws import LAWS  # noqa: E402

TOOLS = pathlib.Path(sys.argv.pop(1)).resolve()
PLAIN = ["--precision", "double", "--out-format", "double"]
SEEDS = range(1, 13)

# Plays as the real one, with the lowest bit of one number turned round.
LIAR = """#!/usr/bin/python3
import pathlib, subprocess, sys
code = subprocess.run(["{tool}", *sys.argv[1:]]).returncode
wav = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
content = bytearray(wav.read_bytes())
content[content.index(b"data") + 8 + 8 * 1234] ^= 1
wav.write_bytes(content)
sys.exit(code)
"""


class DifferenceTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def other_build(self, **tools):
        """Tools of another build: the text of a program each."""
        folder = pathlib.Path(self.folder.name) / "other"
        folder.mkdir()
        for name in ("render", "check"):
            tool = folder / name
            if name in tools:
                tool.write_text(tools[name].format(tool=TOOLS / name))
                tool.chmod(tool.stat().st_mode | stat.S_IXUSR)
            else:
                tool.symlink_to(TOOLS / name)
        return folder

    def differences(self, other, options=()):
        model = next(compare_builds.models())
        case = model._replace(played=["--seconds", "0.05"])
        return compare_builds.compared((TOOLS, other), case, [PLAIN + list(options)])[0]

    def test_finds_none_in_the_same_build(self):
        self.assertEqual(self.differences(TOOLS, ["--energies"]), [])

    def test_finds_one_bit_of_one_sample(self):
        (what, commands), = self.differences(self.other_build(render=LIAR))
        self.assertRegex(what, r"^1 of \d+ samples, the first is 1234:")
        self.assertEqual([command[0] for command in commands],
                         [str(TOOLS / "render"), str(pathlib.Path(self.folder.name, "other/render"))])

    def test_finds_another_balance_of_energy(self):
        balance = "#!/bin/sh\n{tool} \"$@\" 2>&1 | sed 's/stored: /stored: 1/'\n"
        (what, _), = self.differences(self.other_build(render=balance), ["--energies"])
        self.assertIn("stored: 1", what)

    def test_finds_another_verdict_but_no_other_cost(self):
        verdict = "#!/bin/sh\n{tool} \"$@\" | sed 's/\"margin\": 0/\"margin\": 1/; s/_ns\": /&1/'\n"
        (what, _), = self.differences(self.other_build(check=verdict))
        self.assertRegex(what, "^check: .*margin")

    def test_takes_no_number_for_another_one_but_for_no_sample(self):
        a, b = numpy.array([1.0, numpy.nan]), numpy.array([1.0, -numpy.nan])
        self.assertIsNone(compare_builds.first_difference(a, b))
        self.assertIsNotNone(compare_builds.first_difference(a, numpy.array([1.0, 2.0])))
        self.assertIsNotNone(compare_builds.first_difference(numpy.zeros(2), -numpy.zeros(2)))
        self.assertIsNotNone(compare_builds.first_difference(a, a[:1]))
        self.assertIsNotNone(compare_builds.first_difference(a, None))


class SceneTest(unittest.TestCase):
    def test_is_the_same_for_the_same_seed(self):
        one, same, other = (compare_builds.Scene(seed) for seed in (5, 5, 6))
        self.assertEqual((one.text, one.sets, one.gesture), (same.text, same.sets, same.gesture))
        self.assertNotEqual(one.text, other.text)

    def test_nearly_always_sounds(self):
        with tempfile.TemporaryDirectory() as name:
            cases = [compare_builds.random_case(pathlib.Path(name), seed) for seed in SEEDS]
            states = [compare_builds.state_of(compare_builds.play(TOOLS, case, PLAIN))
                      for case in cases]
        self.assertGreaterEqual(states.count("sounding"), len(SEEDS) - 2, states)

    def test_knows_every_law_of_the_schema(self):
        schema = json.loads(subprocess.run([TOOLS / "expand", "--schema"], check=True, capture_output=True).stdout)
        words = schema["definitions"]["lia"]["properties"]["type"]["anyOf"][0]["enum"]
        self.assertEqual(set(LAWS), set(words) - {"bend", "stretch"})

    def test_meets_everything_in_two_hundred(self):
        features = sum((compare_builds.Scene(seed).features for seed in range(1, 201)),
                       compare_builds.collections.Counter())
        for feature in [f"link {law}" for law in LAWS] + [
                "string scalar", "string line", "string plane", "string space", "coarse string",
                "mesh scalar", "mesh plane", "mesh space", "chaplet", "filter auto", "modes all",
                "modes auto", "modes N", "moving point", "guide", "sleep", "agent", "cell", "parameter",
                "parameter set", "table linear", "table smooth", "force input", "position input",
                "hear position", "hear velocity", "hear force", "rates joined", "generator energy_stable"]:
            self.assertGreaterEqual(features[feature], 3, feature)


if __name__ == "__main__":
    unittest.main()
