#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Says what a recorded performance was like, and whether it was as it should be (exit 0)."""
import argparse
import json
import os
import sys

import numpy as np
from report import picture, sound
from report.performance import Performance
from report.verdict import Verdict

MOVED_M = 1e-3  # a key this far from where it was at first has been moved by the hand
STILL_M = 2e-4  # a key that moves less than this is at rest
SETTLE_S = 0.3  # after which a string is taken to be free of what touched it
WINDOW_S = 0.1  # in which motion and force are looked at
FREE_S = 0.8  # shortest stretch of a free string that its pitch is measured in
QUIET_S = 1.0  # of silence that has to be heard before the first touch
LOUD_DBFS, QUIET_DBFS = -40.0, -90.0
PITCH_CENTS = 1.0
FORCE_N = 1.0
CORRELATION = 0.5
SHARE_EQUAL = 0.9
PIXELS = 50


def tell_counters(performance):
    first, last = performance.statuses[0], performance.statuses[-1]
    gained = lambda name: getattr(last, name) - getattr(first, name)
    print(f"      model: {last.model}, {last.modules} modules, {last.links} links, {last.verdict}")
    print(f"      rates: {last.audio_rate:g} Hz audio, {last.gestural_rate:g} Hz gestures "
          f"(R = {last.ratio}), load {100 * last.load_mean:.1f} %")
    print(f"      compiled: {last.precision}, {last.isa}, threads: {last.threads}")
    print(f"      ticks: {gained('ticks')} while recorded; late: {gained('late_wake_up')} woken late, "
          f"{gained('late_device')} slow device, {gained('late_compute')} long computation; "
          f"{gained('stalls')} stalls, {gained('catch_up_ticks')} caught up, "
          f"{gained('lost_ticks')} lost")
    print(f"      sound: {gained('xruns')} xruns of JACK, {gained('underruns')} underruns "
          f"({gained('underrun_frames')} frames)")


def find_first_touch(performance):
    """Index of the tick at which the hand starts to move a key, or None."""
    away = np.abs(performance.positions - performance.positions[0])
    moved = np.flatnonzero(np.any(away > MOVED_M, axis=1))
    return int(moved[0]) if moved.size else None


def by_windows(values, window):
    """[windows][window] of a series, without what is left over at the end."""
    return values[: len(values) // window * window].reshape(-1, window)


def check_force(verdict, performance):
    """Force is there while a key moves, and only then."""
    peaks = np.max(np.abs(performance.forces), axis=0)
    key = int(np.argmax(peaks))
    window = max(int(WINDOW_S * performance.tick_rate), 1)
    force = np.max(np.abs(by_windows(performance.forces[:, key], window)), axis=1)
    motion = np.ptp(by_windows(performance.positions[:, key], window), axis=1)
    moving = motion > MOVED_M
    correlation = np.corrcoef(force, motion)[0, 1] if np.any(moving) else 0.0
    verdict.check("force goes with the keys",
                  peaks[key] > FORCE_N and np.all(moving[force > FORCE_N]) and
                  correlation > CORRELATION,
                  f"peak {peaks[key]:.2f} N on slice {key}; correlation with its motion "
                  f"{correlation:.2f}; above {FORCE_N:g} N in {np.sum(force > FORCE_N)} windows "
                  f"of {1e3 * WINDOW_S:.0f} ms, {np.sum(moving[force > FORCE_N])} of them with the key moving")


def free_stretch(performance, rate, to_sound):
    """The longest stretch of sound in which all keys rest after a touch: (first, end) frames."""
    ticks = len(performance.ticks)
    window = max(int(WINDOW_S * performance.tick_rate), 1)
    starts = np.arange(0, ticks - window, window)
    still = np.array([np.max(np.ptp(performance.positions[at : at + window], axis=0)) < STILL_M
                      for at in starts])
    still &= starts > find_first_touch(performance)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
    runs = [(starts[a], starts[b - 1] + window - 1) for a, b in zip(edges[::2], edges[1::2])]
    if not runs:
        return None
    first, last = max(runs, key=lambda run: run[1] - run[0])
    begin = to_sound(performance.ticks[first]) + int(SETTLE_S * rate)
    end = to_sound(performance.ticks[last])
    return (begin, end) if end - begin >= FREE_S * rate else None


def check_sound(verdict, performance, recorded, rate, to_sound, expected):
    touch = find_first_touch(performance)
    if touch is None:
        verdict.check("the hand moves", False, "no key was moved")
        return
    touched = to_sound(performance.ticks[touch])
    before, after = recorded[: max(touched, 0)], recorded[max(touched, 0) :]
    level = sound.level_dbfs(before)
    verdict.check("silent before the first touch",
                  level < QUIET_DBFS and len(before) >= QUIET_S * rate,
                  f"{level:.1f} dBFS RMS over {len(before) / rate:.2f} s")
    level = sound.level_dbfs(after)
    verdict.check("sound while playing", level > LOUD_DBFS,
                  f"{level:.1f} dBFS RMS over {len(after) / rate:.2f} s")
    stretch = free_stretch(performance, rate, to_sound)
    if stretch is None:
        verdict.check("pitch", False, f"the string never rings freely for {FREE_S:g} s")
        return
    tail = recorded[max(stretch[0], 0) : stretch[1], 0]
    pitch = sound.measure_pitch(tail, rate, expected)
    error = sound.cents(pitch, expected)
    verdict.check("pitch", abs(error) < PITCH_CENTS,
                  f"{pitch:.5f} Hz over {len(tail) / rate:.2f} s, closed form {expected:.5f} Hz, "
                  f"{error:+.4f} cents")


def reported_underruns(performance):
    """Frames reported between the first and the last status: at least, and at most."""
    first, last = performance.statuses[0].ticks, performance.statuses[-1].ticks
    near = performance.tick_rate  # a second: what is reported close to a status may be in it or not
    inside = lambda margin: sum(frames for tick, frames in performance.underruns
                                if first + margin < tick <= last - margin)
    return inside(near), inside(-near)


def check_replay(verdict, performance, recorded, replay, shift, capture):
    """The bag plays the same sound, sample by sample, but where the station said it did not."""
    start = performance.frame_of_first_keyframe()
    silenced = [(frame - start + shift, frames) for frame, frames, _ in performance.silenced
                if -frames < frame - start + shift < len(recorded)]
    found = sound.compare(replay, recorded, shift, silenced)
    excused = capture["lost"] + capture["dropped"]  # cycles that never reached the recorder
    unexplained = found["different"] - min(found["gaps"], excused)
    verdict.check("the replay of the bag is the sound, sample by sample",
                  unexplained == 0 and found["share"] >= SHARE_EQUAL,
                  f"{100 * found['share']:.2f} % of {len(recorded)} frames equal, "
                  f"{unexplained} differ, {min(found['gaps'], excused)} missed by the recorder")
    fewest, most = reported_underruns(performance)
    counted = performance.statuses[-1].underrun_frames - performance.statuses[0].underrun_frames
    verdict.check("every underrun was counted and reported", fewest <= counted <= most,
                  f"{counted} frames counted, {most} reported")
    where = [frame - start + shift == at - capture["first_jack_frame"]
             for frame, _, at in performance.silenced]
    verdict.check("frames that did not sound are those that were reported",
                  found["noisy"] == 0 and all(where) and performance.audio_stops == 0,
                  f"{len(silenced)} underruns and periods left out by JACK, "
                  f"{sum(frames for _, frames in silenced)} frames, "
                  f"{found['noisy']} of them not silent")


def check_pictures(verdict, performance, folder, chosen):
    """Copies the picture of the widest vibration to `chosen`; another one has to differ."""
    names = sorted(os.listdir(folder), key=lambda name: float(name[:-4]))
    taken = np.array([float(name[:-4]) for name in names])

    def vibration(time):  # of what rviz shows then
        shown = (performance.times > time - 0.15) & (performance.times < time + 0.05)
        return np.mean(performance.displacements[shown]) if np.any(shown) else 0.0

    widths = np.array([vibration(time) for time in taken])
    if len(names) < 2 or np.max(widths) <= 0.0:
        verdict.check("the picture changes", False, f"{len(names)} pictures of a string at rest")
        return
    best = int(np.argmax(widths))
    sounding = [i for i in np.flatnonzero(widths > 0.01 * widths[best]) if i != best]
    other = max(sounding or [0], key=lambda i: abs(taken[i] - taken[best]))
    paths = [os.path.join(folder, names[i]) for i in (best, other)]
    pixels = picture.changed_pixels(*(picture.read_ppm(path) for path in paths))
    os.replace(paths[0], chosen)
    verdict.check("the picture changes", pixels >= PIXELS,
                  f"{pixels} pixels between two moments {abs(taken[other] - taken[best]):.1f} s "
                  f"apart; string displaced by {1e3 * widths[best]:.2f} mm")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name, help_text in (("bag", "of the performance"),
                            ("sound", "WAV file recorded from the station's ports"),
                            ("capture", "what `capture` printed (JSON)"),
                            ("replay", "WAV file that `render` made of the bag"),
                            ("check", "what `check --json` printed of the model"),
                            ("shots", "folder of pictures, <time in s>.ppm"),
                            ("picture", "where to put the best of them")):
        parser.add_argument(f"--{name}", required=True, help=help_text)
    options = parser.parse_args()

    performance = Performance(options.bag)
    recorded, rate = sound.read_wav(options.sound)
    replay, _ = sound.read_wav(options.replay)
    with open(options.capture) as file:
        capture = json.load(file)
    with open(options.check) as file:
        expected = json.load(file)["strings"][0]["pitch_hz"]

    verdict = Verdict()
    tell_counters(performance)
    check_force(verdict, performance)
    shift = sound.find_shift(replay, recorded)
    if shift is None:
        verdict.check("the replay of the bag is the sound", False, "not one sample in common")
    else:
        start = performance.frame_of_first_keyframe()
        to_sound = lambda tick: int(tick * performance.ratio - start + shift)
        check_sound(verdict, performance, recorded, rate, to_sound, expected)
        check_replay(verdict, performance, recorded, replay, shift, capture)
    check_pictures(verdict, performance, options.shots, options.picture)
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main())
