#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Says how a station bore what scripts/abuse_station did to it, and whether as it should (exit 0)."""
import argparse
import bisect
import collections
import json
import pathlib
import sys

import numpy as np
import rosbag
from report import sound
from report.verdict import Verdict
from soaking.pauses import overlap_ns

MS = 1_000_000
FORCE_LIMIT_N = 20.0
SLEW_N_S = 5000.0      # the station's own, of default
GONE_N = 0.15          # less is no force
LIMIT_NS = 10 * MS     # from the request of a stop to no force at the device
STANDING_LIMIT_NS = 60 * MS  # the same while a fault lets no tick run: watchdog and guardian
AFTER_FAULT_NS = 100 * MS
EXCUSED = 0.1          # share of stops that pauses of the machine may excuse
GROWTH = 1.1           # of memory, from the second fifth of the time to the last
SLACK_BYTES = 20e6     # beyond
MORE = {"descriptors": 8, "threads": 2}
STOPS = ("stop", "emergency_stop", "emergency_stop topic")
STANDSTILLS = ("stopped", "slow", "unplugged")


def growth_of(before, after):
    """By how much forces became more than they were on their side, N."""
    return np.abs(after) - np.where(before * after > 0.0, np.abs(before), 0.0)


class Forces:
    """What each slice of the device felt: {slice: (times in ns, forces in N)}, every change of it."""

    def __init__(self, path):
        records = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2,
                             dtype=[("time", "i8"), ("slice", "i4"), ("force", "f8")]).ravel()
        self.slices = {index: (of["time"], of["force"]) for index in np.unique(records["slice"])
                       for of in (records[records["slice"] == index],)}

    def peak(self):
        return max((np.abs(forces).max() for _, forces in self.slices.values()), default=0.0)

    def growth(self):
        """The largest step by which a force became more than it was, N."""
        return max((growth_of(forces[:-1], forces[1:]).max(initial=0.0)
                    for _, forces in self.slices.values()), default=0.0)

    def gone_after(self, start_ns, end_ns):
        """From `start_ns` until no slice had force any more, and so till `end_ns`, ns; 0: there was none."""
        latest = start_ns
        for times, forces in self.slices.values():
            first = max(bisect.bisect_right(times, start_ns) - 1, 0)
            last = bisect.bisect_left(times, end_ns)
            felt = np.flatnonzero(np.abs(forces[first:last]) >= GONE_N)
            if felt.size:
                next_change = first + felt[-1] + 1
                latest = max(latest, min(times[next_change], end_ns) if next_change < len(times) else end_ns)
        return latest - start_ns


def judge_stops(verdict, forces, journal, pauses):
    engages = sorted(line["start_ns"] for line in journal if line["what"] == "engage")
    stops = [line for line in journal if line["what"] in STOPS]
    standing = [(line["start_ns"], line["end_ns"] + AFTER_FAULT_NS) for line in journal
                if line["what"] == "inject_fault" and line["kind"] in STANDSTILLS]
    worst, worst_standing, excused, late = 0, 0, 0, []
    for stop in stops:
        start = stop["start_ns"]
        after = bisect.bisect_right(engages, start)
        gone = forces.gone_after(start, engages[after] if after < len(engages) else 1 << 62)
        stands = overlap_ns(standing, start, start + LIMIT_NS) > 0
        limit = STANDING_LIMIT_NS if stands else LIMIT_NS
        touching = [pause for pause in pauses if pause[0] < start + limit and pause[1] > start]
        if gone <= limit:
            worst, worst_standing = ((worst, max(worst_standing, gone)) if stands else
                                     (max(worst, gone), worst_standing))
        elif gone <= limit + overlap_ns(touching, start, 1 << 62):
            excused += 1
        else:
            late.append(f"{stop['what']} {gone / MS:.1f} ms")
    verdict.check("force is gone within 10 ms of a stop, until the next engage",
                  not late and excused <= EXCUSED * len(stops),
                  f"{len(stops)} stops, at most {worst / MS:.2f} ms, {worst_standing / MS:.1f} ms where a fault let "
                  f"no tick run; {excused} excused by pauses of the machine; late: {', '.join(late) or 'none'}")


def in_runs(blocks):
    """What the station sent, N: arrays [ticks][slices] without a gap, of gesture blocks that may lack some."""
    runs, next_tick = [], None
    for block in blocks:
        sent = np.reshape(block.forces, (block.ticks, block.slices))
        if block.first_tick != next_tick:
            runs.append([])
        runs[-1].append(sent)
        next_tick = block.first_tick + block.ticks
    return [np.concatenate(run) for run in runs]


def judge_force(verdict, forces, runs, tick_rate):
    """`runs`, arrays [ticks][slices]: what the station sent, N, tick by tick."""
    verdict.check("force stays within its limit", forces.peak() <= FORCE_LIMIT_N + 1e-6,
                  f"{forces.peak():.2f} N of {FORCE_LIMIT_N:g} N")
    step = SLEW_N_S / tick_rate
    largest = max(growth_of(sent[:-1], sent[1:]).max(initial=0.0) for sent in runs)
    verdict.check("force grows as slowly as it must", largest <= step + 1e-5,
                  f"by {largest:.4f} N from tick to tick of {sum(map(len, runs))} in {len(runs)} runs, {step:.4f} N are allowed")
    # A device that comes late meets several ticks at once.
    print(f"      the device met a growth of {forces.growth():.2f} N at once at most")


def judge_process(verdict, looks):
    gone = [look["gone_ns"] for look in looks if "gone_ns" in look]
    looks = [look for look in looks if "gone_ns" not in look]
    verdict.check("the station lives to the end", not gone, f"{len(looks)} looks, "
                  + (f"gone {(gone[0] - looks[0]['time_ns']) * 1e-9:.0f} s after the first" if gone else "none without it"))
    fifth = max(len(looks) // 5, 1)
    early, late = looks[fifth:2 * fifth], looks[-fifth:]
    peak = lambda part, key: max(look[key] for look in part)
    before, after = peak(early, "memory"), peak(late, "memory")
    verdict.check("memory does not grow", after <= GROWTH * before + SLACK_BYTES,
                  f"{before / 1e6:.0f} MB early, {after / 1e6:.0f} MB late, at most {peak(looks, 'memory') / 1e6:.0f} MB")
    for key, more in MORE.items():
        verdict.check(f"{key} do not grow", peak(late, key) <= peak(early, key) + more,
                      f"{peak(early, key)} early, {peak(late, key)} late, at most {peak(looks, key)}")
    seconds = (looks[-1]["time_ns"] - looks[0]["time_ns"]) * 1e-9
    print(f"      processor: {100 * (looks[-1]['cpu_s'] - looks[0]['cpu_s']) / seconds:.0f} % of one")


def judge_sound(verdict, paths):
    step, peak, frames, finite = 0.0, 0.0, 0, True
    for path in paths:
        signal, _ = sound.read_wav(path)
        finite &= bool(np.all(np.isfinite(signal)))
        frames += len(signal)
        step = max(step, np.max(np.abs(np.diff(signal, axis=0)), initial=0.0))
        peak = max(peak, np.max(np.abs(signal), initial=0.0))
    verdict.check("sound is finite", finite and frames > 0, f"{frames} frames in {len(paths)} recordings")
    print(f"      sound: peak {peak:.3f}, largest step from frame to frame {step:.3f}")


def tell_counters(statuses):
    last = statuses[-1]
    print(f"      ticks: {last.ticks}; late: {last.late_wake_up} woken late, {last.late_device} slow device, "
          f"{last.late_compute} long computation, worst {1e3 * last.late_worst:.2f} ms; {last.stalls} stalls, "
          f"{last.catch_up_ticks} caught up, {last.lost_ticks} lost")
    print(f"      load: {100 * last.load_mean:.1f} % at the end, peak {100 * last.load_peak:.0f} % of a tick")
    print(f"      sound: {last.xruns} xruns, {last.underruns} underruns ({last.underrun_frames} frames)")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="journal, looks, pauses, log, bag, sounds")
    options = parser.parse_args()
    read = lambda path: [json.loads(line) for line in path.read_text().splitlines()]
    journal = [line for path in options.folder.glob("journal_*") for line in read(path)]
    looks = read(options.folder / "process")
    pauses = [tuple(map(int, line.split(",")))
              for line in (options.folder / "pauses").read_text().splitlines()]
    forces = Forces(options.folder / "forces.csv")
    with rosbag.Bag(str(options.folder / "soak.bag")) as bag:
        statuses = [message for _, message, _ in bag.read_messages(["/station/status"])]
        runs = in_runs(message for _, message, _ in bag.read_messages(["/station/gesture"]))

    verdict = Verdict()
    counts = collections.Counter(line["what"] for line in journal)
    refused = collections.Counter(line["what"] for line in journal if line.get("success") is False)
    print("      asked for: " + ", ".join(f"{what} {count} ({refused[what]} refused)"
                                          for what, count in sorted(counts.items())))
    lost = [line for line in journal if "error" in line]
    verdict.check("all that was asked for is answered", not lost,
                  f"{len(lost)} without" + (f", first {lost[0]['what']}: {lost[0]['error']}" if lost else ""))
    judge_process(verdict, looks)
    judge_stops(verdict, forces, journal, pauses)
    judge_force(verdict, forces, runs, statuses[-1].gestural_rate)
    judge_sound(verdict, sorted(options.folder.glob("sound_*.wav")))
    tell_counters(statuses)
    print(f"      pauses of the machine: {len(pauses)}, longest "
          f"{max((end - start for start, end in pauses), default=0) / MS:.1f} ms")
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main())
