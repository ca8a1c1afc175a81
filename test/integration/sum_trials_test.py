#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How much the tests of a run may be excused for."""
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "support/sum_trials.py"


class SumTrialsTest(unittest.TestCase):
    def sum(self, notes):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "trials.txt"
            if notes is not None:
                path.write_text("".join(f"Suite.Test{n}/0\t{tries}\t{excused}\n"
                                        for n, (tries, excused) in enumerate(notes)))
            done = subprocess.run([SCRIPT, path], capture_output=True, text=True, check=False)
        return done.returncode == 0, done.stdout

    def test_tells_what_was_excused(self):
        passed, said = self.sum([(3, 0), (4, 1), (6300, 63)] + 3 * [(3, 0)])
        self.assertTrue(passed)
        self.assertIn("Suite.Test1/0: 1 of 4 tries excused\n", said)
        self.assertIn("64 of 6316 tries excused in 6 tests\n", said)
        self.assertNotIn("Test0", said)

    def test_a_third_may_be_excused_each_test_counting_alike(self):
        self.assertTrue(self.sum([(6, 3)] * 6 + [(3, 0)] * 4)[0])
        self.assertFalse(self.sum([(6, 3)] * 7 + [(3, 0)] * 3)[0])
        self.assertFalse(self.sum([(6, 3)] * 7 + [(3, 0)] * 2 + [(100000, 0)])[0])

    def test_a_test_alone_may_have_nine_of_twelve(self):
        self.assertTrue(self.sum([(12, 9)])[0])
        self.assertFalse(self.sum([(12, 9), (4, 1)])[0])

    def test_a_run_without_tries_passes(self):
        self.assertTrue(self.sum(None)[0])
        self.assertTrue(self.sum([])[0])


if __name__ == "__main__":
    unittest.main()
