#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which period of JACK and which ring_depth a machine keeps: what `scripts/station --tune` tries, how
it chooses, and the file that it writes.

  sound_setting.py steps [PERIOD[:RING_DEPTH]...]   "PERIOD RING_DEPTH" of each step, one a line
  sound_setting.py heading                          of the table
  sound_setting.py row RESULT                       a row of the table
  sound_setting.py ended FILE                       exit code 0: more steps would tell nothing more
  sound_setting.py choose FILE SOUND                chooses, writes the setting, says what it is
  sound_setting.py read SOUND                       "PERIOD RING_DEPTH RATE LATENCY_MS" of the setting for SOUND, if there is one

A RESULT is a line of FILE: period, ring depth and the buffer of JACK in frames, the rate in Hz, then
underruns, xruns and late ticks; or period and ring depth alone, where the card refuses the period.
SOUND says where the sound goes: `alsa:` and the name of a card, `pipewire`, or `dummy`.
"""
import dataclasses
import datetime
import os
import pathlib
import re
import signal
import sys
import tempfile

PERIODS = (1024, 512, 256, 128, 64, 32)
RING_OF_PERIODS = (3, 2)
# Of a ring above the period: a tick of the default instrument, and what the station adds to it.
LEAST_ABOVE_PERIOD = 80
MOST_FRAMES = 1 << 14
PATIENCE = 2  # steps in a row that are not clean: the following ones will not be, either
HEADING = f"{'period':>7} {'ring_depth':>11} {'latency':>10} {'underruns':>10} {'xruns':>6} {'late ticks':>11}"


@dataclasses.dataclass(frozen=True)
class Result:
    """What became of a step."""

    period: int  # frames
    ring_depth: int  # frames
    buffer: int = 0  # frames that JACK keeps before the card plays them
    rate: int = 0  # Hz; 0: the card refuses this period
    underruns: int = 0
    xruns: int = 0
    late: int = 0  # ticks; none of them is heard as long as there is no underrun

    @property
    def is_refused(self):
        return self.rate == 0

    @property
    def is_clean(self):
        return not self.is_refused and self.underruns == 0 and self.xruns == 0

    @property
    def latency_ms(self):
        """From a tick's due time to the converter of the card."""
        return 1e3 * (self.ring_depth + self.buffer) / self.rate


def steps(words=PERIODS):
    """[(period, ring depth)] in frames, with less and less latency: several rings for each period, or the
    one of `period:ring_depth`"""
    found = set()
    for word in words:
        period, _, ring_depth = str(word).partition(":")
        period = frames(period, 16)
        rings = [frames(ring_depth, 1)] if ring_depth else [max(n * period, period + LEAST_ABOVE_PERIOD)
                                                            for n in RING_OF_PERIODS]
        found.update((period, ring) for ring in rings)
    return sorted(found, reverse=True)


def frames(text, least):
    if not re.fullmatch("[0-9]{1,6}", text) or not least <= int(text) <= MOST_FRAMES:
        raise SystemExit(f"error: {text} frames, allowed: {least}...{MOST_FRAMES}; steps are written PERIOD or "
                         "PERIOD:RING_DEPTH")
    return int(text)


def result_of(line):
    return Result(*map(int, line.split()))


def results_of(text):
    return [result_of(line) for line in text.splitlines() if line.strip()]


def has_ended(results):
    """Whether the last steps that could be tried were all unclean."""
    tried = [result for result in results if not result.is_refused]
    return len(tried) >= PATIENCE and not any(result.is_clean for result in tried[-PATIENCE:])


def choose(results):
    """The smallest step that was clean, and one step of margin: the clean one before it, if there is
    one. None if no step was clean. \\pre ordered as `steps`"""
    clean = [result for result in results if result.is_clean]
    return clean[-2] if len(clean) > 1 else clean[0] if clean else None


def row(result):
    head = f"{result.period:7d} {result.ring_depth:11d}"
    if result.is_refused:
        return f"{head}   the sound card refuses this period"
    return (f"{head} {result.latency_ms:7.1f} ms {result.underruns:10d} {result.xruns:6d} {result.late:11d}"
            f"   {'clean' if result.is_clean else 'not clean'}")


# The file

def setting_file(environment):
    home = environment.get("XDG_CONFIG_HOME", "")
    if not os.path.isabs(home):  # as the XDG says
        home = os.path.join(os.path.expanduser("~"), ".config")
    return pathlib.Path(home) / "ergotic" / "sound.yaml"


def text_of(result, sound, now):
    return (f"# Written by `scripts/station --tune` on {now:%Y-%m-%d at %H:%M}. Without this file a start takes the\n"
            "# safe setting; ring_depth:=N wins over it.\n"
            f'sound: "{escaped(sound)}"\n'
            f"rate: {result.rate}  # Hz\n"
            f"period: {result.period}  # frames\n"
            f"ring_depth: {result.ring_depth}  # frames\n"
            f"latency_ms: {result.latency_ms:.1f}\n")


def escaped(text):
    return text.replace("\\", "\\\\").replace('"', '\\"')


def write(path, text):
    """All of it or nothing; a Ctrl-C waits until it is done."""
    path.parent.mkdir(parents=True, exist_ok=True)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".sound.")
    try:
        with open(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError:
        os.unlink(temporary)
        raise
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})


def read(path, sound):
    """(period, ring depth, rate, latency in ms) that was found for this sound; None if there is none.
    \\throws ValueError if the file is not as it was written"""
    import yaml
    try:
        with open(path, encoding="utf-8") as file:
            setting = yaml.safe_load(file.read(1 << 16))
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ValueError(str(error).splitlines()[0]) from error
    if not isinstance(setting, dict):
        raise ValueError("it holds no map")
    if setting.get("sound") != sound:
        return None
    found = []
    for key, least, most in (("period", 16, MOST_FRAMES), ("ring_depth", 1, MOST_FRAMES), ("rate", 8000, 192000)):
        value = setting.get(key)
        if type(value) is not int or not least <= value <= most:
            raise ValueError(f"{key} is {value}, allowed: {least}...{most}")
        found.append(value)
    latency = setting.get("latency_ms")
    return (*found, float(latency) if isinstance(latency, (int, float)) else 0.0)


# What the scripts ask

def say_choice(results, sound, environment):
    chosen = choose(results)
    if chosen is None:
        raise SystemExit("error: no setting played without a gap, so none was written. Does another program need the "
                         "processor? README, \"Real time\", says how to permit real-time priority.")
    path = setting_file(environment)
    write(path, text_of(chosen, sound, datetime.datetime.now()))
    print(f"chosen, with a step of margin: period {chosen.period}, ring_depth {chosen.ring_depth}, "
          f"{chosen.latency_ms:.1f} ms from the hand's tick to the sound card; written to {path}")


def say_setting(sound, environment):
    path = setting_file(environment)
    try:
        setting = read(path, sound)
    except ValueError as error:
        print(f"warning: {path} is passed over: {error}. `scripts/station --tune` writes it anew.", file=sys.stderr)
        return
    if setting:
        print("{} {} {} {:.1f}".format(*setting))


def content(path):
    with open(path, encoding="utf-8") as file:
        return results_of(file.read())


def main(action="", *rest):
    if action == "steps":
        print(*(f"{period} {ring}" for period, ring in steps(rest or PERIODS)), sep="\n")
    elif action == "heading":
        print(HEADING)
    elif action == "row":
        print(row(result_of(" ".join(rest))))
    elif action == "ended":
        return 0 if has_ended(content(rest[0])) else 1
    elif action == "choose":
        say_choice(content(rest[0]), rest[1], os.environ)
    elif action == "read":
        say_setting(rest[0], os.environ)
    else:
        raise SystemExit(__doc__)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
