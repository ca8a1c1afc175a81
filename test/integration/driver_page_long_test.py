#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/driver.md: the package that it shows, built from its text out of an install space, keeps the contract and plays.
usage: driver_page_long_test.py BUILD_FOLDER"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop())
PORT = 11500 + os.getpid() % 500
KINDS = "xml|cmake|cpp"


def files_of(page):
    """{path: text} of the package: each block that is code belongs to the file that was named last before it."""
    files = {}
    for before, _, text in re.findall(rf"(.*?)^```({KINDS})\n(.*?)^```$", page, re.DOTALL | re.MULTILINE):
        name = re.findall(r"`([\w./]+\.(?:xml|txt|hpp|cpp))`", before)
        name = [each for each in name if not each.startswith(("ergotic/", "support/"))][-1]
        assert name not in files, name
        files[name] = text
    return files


def commands_of(page):
    """Lines for a shell of the last section."""
    last = page.split("\n## ")[-1]
    return [line for block in re.findall(r"^```\n(.*?)^```$", last, re.DOTALL | re.MULTILINE) for line in block.splitlines()]


class DriverPageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.page = (ROOT / "docs/driver.md").read_text(encoding="utf-8")
        cls.install()
        for name, text in files_of(cls.page).items():
            path = cls.folder / "my_device" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")

    @classmethod
    def install(cls):
        """Ergotic, in $HOME/ergotic."""
        cache = (BUILD / "CMakeCache.txt").read_text(encoding="utf-8")
        prefix = re.search(r"^CMAKE_INSTALL_PREFIX:PATH=(.*)$", cache, re.MULTILINE)[1]
        subprocess.run(["cmake", "--install", BUILD], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "DESTDIR": str(cls.folder / "installed")})
        os.rename(f"{cls.folder}/installed{prefix}", cls.folder / "ergotic")
        cls.environment = {name: value for name, value in os.environ.items()
                           if name not in ("ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH")}
        cls.environment.update(HOME=str(cls.folder), ROS_HOME=str(cls.folder / "ros"), ROS_IP="127.0.0.1",
                               ROS_MASTER_URI=f"http://127.0.0.1:{PORT}", PATH="/usr/bin:/bin")

    def start(self, line):
        process = subprocess.Popen(["bash", "-c", line], cwd=self.folder, env=self.environment, text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        self.addCleanup(process.stdout.close)
        return process

    def type(self, line, seconds=300):
        process = self.start(line)
        said, _ = process.communicate(timeout=seconds)
        self.assertEqual(process.returncode, 0, f"{line}\n{said}")
        return said

    def station(self, line, status):
        """What /station/status says of it once `status` is in it."""
        setup = "source $HOME/ergotic/setup.bash; "
        process = self.start(f"{setup}exec {line} rviz:=false jack:=none jack_wait:=0 gamepads:=false >log 2>&1")
        try:
            end = time.monotonic() + 60
            said = ""
            while status not in said:
                if time.monotonic() > end:
                    self.fail(said + (self.folder / "log").read_text(encoding="utf-8"))
                said = subprocess.run(["bash", "-c", setup + "timeout 10 rostopic echo -n 1 /station/status"], text=True,
                                      cwd=self.folder, env=self.environment, capture_output=True, check=False).stdout
            return said
        finally:
            os.killpg(process.pid, signal.SIGINT)
            process.wait(30)

    def test_the_package_is_built_keeps_the_contract_and_plays(self):
        setup, build, check, install, plays, refused = commands_of(self.page)
        self.type(f"{setup} && {build}")
        self.assertIn("100% tests passed, 0 tests failed out of 1", self.type(f"{setup} && {check}"))
        tests = self.type("$(find build -type f -name contract_test) --gtest_list_tests")
        self.assertGreater(len(tests.splitlines()), 13)
        self.type(f"{setup} && {install}")
        said = self.station(plays, "my_device/sliding")
        self.assertIn("slices: 3\n", said)
        self.assertIn("model: \"plucked and struck string\"", said)
        said = self.station(refused, "allowed: 1...64")
        self.assertIn("parameter driver_settings:1:10: error: slices is 300, allowed: 1...64", said.replace("\\\n    ", ""))


if __name__ == "__main__":
    unittest.main()
