#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What changes while a station plays: a gesture file sets parameters of the scene, the scene is edited and read again."""
import os
import subprocess
import time

import rospy
import rostest
from std_srvs.srv import Trigger

from desk import ROOT, DeskTest, Newest, until
from ergotic.msg import Event, GestureBlock, Parameters, Status
from ergotic.srv import LoadModel, SetParameter, Take, TakeRequest

TOOLS = os.path.join(ROOT, "devel/lib/ergotic")
MODEL = os.path.join(ROOT, "models/string.yaml")
CHANGES = ((3.0, 0.3), (3.5, 0.1))  # of the volume, s
LAST_S = 6.0
OTHER = "ergotic: 1\nname: other\nsections: {s: {rate: audio}}\nmats: {m: {type: mass, section: s, mass: 1}}\n"


class ChangesTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        os.environ["ROS_HOME"] = os.path.join(cls.folder.name, "ros")
        cls.gesture = os.path.join(cls.folder.name, "gesture.csv")
        cls.status = Newest("/station/status", Status)
        cls.parameters = Newest("/station/model_parameters", Parameters)
        cls.changes = []
        rospy.Subscriber("/station/events", Event, lambda event: cls.changes.append(event))
        cls.write_gesture("1,$volume,0.5\n")
        cls.start_station(model=MODEL, jack="none", gesture=cls.gesture, autoengage=True, ramp=0.1)

    @classmethod
    def write_gesture(cls, rows):
        with open(cls.gesture, "w", encoding="utf-8") as file:
            file.write("time_s,slice,target_m\n" + rows)

    def message(self):
        return self.status.message.message if self.status.message else ""

    def load(self, model):
        return rospy.ServiceProxy("/station/load_model", LoadModel)(model=model)

    def reload(self):
        return rospy.ServiceProxy("/station/reload", Trigger)()

    def take(self, action, name=""):
        answer = rospy.ServiceProxy("/station/take", Take)(action=action, name=name)
        self.assertTrue(answer.success, answer.message)
        return answer.path

    def finish_and_replay(self):
        bag = self.take(TakeRequest.FINISH)
        again = subprocess.run([os.path.join(TOOLS, "render"), "--gesture", bag], timeout=60, capture_output=True,
                               text=True, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)

    def values(self):
        return dict(zip(self.parameters.message.names, self.parameters.message.values))

    def test_1_a_gesture_that_sets_what_the_scene_does_not_allow_is_refused(self):
        self.assertTrue(until(lambda: self.message(), 60), "no status")
        place = f"{self.gesture}:2:11: error: volume = 0.5 is out of range, allowed: 0...0.4"
        self.assertTrue(until(lambda: place in self.message(), 20), self.message())
        self.write_gesture("1,$volum,0.3\n")
        self.assertIn(f"{self.gesture}:2:3: error: the scene has no parameter 'volum'", self.load(MODEL).message)

    def test_2_a_gesture_sets_parameters_and_the_take_is_replayed_bit_for_bit(self):
        rows = "0,0,0\n1.5,0,0\n2,0,0.02\n" + "".join(f"{at},$volume,{value}\n" for at, value in CHANGES)
        self.write_gesture(rows + f"{LAST_S},$brightness,0.005\n")
        answer = self.load(MODEL)
        self.assertTrue(answer.success, answer.message)
        self.take(TakeRequest.RECORD, "gesture")
        for _, value in CHANGES:
            self.assertTrue(until(lambda wanted=value: self.values()["volume"] == wanted, 10), self.values())
        blocks = Newest("/station/gesture", GestureBlock)  # a new listener, for whom there is a keyframe
        self.assertTrue(until(lambda: blocks.message, 5), "no gesture")
        time.sleep(0.5)
        self.finish_and_replay()
        rate = blocks.message.tick_rate_hz
        told = [(event.tick / rate, event.value) for event in self.changes if event.type == Event.PARAMETER]
        print(f"asked for {CHANGES}, set {told}")
        self.assertEqual([value for _, value in told], [value for _, value in CHANGES])
        for (wanted_s, _), (at_s, _) in zip(CHANGES, told):
            self.assertTrue(0.0 <= at_s - wanted_s < 0.2, f"{wanted_s} s came at {at_s} s")

    def test_3_what_another_scene_does_not_have_is_passed_over_with_a_warning(self):
        self.assertTrue(self.load(OTHER).success)
        self.assertTrue(until(lambda: f"{self.gesture}:7:5: error: the scene has no parameter 'brightness'" in
                              self.message(), LAST_S), self.message())
        self.assertEqual(self.status.message.model, "other")
        self.assertIn("came as a text", self.reload().message)

    def edit(self, *changes):
        """Changes the file of the scene, and reads it again."""
        for old, new in changes:
            self.assertIn(old, self.text)
            self.text = self.text.replace(old, new)
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(self.text)
        return self.reload()

    def test_4_an_edited_scene_is_read_again_with_the_parameters_that_were_changed(self):
        self.scene = os.path.join(self.folder.name, "scene.yaml")
        with open(MODEL, encoding="utf-8") as file:
            self.text = file.read()
        self.assertIn("came as a text", self.edit().message)
        self.assertTrue(self.load(self.scene).success)
        for name, value in (("loss", 3e-5), ("brightness", 5e-3)):
            self.assertTrue(rospy.ServiceProxy("/station/set_parameter", SetParameter)(name=name, value=value).success)
        self.take(TakeRequest.RECORD, "edited")
        answer = self.edit(("name: plucked and struck string", "name: edited"), ("{value: 0.15,", "{value: 0.2,"),
                           ("range: [2.0e-4, 1.0e-2]", "range: [2.0e-4, 4.0e-3]"))
        self.assertTrue(answer.success, answer.message)
        self.assertIn("plays 'edited'", answer.message)
        self.assertIn("not as they were: 'brightness' is 0.005, allowed: 0.0002...0.004", answer.message)
        values = {"loss": 3e-5, "brightness": 1e-3, "volume": 0.2}
        self.assertTrue(until(lambda: self.status.message.model == "edited" and self.values() == values), self.values())
        time.sleep(0.5)
        self.finish_and_replay()

        line = self.text[:self.text.index("masses: 160")].count("\n") + 1
        answer = self.edit(("name: edited", "name: broken"), ("masses: 160", "masses: many"))
        self.assertFalse(answer.success)
        self.assertTrue(answer.message.startswith(f"{self.scene}:{line}:"), answer.message)
        self.assertEqual((self.status.message.model, self.values()), ("edited", values))
        answer = self.edit(("masses: many", "masses: 80"), ("name: broken", "name: mended"))
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: self.status.message.model == "mended" and self.values() == values), self.values())

    def test_5_a_scene_brings_its_own_end_effectors_and_takes_them_away(self):
        os.mkdir(os.path.join(self.folder.name, "hands"))
        scene, hands = (os.path.join(self.folder.name, name) for name in ("ball.yaml", "hands/ball.yaml"))
        with open(scene, "w", encoding="utf-8") as file:
            file.write("ergotic: 1\nname: ball\nsections: {s: {rate: gestural, geometry: space}}\n"
                       "mats: {m: {type: slice, section: s}}\n"
                       "ports: {'m_{a}': {for: {a: [x, y, z]}, mat: m, axis: =a}}\n")
        with open(hands, "w", encoding="utf-8") as file:
            file.write("end_effectors: {ball: {type: ball, slices: [0, 1, 2], ports: [m_x, m_y, m_z]}}\n")
        load = rospy.ServiceProxy("/station/load_model", LoadModel)

        def names():
            return [each.name for each in self.status.message.end_effectors]
        answer = load(model=scene, end_effectors="auto")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: (self.status.message.model, names()) == ("ball", ["ball"])), names())
        answer = load(model=MODEL)
        self.assertFalse(answer.success, "the ball stands on ports that this scene does not have")
        answer = load(model=MODEL, end_effectors="auto")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: names() == []), names())


if __name__ == "__main__":
    rospy.init_node("changes")
    rostest.rosrun("ergotic", "changes", ChangesTest)
