# SPDX-License-Identifier: BSD-3-Clause
"""The rooms of the program in their order, and who includes whom. For check_includes and draw_rooms."""

import re
from pathlib import Path

# Each room, lowest first, and the rooms below that it may include. A room is a folder below src/ and
# include/ergotic/; folders that are not named here belong to the room around them.
ROOMS = {
    "exception": "",
    "algebra": "",
    "files": "exception",
    "rt": "exception",
    "scene": "exception files",
    "scene/laws": "exception rt scene",
    "scene/rules": "exception scene scene/laws",
    "scene/generate": "exception algebra scene",
    "scene/text": "exception files scene",
    "scene/tree": "exception files scene scene/generate scene/text",
    "scene/language": "exception scene scene/generate scene/text scene/tree",
    "scene/yaml": "exception scene scene/laws scene/rules scene/generate scene/text scene/tree"
                  " scene/language",
    "scene/mdl": "scene scene/laws scene/generate scene/text scene/language",
    "physics": "exception rt scene scene/laws",
    "physics/laws": "exception scene scene/laws physics",
    "physics/network": "exception algebra scene scene/laws physics physics/laws",
    "physics/layout/blocks": "exception scene scene/laws physics",
    "physics/layout": "exception scene scene/laws physics physics/layout/blocks",
    "physics/modes": "exception algebra scene scene/laws physics physics/laws physics/network",
    "physics/state": "exception scene scene/laws physics physics/laws physics/layout physics/layout/blocks",
    "physics/kernels": "rt scene/laws physics/layout physics/layout/blocks physics/state",
    "physics/engine": "exception rt scene physics physics/laws physics/modes physics/layout"
                      " physics/layout/blocks physics/state physics/kernels",
    "physics/certificate": "exception algebra scene scene/laws physics physics/layout physics/network physics/engine",
    "physics/settling": "exception algebra scene scene/laws scene/generate physics physics/laws physics/network"
                        " physics/certificate",
    "advice": "exception algebra scene scene/laws scene/generate physics physics/laws physics/network physics/certificate"
              " physics/settling",
    "tgr": "exception algebra files rt scene scene/text scene/tree",
    "station": "exception rt scene physics physics/engine physics/certificate physics/settling tgr",
    "audio": "exception rt",
    "gamepads": "rt tgr",
    "tgr/drivers/comedi": "exception rt tgr",
    "tgr/drivers/jack": "exception rt tgr audio",
    "guardian": "exception rt tgr",
    "preload": "",
    "bag": "exception files physics/engine tgr station",
    "replay": "exception scene/text physics tgr station bag",
    "ros/device": "exception files rt scene scene/text physics/engine physics/certificate tgr station bag",
    "ros/display": "scene tgr station ros/device",
    "ros/interface": "exception files rt scene scene/laws scene/text physics/engine tgr station audio gamepads bag replay"
                        " ros/device ros/display",
    "ros": "ros/device ros/interface",
    "rviz": "",
    "tools/lib": "exception files rt scene scene/laws scene/generate scene/text physics physics/engine"
                 " physics/certificate physics/settling advice tgr station audio bag replay",
    "tools": "exception files rt scene tgr audio tgr/drivers/jack tools/lib",
    "lab": "exception rt scene scene/generate scene/text physics physics/engine physics/certificate physics/settling advice tgr"
           " station tools/lib",
}

# Headers of others that a room may know beside those of the C++ library and the system: by the
# beginnings of their names. The core knows neither ROS nor JACK.
CORE = "Eigen/ Spectra/ yaml-cpp/ boost/lockfree/"
ROS = CORE + " ros/ rosbag/ nodelet/ pluginlib/ class_loader/ xmlrpcpp/ diagnostic_updater/ tf2_ros/" \
             " console_bridge/ ergotic/ diagnostic_msgs/ geometry_msgs/ sensor_msgs/ std_msgs/ std_srvs/ visualization_msgs/"
FOREIGN = {
    "audio": CORE + " jack/ sndfile",
    "gamepads": CORE + " libevdev/",
    "guardian": CORE + " jack/",
    "tgr/drivers/comedi": CORE + " comedilib.h pluginlib/",
    "tgr/drivers/jack": CORE + " pluginlib/",
    "bag": ROS,
    "ros": ROS,
    "ros/device": ROS,
    "ros/display": ROS,
    "ros/interface": ROS,
    "rviz": ROS + " rviz/ Q Ogre unsupported/Eigen/FFT",
    "tools/lib": CORE + " CLI/ nlohmann/ sndfile ebur128 smf.h glib.h",
    "tools": CORE + " CLI/ nlohmann/",
    "lab": CORE + " CLI/ nlohmann/",
}
# Of the system: no slash, or one of these.
SYSTEM = "sys/ linux/ netinet/ arpa/"

# A file and a header above it that it still includes. May only shrink: what is no longer needed fails, too.
EXCEPTIONS = """
"""

_PLAIN = re.compile(r'#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)[ \t]*')
_TOKENS = re.compile(r'R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def room_of(path):
    """The room of a file, by its path below the root; None if there is none."""
    parts = re.sub(r"^(src|include/ergotic)/", "", path)
    folder = "exception" if re.fullmatch(r"(exception|at|constants)\.[ch]pp", parts) else str(Path(parts).parent)
    while folder not in ROOMS and folder != ".":
        folder = str(Path(folder).parent)
    return folder if folder in ROOMS else None


def files(root):
    """All files of the program, below the root."""
    root = Path(root)
    found = [path for part in ("src", "include", "lab") for path in sorted((root / part).rglob("*"))]
    tests = (root / "lab" / "test", root / "lab" / "scripts")
    return [path for path in found
            if (path.is_symlink() or not path.is_dir()) and path.parent not in tests and path.suffix != ".md"]


def directives(text):
    """The lines that include something, without comments and as one line each."""
    text = text.lstrip("\ufeff").replace("\\\r\n", "").replace("\\\n", "")
    text = _TOKENS.sub(lambda token: token[0] if token[0].startswith('"') else " ", text)
    for line in re.split(r"[\n\r\v\f]", text):
        if re.match(r"\s*(#|%:|\?\?=)\s*(include|import)", line):
            yield line.strip()


def includes(root):
    """(file, name, header) of every include: header is its path below the root, None if it is not ours.

    What is written in another way than `#include "name"` or `#include <name>` has the name None.
    """
    root = Path(root)
    for path in files(root):
        if not path.is_file():
            continue  # a folder by a link
        for line in directives(path.read_text(errors="replace")):
            plain = _PLAIN.fullmatch(line)
            if not plain or re.search(r'["</]\.\.?/|//', line):
                yield path.relative_to(root).as_posix(), None, line
                continue
            ours, other = plain.groups()
            name = ours or other
            bases = ("src/", "include/") if not name.startswith("lab/") else ("",)
            found = [b + name for b in bases if (root / (b + name)).is_file()]
            yield path.relative_to(root).as_posix(), f'"{ours}"' if ours else f"<{other}>", \
                found[0] if found else None
