#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Who can reach a station, and its force, from another address: nobody unless `allow_remote` is set."""
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

PATIENCE_S = 60.0
# Of the machine: they are no fault of who may call.
ALLOWED_STALLS = ("_max_stall:=1.0", "_max_stalls:=1000000", "_watchdog:=1.0")


class OtherHost:
    """A network of two: this host, and a namespace with interfaces of its own. Needs root."""

    OURS, ITS = "198.18.77.1", "198.18.77.2"  # of those that are for tests (RFC 2544)

    def __init__(self):
        self.name = f"ergotic{os.getpid()}"
        self.here, there = f"er{os.getpid()}", f"et{os.getpid()}"
        self.ip("netns", "add", self.name)
        self.ip("link", "add", self.here, "type", "veth", "peer", "name", there, "netns", self.name)
        self.ip("address", "add", f"{self.OURS}/30", "dev", self.here)
        self.ip("link", "set", self.here, "up")
        self.ip("-n", self.name, "address", "add", f"{self.ITS}/30", "dev", there)
        self.ip("-n", self.name, "link", "set", there, "up")

    @staticmethod
    def ip(*arguments):
        subprocess.run(["ip", *arguments], check=True)

    def reaches(self, port):
        """Whether a connection from there to a port of ours is taken."""
        script = f"import socket; socket.create_connection(('{self.OURS}', {port}), 5.0)"
        return subprocess.run(["ip", "netns", "exec", self.name, sys.executable, "-c", script], check=False,
                              stderr=subprocess.DEVNULL).returncode == 0

    def close(self):
        self.ip("link", "delete", self.here)
        self.ip("netns", "delete", self.name)


def free_port():
    with socket.socket() as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def is_open(address, port):
    try:
        socket.create_connection((address, port), 5.0).close()
        return True
    except ConnectionRefusedError:
        return False


def ports_of(pid):
    """TCP ports on which a process listens."""
    listed = subprocess.run(["ss", "-Hltnp"], check=True, capture_output=True, text=True).stdout
    return {int(line.split()[3].rsplit(":", 1)[1]) for line in listed.splitlines()
            if re.search(rf"\bpid={pid},", line)}


class World:
    """A ROS master that hears `master_ip` ("" for all addresses), here or elsewhere, and a station."""

    def __init__(self, master_ip, *parameters, elsewhere=None):
        self.folder = tempfile.TemporaryDirectory()
        self.port = free_port()
        host = elsewhere.ITS if elsewhere else "localhost"
        self.environment = {**os.environ, "ROS_MASTER_URI": f"http://{host}:{self.port}",
                            "ROS_LOG_DIR": self.folder.name}
        for name in ("ROS_IP", "ROS_HOSTNAME"):
            self.environment.pop(name, None)
        self.started = []
        own = {"ROS_IP": master_ip} if master_ip else {}
        there = ("ip", "netns", "exec", elsewhere.name) if elsewhere else ()
        self.start({**own}, *there, "rosmaster", "--core", "-p", str(self.port))
        self.wait(lambda: is_open(host, self.port), "a master")
        self.station = self.start({"ROS_HOSTNAME": "localhost"}, "rosrun", "nodelet", "nodelet", "standalone",
                                  "ergotic/Station", "__name:=station", "_jack:=none",
                                  f"_model:={os.getcwd()}/models/string.yaml", *ALLOWED_STALLS, *parameters)
        self.wait(lambda: "success" in self.call("stop"), "a station")

    def start(self, environment, *command):
        process = subprocess.Popen(command, env={**self.environment, **environment}, start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.started.append(process)
        return process

    @staticmethod
    def wait(holds, what):
        end = time.monotonic() + PATIENCE_S
        while not holds():
            if time.monotonic() > end:
                raise AssertionError(f"no {what} within {PATIENCE_S:g} s")
            time.sleep(0.2)

    def call(self, service):
        return subprocess.run(["rosservice", "call", f"/station/{service}"], env=self.environment, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout

    def engage(self):
        """As soon as there is a model, which comes after the services."""
        answer = ""
        def said():
            nonlocal answer
            answer = self.call("engage")
            return "no model" not in answer and "nothing plays" not in answer
        self.wait(said, "model")
        return answer

    def ports(self):
        """Of the station's process: XML-RPC, topics and services."""
        with xmlrpc.client.ServerProxy(f"http://localhost:{self.port}") as master:
            uri = master.lookupNode("/remote_test", "/station")[2]
        with xmlrpc.client.ServerProxy(uri) as node:
            return ports_of(node.getPid("/remote_test")[2])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.started):
            os.killpg(process.pid, signal.SIGINT)
        for process in self.started:
            process.wait(30.0)
        self.folder.cleanup()


@unittest.skipUnless(os.geteuid() == 0, "only root may have a network of its own")
class RemoteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.other_host = OtherHost()
        cls.addClassCleanup(cls.other_host.close)

    def reached(self, world):
        """Ports of a station that the other host reaches; here all of them are."""
        ports = world.ports()
        self.assertGreaterEqual(len(ports), 2)
        for port in ports:
            self.assertTrue(is_open("127.0.0.1", port), port)
        return {port for port in ports if self.other_host.reaches(port)}

    def test_a_station_hears_its_own_host_only(self):
        with World("127.0.0.1") as world:
            self.assertFalse(self.other_host.reaches(world.port))
            self.assertEqual(self.reached(world), set())
            self.assertIn("success: True", world.engage())

    def test_a_master_that_others_reach_lets_no_force_out(self):
        with World("") as world:
            self.assertTrue(self.other_host.reaches(world.port))
            self.assertEqual(self.reached(world), set())
            answer = world.engage()
            self.assertIn("success: False", answer)
            self.assertIn("ROS_IP=127.0.0.1", answer)

    def test_a_master_on_another_host_lets_no_force_out(self):
        """Though another one here, which nobody else reaches, has the same port."""
        with World("", elsewhere=self.other_host) as world, \
                socket.create_server(("127.0.0.1", world.port)):
            answer = world.engage()
            self.assertIn("success: False", answer)
            self.assertIn("can be reached from other hosts", answer)

    def test_who_allows_others_is_reached_by_them(self):
        with World("", "_allow_remote:=true") as world:
            self.assertNotEqual(self.reached(world), set())
            self.assertIn("success: True", world.engage())


if __name__ == "__main__":
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    unittest.main(argv=sys.argv)
