#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What of rviz/station.rviz follows the name of a station."""
import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import yaml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("window", str(ROOT / "scripts/window"))
window = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
loader.exec_module(window)

SHIPPED = ROOT / "rviz/station.rviz"


def names_in(node):
    """All texts of a configuration."""
    if isinstance(node, dict):
        return [name for value in node.values() for name in names_in(value)]
    if isinstance(node, list):
        return [name for value in node for name in names_in(value)]
    return [node] if isinstance(node, str) else []


class WindowTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.home = folder.name

    def configuration(self, *words, **environment):
        found = mock.Mock(get_path=lambda _: str(ROOT))
        with mock.patch.object(window.rospkg, "RosPack", return_value=found), \
                mock.patch.dict(os.environ, {"ROS_HOME": self.home, **environment}):
            return window.configuration(*words)

    def test_the_usual_station_has_the_shipped_file(self):
        self.assertEqual(self.configuration("station", "", "robot_description"), SHIPPED)

    def test_one_of_another_name_has_a_copy_that_follows_it(self):
        path = self.configuration("left", "left", "robot_description_left")
        self.assertEqual(str(path), f"{self.home}/ergotic/windows/left.rviz")
        before = names_in(yaml.safe_load(SHIPPED.read_text(encoding="utf-8")))
        after = names_in(yaml.safe_load(path.read_text(encoding="utf-8")))
        changed = [(old, new) for old, new in zip(before, after) if old != new]
        self.assertEqual(len(before), len(after))
        self.assertEqual(set(changed), {("/station", "/left"), ("tgr_base", "left/tgr_base"), ("", "left"),
                                        ("/station/end_effector_shapes", "/left/end_effector_shapes"),
                                        ("robot_description", "robot_description_left")})
        self.assertFalse([name for name in after if "/station" in name or name == "tgr_base"])

    def test_a_namespace_stands_before_the_name(self):
        path = self.configuration("station", "", "robot_description", ROS_NAMESPACE="/hall")
        text = path.read_text(encoding="utf-8")
        self.assertIn("Station: /hall/station\n", text)
        self.assertIn("Fixed Frame: tgr_base\n", text)

    def test_roslaunch_adds_its_own_arguments(self):
        with mock.patch.object(os, "execvp") as runs, mock.patch.object(window, "configuration") as configuration:
            configuration.return_value = "x.rviz"
            window.main(["left", "", "__name:=rviz_left", "__log:=f"])
        configuration.assert_called_once_with("left", "", "robot_description")
        runs.assert_called_once_with("rviz", ["rviz", "-d", "x.rviz", "__name:=rviz_left", "__log:=f"])
        with self.assertRaises(SystemExit):
            window.main([])


if __name__ == "__main__":
    unittest.main()
