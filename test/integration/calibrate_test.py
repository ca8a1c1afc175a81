#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/calibrate asks of a person and of a station."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import sys
import types
import unittest

sys.dont_write_bytecode = True
SCRIPT = os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "calibrate")
loader = importlib.machinery.SourceFileLoader("calibrate", SCRIPT)
calibrate = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
loader.exec_module(calibrate)


class Request(types.SimpleNamespace):
    BEGIN, SAMPLE, FINISH, ABORT, CHECK = range(5)
    NAMES = "BEGIN", "SAMPLE", "FINISH", "ABORT", "CHECK"


class Station:
    """Answers as one does; `refuses` is an action that it does not do."""

    def __init__(self, refuses=None):
        self.asked = []
        self.refuses = refuses

    def __call__(self, request):
        self.asked.append((Request.NAMES[request.action], {name: value for name, value in vars(request).items()
                                                           if name != "action"}))
        return types.SimpleNamespace(success=request.action != self.refuses, message="in use", volts=1.5, noise=1e-4,
                                     gain=0.004, rest=0.3, residual=2e-5)

    def actions(self):
        return [name for name, _ in self.asked]


class Person:
    """Answers in turn; then nobody is there any more."""

    def __init__(self, *answers):
        self.answers = list(answers)
        self.told = []

    def __call__(self, text):
        self.told.append(text)
        if not self.answers:
            raise EOFError
        return self.answers.pop(0)


class CalibrateTest(unittest.TestCase):
    def walk(self, station, person, *words):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            try:
                calibrate.walk(calibrate.Calibration(station, Request), calibrate.parsed(words), person)
            finally:
                self.said = said.getvalue()

    def refused(self, *words):
        with contextlib.redirect_stderr(io.StringIO()) as said, self.assertRaises(SystemExit):
            calibrate.parsed(words)
        return said.getvalue()

    def test_it_asks_for_one_place_after_the_other_and_then_for_hands_off(self):
        station, person = Station(), Person("-20", "20", "", "")
        self.walk(station, person, "--slice", "3", "--file", "devices.yaml")
        self.assertEqual(station.asked, [
            ("BEGIN", {"slice": 3}), ("SAMPLE", {"position": -0.02}), ("SAMPLE", {"position": 0.02}),
            ("FINISH", {"file": "devices.yaml", "volts_per_newton": 0.0, "max_residual": 0.0}),
            ("CHECK", {"slice": 3, "file": "devices.yaml"})])
        self.assertIn("known", person.told[0].replace("that you know", "known"))
        self.assertIn("Take your hands off", person.told[-1])
        self.assertIn("At -20 mm the sensor says 1.5000 V", self.said)
        self.assertIn("4.0000 mm per volt", self.said)

    def test_places_that_are_given_are_asked_for_in_turn(self):
        station, person = Station(), Person("", "", "")
        self.walk(station, person, "--slice", "0", "--mm", "-20", "0", "20", "--no-check")
        self.assertEqual(station.actions(), ["BEGIN"] + 3 * ["SAMPLE"] + ["FINISH"])
        self.assertEqual([text.split(" mm")[0].split()[-1] for text in person.told], ["-20", "0", "20"])

    def test_too_few_places_and_words_are_asked_for_again(self):
        station, person = Station(), Person("-20", "", "far up", "20", "")
        self.walk(station, person, "--slice", "0", "--no-check")
        self.assertEqual(station.actions(), ["BEGIN", "SAMPLE", "SAMPLE", "FINISH"])
        self.assertIn("It takes 2 places", self.said)
        self.assertIn("far up is no number", self.said)

    def test_who_goes_away_or_is_refused_leaves_no_calibration_behind(self):
        for refuses, reason in ((None, EOFError), (Request.SAMPLE, calibrate.Refusal), (Request.FINISH, calibrate.Refusal)):
            station = Station(refuses)
            with self.assertRaises(reason):
                self.walk(station, Person("-20") if refuses is None else Person("-20", "20", ""), "--slice", "0")
            self.assertEqual(station.actions()[-1], "ABORT")
        station = Station(Request.BEGIN)  # another calibration may be under way
        with self.assertRaises(calibrate.Refusal):
            self.walk(station, Person(), "--slice", "0")
        self.assertEqual(station.actions(), ["BEGIN"])

    def test_steps_need_what_they_need(self):
        self.assertIn("--slice N", self.refused())
        self.assertIn("--slice N", self.refused("check"))
        self.assertIn("allowed: 0 and above", self.refused("begin", "--slice", "-1"))
        self.assertIn("--mm MM", self.refused("sample"))
        self.assertIn("--mm MM", self.refused("sample", "--mm", "1", "2"))
        self.assertIn("2 and more", self.refused("--slice", "0", "--mm", "1"))
        self.assertIn("begin", self.refused("start", "--slice", "0"))
        self.assertEqual(calibrate.parsed(["sample", "--mm", "-20"]).mm, [-20.0])


if __name__ == "__main__":
    unittest.main()
