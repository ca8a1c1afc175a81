# SPDX-License-Identifier: BSD-3-Clause
"""What tests need that play a station as a person at a desk does: programs of their own, a display, keys."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import numpy
import rosgraph
import rospy

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))


class Newest:
    """The newest message of a topic."""

    def __init__(self, topic, kind):
        self.message = None
        rospy.Subscriber(topic, kind, self.hear)

    def hear(self, message):
        self.message = message


def until(condition, seconds=10.0):
    """Whether it is true before the time is over."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def end(process):
    """Ends a program and all that it has started."""
    for how in (signal.SIGTERM, signal.SIGKILL):
        if process.poll() is None:
            os.killpg(process.pid, how)
            until(lambda: process.poll() is not None)
    if process.stdout:
        process.stdout.close()


def samples(path):
    """[channels, frames] of 32-bit floats."""
    with open(path, "rb") as file:
        data = file.read()
    channels = int.from_bytes(data[data.index(b"fmt ") + 10:][:2], "little")
    start = data.index(b"data") + 8
    sound = numpy.frombuffer(data[start:start + (len(data) - start) // (4 * channels) * 4 * channels], dtype="<f4")
    return sound.reshape(-1, channels).T


class DeskTest(unittest.TestCase):
    """Programs that it starts end with it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        os.environ.update(XDG_RUNTIME_DIR=cls.folder.name, HOME=cls.folder.name)

    @classmethod
    def start(cls, *command, **options):
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True, **options)
        cls.addClassCleanup(end, process)
        return process

    @classmethod
    def start_screen(cls):
        """A display with a window manager: without one no window gets keys."""
        screen = cls.start("Xvfb", "-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp",
                           stdout=subprocess.PIPE)
        os.environ.update(DISPLAY=":" + screen.stdout.readline().decode().strip(), QT_QPA_PLATFORM="xcb",
                          LIBGL_ALWAYS_SOFTWARE="1")
        cls.start("openbox")

    @classmethod
    def start_rviz(cls):
        return cls.start("rviz", "--display-config", os.path.join(ROOT, "rviz/station.rviz"))

    @classmethod
    def start_jack(cls):
        os.environ["JACK_DEFAULT_SERVER"] = f"desk_{os.getpid()}"
        cls.start("jackd", "--realtime", "--sync", "--name", os.environ["JACK_DEFAULT_SERVER"], "-d", "dummy",
                  "--rate", "44100", "--period", "256", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        assert until(lambda: subprocess.run(["jack_lsp"], capture_output=True, check=False).returncode == 0), \
            "no JACK server"

    @classmethod
    def start_station(cls, **parameters):
        for name, value in parameters.items():
            rospy.set_param(f"/station/{name}", value)
        cls.station = cls.start("/usr/lib/nodelet/nodelet", "standalone", "ergotic/Station", "__name:=station")

    def wait_for_window(self, topic):
        """Until rviz listens to a topic, and its window has the keyboard."""
        def hears():
            _, subscribed, _ = rosgraph.Master("/desk").getSystemState()
            return any(name == topic and any("/rviz" in node for node in nodes) for name, nodes in subscribed)
        self.assertTrue(until(hears, 60), f"rviz does not listen to {topic}")
        found = []

        def activates():
            found[:] = [subprocess.run(
                ["xdotool", "search", "--onlyvisible", "--name", "RViz", "windowactivate", "--sync"], timeout=10,
                capture_output=True, text=True, check=False)]
            return found[0].returncode == 0
        self.assertTrue(until(activates, 30), f"rviz has no window: {found[0].stderr}")
