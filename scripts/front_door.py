#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the words behind `scripts/station` mean. It needs no ROS, and nothing that has to be built.

  front_door.py list               the shipped instruments, one line each
  front_door.py arguments WORD...  assignments for bash: `arguments`, for roslaunch, `is_simulated` and `name`
  front_door.py free NAME          fails if a station of that name runs at the ROS master of $ROS_MASTER_URI
"""
import difflib
import os
import pathlib
import re
import shlex
import shutil
import socket
import sys
import textwrap
import xml.etree.ElementTree
import xmlrpc.client

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = (".yaml", ".mdl")
NO_INSTRUMENTS = re.compile(r"_truths$")  # scenes for measurements
PATHS = ("model", "device", "gesture", "end_effectors")  # arguments that name a file
PATHS_IN_SETTINGS = ("file", "bag", "gesture")  # keys of driver_settings that do
OPTIONS = ("--list", "--tune", "--demo", "--help")
MOST_BYTES = 1 << 24
USUAL_NAME = "station"
HOW_TO_LIST = "`scripts/station --list` shows all instruments"
PATIENCE_S = 2.0  # with a master or a station that does not answer


class Refusal(Exception):
    """A word that means nothing; the text says what to write."""


def greeting(instrument, has_window, is_simulated, has_force, name=USUAL_NAME):
    """The one line at the end of a start: what a player can do now, at the station of this name."""
    midi_in = "ergotic:midi_in" if name == USUAL_NAME else f"ergotic_{name}:midi_in"
    if not has_force:
        act = f" Force stays off until you run `rosservice call /{name}/engage`;"
    elif not is_simulated:
        act = " Its force is on;"
    elif has_window:
        act = " Drag what lights up under the mouse, or play the keys Z to / and Q to P in the picture;"
    else:
        act = f" There is no window; a MIDI keyboard at {midi_in} plays it, or gesture:=FILE.csv;"
    return f"Instrument {instrument} plays.{act} Ctrl-C ends."


def near(word, known):
    """[the one of `known` that `word` is most like], or []"""
    by_key = {key_of(name): name for name in known}
    keys = difflib.get_close_matches(key_of(word), by_key, 1, 0.5)
    return [by_key[key] for key in keys]


def key_of(name):
    return re.sub(r"[\s-]+", "_", name).lower()


def did_you_mean(word, known, otherwise):
    found = near(word, known)
    return f"did you mean {found[0]}?" if found else otherwise


# Instruments

def instruments(folder=ROOT / "models"):
    """{name: scene file} of what is shipped, by name."""
    return {path.stem: path for path in sorted(folder.iterdir())
            if path.suffix in SUFFIXES and not NO_INSTRUMENTS.search(path.stem)}


def description(text):
    """One sentence on a scene: of its `about`, else the first of its leading comment."""
    return from_about(text) or first_sentence(leading_comment(text))


def from_about(text):
    """`description` or `title` of `about`. Only that part is read as YAML, for scenes can be long."""
    found = re.search(r"^about:.*\n?(?:^(?![A-Za-z_]\w*:).*\n?)*", text, re.MULTILINE)
    if not found:
        return ""
    import yaml  # a tenth of a second, which few scenes ask for
    try:
        about = yaml.load(found.group(), yaml.BaseLoader)["about"]
    except yaml.YAMLError:
        return ""
    said = isinstance(about, dict) and (about.get("description") or about.get("title"))
    return first_sentence(said) if isinstance(said, str) else ""


def leading_comment(text):
    """Of a YAML (#) or `.mdl` (; or //) scene, without licence and paths of schemas."""
    words = []
    for line in text.splitlines():
        comment = re.match(r"\s*(?:#+|;+|//+)\s?(.*)", line)
        if not comment and (line.strip() or words):
            break
        if comment and not re.match(r"SPDX-|yaml-language-server:", comment.group(1).strip()):
            words.append(comment.group(1))
    return " ".join(words)


def first_sentence(text):
    text = " ".join(text.split())
    return re.split(r"(?<=[.!?])\s", text, 1)[0].rstrip(".")


def listing(shipped, width):
    """A line for each instrument, no longer than `width`."""
    longest = max(map(len, shipped), default=0)
    lines = []
    for name, path in shipped.items():
        with open(path, encoding="utf-8", errors="replace") as file:
            said = description(file.read(MOST_BYTES))
        line = textwrap.shorten(said, max(20, width - longest - 2), placeholder=" ...")
        lines.append(f"{name:{longest}}  {line}".rstrip())
    return "\n".join(lines)


# Paths

def absolute(path, folder):
    """As the shell would find it from `folder`; roslaunch starts nodes somewhere else."""
    return os.path.join(folder, os.path.expanduser(path))


def split_variant(path):
    """(path, "#variant" or "") of a scene"""
    if "#" in path and not os.path.exists(path):
        stem, _, variant = path.rpartition("#")
        return stem, "#" + variant
    return path, ""


def file_of(path, folder, what):
    found = absolute(path, folder)
    if not os.path.isfile(found):
        raise Refusal(f"{what}: there is no file {found}")
    return found


def scene_of(word, folder, shipped):
    """The scene file that a name or a path means, with its variant."""
    path, variant = split_variant(absolute(word, folder))
    name = split_variant(word)[0]
    if "/" not in name and name in shipped:
        return str(shipped[name]) + variant
    if os.path.isfile(path):
        return path + variant
    if "/" in name or name.endswith(SUFFIXES):
        stem = pathlib.Path(name).stem
        hint = f"; `scripts/station {stem}` plays the shipped one" if stem in shipped else ""
        raise Refusal(f"there is no scene file {path}{hint}")
    answer = did_you_mean(name, shipped, "")
    raise Refusal(f"there is no instrument {name}{', ' + answer if answer else '.'} {HOW_TO_LIST}")


def with_absolute_paths(text, keys, folder):
    """A YAML map in which the values of some keys are absolute paths; the rest stays as it is."""
    import yaml  # only who has such a map needs it
    try:
        node = yaml.compose(text, yaml.BaseLoader)
    except yaml.YAMLError:
        return text  # the station says what is wrong, and where
    if not isinstance(node, yaml.MappingNode):
        return text
    for key, value in reversed(node.value):
        if key.value in keys and isinstance(value, yaml.ScalarNode) and value.value and "\n" not in value.value:
            path = absolute(value.value, folder).replace("'", "''")
            text = text[:value.start_mark.index] + f"'{path}'" + text[value.end_mark.index:]
    return text


# Arguments

def known_arguments(launch=ROOT / "launch" / "station.launch"):
    """Names of the arguments that a launch file can be given, in its order."""
    arguments = xml.etree.ElementTree.parse(launch).getroot().findall("arg")
    return [argument.get("name") for argument in arguments if argument.get("default") is not None]


def split_words(words, known):
    """(name of an instrument or None, {argument: value})"""
    instrument, given = None, {}
    for word in words:
        name, colon, value = word.partition(":=")
        if colon and re.fullmatch(r"[A-Za-z_]+", name):
            if name not in known:
                raise Refusal(f"station.launch has no argument {name}, "
                              + did_you_mean(name, known, "it has: " + ", ".join(known)))
            given[name] = value
        elif word in OPTIONS:
            raise Refusal(f"{word} stands first, and no instrument beside it")
        elif word.startswith("-"):
            raise Refusal(f"there is no option {word}, "
                          + did_you_mean(word, OPTIONS, "there are: " + ", ".join(OPTIONS)))
        elif (typo := re.match(r"([a-z_]+)\s*[:=]+\s*(.*)", word, re.DOTALL)) and near(typo[1], known):
            raise Refusal(f"arguments are written name:=value: {near(typo[1], known)[0]}:={typo[2]}")
        elif instrument is not None:
            raise Refusal(f"two instruments, {instrument} and {word}: one plays at a time (a name with blanks needs "
                          "quotes)")
        else:
            instrument = word
    return instrument, given


def with_paths(given, folder, shipped):
    """The arguments, with absolute paths. A text of more than one line is YAML, no path."""
    given = dict(given)
    for name in PATHS:
        value = given.get(name, "")
        if value and "\n" not in value:
            given[name] = (scene_of(value, folder, shipped) if name == "model"
                           else file_of(value, folder, name))
    if given.get("record"):
        given["record"] = absolute(given["record"], folder)
        if not os.path.isdir(os.path.dirname(given["record"])):
            raise Refusal(f"record: there is no folder {os.path.dirname(given['record'])}")
    if given.get("driver_settings"):
        given["driver_settings"] = with_absolute_paths(given["driver_settings"], PATHS_IN_SETTINGS, folder)
    if given.get("parameters"):
        given["parameters"] = with_absolute_paths(given["parameters"], PATHS, folder)
    return given


def is_simulated(given):
    """Whether no real device can be meant. \\pre paths are absolute"""
    import yaml
    try:
        meant = {**given, **(yaml.load(given.get("parameters", "{}"), yaml.BaseLoader) or {})}
        device = meant.get("device", "")
        if not device:
            return meant.get("driver", "virtual") == "virtual"
        if "\n" not in device:
            with open(device, encoding="utf-8") as file:
                device = file.read(MOST_BYTES)
        devices = yaml.load(device, yaml.BaseLoader)["devices"]
        return bool(devices) and all(each["driver"] == "virtual" for each in devices)
    except (yaml.YAMLError, OSError, ValueError, TypeError, KeyError):
        return False  # the station will say what is wrong


def usual_hands(given):
    """The file of what stands on the slices for a scene `folder/NAME.yaml`: `folder/hands/NAME.yaml`, or None."""
    scene = pathlib.Path(split_variant(given.get("model", ""))[0])
    hands = scene.parent / "hands" / (scene.stem + ".yaml")
    return str(hands) if scene.name and hands.is_file() else None


def arguments_of(words, folder, environment, shipped, known):
    """({argument: value} of what roslaunch is told, whether the device is simulated)"""
    instrument, given = split_words(words, known)
    if instrument is not None:
        if "model" in given:
            raise Refusal(f"the instrument {instrument} and model:= name a scene twice, allowed: one of them")
        given["model"] = instrument
    if not re.fullmatch(r"[A-Za-z]\w*", given.get("name", USUAL_NAME), re.ASCII):
        raise Refusal(f"name is {given['name']}, allowed: letters, digits and _, a letter first")
    given = with_paths(given, folder, shipped)
    simulated = is_simulated(given)
    if simulated:
        given.setdefault("autoengage", "true")
        given.setdefault("force_after_swap", "always")  # nobody can be hurt, whoever chooses another instrument
        hands = usual_hands(given)
        if hands and not given.get("device"):
            given.setdefault("end_effectors", hands)
    given.setdefault("rviz", "true" if environment.get("DISPLAY") else "false")
    if simulated and given["rviz"] == "true":
        given.setdefault("window_required", "true")  # who closes it does not want to go on
    return given, simulated


def in_shell(given, simulated):
    words = " ".join(shlex.quote(f"{name}:={value}") for name, value in given.items())
    return f"arguments=({words}) is_simulated={str(simulated).lower()} name={given.get('name', USUAL_NAME)}"


def expect_free(name, environment):
    """Refuses the name of a station that runs: ROS would end that one for a second of its name."""
    node = "/" + "/".join(part for part in (environment.get("ROS_NAMESPACE", "") + "/" + name).split("/") if part)
    socket.setdefaulttimeout(PATIENCE_S)
    try:
        code, _, address = xmlrpc.client.ServerProxy(environment["ROS_MASTER_URI"]).lookupNode("/front_door", node)
        if code == 1:
            xmlrpc.client.ServerProxy(address).getPid("/front_door")  # or it died, and nobody told the master
            raise Refusal(f"a station called {name} runs already. Choose another instrument in its window, end it by "
                          "Ctrl-C where it was started, or start one beside it with name:=second")
    except (OSError, xmlrpc.client.Error):
        return


def main(words):
    if words[:1] == ["list"]:
        print(listing(instruments(), shutil.get_terminal_size((100, 0)).columns))
    elif words[:1] == ["arguments"]:
        print(in_shell(*arguments_of(words[1:], os.getcwd(), os.environ, instruments(), known_arguments())))
    elif words[:1] == ["free"] and len(words) == 2:
        expect_free(words[1], os.environ)
    else:
        raise SystemExit(__doc__)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except Refusal as refusal:
        raise SystemExit(f"error: {refusal}")
    except BrokenPipeError:  # `scripts/station --list | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
