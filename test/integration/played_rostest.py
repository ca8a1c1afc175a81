#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Four instruments without a device, by mouse, keys and MIDI: each a take that is what was heard, bit for bit."""
import os
import subprocess
import time

import numpy
import rospy
import rostest

from desk import ROOT, DeskTest, Newest, samples, until
from ergotic.msg import Status, Takes
from ergotic.srv import LoadModel, Take, TakeRequest
from midi_keyboard import MidiKeyboard
from pointer import Pointer, xdotool

TOOLS = os.path.join(ROOT, "devel/lib/ergotic")
SECONDS = 16
PARTS = 12       # of a take, the loudest frame of each says where it begins in what was heard


class PlayedTest(Pointer, DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.takes = Newest("/station/takes", Takes)
        cls.start_desk(limiter=False, force_after_swap="always")

    def load(self, name):
        answer = rospy.ServiceProxy("/station/load_model", LoadModel)(model=os.path.join(ROOT, f"models/{name}.yaml"))
        self.assertTrue(answer.success, answer.message)
        self.wait_for_window("/station/handles")
        time.sleep(1.0)  # rviz turns its camera to it
        self.assertTrue(until(lambda: self.status.message.state == Status.PLAYING, 10), "no force")

    def check_take(self, name, play):
        """Plays while it is recorded, and compares what was heard with what the take renders."""
        captured, rendered = (os.path.join(self.folder.name, f"{name}_{kind}.wav") for kind in ("heard", "again"))
        capture = self.start(os.path.join(TOOLS, "capture"), "--seconds", str(SECONDS), "--port", "ergotic:out_1",
                             "--port", "ergotic:out_2", captured, stdout=subprocess.DEVNULL)
        time.sleep(1.0)
        take = rospy.ServiceProxy("/station/take", Take)
        self.assertTrue(take(action=TakeRequest.RECORD, name=name).success)
        self.assertTrue(until(lambda: self.takes.message.recorded > 0.1), "nothing is recorded")
        play()
        answer = take(action=TakeRequest.FINISH)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: capture.poll() is not None, SECONDS + 10))
        subprocess.run([os.path.join(TOOLS, "render"), "--gesture", answer.path, "--out", rendered], check=True,
                       timeout=120, capture_output=True)
        heard, again = samples(captured)[0], samples(rendered)[0]
        loudest = int(numpy.argmax(numpy.abs(again)))
        self.assertGreater(abs(again[loudest]), 3e-3, "it does not sound")
        # One of these frames may be just what JACK left out.
        parts = numpy.array_split(numpy.arange(len(again)), PARTS)
        known = [int(part[numpy.argmax(numpy.abs(again[part]))]) for part in parts]
        best = (0.0, -1)
        for at in {int(at) for frame in known if again[frame] != 0.0
                   for at in numpy.flatnonzero(heard == again[frame]) - frame}:
            low, high = max(0, -at), min(len(again), len(heard) - at)
            both = heard[at + low:at + high], again[low:high]
            # What JACK left out on a busy machine is silence, and nothing else may differ.
            wrong = int(numpy.count_nonzero((both[0] != both[1]) & (both[0] != 0.0)))
            best = max(best, (float(numpy.mean(both[0] == both[1])), -wrong))
        equal, wrong = best[0], -best[1]
        print(f"{name}: {len(again)} frames, peak {abs(again[loudest]):.3f}, {100 * equal:.2f} % equal, {wrong} wrong")
        self.assertGreater(equal, 0.95)
        self.assertEqual(wrong, 0)

    def test_1_guitar_by_mouse(self):
        self.load("guitar")

        def play():
            strings = [name for name in self.handles.message.names if "pick" in name]
            for name in strings[:4]:
                x, y = self.touched(name)
                xdotool("mousemove", x, y, "sleep", 0.2, "click", 1, "sleep", 0.4)
            x, y = self.touched(strings[0])
            xdotool("mousemove", x, y, "sleep", 0.3, "mousedown", 1, "sleep", 0.3)
            for _ in range(20):
                xdotool("mousemove_relative", "--", 0, -3, "sleep", 0.01)
            if os.environ.get("PICTURES"):
                subprocess.run(["import", "-window", "root", f"{os.environ['PICTURES']}/guitar.png"], check=True)
            xdotool("mouseup", 1, "sleep", 0.5)
        self.check_take("guitar", play)

    def test_2_piano_by_keys(self):
        self.load("piano12")
        left, top, width, height = self.picture()
        xdotool("mousemove", left + width // 2, top + height - 20, "sleep", 0.5)

        def play():
            for key in "qwertyq":
                xdotool("keydown", key, "sleep", 0.25, "keyup", key, "sleep", 0.05)
            if os.environ.get("PICTURES"):
                subprocess.run(["import", "-window", "root", f"{os.environ['PICTURES']}/piano12.png"], check=True)
        self.check_take("piano12", play)

    def test_3_marimba_by_midi(self):
        self.load("marimba12")
        keyboard = MidiKeyboard("keyboard")
        self.addCleanup(keyboard.close)
        self.assertTrue(until(keyboard.is_connected), "it is not connected by itself")

        def play():
            for note, velocity in ((48, 60), (52, 80), (55, 100), (59, 127), (55, 90), (52, 70), (48, 110)):
                keyboard.send(0x90, note, velocity)
                time.sleep(0.2)
                keyboard.send(0x80, note, 64)
            if os.environ.get("PICTURES"):
                subprocess.run(["import", "-window", "root", f"{os.environ['PICTURES']}/marimba12.png"], check=True)
            time.sleep(0.5)
        self.check_take("marimba12", play)

    def test_4_violin_by_a_click_and_by_one_key_a_note(self):
        self.load("violin_g")
        bow = next(name for name in self.handles.message.names if "bow" in name)
        x, y = self.touched(bow)
        xdotool("mousemove", x, y, "sleep", 0.2)
        self.check_take("violin_click", lambda: xdotool("click", 1, "sleep", 1.0))
        keyboard = MidiKeyboard("violinist")
        self.addCleanup(keyboard.close)
        self.assertTrue(until(keyboard.is_connected), "it is not connected by itself")

        def play():
            last = None
            for note in (55, 57, 59, 60, 62, 67, 62):  # slurred
                keyboard.send(0x90, note, 100)
                time.sleep(0.05)
                if last:
                    keyboard.send(0x80, last, 64)
                time.sleep(0.4)
                last = note
            time.sleep(1.5)  # the bow turns at its end
            keyboard.send(0x80, last, 64)
            time.sleep(0.5)
        self.check_take("violin", play)


if __name__ == "__main__":
    rospy.init_node("played")
    rostest.rosrun("ergotic", "played", PlayedTest)
