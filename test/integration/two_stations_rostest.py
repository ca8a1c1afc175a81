#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two stations of station.launch on one ROS master: nothing of one is the other's."""
import glob
import io
import os
import signal
import struct
import subprocess

import rosbag
import rosgraph
import rosnode
import rospy
import rostest
from geometry_msgs.msg import TransformStamped

from desk import ROOT, DeskTest, Newest, until
from ergotic.msg import Handles, ModelStructure, Parameters, Status
from ergotic.srv import LoadModel, SetParameter

USUAL, SECOND = "station", "second_station"  # whose name ends as the first's
MODELS = {USUAL: "string", SECOND: "marimba12"}
NAMES = {"string": "plucked and struck string", "marimba12": "Marimba of twelve bars"}  # of the scenes
RECORDED = {"gesture", "keyframe", "events", "status"}


def transforms_of(raw):
    """TransformStamped of a tf2_msgs/TFMessage that came as bytes: an array of them."""
    data = raw._buff
    (count,), at = struct.unpack_from("<I", data), 4
    for _ in range(count):
        transform = TransformStamped()
        transform.deserialize(data[at:])
        again = io.BytesIO()
        transform.serialize(again)
        at += len(again.getvalue())
        yield transform


class Frames:
    """(parent, child) of what comes on a topic of tf."""

    def __init__(self, topic):
        self.seen = set()
        rospy.Subscriber(topic, rospy.AnyMsg, self.hear)

    def hear(self, raw):
        self.seen |= {(each.header.frame_id, each.child_frame_id) for each in transforms_of(raw)}


def words(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=20).stdout.split()


class TwoStationsTest(DeskTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        os.environ["ROS_HOME"] = os.path.join(cls.folder.name, "ros home")
        cls.start_screen()
        cls.start_jack()
        cls.moving, cls.fixed = Frames("/tf"), Frames("/tf_static")
        cls.status, cls.structure, cls.parameters, cls.handles, cls.launched = {}, {}, {}, {}, {}
        for name, model in MODELS.items():
            cls.status[name] = Newest(f"/{name}/status", Status)
            cls.structure[name] = Newest(f"/{name}/model_structure", ModelStructure)
            cls.parameters[name] = Newest(f"/{name}/model_parameters", Parameters)
            cls.handles[name] = Newest(f"/{name}/handles", Handles)
            cls.launched[name] = cls.start(
                "roslaunch", "ergotic", "station.launch", f"name:={name}", f"model:={ROOT}/models/{model}.yaml",
                "autoengage:=true", f"record:={cls.folder.name}/take_of_{name}", "gamepads:=false")
        for name in MODELS:
            assert until(lambda: cls.state(name) == Status.PLAYING and cls.status[name].message.audio_running, 60), \
                f"{name}: no force, or no sound"

    @classmethod
    def state(cls, name):
        return cls.status[name].message.state if cls.status[name].message else None

    def test_1_each_has_names_of_its_own(self):
        self.assertTrue({"/station", "/second_station", "/rviz", "/rviz_second_station", "/record",
                         "/record_second_station"} <= set(rosnode.get_node_names()), rosnode.get_node_names())
        published, _, services = rosgraph.Master("/two").getSystemState()
        for offered in (published, services):
            own = {name: {topic[len(name) + 1:] for topic, nodes in offered
                          if topic.startswith(f"/{name}/") and nodes == [f"/{name}"]} for name in MODELS}
            self.assertGreater(len(own[USUAL]), 12)
            self.assertEqual(own[USUAL], own[SECOND])
        for name, model in MODELS.items():
            self.assertEqual(self.status[name].message.model, NAMES[model])
        ports = words("jack_lsp")
        for client in ("ergotic", "ergotic_second_station"):
            self.assertTrue({f"{client}:out_1", f"{client}:out_2", f"{client}:midi_in"} <= set(ports), ports)
        self.assertIn("tgr_slice_11", rospy.get_param("/robot_description"))
        self.assertIn("tgr_slice_11", rospy.get_param("/robot_description_second_station"))

    def test_2_each_has_frames_of_its_own(self):
        fixed = {("tgr_base", "model"), ("second_station/tgr_base", "second_station/model")}
        self.assertTrue(until(lambda: self.fixed.seen == fixed), self.fixed.seen)
        slices = [f"tgr_slice_{i}" for i in range(12)]
        moving = ({("tgr_base", child) for child in slices} |
                  {("second_station/tgr_base", f"second_station/{child}") for child in slices})
        self.assertTrue(until(lambda: self.moving.seen == moving), self.moving.seen)
        for name, frame in ((USUAL, "model"), (SECOND, "second_station/model")):
            self.assertEqual(self.structure[name].message.header.frame_id, frame)
            self.assertEqual(self.handles[name].message.header.frame_id, frame)

    def test_3_each_window_shows_its_own(self):
        def looks_at(window, name):
            _, heard, _ = rosgraph.Master("/two").getSystemState()
            return {topic for topic, nodes in heard if window in nodes and topic.startswith(f"/{name}/")}
        for window, own, other in (("/rviz", USUAL, SECOND), ("/rviz_second_station", SECOND, USUAL)):
            wanted = {f"/{own}/{topic}" for topic in ("status", "model_state", "handles", "end_effector_shapes")}
            self.assertTrue(until(lambda: wanted <= looks_at(window, own), 60), looks_at(window, own))
            self.assertEqual(looks_at(window, other), set())

    def test_4_what_is_asked_of_one_leaves_the_other_alone(self):
        before = self.parameters[USUAL].message.values
        asked = rospy.ServiceProxy("/second_station/set_parameter", SetParameter)
        name = self.parameters[SECOND].message.names[0]
        value = self.parameters[SECOND].message.highs[0]
        self.assertTrue(asked(name=name, value=value).success)
        self.assertTrue(until(lambda: self.parameters[SECOND].message.values[0] == value))
        load = rospy.ServiceProxy("/second_station/load_model", LoadModel)
        answer = load(model=f"{ROOT}/models/string.yaml")
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(until(lambda: self.status[SECOND].message.model == NAMES["string"]))
        self.assertEqual(self.parameters[USUAL].message.values, before)
        answer = load(model=f"{ROOT}/models/marimba12.yaml")
        self.assertTrue(until(lambda: self.status[SECOND].message.model == NAMES["marimba12"]), answer.message)
        self.assertEqual(self.status[USUAL].message.model, NAMES["string"])
        self.assertEqual(self.state(USUAL), Status.PLAYING)

    def test_5_each_recording_is_of_its_own(self):
        for launched in self.launched.values():
            launched.send_signal(signal.SIGINT)
        for name, launched in self.launched.items():
            self.assertTrue(until(lambda: launched.poll() is not None, 40), name)
            bags = glob.glob(f"{self.folder.name}/take_of_{name}_*.bag")
            self.assertEqual(len(bags), 1, os.listdir(self.folder.name))
            with rosbag.Bag(bags[0]) as bag:
                self.assertEqual(set(bag.get_type_and_topic_info().topics), {f"/{name}/{topic}" for topic in RECORDED})
                scenes = {message.scene_name for _, message, _ in bag.read_messages(f"/{name}/keyframe")}
            self.assertIn(f"{ROOT}/models/{MODELS[name]}.yaml", scenes)


if __name__ == "__main__":
    rospy.init_node("two")
    rostest.rosrun("ergotic", "two_stations", TwoStationsTest)
