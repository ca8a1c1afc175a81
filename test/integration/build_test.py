#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/build builds what it is asked for, where it stands, says how far it is and when it failed."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

PROJECT = """
cmake_minimum_required(VERSION 3.20)
project(toy NONE)
option(SPOILT "Make the build fail" OFF)
file(WRITE ${CMAKE_SOURCE_DIR}/devel/lib/made "")
file(WRITE ${CMAKE_SOURCE_DIR}/devel/.catkin ${CMAKE_SOURCE_DIR})
add_custom_target(everything ALL COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/everything)
add_custom_target(play COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/play)
add_custom_target(slow COMMAND sleep 6)
add_custom_target(slower COMMAND sleep 6)
add_dependencies(slower slow)
if(SPOILT)
  add_custom_target(spoilt ALL COMMAND echo this is spoilt COMMAND false)
endif()
"""


class BuildTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.toy = self.folder / "toy"
        (self.toy / "scripts").mkdir(parents=True)
        for script in ("build", "lib.sh"):
            shutil.copy(ROOT / "scripts" / script, self.toy / "scripts")
        (self.toy / "CMakeLists.txt").write_text(PROJECT)

    def build(self, *arguments, place=None):
        run = subprocess.run([(place or self.toy) / "scripts/build", *arguments], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return run.returncode, run.stdout

    def made(self, name, place=None):
        return ((place or self.toy) / "build" / name).exists()

    def test_builds_everything_or_only_a_target(self):
        self.assertEqual(self.build("--target", "play")[0], 0)
        self.assertTrue(self.made("play"))
        self.assertFalse(self.made("everything"))
        self.assertEqual(self.build(), (0, ""))
        self.assertTrue(self.made("everything"))

    def test_says_what_failed(self):
        status, said = self.build(self.toy / "build", "-D", "SPOILT=ON")
        self.assertEqual(status, 1)
        self.assertIn("this is spoilt", said)
        self.assertIn(f"all of it: {self.toy}/build/build.log", said)

    def test_says_how_far_it_is(self):
        status, said = self.build("--target", "slower")
        self.assertEqual(status, 0)
        self.assertRegex(said, r"building: \[ *\d+(/\d+|%)\], 1\d s")

    def test_makes_a_folder_of_another_place_anew(self):
        self.build()
        copy = self.folder / "copy"
        shutil.copytree(self.toy, copy)
        (self.toy / "build/everything").unlink()
        (copy / "build/everything").unlink()
        (copy / "devel/old").touch()
        status, said = self.build(place=copy)
        self.assertEqual(status, 0)
        self.assertIn(f"{copy}/build belongs to {self.toy}/build, or is not whole, and is made anew", said)
        self.assertTrue(self.made("everything", copy))
        self.assertFalse(self.made("everything"))
        self.assertTrue((copy / "devel/lib/made").exists())
        self.assertFalse((copy / "devel/old").exists())
        self.assertEqual(self.build(place=copy), (0, ""))

    def test_leaves_the_folder_of_another_program_alone(self):
        self.build()
        other = self.folder / "other"
        shutil.copytree(self.toy / "scripts", other / "scripts")
        shutil.copy(self.toy / "CMakeLists.txt", other)
        status, said = self.build(self.toy / "build", place=other)
        self.assertEqual(status, 1)
        self.assertIn(f"{self.toy}/build builds what is in {self.toy}: name another folder", said)
        self.assertTrue(self.made("everything"))

    def test_never_removes_what_is_no_build_of_its_own(self):
        status, said = self.build(self.toy)
        self.assertEqual(status, 1)
        self.assertIn("holds the program", said)
        status, said = self.build(self.folder)
        self.assertEqual(status, 1)
        self.assertTrue((self.toy / "CMakeLists.txt").exists())
        other = self.folder / "thesis"
        other.mkdir()
        (other / "text").touch()
        (other / "CMakeCache.txt").write_text("CMAKE_CACHEFILE_DIR:INTERNAL=/nowhere\n"
                                              "CMAKE_PROJECT_NAME:STATIC=thesis\n")
        status, said = self.build(other)
        self.assertEqual(status, 1)
        self.assertIn("builds thesis: name another build folder", said)
        self.assertTrue((other / "text").exists())

    def test_builds_in_the_same_place_through_a_link(self):
        self.build()
        (self.toy / "devel/mine").touch()
        link = self.folder / "link"
        link.symlink_to(self.toy)
        self.assertEqual(self.build(place=link), (0, ""))
        self.assertTrue((self.toy / "devel/mine").exists())

    def test_removes_a_devel_space_of_another_place(self):
        self.build()
        copy = self.folder / "copy"
        shutil.copytree(self.toy, copy)
        shutil.rmtree(copy / "build")
        (copy / "devel/old").touch()
        self.assertEqual(self.build(place=copy)[0], 0)
        self.assertFalse((copy / "devel/old").exists())
        self.assertEqual((copy / "devel/.catkin").read_text(), str(copy))

    def test_recovers_from_a_configuration_that_failed(self):
        (self.toy / "build").mkdir()
        (self.toy / "build/CMakeCache.txt").write_text("")
        self.assertEqual(self.build()[0], 0)
        self.assertTrue(self.made("everything"))

    def test_two_at_once_wait_for_each_other(self):
        two = [subprocess.Popen([self.toy / "scripts/build"], stdout=subprocess.DEVNULL)
               for _ in range(2)]
        self.assertEqual([run.wait() for run in two], [0, 0])
        self.assertTrue(self.made("everything"))


if __name__ == "__main__":
    unittest.main()
