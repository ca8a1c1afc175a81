#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/play_gesture reads and writes."""
import importlib.machinery
import importlib.util
import os
import sys
import tempfile
import types
import unittest
from unittest import mock

SCRIPT = os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "play_gesture")
loader = importlib.machinery.SourceFileLoader("play_gesture", SCRIPT)
play_gesture = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
loader.exec_module(play_gesture)


def block(first_tick, *rows):
    return types.SimpleNamespace(first_tick=first_tick, tick_rate_hz=1000.0, slices=2,
                                 ticks=len(rows), positions=[x for row in rows for x in row])


class PlayGestureTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, text):
        path = os.path.join(self.folder.name, "g.csv")
        with open(path, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
        return path

    def test_reads_targets(self):
        path = self.write("# a comment\ntime_s,slice,target_m\n0,1,0\n2,1,0.02\n")
        gesture = play_gesture.read_csv(path, None)
        self.assertEqual(gesture.length, 2.0)
        self.assertEqual(gesture.at(1.0), [(1, 0.01)])
        self.assertEqual(gesture.at(9.0), [(1, 0.02)])

    def test_reads_files_of_any_program(self):
        for text in ("\ufeffTime_s,Slice,Target_m\r\n0,1,0\r\n2,1,0.02\r\n",
                     'sep=,\n"time_s","slice","target_m"\n"0","1","0"\n"2","1","0.02"\n',
                     "time_s,slice,target_m,,\n+0.0,1.0,+0,,\n,,,,\n2e0,1,+2.0e-02,,\n",
                     b"# \xfcber den Steg; 0,5\r0\t1\t0\r2\t1\t0.02\r"):
            gesture = play_gesture.read_csv(self.write(text), None)
            self.assertEqual(gesture.length, 2.0)
            self.assertEqual(gesture.at(1.0), [(1, 0.01)])

    def test_reads_positions_per_tick(self):
        path = self.write("tick,x0,x1\n7,0,0.01\n8,0.02,0.03\n")
        gesture = play_gesture.read_csv(path, 100.0)
        self.assertEqual(gesture.length, 0.01)
        self.assertEqual(gesture.at(0.0), [(0, 0.0), (1, 0.01)])
        self.assertAlmostEqual(gesture.at(0.005)[0][1], 0.01)

    def test_reads_values_of_parameters(self):
        path = self.write("0,1,0\n2,$loss,1e-5\n1.5,\"$tension\",80\n")
        gesture = play_gesture.read_csv(path, None)
        self.assertEqual(gesture.length, 2.0)
        self.assertEqual(gesture.at(1.0), [(1, 0.0)])
        tension, loss = (1.5, "tension", 80.0, 3), (2.0, "loss", 1e-5, 2)
        self.assertEqual(gesture.changes_between(-1.0, 1.4), [])
        self.assertEqual(gesture.changes_between(1.4, 1.5), [tension])
        self.assertEqual(gesture.changes_between(1.5, 9.0), [loss])
        self.assertEqual(gesture.changes_between(1.8, 1.6), [loss, tension], "it began again")
        known = types.SimpleNamespace(names=["tension", "loss"], lows=[10.0, 0.0], highs=[90.0, 1e-3], units=["N", ""])
        play_gesture.check_changes(gesture, "g.csv", known)
        known.highs[0] = 70.0
        with self.assertRaises(SystemExit) as refused:
            play_gesture.check_changes(gesture, "g.csv", known)
        self.assertEqual(str(refused.exception), "g.csv:3: error: tension = 80, allowed: 10...70 N")
        known.names[1] = "damping"
        known.highs[0] = 90.0
        with self.assertRaises(SystemExit) as refused:
            play_gesture.check_changes(gesture, "g.csv", known)
        self.assertEqual(str(refused.exception),
                         "g.csv:2: error: the scene has no parameter 'loss', allowed: tension, damping")

    def test_says_what_is_wrong(self):
        for text, rate, expected in [
                ("tick,x0\n0,0\n", None, "--rate"),
                ("time_s,slice,target_m\n0,1\n", None, "g.csv:2: error: expected time_s"),
                ("tick,x0\n0,zero\n", 100.0, "g.csv:2: error: expected tick"),
                ("tick,x0\n0,nan\n", 100.0, "g.csv:2: error: expected tick"),
                ("time_s,slice,target_m\n0,1,inf\n", None, "g.csv:2: error: expected time_s"),
                ("0;0;0\n0,5;0;0,02\n", None, "g.csv:1: error: a semicolon separates the fields"),
                ("0,0,0\n".encode("utf-16"), None, "g.csv:1: error: the text is UTF-16, allowed: UTF-8"),
                ("1,$a,2\n1,$b,2\n1,$a,3\n", None, "g.csv:3: error: time_s = 1 s is not after the parameter's"),
                ("1,$,2\n", None, "g.csv:1: error: the name of a parameter is missing"),
                ("1,$a\n", None, "g.csv:1: error: expected time_s,slice,target_m, or time_s,$parameter,value"),
                ("# nothing\n", None, "no targets")]:
            with self.assertRaises(SystemExit) as refused:
                play_gesture.read_csv(self.write(text), rate)
            self.assertIn(expected, str(refused.exception))

    def test_lets_force_in_before_and_stops_it_after(self):
        done = []
        rospy = mock.MagicMock()
        rospy.get_time.return_value = 0.0
        note = lambda *arguments: done.append(arguments[-1])  # noqa: E731
        with mock.patch.dict(sys.modules, {"rospy": rospy, "ergotic": mock.MagicMock(),
                                           "ergotic.msg": mock.MagicMock()}), \
                mock.patch.object(play_gesture, "call", note), \
                mock.patch.object(play_gesture, "wait_for_force", lambda _: done.append("wait")), \
                mock.patch.object(play_gesture, "play", lambda *_: done.append("play")):
            options = types.SimpleNamespace(station="/station", engage=True, seconds=1.0, repeat=1.0)
            rospy.Publisher.return_value.get_num_connections.return_value = 1
            play_gesture.perform(mock.MagicMock(changes=[]), options)
            self.assertEqual(done, ["engage", "wait", "play", "stop"])
            done.clear()
            options.engage = False
            play_gesture.perform(mock.MagicMock(changes=[]), options)
            self.assertEqual(done, ["play"])

    def test_refuses_positions_that_are_no_numbers(self):
        blocks = [block(5, (0.1, 0.2)), block(6, (0.3, float("nan")))]
        with self.assertRaises(SystemExit) as refused:
            list(play_gesture.checked(blocks, "g.bag"))
        self.assertIn("tick 6", str(refused.exception))

    def test_takes_the_station_that_is_chosen(self):
        topics = ["/left/gesture", "/stage/right/gesture"]
        self.assertEqual(play_gesture.choose(topics, "stage/right", "g.bag"), topics[1])
        self.assertEqual(play_gesture.choose(topics[:1], "", "g.bag"), topics[0])
        for station, expected in [("", "say by --of which: /left, /stage/right"),
                                  ("none", "no gesture of /none, allowed: /left")]:
            with self.assertRaises(SystemExit) as refused:
                play_gesture.choose(topics, station, "g.bag")
            self.assertIn(expected, str(refused.exception))

    def test_takes_each_recorded_tick_once_and_fills_gaps(self):
        blocks = [block(5, (0.1, 0.2), (0.3, 0.4)), block(6, (9.0, 9.0)), block(9, (0.5, 0.6))]
        gesture = play_gesture.gesture_of(blocks)
        self.assertEqual(gesture.times[0], [0.0, 0.001, 0.004])
        self.assertEqual(gesture.targets[1], [0.2, 0.4, 0.6])
        path = os.path.join(self.folder.name, "saved.csv")
        play_gesture.save(blocks, path)
        with open(path) as file:
            self.assertEqual(file.read(), "tick,x0,x1\n5,0.1,0.2\n6,0.3,0.4\n7,0.3,0.4\n"
                                          "8,0.3,0.4\n9,0.5,0.6\n")


if __name__ == "__main__":
    unittest.main()
