#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A player at rviz: keys of the panel `ergotic/StationPanel`, and what a real station makes of them."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import rosgraph
import rospy
import rostest

from ergotic.msg import Parameters, Status

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
FORCE = (Status.ENGAGING, Status.PLAYING)


class Newest:
    """The newest message of a topic."""

    def __init__(self, topic, kind):
        self.message = None
        rospy.Subscriber(topic, kind, self.hear)

    def hear(self, message):
        self.message = message


def until(condition, seconds=10.0):
    """Whether it is true before the time is over."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class PanelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        screen = cls.start("Xvfb", "-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp",
                           stdout=subprocess.PIPE)
        os.environ.update(DISPLAY=":" + screen.stdout.readline().decode().strip(), QT_QPA_PLATFORM="xcb",
                          LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=cls.folder.name, HOME=cls.folder.name)
        cls.start("openbox")  # without a window manager no window gets keys
        cls.status = Newest("/station/status", Status)
        cls.parameters = Newest("/station/model_parameters", Parameters)
        rospy.set_param("/station/model", os.path.join(ROOT, "models/string.yaml"))
        rospy.set_param("/station/jack", "none")
        rospy.set_param("/station/ramp", 0.1)
        cls.start_station()
        cls.rviz = cls.start("rviz", "--display-config", os.path.join(ROOT, "rviz/station.rviz"))

    @classmethod
    def start(cls, *command, **options):
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True, **options)
        cls.addClassCleanup(cls.end, process)
        return process

    @classmethod
    def start_station(cls):
        cls.station = cls.start("/usr/lib/nodelet/nodelet", "standalone", "ergotic/Station", "__name:=station")

    @staticmethod
    def end(process):
        for how in (signal.SIGTERM, signal.SIGKILL):
            if process.poll() is None:
                os.killpg(process.pid, how)
                until(lambda: process.poll() is not None)
        if process.stdout:
            process.stdout.close()

    def press(self, *keys):
        subprocess.run(["xdotool", "key", *keys], check=True, timeout=10)

    def state(self):
        return self.status.message.state if self.status.message else None

    def values(self):
        return list(self.parameters.message.values) if self.parameters.message else []

    def wait_for_panel(self):
        """It hears the station, and its window has the keyboard."""
        def hears():
            _, subscribed, _ = rosgraph.Master("/panel").getSystemState()
            return any(topic == "/station/events" and any("/rviz" in node for node in nodes)
                       for topic, nodes in subscribed)
        self.assertTrue(until(hears, 60), "the panel does not listen to the station")
        self.assertTrue(until(lambda: subprocess.run(
            ["xdotool", "search", "--onlyvisible", "--name", "RViz", "windowactivate", "--sync"], timeout=10,
            capture_output=True, check=False).returncode == 0, 30), "rviz has no window")

    def test_keys_of_the_panel_play_a_station_that_dies_and_comes_back(self):
        self.assertTrue(until(lambda: self.state() == Status.READY, 60), "no station")
        self.wait_for_panel()
        with self.subTest("Engage lets force in"):
            # The first key may come before rviz has its first picture.
            self.assertTrue(until(lambda: self.press("F5") or until(lambda: self.state() in FORCE, 2)))
            self.assertTrue(until(lambda: self.state() == Status.PLAYING))
        with self.subTest("a slider moves a parameter, and comes back to what the scene says"):
            at_first = self.values()
            self.press("F4", "Prior", "Prior")
            self.assertTrue(until(lambda: self.values()[1:] == at_first[1:] and
                                  self.values()[0] > at_first[0]), self.values())
            self.press("Home")
            self.assertTrue(until(lambda: self.values()[0] == self.parameters.message.lows[0]))
        with self.subTest("Stop takes force away"):
            self.press("F6")
            self.assertTrue(until(lambda: self.state() == Status.READY))
        with self.subTest("an emergency stop latches until Recover"):
            self.press("F5")
            self.assertTrue(until(lambda: self.state() in FORCE))
            self.press("F12")
            self.assertTrue(until(lambda: self.state() == Status.FAULT))
            self.assertEqual(self.status.message.fault, Status.FAULT_EMERGENCY_STOP)
            time.sleep(0.6)  # within half a second it is refused: docs/ros.md
            self.press("F7")
            self.assertTrue(until(lambda: self.state() == Status.READY))
        with self.subTest("a station that dies and comes back is played again"):
            self.station.kill()
            self.station.wait()
            self.status.message = None
            self.press("F5")
            self.start_station()
            self.assertTrue(until(lambda: self.state() == Status.READY, 30))
            self.assertTrue(until(lambda: self.press("F5") or until(lambda: self.state() in FORCE, 2)))
            self.assertIsNone(self.rviz.poll(), "rviz has ended")


if __name__ == "__main__":
    rospy.init_node("panel")
    rostest.rosrun("ergotic", "panel", PanelTest)
