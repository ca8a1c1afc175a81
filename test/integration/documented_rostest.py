#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/ros.md, against what a station offers to ROS."""
import os
import re
import threading
import unittest

import rosgraph
import rospy
import rosservice
import rostest

DOCS = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "ros.md")
OF_ROSCPP = {"/rosout", "/rosout_agg", "/clock"}


def rows(section):
    """Columns of the first table below a heading, without their marks."""
    with open(DOCS, encoding="utf-8") as docs:
        text = docs.read().split(f"\n## {section}\n")[1]
    table = re.search(r"(?:\|.*\n)+", text).group(0).splitlines()[2:]
    return [[column.strip().strip("`") for column in line.strip("|").split("|")]
            for line in table]


def full(name):
    return name if name.startswith("/") else "/station/" + name


def of_station(entries):
    return {name for name, nodes in entries if "/station" in nodes} - OF_ROSCPP


class DocumentedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/station/engage", 60)
        rospy.wait_for_message("/station/model_state", rospy.AnyMsg, 60)  # all is offered by then
        cls.master = rosgraph.Master("/documented")
        cls.published, cls.subscribed, cls.services = cls.master.getSystemState()
        cls.types = dict(cls.master.getTopicTypes())

    def test_topics_out_are_those_of_the_station_with_their_types(self):
        told = {full(name): kind for name, kind, *_ in rows("Topics out") if "/" in kind}
        self.assertEqual(set(told), of_station(self.published))
        for name, kind in told.items():
            self.assertEqual(kind.split(",")[0], self.types[name], name)

    def test_topics_in_are_those_of_the_station_with_their_types(self):
        told = {full(name): kind for name, kind, _ in rows("Topics in")}
        self.assertEqual(set(told), of_station(self.subscribed))
        for name, kind in told.items():
            if self.types.get(name, "*") != "*":
                self.assertEqual(kind, self.types[name], name)

    def test_services_are_those_of_the_station_with_their_types(self):
        told = {full(name): kind for name, kind, _ in rows("Services")}
        offered = {name for name in of_station(self.services)
                   if name.rsplit("/", 1)[1] not in
                   ("get_loggers", "set_logger_level", "list", "load_nodelet", "unload_nodelet")}
        self.assertEqual(set(told), offered)
        for name, kind in told.items():
            self.assertEqual(kind, rosservice.get_service_type(name), name)

    def test_what_is_told_to_be_latched_is_and_nothing_else(self):
        came = {}
        done = threading.Event()
        expected = {full(name): "latched" in told for name, told, *_ in rows("Topics out")}
        # Nothing happens, nobody holds anything, and no sound.
        quiet = {"/station/events", "/station/holds", "/station/levels", "/station/scope"}

        def hear(name):
            def heard(message):
                came[name] = message._connection_header.get("latching", "0") == "1"
                if set(came) >= set(expected) - quiet:
                    done.set()
            return heard
        subscribers = [rospy.Subscriber(name, rospy.AnyMsg, hear(name)) for name in expected]
        done.wait(30)
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual({name: expected[name] for name in came}, came)
        self.assertGreaterEqual(set(came), set(expected) - quiet)


if __name__ == "__main__":
    rospy.init_node("documented")
    rostest.rosrun("ergotic", "documented", DocumentedTest)
