#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A recorded performance in rviz: show_bag.launch shows again what was seen."""
import glob
import os
import signal
import subprocess
import time

import numpy
import rospy
import rostest

from desk import ROOT, DeskTest, Newest, end, until
from ergotic.msg import ModelState, ModelStructure, Note, Status
from ergotic.srv import LoadModel

STRING, MARIMBA = "plucked and struck string", "Marimba of twelve bars"  # as the scenes are called
STRONG = 60  # of 255, between red and blue


class ShowBagTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.start_screen()
        cls.record()

    @classmethod
    def record(cls):
        """A note on the string, then on the marimba: performance.bag, by arguments of station.launch."""
        status = Newest("/station/status", Status)
        states = cls.states()
        launched = cls.start("roslaunch", "ergotic", "station.launch", f"model:={ROOT}/models/string.yaml", "jack:=none",
                             "autoengage:=true", "force_after_swap:=always", "rviz:=false", "gamepads:=false",
                             f"record:={cls.folder.name}/take")
        notes = rospy.Publisher("/station/notes", Note, queue_size=10)
        assert until(lambda: status.message and status.message.state == Status.PLAYING and
                     notes.get_num_connections() > 0 and glob.glob(f"{cls.folder.name}/take*.active"), 60), "it does not play"
        time.sleep(1.2)  # until the recorder listens
        cls.play(notes)
        answer = rospy.ServiceProxy("/station/load_model", LoadModel)(model=f"{ROOT}/models/marimba12.yaml")
        assert answer.success, answer.message
        cls.play(notes)
        states.topic.unregister()
        cls.played = states.seen
        time.sleep(0.2)  # what was seen is recorded
        launched.send_signal(signal.SIGINT)
        assert until(lambda: launched.poll() is not None, 40), "it does not end"
        bag, = glob.glob(f"{cls.folder.name}/take*.bag")
        os.rename(bag, f"{cls.folder.name}/performance.bag")

    @staticmethod
    def play(notes):
        for _ in range(2):
            notes.publish(note=60, velocity=110)
            time.sleep(0.2)
            notes.publish(note=60, velocity=0)
            time.sleep(0.2)

    @staticmethod
    def states(station="/station"):
        """How the model stood at each tick that was shown: `seen`."""
        class States:
            def hear(self, state):
                self.seen[state.tick] = state.displacement
        states = States()
        states.seen = {}
        states.topic = rospy.Subscriber(f"{station}/model_state", ModelState, states.hear)
        return states

    def show(self, *arguments):
        """Where the bag is, until the test ends."""
        launched = self.start("roslaunch", "ergotic", "show_bag.launch", *arguments, cwd=self.folder.name,
                              env={**os.environ, "PWD": self.folder.name})
        self.addCleanup(end, launched)

    def warm(self):
        shot = subprocess.run(["import", "-window", "root", "-depth", "8", "rgb:-"], check=True, capture_output=True,
                              timeout=20).stdout
        pixels = numpy.frombuffer(shot, dtype=numpy.uint8).reshape(-1, 3).astype(int)
        return numpy.count_nonzero(pixels[:, 0] - pixels[:, 2] > STRONG)

    def test_1_it_waits_for_who_looks(self):
        status = Newest("/station/status", Status)
        structure = Newest("/station/model_structure", ModelStructure)
        self.show("bag:=performance.bag", "rviz:=false")
        self.assertTrue(until(lambda: structure.message and structure.message.name == STRING, 30), "no picture")
        time.sleep(0.5)
        self.assertEqual(status.message.model, STRING)
        self.assertIn("performance.bag, 0 of ", status.message.message)

    def test_2_rviz_shows_what_was_seen_beside_a_station_of_another_name(self):
        before = self.warm()
        structure = Newest("/recording/model_structure", ModelStructure)
        states = self.states("/recording")
        self.show("bag:=" + os.path.join(self.folder.name, "performance.bag"), "name:=recording", "loop:=true")
        self.wait_for_window("/recording/model_state")
        self.assertTrue(until(lambda: structure.message and structure.message.name == MARIMBA, 30), "the second model is not shown")
        self.assertTrue(until(lambda: self.warm() > before + 3000, 30), "the bars are not seen")
        self.assertTrue(until(lambda: states.seen and max(states.seen) >= max(self.played), 30), "it does not come to its end")
        again = (self.played.keys() & states.seen.keys()) - {0}  # which each model has before it plays
        for size, least in ((len(self.played[min(self.played)]), 1e-4), (len(self.played[max(self.played)]), 1e-6)):
            ticks = [tick for tick in again if len(self.played[tick]) == size]
            self.assertGreater(len(ticks), 15)
            self.assertGreater(max(max(map(abs, self.played[tick])) for tick in ticks), least, "it stands still")
        self.assertEqual([tick for tick in again if states.seen[tick] != self.played[tick]], [])
        states.topic.unregister()

    def test_3_a_bag_that_is_none_is_told(self):
        status = Newest("/station/status", Status)
        self.show("bag:=nothing.bag", "rviz:=false")
        self.assertTrue(until(lambda: status.message and "nothing.bag" in status.message.message, 30))


if __name__ == "__main__":
    rospy.init_node("show")
    rostest.rosrun("ergotic", "show_bag_long", ShowBagTest)
