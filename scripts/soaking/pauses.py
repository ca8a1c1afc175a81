# SPDX-License-Identifier: BSD-3-Clause
"""Pauses of the machine: noted by a process on each processor, above the priority of the ticks."""
import os
import sys
import time

PRIORITY = 90
PAUSE_S = 1e-3
LEAST_NS = 3_000_000  # what counts as a pause


def outrank(priority):
    """Gives this thread, and those that it starts, a real-time priority."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError:
        print("no real-time priority: load from other programs may be counted as a pause of the machine or as late", file=sys.stderr)


def note(cpu, path, end):
    """Appends `start_ns,end_ns` (CLOCK_MONOTONIC) of each pause of a processor to a file until `end`
    (time.monotonic, s)."""
    os.sched_setaffinity(0, {cpu})
    outrank(PRIORITY)
    with open(path, "a", encoding="utf-8", buffering=1) as file:
        last = time.monotonic_ns()
        while time.monotonic() < end:
            time.sleep(PAUSE_S)
            now = time.monotonic_ns()
            if now - last >= LEAST_NS:
                file.write(f"{last},{now}\n")
            last = now


def overlap_ns(pauses, start_ns, end_ns):
    """For how long any of `pauses` [(start, end)] went on between two times."""
    total, counted_to = 0, start_ns
    for begin, until in sorted(pauses):
        until = min(until, end_ns)
        total += max(until - max(begin, counted_to), 0)
        counted_to = max(counted_to, until)
    return total
