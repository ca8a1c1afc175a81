# SPDX-License-Identifier: BSD-3-Clause
"""Subscribers that hear everything, understand nothing, and come and go."""
import random
import select
import socket
import time
import xmlrpc.client

import rosgraph
from rosgraph import network

SECONDS_BETWEEN_GUESTS = 2.0


def listen(station, count, end):
    """Keeps so many connections to the topics of a station until `end` (time.monotonic, s)."""
    Crowd(station, count).stay(end)


class Crowd:
    """As many connections as are asked for, to all topics of a station in turn.

    A subscriber of rospy would share one connection with all others of its process, and read what it gets.
    """

    def __init__(self, station, count):
        self.station = station
        self.count = count
        master = rosgraph.Master("/crowd")
        published, _, _ = master.getSystemState()
        self.topics = [name for name, nodes in published if station in nodes]
        self.node = xmlrpc.client.ServerProxy(master.lookupNode(station))
        self.guests = []

    def stay(self, end):
        """Listens until `end` (time.monotonic, s); the one that came first leaves for a new one at times."""
        dice = random.Random(0)
        change = 0.0
        while time.monotonic() < end:
            while len(self.guests) < self.count:
                self.guests.append(self._join(self.topics[len(self.guests) % len(self.topics)]))
            readable, _, _ = select.select(self.guests, [], [], 0.1)
            for guest in readable:
                if not guest.recv(1 << 20):
                    self._leave(guest)
            if time.monotonic() > change:
                self._leave(dice.choice(self.guests))
                change = time.monotonic() + SECONDS_BETWEEN_GUESTS
        for guest in self.guests:
            guest.close()

    def _leave(self, guest):
        if guest in self.guests:
            self.guests.remove(guest)
        guest.close()

    def _join(self, topic):
        _, _, (_, host, port) = self.node.requestTopic("/crowd", topic, [["TCPROS"]])
        guest = socket.create_connection((host, port))
        network.write_ros_handshake_header(
            guest, {"callerid": "/crowd", "topic": topic, "type": "*", "md5sum": "*"})
        return guest
