#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The judges of a soak, on forces and looks of which it is known what is wrong."""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))
import soak_report  # noqa: E402
from report.verdict import Verdict  # noqa: E402
from soaking.pauses import overlap_ns  # noqa: E402

MS = soak_report.MS
TICK_RATE = 3150.0


def forces(*changes):
    """(time in ms, slice, force in N) as a device writes them."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "forces.csv"
        rows = [f"{int(time * MS)},{index},{force}\n" for time, index, force in changes]
        path.write_text("time_ns,slice,force_n\n" + "".join(rows))
        return soak_report.Forces(path)


def asked(what, time, **more):
    return {"what": what, "start_ns": int(time * MS), "end_ns": int(time * MS), "kind": None, **more}


def passes(judge, *arguments):
    verdict = Verdict()
    with contextlib.redirect_stdout(io.StringIO()):
        judge(verdict, *arguments)
    return verdict.passed


def stops_pass(changes, journal, pauses=()):
    return passes(soak_report.judge_stops, forces(*changes), journal,
                  [(int(start * MS), int(end * MS)) for start, end in pauses])


class StopsTest(unittest.TestCase):
    STOP = [asked("emergency_stop", 100.0)]

    def test_force_that_is_gone_in_time_and_stays_so_passes(self):
        self.assertTrue(stops_pass([(1, 0, 15.0), (109, 0, 0.0)], self.STOP))

    def test_force_of_any_slice_that_goes_late_fails(self):
        self.assertFalse(stops_pass([(1, 0, 15.0), (111, 0, 0.0)], self.STOP))
        self.assertFalse(stops_pass([(1, 0, 15.0), (1, 3, -1.0), (101, 0, 0.0), (111, 3, 0.0)], self.STOP))

    def test_force_that_never_goes_fails(self):
        self.assertFalse(stops_pass([(1, 0, 15.0)], self.STOP))

    def test_force_that_comes_back_fails_unless_it_was_asked_for_later(self):
        again = [(1, 0, 15.0), (101, 0, 0.0), (500, 0, 1.0), (501, 0, 0.0)]
        self.assertFalse(stops_pass(again, self.STOP))
        self.assertFalse(stops_pass(again, self.STOP + [asked("engage", 99.0)]))
        self.assertTrue(stops_pass(again, self.STOP + [asked("engage", 400.0)]))

    def test_a_pause_excuses_by_its_length_and_only_before_the_limit(self):
        changes = [(time, 0, force) for at in range(0, 3000, 100) for time, force in ((at, 15.0), (at + 51, 0.0))]
        journal = [line for at in range(50, 3000, 100) for line in (asked("stop", at), asked("engage", at + 40))]
        changes[1] = (65, 0, 0.0)
        self.assertFalse(stops_pass(changes, journal))
        self.assertTrue(stops_pass(changes, journal, [(55, 62)]))
        self.assertFalse(stops_pass(changes, journal, [(55, 58)]))
        self.assertFalse(stops_pass(changes, journal, [(61, 70)]))

    def test_more_than_a_tenth_of_excuses_fails(self):
        self.assertFalse(stops_pass([(1, 0, 15.0), (115, 0, 0.0)], self.STOP, [(101, 108)]))

    def test_a_fault_that_stops_ticks_gives_watchdogs_their_time_and_no_more(self):
        stopped = [asked("inject_fault", 90.0, kind="stopped")]
        self.assertTrue(stops_pass([(1, 0, 15.0), (150, 0, 0.0)], self.STOP + stopped))
        self.assertFalse(stops_pass([(1, 0, 15.0), (170, 0, 0.0)], self.STOP + stopped))


class OthersTest(unittest.TestCase):
    def test_force_keeps_its_limit_and_its_slew(self):
        felt = forces((1, 0, 20.0))
        sent = np.array([[1.58 * n, 0.0] for n in range(12)] + [[0.0, -1.58]])
        self.assertTrue(passes(soak_report.judge_force, felt, [sent], TICK_RATE))
        self.assertFalse(passes(soak_report.judge_force, forces((1, 0, 20.1)), [sent], TICK_RATE))
        for late in ([0.0, -3.2], [1.6, -1.58], [0.0, 1.6]):
            self.assertFalse(passes(soak_report.judge_force, felt, [np.append(sent, [late], axis=0)], TICK_RATE))

    def test_ticks_that_were_not_recorded_are_no_growth(self):
        def block(first, *sent):
            return SimpleNamespace(first_tick=first, ticks=len(sent), slices=1, forces=np.array(sent))
        blocks = [block(7, 0.0, 1.5), block(9, 3.0), block(20, 15.0, 16.0)]
        runs = soak_report.in_runs(blocks)
        self.assertEqual([run.ravel().tolist() for run in runs], [[0.0, 1.5, 3.0], [15.0, 16.0]])
        self.assertTrue(passes(soak_report.judge_force, forces((1, 0, 16.0)), runs, TICK_RATE))
        self.assertFalse(passes(soak_report.judge_force, forces((1, 0, 16.0)),
                                soak_report.in_runs([*blocks, block(22, 18.0)]), TICK_RATE))

    def test_a_process_must_not_grow(self):
        def looks(**last):
            calm = {"memory": 4e8, "descriptors": 90, "threads": 20, "cpu_s": 0.0}
            return [{"time_ns": n, **calm, **(last if n > 90 else {})} for n in range(100)]
        self.assertTrue(passes(soak_report.judge_process, looks()))
        self.assertFalse(passes(soak_report.judge_process, [*looks(), {"gone_ns": 101}]))
        for name, much in (("memory", 5e8), ("descriptors", 99), ("threads", 23)):
            self.assertFalse(passes(soak_report.judge_process, looks(**{name: much})), name)

    def test_pauses_that_overlap_count_once(self):
        self.assertEqual(overlap_ns([(0, 10), (5, 20), (30, 40)], 8, 35), 17)


if __name__ == "__main__":
    unittest.main()
