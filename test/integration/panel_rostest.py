#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A player at rviz: keys of the panel `ergotic/StationPanel`, and what a real station makes of them."""
import io
import os
import subprocess

import numpy
import rospy
import rostest
from PIL import Image

from desk import ROOT, DeskTest, Newest, until
from ergotic.msg import ModelStructure, Parameters, Status

FORCE = (Status.ENGAGING, Status.PLAYING)


class PanelTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.start_screen()
        cls.status = Newest("/station/status", Status)
        cls.parameters = Newest("/station/model_parameters", Parameters)
        cls.structure = Newest("/station/model_structure", ModelStructure)
        cls.start_station(model=os.path.join(ROOT, "models/string.yaml"), jack="none", ramp=0.1)
        cls.rviz = cls.start_rviz()

    def press(self, *keys):
        subprocess.run(["xdotool", "key", *keys], check=True, timeout=10)

    def state(self):
        return self.status.message.state if self.status.message else None

    def values(self):
        return list(self.parameters.message.values) if self.parameters.message else []

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
        self.wait_for_window("/station/events")
        self.expect(*FORCE, key="F5")
        self.expect(Status.PLAYING)
        self.check_sliders()
        self.check_reload()

        self.expect(Status.READY, key="F6")
        self.expect(*FORCE, key="F5")
        self.expect(Status.FAULT, key="F12")
        self.assertEqual(self.status.message.fault, Status.FAULT_EMERGENCY_STOP)
        self.expect(Status.READY, key="F7")  # refused within half a second after the stop

        self.check_emergency_stop_beside_an_open_list()

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

    def check_emergency_stop_beside_an_open_list(self):
        """Neither does the list of instruments cover the red button, nor does it take the click for itself."""
        self.expect(*FORCE, key="F5")
        shot = subprocess.run(["import", "-window", "root", "png:-"], capture_output=True, check=True, timeout=10).stdout
        red, green, blue = (numpy.asarray(band, dtype=int) for band in Image.open(io.BytesIO(shot)).convert("RGB").split())
        rows, columns = numpy.nonzero((red > 150) & (green < 60) & (blue < 60))
        at = str(int(numpy.median(columns))), str(int(numpy.median(rows)) + 10)  # below its words
        self.press("F3", "alt+Down")
        rospy.sleep(1.0)
        subprocess.run(["xdotool", "mousemove", *at, "click", "1"], check=True, timeout=10)
        self.expect(Status.FAULT)
        self.expect(Status.READY, key="F7")

    def check_sliders(self):
        at_first = self.values()
        self.press("F4", "Prior", "Prior")
        self.assertTrue(until(lambda: self.values()[0] > at_first[0]), self.values())
        self.press("Home")
        self.assertTrue(until(lambda: self.values()[0] == self.parameters.message.lows[0]), self.values())
        self.assertEqual(self.values()[1:], at_first[1:])

    def check_reload(self):
        """With the value that a slider was moved to."""
        before, values = self.structure.message, self.values()
        self.press("shift+F5")
        self.assertTrue(until(lambda: self.structure.message is not before), "the scene is not read again")
        self.assertTrue(until(lambda: self.values() == values), self.values())
        self.expect(Status.PLAYING)


if __name__ == "__main__":
    rospy.init_node("panel")
    rostest.rosrun("ergotic", "panel", PanelTest)
