#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/station as a musician starts it, without a display: it plays, tunes its sound, and leaves nothing.
usage: front_door_long_test.py SETUP_FILE"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPACE = sys.argv.pop()
PATIENCE_S = 60.0


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class FrontDoorTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(suffix=" it's mine")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.mark = f"ergotic_front_door_{os.getpid()}"
        self.setting = self.folder / "config/ergotic/sound.yaml"
        self.environment = {
            **os.environ, "ERGOTIC_SPACE": SPACE, "XDG_CONFIG_HOME": str(self.folder / "config"),
            "ROS_HOME": str(self.folder / "ros"), "ROS_LOG_DIR": str(self.folder / "ros/log"),
            "ROS_MASTER_URI": f"http://localhost:{free_port()}", "JACK_DEFAULT_SERVER": self.mark, "MARK": self.mark}
        for name in ("DISPLAY", "ROS_IP", "ROS_HOSTNAME"):
            self.environment.pop(name, None)

    def start(self, *words):
        station = subprocess.Popen([ROOT / "scripts/station", *words], cwd=self.folder, env=self.environment, text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        self.addCleanup(station.stdout.close)
        self.addCleanup(self.end, station)
        return station

    def read_until(self, station, text):
        """What it says, up to a line with this text; it is ended when that does not come."""
        said = ""
        patience = threading.Timer(PATIENCE_S, os.killpg, (station.pid, signal.SIGINT))
        patience.start()
        try:
            for line in station.stdout:
                said += line
                if text in line:
                    return said
        finally:
            patience.cancel()
        self.fail(f"{text!r} was not said:\n{said}")

    def end(self, station):
        """As Ctrl-C does; nothing is left then."""
        if station.poll() is None:
            os.killpg(station.pid, signal.SIGINT)
        station.wait(PATIENCE_S)
        self.assertEqual(self.left(), [])

    def left(self):
        """Command lines of what still runs"""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if f"MARK={self.mark}".encode() in (process / "environ").read_bytes().split(b"\0"):
                    found.append((process / "cmdline").read_text().replace("\0", " "))
            except OSError:
                continue  # it has ended
        return found

    def wait_for(self, pattern):
        end = time.monotonic() + PATIENCE_S
        while not list(self.folder.glob(pattern)):
            self.assertLess(time.monotonic(), end, f"no {pattern}")
            time.sleep(0.1)

    def test_plays_a_scene_beside_the_player_and_records_it(self):
        shutil.copy(ROOT / "models/string.yaml", self.folder / "my string.yaml")
        station = self.start("my string.yaml", "record:=a 'take'")
        said = self.read_until(station, "Instrument plucked and struck string plays.")
        self.assertIn("no sound will be heard", said)
        self.wait_for("a 'take'_*.bag.active")
        self.end(station)
        self.wait_for("a 'take'_*.bag")

    def test_tunes_its_sound(self):
        station = self.start("--tune", "1", "1024:3072")
        said = self.read_until(station, "chosen, with a step of margin: period 1024")
        self.assertEqual(station.wait(PATIENCE_S), 0)
        self.assertEqual(said.count("   clean\n"), 1)
        self.assertIn("period: 1024", self.setting.read_text())
        written = self.setting.stat()
        station = self.start("--tune", "9", "512")
        self.read_until(station, "latency")
        self.end(station)
        self.assertEqual(self.setting.stat(), written)
        self.assertEqual(os.listdir(self.setting.parent), ["sound.yaml"])


if __name__ == "__main__":
    unittest.main()
