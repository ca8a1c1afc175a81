#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Waits for a station that starts, and says how it does. Needs a devel or install space.

  watch_station.py greet NAME WINDOW SIMULATED FORCE   prints what a player can do as soon as something plays;
                                                       true or false: there is a window, the device is
                                                       simulated, force comes in by itself
  watch_station.py sound SECONDS                       prints "UNDERRUNS XRUNS LATE_TICKS" of so long
"""
import sys
import time

import rosgraph
import rospy
from ergotic.msg import Status

import front_door

PATIENCE_S = 60.0
SETTLE_S = 1.5  # after the start, which needs the processor for itself


class Station:
    """What the status of a station says, as it comes."""

    def __init__(self, name=front_door.USUAL_NAME):
        while not rosgraph.is_master_online():  # roslaunch starts one, if none runs
            time.sleep(0.2)
        rospy.init_node("watch_station", anonymous=True, disable_signals=True)
        self.status = None
        rospy.Subscriber(f"/{name}/status", Status, self.hear)

    def hear(self, status):
        self.status = status

    def wait(self, holds, patience_s=None):
        """\return the first status of which `holds` is true, or None if there was none in time"""
        end = None if patience_s is None else time.monotonic() + patience_s
        while end is None or time.monotonic() < end:
            status = self.status
            if status and holds(status):
                return status
            time.sleep(0.05)
        return None


def wait_for_window(name):
    end = time.monotonic() + PATIENCE_S
    master = rosgraph.Master("/watch_station")
    while time.monotonic() < end:
        readers = dict(master.getSystemState()[1]).get(f"/{name}/model_state", [])
        if any("rviz" in reader for reader in readers):
            return
        time.sleep(0.3)


def greet(name, *true_or_false):
    window, simulated, force = (word == "true" for word in true_or_false)
    station = Station(name)
    station.wait(lambda status: status.model)
    if window:
        wait_for_window(name)
    print(front_door.greeting(station.status.model, window, simulated, force, name), flush=True)


def lost(status):
    return (status.underruns, status.xruns, status.late_wake_up + status.late_device + status.late_compute)


def count_sound(seconds):
    station = Station()
    if not station.wait(lambda status: status.model and status.audio_running, PATIENCE_S):
        message = station.status.message if station.status else "no station answers"
        raise SystemExit(f"error: there is no sound within {PATIENCE_S:g} s: {message}")
    time.sleep(SETTLE_S)
    before = station.status
    time.sleep(float(seconds))
    now = rospy.get_rostime()
    after = station.wait(lambda status: status.header.stamp >= now, PATIENCE_S)
    if not after:
        raise SystemExit(f"error: the station said nothing for {PATIENCE_S:g} s")
    underruns, xruns, late = (b - a for a, b in zip(lost(before), lost(after)))
    print(underruns, xruns + (not after.audio_running), late)  # a client that JACK gave up has lost all


def main(action="", *rest):
    actions = {"greet": greet, "sound": count_sound}
    if action not in actions:
        raise SystemExit(__doc__)
    actions[action](*rest)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(130)
