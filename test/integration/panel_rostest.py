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
        self.assertTrue(until(hears, 30), "the panel does not listen to the station")
        self.assertTrue(until(lambda: subprocess.run(
            ["xdotool", "search", "--onlyvisible", "--name", "RViz", "windowactivate", "--sync"], timeout=10,
            capture_output=True, check=False).returncode == 0, 30), "rviz has no window")

    def expect(self, *states, key=None, seconds=10):
        """One of these states comes, of itself or by a key, which is pressed again where it was not heard."""
        def comes():
            if key:
                self.press(key)
            return until(lambda: self.state() in states, 2.0)
        came = until(comes, seconds)
        if not came and "PANEL_PICTURE" in os.environ:  # for who looks for the reason
            subprocess.run(["import", "-window", "root", os.environ["PANEL_PICTURE"]], timeout=10, check=False)
        self.assertTrue(came, f"{key}: state {self.state()}, expected {states}")

    def test_keys_of_the_panel_play_a_station_that_dies_and_comes_back(self):
        self.expect(Status.READY, seconds=40)
        self.wait_for_panel()
        self.expect(*FORCE, key="F5")
        self.expect(Status.PLAYING)
        self.check_sliders()

        self.expect(Status.READY, key="F6")
        self.expect(*FORCE, key="F5")
        self.expect(Status.FAULT, key="F12")
        self.assertEqual(self.status.message.fault, Status.FAULT_EMERGENCY_STOP)
        self.expect(Status.READY, key="F7")  # refused within half a second after the stop

        self.station.kill()
        self.station.wait()
        self.press("F5")
        self.status.message = None
        self.start_station()
        self.expect(Status.READY, seconds=30)
        self.expect(*FORCE, key="F5")
        self.press("ctrl+q")
        self.assertTrue(until(lambda: self.rviz.poll() is not None), "rviz does not end")
        self.assertEqual(self.rviz.returncode, 0)

    def check_sliders(self):
        at_first = self.values()
        self.press("F4", "Prior", "Prior")
        self.assertTrue(until(lambda: self.values()[0] > at_first[0]), self.values())
        self.press("Home")
        self.assertTrue(until(lambda: self.values()[0] == self.parameters.message.lows[0]), self.values())
        self.assertEqual(self.values()[1:], at_first[1:])


if __name__ == "__main__":
    rospy.init_node("panel")
    rostest.rosrun("ergotic", "panel", PanelTest)
