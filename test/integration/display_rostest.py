#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of the model in rviz, by its colours: what hands move is blue, what sounds glows, what is silent is grey."""
import os
import subprocess

import numpy
import rospy
import rostest

from desk import ROOT, DeskTest, Newest, until
from ergotic.msg import Note, Scope
from ergotic.srv import LoadModel
from pointer import Pointer

STRONG = 60  # of 255, between the largest and the least of red, green and blue


class DisplayTest(Pointer, DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.start_desk()

    def colours(self):
        """[pixels, 3] of the picture that are no greys."""
        left, top, width, height = self.picture()
        shot = subprocess.run(["import", "-window", "root", "-crop", f"{width}x{height}+{left}+{top}", "-depth", "8",
                               "rgb:-"], check=True, capture_output=True, timeout=20).stdout
        pixels = numpy.frombuffer(shot, dtype=numpy.uint8).reshape(-1, 3).astype(int)
        return pixels[numpy.ptp(pixels, axis=1) > STRONG]

    def blue(self):
        colours = self.colours()
        return numpy.count_nonzero(colours[:, 2] > colours[:, 0])

    def warm(self):
        colours = self.colours()
        return numpy.count_nonzero(colours[:, 0] > colours[:, 2])

    def expect(self, condition, what, seconds=30):
        came = until(condition, seconds)
        if not came and "DISPLAY_PICTURE" in os.environ:  # for who looks for the reason
            subprocess.run(["import", "-window", "root", os.environ["DISPLAY_PICTURE"]], timeout=10, check=False)
        self.assertTrue(came, what)

    def check_scope(self, strike):
        """The blocks of the topic `scope` have the partials of the string."""
        scope = Newest("/station/scope", Scope)

        def is_seen():
            strike()
            return scope.message and numpy.max(numpy.abs(scope.message.samples)) > 1e-3
        self.expect(is_seen, "the sound is not seen")
        sound = scope.message
        self.assertEqual((sound.rate, list(sound.channels), len(sound.samples)), (44100.0, [1, 2], 2 * 2048))

        def is_of_string():  # once it rings by itself
            lines = numpy.abs(numpy.fft.rfft(numpy.hanning(2048) * scope.message.samples[:2048]))
            partial = numpy.argmax(lines) * sound.rate / 2048 / 110.0
            return partial > 0.8 and abs(partial - round(partial)) < 0.2
        self.expect(is_of_string, "the string is not heard at its partials", 10)

    def test_it_shows_what_sounds_what_is_silent_and_another_model(self):
        self.wait_for_window("/station/end_effector_shapes")
        self.expect(lambda: self.blue() > 50, "the hands are not seen")

        notes = rospy.Publisher("/station/notes", Note, queue_size=10)

        def glows():
            notes.publish(note=60, velocity=110)
            notes.publish(note=60, velocity=0)
            return self.warm() > 50
        self.expect(glows, "the string does not glow")

        self.check_scope(glows)

        load = rospy.ServiceProxy("/station/load_model", LoadModel)
        self.assertTrue(load(model=os.path.join(ROOT, "models/marimba12.yaml")).success)
        self.expect(lambda: self.warm() > 5000, "the wood of the bars is not seen")
        self.assertTrue(load(model=os.path.join(ROOT, "models/string.yaml")).success)
        self.expect(lambda: 50 < self.blue() and self.warm() < 3000, "bars are left")

        self.station.kill()
        self.station.wait()
        self.expect(lambda: len(self.colours()) == 0, "the picture of a dead station is not grey")
        self.start_station()
        self.expect(lambda: self.blue() > 50, "the station that came back is not seen", 60)


if __name__ == "__main__":
    rospy.init_node("display")
    rostest.rosrun("ergotic", "display", DisplayTest)
