#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes: what a station records by itself, and how it plays that again through its JACK ports."""
import os
import subprocess
import time

import numpy
import rospy
import rostest

from desk import ROOT, DeskTest, Newest, samples, until
from ergotic.msg import (HandTargets, Hold, HoldTarget, ModelState, ModelStructure, Note, Parameters, ParameterValue,
                         Presets, Status, Takes)
from ergotic.srv import LoadModel, Preset, PresetRequest, SetParameter, Take, TakeRequest

TOOLS = os.path.join(ROOT, "devel/lib/ergotic")
MODEL = os.path.join(ROOT, "models/string.yaml")
FADE = 400  # frames, more than the fade in of a take


class TakesTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        os.environ["ROS_HOME"] = os.path.join(cls.folder.name, "ros home")
        cls.takes_folder = os.path.join(os.environ["ROS_HOME"], "ergotic/takes")
        cls.start_jack()
        cls.status = Newest("/station/status", Status)
        cls.takes = Newest("/station/takes", Takes)
        cls.state = Newest("/station/model_state", ModelState)
        cls.structure = Newest("/station/model_structure", ModelStructure)
        cls.presets = Newest("/station/presets", Presets)
        cls.parameters = Newest("/station/model_parameters", Parameters)
        cls.start_station(model=MODEL, autoengage=True, limiter=False)
        assert until(lambda: cls.status.message and cls.status.message.state == Status.PLAYING and
                     cls.status.message.audio_running, 60), "no force, or no sound"
        cls.notes = rospy.Publisher("/station/notes", Note, queue_size=10)
        cls.holds = rospy.Publisher("/station/hold_targets", HoldTarget, queue_size=10)
        cls.held = Newest("/station/holds", Hold)
        assert until(lambda: cls.notes.get_num_connections() > 0 and cls.holds.get_num_connections() > 0)

    def take(self, action, name="", new_name=""):
        return rospy.ServiceProxy("/station/take", Take)(action=action, name=name, new_name=new_name)

    def hold(self, module, target):
        self.holds.publish(module=module, target=[target, 0, 0], grip=HandTargets.SOFT, timeout=5)
        self.assertTrue(until(lambda: self.held.message and self.held.message.module == module), "it is not held")

    def record(self, name):
        string = self.structure.message.string_first[0]
        self.hold(string + 20, 0.002)  # is held when the take begins
        answer = self.take(TakeRequest.RECORD, name)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: self.takes.message.recorded > 0.1), "nothing is recorded")
        self.hold(string + 20, -0.001)
        self.hold(string + 40, 0.003)
        time.sleep(0.2)
        self.holds.publish(module=-1, release=True)
        for note in (60, 48, 62):
            self.notes.publish(note=note, velocity=100)
            time.sleep(0.3)
            self.notes.publish(note=note, velocity=0)
        parameter = rospy.ServiceProxy("/station/set_parameter", SetParameter)
        self.assertTrue(parameter(name="brightness", value=5e-3).success)
        time.sleep(0.5)
        answer = self.take(TakeRequest.FINISH)
        self.assertTrue(answer.success, answer.message)
        return answer.path

    def preset(self, action, name="", seconds=0.0):
        return rospy.ServiceProxy("/station/preset", Preset)(action=action, name=name, seconds=seconds)

    def values(self):
        return dict(zip(self.parameters.message.names, self.parameters.message.values))

    def swing(self):
        first, count = self.structure.message.string_first[0], self.structure.message.string_count[0]
        return max(map(abs, self.state.message.displacement[first:first + count]))

    def test_1_a_take_is_replayed_through_the_ports_bit_for_bit(self):
        path = self.record("first")
        self.assertEqual(path, os.path.join(self.takes_folder, "first.bag"))
        self.assertTrue(until(lambda: list(self.takes.message.names) == ["first"]), self.takes.message.names)
        rendered = os.path.join(self.folder.name, "rendered.wav")
        subprocess.run([os.path.join(TOOLS, "render"), "--gesture", path, "--out", rendered],
                       check=True, timeout=60, capture_output=True)
        # A new one has not been touched, so that it is silent.
        self.assertTrue(rospy.ServiceProxy("/station/load_model", LoadModel)(model=MODEL).success)
        captured = os.path.join(self.folder.name, "captured.wav")
        capture = self.start(os.path.join(TOOLS, "capture"), "--seconds", "8", "--port", "ergotic:out_1", "--port",
                             "ergotic:out_2", captured, stdout=subprocess.DEVNULL)
        time.sleep(1.0)
        answer = self.take(TakeRequest.REPLAY)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: self.takes.message.replaying == "first" and self.takes.message.replayed > 0))
        self.assertTrue(until(lambda: self.swing() > 1e-4), "the picture is not that of the take")
        self.assertFalse(self.take(TakeRequest.REPLAY).success, "one is played already")
        self.assertTrue(until(lambda: self.takes.message.replaying == "", 20), "it does not end")
        self.assertTrue(until(lambda: self.swing() < 1e-6), "the picture is still that of the take")
        self.assertTrue(until(lambda: capture.poll() is not None, 20))
        wanted, heard = samples(rendered)[:, FADE:], samples(captured)
        loud = int(numpy.argmax(numpy.abs(wanted[0])))
        self.assertGreater(abs(wanted[0][loud]), 1e-3, "the take is silent")
        places = [at - loud for at in numpy.flatnonzero(heard[0] == wanted[0][loud])
                  if 0 <= at - loud <= heard.shape[1] - wanted.shape[1]]
        worst = min((int(numpy.count_nonzero(heard[:, at:at + wanted.shape[1]] != wanted)) for at in places),
                    default=-1)
        print(f"{wanted.shape[1]} frames, {worst} samples differ")
        self.assertEqual(worst, 0)

    def test_1a_presets_are_kept_recalled_undone_and_saved(self):
        self.assertTrue(rospy.ServiceProxy("/station/load_model", LoadModel)(model=MODEL).success)
        first = {"loss": 1.5e-5, "brightness": 1e-3, "volume": 0.15}
        self.assertTrue(until(lambda: self.values() == first), self.values())
        self.assertFalse(self.presets.message.can_undo)
        self.assertIn("no change", self.preset(PresetRequest.UNDO).message)
        answer = self.preset(PresetRequest.KEEP, "dry")
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.path, os.path.join(os.environ["ROS_HOME"], "ergotic/presets/string.yaml"))
        self.assertTrue(until(lambda: (self.presets.message.scene, self.presets.message.names) == ("string", ["dry"])))
        parameter = rospy.ServiceProxy("/station/set_parameter", SetParameter)
        third = 1 / 3
        self.assertTrue(parameter(name="volume", value=third).success)
        self.assertTrue(parameter(name="brightness", value=9e-3).success)
        time.sleep(1.1)  # what follows is another change
        answer = self.preset(PresetRequest.RECALL, "dry", 0.5)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: 0.16 < self.values()["volume"] < 0.3, 2), "it does not go there evenly")
        self.assertTrue(until(lambda: self.values() == first, 2), self.values())
        self.assertTrue(self.preset(PresetRequest.UNDO).success)
        self.assertTrue(until(lambda: self.values() == {"loss": 1.5e-5, "brightness": 9e-3, "volume": third}, 2))
        self.assertTrue(until(lambda: self.presets.message.can_undo))
        self.assertTrue(self.preset(PresetRequest.UNDO).success)
        self.assertTrue(until(lambda: self.values() == first and not self.presets.message.can_undo, 2), self.values())
        topic = rospy.Publisher("/station/parameters", ParameterValue, queue_size=1, latch=True)
        topic.publish(name="loss", value=7e-5)
        self.assertTrue(until(lambda: self.presets.message.can_undo and self.values()["loss"] == 7e-5, 5))
        answer = self.preset(PresetRequest.SAVE, "worn")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(self.preset(PresetRequest.RECALL, "dry").success)
        load = rospy.ServiceProxy("/station/load_model", LoadModel)
        self.assertTrue(load(model=answer.path + "#worn").success)
        self.assertTrue(until(lambda: self.values()["loss"] == 7e-5, 5), self.values())
        self.assertTrue(until(lambda: self.presets.message.scene == "worn" and not self.presets.message.can_undo))

    def test_4_a_take_goes_on_to_another_model(self):
        load = rospy.ServiceProxy("/station/load_model", LoadModel)
        other = os.path.join(ROOT, "models/marimba12.yaml")
        self.assertTrue(load(model=MODEL).success)
        self.assertTrue(self.take(TakeRequest.RECORD, "two_models").success)
        time.sleep(0.3)
        self.assertTrue(load(model=other).success)
        self.assertTrue(until(lambda: "Marimba" in self.structure.message.name))
        time.sleep(0.5)
        self.assertTrue(self.take(TakeRequest.FINISH).success)
        self.assertTrue(load(model=MODEL).success)
        self.assertTrue(until(lambda: "Marimba" not in self.structure.message.name))
        markers = rospy.Subscriber("/station/markers", rospy.AnyMsg, lambda _: None)  # which are drawn for who looks
        answer = self.take(TakeRequest.REPLAY, "two_models")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: "Marimba" in self.structure.message.name, 20), "its second model is not shown")
        self.assertTrue(until(lambda: "Marimba" not in self.structure.message.name, 20), "nor the one that plays")
        markers.unregister()

    def test_1b_what_of_a_preset_cannot_be_had_is_said(self):
        self.assertTrue(rospy.ServiceProxy("/station/load_model", LoadModel)(model=MODEL).success)
        with open(os.path.join(os.environ["ROS_HOME"], "ergotic/presets/string.yaml"), "a", encoding="utf-8") as file:
            file.write("odd: {loss: 2e-5, volume: 7, width: 1}\n")
        answer = self.preset(PresetRequest.RECALL, "odd")
        self.assertTrue(answer.success, answer.message)
        self.assertIn("left out: 'volume' is 7, allowed: 0...0.4; the scene has no parameter 'width'", answer.message)
        self.assertTrue(until(lambda: (self.values()["loss"], self.values()["volume"]) == (2e-5, 0.15), 5))
        for action, name, seconds, refusal in (
                (PresetRequest.RECALL, "dry", 61, "allowed: 0...60 s"), (PresetRequest.RECALL, "dry", -1, "0...60 s"),
                (PresetRequest.RECALL, "dry", float("nan"), "0...60 s"), (9, "dry", 0, "allowed: 0...4"),
                (PresetRequest.RECALL, "wet", 0, "no preset 'wet'; known: dry, odd"),
                (PresetRequest.KEEP, "../x", 0, "cannot be named"), (PresetRequest.FORGET, "wet", 0, "no preset 'wet'")):
            answer = self.preset(action, name, seconds)
            self.assertFalse(answer.success)
            self.assertIn(refusal, answer.message)
        self.assertTrue(self.preset(PresetRequest.FORGET, "odd").success)
        self.assertTrue(until(lambda: self.presets.message.names == ["dry"]))

    def test_2_what_cannot_be_done_is_said_and_nothing_is_lost(self):
        for name in ("../first", "a b", ".x", "n" * 65):
            answer = self.take(TakeRequest.RECORD, name)
            self.assertFalse(answer.success)
            self.assertIn("allowed: 1...64 letters", answer.message)
        before = os.path.getsize(os.path.join(self.takes_folder, "first.bag"))
        self.assertIn("is there already", self.take(TakeRequest.RECORD, "first").message)
        self.assertEqual(os.path.getsize(os.path.join(self.takes_folder, "first.bag")), before)
        left = os.path.join(self.takes_folder, "left.bag.active")
        with open(left, "w", encoding="utf-8") as file:
            file.write("of a station that was killed")
        self.assertIn("rosbag reindex", self.take(TakeRequest.RECORD, "left").message)
        self.assertGreater(os.path.getsize(left), 0)
        self.assertIn("no take is recorded", self.take(TakeRequest.FINISH).message)
        self.assertIn("no take is played", self.take(TakeRequest.HALT).message)
        self.assertIn("action is 9", self.take(9).message)
        with open(os.path.join(self.takes_folder, "broken.bag"), "w", encoding="utf-8") as file:
            file.write("no bag")
        answer = self.take(TakeRequest.REPLAY, "broken")
        self.assertFalse(answer.success)
        self.assertIn("broken.bag: ", answer.message)
        self.assertIn("missing.bag", self.take(TakeRequest.REPLAY, "missing").message)

    def test_3_a_halted_take_fades_and_the_next_one_can_be_played(self):
        for _ in range(2):
            self.assertTrue(self.take(TakeRequest.REPLAY, "first").success)
            time.sleep(0.5)
            self.assertTrue(self.take(TakeRequest.HALT).success)
            self.assertTrue(until(lambda: self.takes.message.replaying == "", 2))

    def test_3a_takes_are_listed_renamed_starred_and_thrown_away(self):
        def told():
            takes = self.takes.message
            return dict(zip(takes.names, zip(takes.starred, takes.lengths, takes.instruments, takes.dates)))
        self.assertTrue(until(lambda: told()["first"][1] > 1.5, 5), told())
        self.assertEqual(told()["first"][2], "plucked and struck string")
        self.assertLess(abs(told()["first"][3].to_sec() - time.time()), 300)
        for action, name, new_name, refusal in (
                (TakeRequest.RENAME, "first", "a b", "cannot be named"), (TakeRequest.RENAME, "none", "x", "no such take"),
                (TakeRequest.RENAME, "first", "broken", "is there already"), (TakeRequest.DELETE, "", "", "cannot be named")):
            answer = self.take(action, name, new_name)
            self.assertFalse(answer.success)
            self.assertIn(refusal, answer.message)
        self.assertTrue(self.take(TakeRequest.STAR, "first").success)
        answer = self.take(TakeRequest.RENAME, "first", "solo")
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.path, os.path.join(self.takes_folder, "solo+.bag"))
        self.assertTrue(until(lambda: "solo" in told() and told()["solo"][0] and told()["solo"][1] > 1.5, 5), told())
        self.assertTrue(self.take(TakeRequest.REPLAY, "solo").success)
        self.assertIn("halt it first", self.take(TakeRequest.DELETE, "solo").message)
        self.assertTrue(self.take(TakeRequest.HALT).success)
        self.assertTrue(until(lambda: self.takes.message.replaying == "", 2))
        answer = self.take(TakeRequest.DELETE, "broken")
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.path, os.path.join(self.takes_folder, "trash/broken.bag"))
        self.assertTrue(os.path.exists(answer.path))
        self.assertTrue(until(lambda: self.takes.message.names == ["solo"]), self.takes.message.names)

    def test_4_a_take_without_a_name_has_that_of_its_instrument(self):
        answer = self.take(TakeRequest.RECORD)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: self.takes.message.recording))
        self.assertRegex(self.takes.message.recording, r"^\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d_plucked_and_struck_string$")
        self.assertTrue(until(lambda: self.takes.message.recorded > 0.2))
        self.station.terminate()
        self.station.wait()
        self.assertTrue(os.path.exists(answer.path), "a station that ends finishes its take")


if __name__ == "__main__":
    rospy.init_node("takes")
    rostest.rosrun("ergotic", "takes", TakesTest)
