#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every line that README.md and docs/ros.md show for a shell, typed into one beside a station."""
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import roslaunch
import rospy
import rostest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "scripts"))
import front_door  # noqa: E402


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


def shown(document):
    """Command lines of a document, without what follows `#`; some go over several lines."""
    lines = []
    for language, block in re.findall(r"^```([^\n]*)\n(.*?)^```$", text_of(document), re.DOTALL | re.MULTILINE):
        if language not in ("", "sh"):
            continue
        block = re.sub(r" +# .*", "", block).replace("\\\n", "")
        starts = r"^(?=roslaunch |rosservice |rostopic |rosrun |rosbag |scripts/station)"
        lines += [line.strip() for line in re.split(starts, block, flags=re.MULTILINE)
                  if re.match(starts, line)]
    return lines


def tried(line):
    """What is run in place of a line: no second station, no window, no recording without end."""
    if line.startswith("scripts/station --"):
        return os.path.join(ROOT, line)
    if line.startswith("scripts/station"):
        return line.replace("scripts/station", f"meant=$({ROOT}/scripts/front_door.py arguments", 1) + (
            ') && eval "$meant" && roslaunch --nodes ergotic station.launch "${arguments[@]}"')
    if line.startswith("roslaunch ergotic "):
        return line.replace("roslaunch", "roslaunch --nodes", 1)
    if line == "rosbag record -a -O performance.bag":
        return ("set -m; " + line + " & until ls *.active; do sleep 0.1; done; sleep 2; kill -INT %1; wait; "
                "while ls *.active; do sleep 0.1; done")
    return line


def loaded(*arguments):
    """What roslaunch reads from the launch file."""
    path = os.path.join(ROOT, "launch", "station.launch")
    return roslaunch.config.load_config_default([(path, list(arguments))], None, assign_machines=False)


class TypedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/station/engage", 60)
        rospy.wait_for_message("/station/model_state", rospy.AnyMsg, 60)

    def setUp(self):
        """A folder like a user's: a clone, with a scene and a song of one's own."""
        self.folder = tempfile.TemporaryDirectory()
        for name in ("models", "config"):
            os.symlink(os.path.join(ROOT, name), os.path.join(self.folder.name, name))
        with open(os.path.join(self.folder.name, "my_scene.yaml"), "w", encoding="utf-8") as file:
            file.write(re.search(r"```yaml\n(.*?)```", text_of("docs/scene.md"), re.DOTALL).group(1))
        note = bytes([0, 0x90, 60, 100, 96, 0x80, 60, 0, 0, 0xff, 0x2f, 0])  # a C of one quarter
        with open(os.path.join(self.folder.name, "song.mid"), "wb") as file:
            file.write(b"MThd" + struct.pack(">IHHH", 6, 0, 1, 96) + b"MTrk" + struct.pack(">I", len(note)) + note)

    def tearDown(self):
        self.folder.cleanup()

    def type_all(self, document):
        """{line: what came of it}; each has to succeed, as far as a shell knows."""
        said = {}
        for line in shown(document):
            if re.match("scripts/station --(demo|tune)", line):
                continue  # the demo runs as a whole before every change, and front_door_long_test.py tunes
            if line.startswith("rosrun ergotic calibrate"):
                continue  # device_rostest.py does, at a device that speaks volts
            done = subprocess.run(["bash", "-c", tried(line)], cwd=self.folder.name, timeout=60, text=True,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, check=False)
            self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}")
            said[line] = done.stdout
        return said

    def test_lines_of_the_readme_do_what_they_say(self):
        said = self.type_all("README.md")
        for line, answer in said.items():
            if line.startswith("rosservice"):
                self.assertIn("success: True", answer, line)
        self.assertGreaterEqual(len(said), 12)

    @unittest.skipIf("--without-docs" in sys.argv, "takes long")
    def test_lines_of_the_docs_are_understood(self):
        self.assertGreaterEqual(len(self.type_all("docs/ros.md")), 12)

    def test_misspelt_arguments_are_answered_with_what_to_write(self):
        said = subprocess.run([os.path.join(ROOT, "scripts/station"), "force_limt:=5"], timeout=60, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertNotEqual(said.returncode, 0)
        self.assertIn("did you mean force_limit?", said.stdout)

    def test_paths_come_to_the_nodes_as_they_were_typed(self):
        names = {"model": "a 'b' \"c\".yaml", "device": "$d & e.yaml", "gesture": "f;g*.csv", "end_effectors": " h .yaml"}
        for name in names.values():
            with open(os.path.join(self.folder.name, name), "w", encoding="utf-8"):
                pass
        given, _ = front_door.arguments_of([f"{name}:={path}" for name, path in names.items()] + ["record:=it's a take"],
                                           self.folder.name, {}, {}, front_door.known_arguments())
        config = loaded(*(f"{name}:={value}" for name, value in given.items()))
        for name, path in names.items():
            self.assertEqual(config.params[f"/station/{name}"].value, os.path.join(self.folder.name, path))
        record = next(node for node in config.nodes if node.name == "record")
        self.assertEqual(shlex.split(record.args)[-1], os.path.join(self.folder.name, "it's a take"))

    def test_arguments_of_the_launch_file_are_its_own(self):
        known = {argument.get("name") for name in ("station.launch", "show_bag.launch")
                 for argument in self.launch(name).iter("arg")}
        used = {name for document in ("README.md", "docs/ros.md", "docs/safety.md", "docs/tgr.md")
                for name in re.findall(r"(?<![\w:])([a-z_]+):=", text_of(document))}
        self.assertEqual(used - known, set())

    def test_parameters_win_over_the_arguments_of_the_launch_file(self):
        names = {param.get("name") for node in self.launch().iter("node") if node.get("name") == "$(arg name)"
                 for param in node.iter("param")}
        self.assertGreaterEqual(len(names), 25)
        given = ", ".join(f"{name}: of_the_map" for name in sorted(names))
        config = loaded("force_limit:=3", f"parameters:={{{given}}}")
        told = {name: config.params["/station/" + name].value for name in names}
        self.assertEqual(told, dict.fromkeys(names, "of_the_map"))

    def test_no_parameter_outlives_the_launch_that_set_it(self):
        self.assertIn("/station/", loaded().clear_params)

    @staticmethod
    def launch(name="station.launch"):
        return xml.etree.ElementTree.fromstring(text_of("launch", name))


if __name__ == "__main__":
    rospy.init_node("typed")
    rostest.rosrun("ergotic", "typed", TypedTest)
