# SPDX-License-Identifier: BSD-3-Clause
"""The rooms of the program in their order, and who includes whom. For check_includes and draw_rooms."""

import re
from pathlib import Path

# Each room, lowest first, and the rooms below that it may include. A room is a folder below src/ and
# include/ergotic/; folders that are not named here belong to the room around them.
ROOMS = {
    "exception": "",
    "rt": "exception",
    "scene": "exception",
    "scene/laws": "exception rt scene",
    "scene/rules": "exception scene scene/laws",
    "scene/generate": "exception scene",
    "scene/text": "exception scene",
    "scene/yaml": "exception scene scene/laws scene/rules scene/generate scene/text",
    "scene/mdl": "exception scene scene/laws scene/generate scene/text",
    "physics": "exception rt scene scene/laws",
    "physics/laws": "exception rt scene scene/laws physics",
    "physics/network": "exception scene scene/laws physics physics/laws",
    "physics/layout/blocks": "exception scene physics",
    "physics/layout": "exception scene physics physics/layout/blocks",
    "physics/modes": "exception scene scene/generate physics physics/laws physics/layout physics/network",
    "physics/state": "exception scene scene/laws physics physics/laws physics/layout physics/layout/blocks",
    "physics/kernels": "rt scene scene/laws physics physics/laws physics/layout physics/layout/blocks"
                       " physics/state",
    "physics/engine": "exception rt scene scene/laws physics physics/laws physics/modes"
                      " physics/layout physics/layout/blocks physics/state physics/kernels",
    "physics/certificate": "exception scene scene/laws physics physics/laws physics/layout physics/network"
                           " physics/engine",
    "physics/settling": "exception scene scene/laws scene/generate physics physics/laws physics/network"
                        " physics/certificate",
    "advice": "exception scene scene/laws scene/generate physics physics/laws physics/network"
              " physics/certificate physics/settling",
    "tgr": "exception rt scene scene/text scene/yaml",
    "station": "exception rt scene physics physics/engine physics/certificate physics/settling tgr",
    "audio": "exception rt",
    "tgr/drivers/comedi": "exception rt tgr",
    "tgr/drivers/jack": "exception rt tgr audio",
    "bag": "exception physics/engine tgr station",
    "ros/device": "exception rt scene physics/engine physics/certificate tgr station bag",
    "ros/display": "scene tgr station ros/device",
    "ros/conversation": "exception rt scene scene/laws scene/text physics/engine tgr station audio ros/device"
                        " ros/display",
    "ros": "ros/device ros/display ros/conversation",
    "tools/lib": "exception rt scene scene/laws scene/generate scene/text physics physics/engine"
                 " physics/certificate physics/settling advice tgr station audio bag",
    "tools": "exception rt tgr audio tgr/drivers/jack tools/lib",
}

# Headers of others, by the beginning of their names, and the only rooms that may know them.
FOREIGN = {
    "jack/": "audio",
    "comedilib.h": "tgr/drivers/comedi",
    "pluginlib/": "tgr/drivers/comedi tgr/drivers/jack ros ros/device",
    "(ros|rosbag|nodelet|xmlrpcpp|diagnostic_updater|tf2_ros|rviz|ergotic|[a-z_]+_(msgs|srvs))/":
        "bag ros ros/device ros/display ros/conversation",
}

# A file and a header above it that it still includes. May only shrink: what is no longer needed fails, too.
EXCEPTIONS = """
"""

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def room_of(path):
    """The room of a file, by its path below the root; None if there is none."""
    parts = re.sub(r"^(src|include/ergotic)/", "", path)
    folder = "exception" if re.fullmatch(r"exception\.[ch]pp", parts) else str(Path(parts).parent)
    while folder not in ROOMS and folder != ".":
        folder = str(Path(folder).parent)
    return folder if folder in ROOMS else None


def includes(root):
    """(file, name, header) of every include: header is its path below the root, None if it is not ours."""
    root = Path(root)
    for path in sorted([*root.glob("src/**/*.[ch]pp"), *root.glob("include/**/*.hpp")]):
        for ours, other in _INCLUDE.findall(path.read_text()):
            name = ours or other
            found = [b + name for b in ("src/", "include/") if (root / (b + name)).is_file()]
            yield path.relative_to(root).as_posix(), f'"{ours}"' if ours else f"<{other}>", \
                found[0] if found else None
