# SPDX-License-Identifier: BSD-3-Clause
"""Reads the text of a scene: what is written there, and what generators, agents, filters and points make of it,
from docs/scene.md alone."""
import itertools
import math
import os
import re

import numpy as np
import yaml

PARTS = {"parameters": "parameters", "sections": "sections", "mats": "modules", "lias": "links"}
DEFAULTS = {"sections": {"rate": "audio", "geometry": "scalar", "medium": "0"},
            "lias": {"rest_length": "0", "threshold": "0", "stiffness": "0", "damping": "0", "parts": []},
            "mats": {"stiffness": "0", "damping": "0", "matched": "true", "power": "1"}, "parameters": {}}
WORDS = {"spring": "spring_damper", "damper": "spring_damper"}
AXES = {"scalar": 1, "line": 1, "plane": 2, "space": 3}
MOST_FRAMES = 48  # of a tick
CHAPLET = ((0.0083, 0.2237, 0.4475), (0.0705, 0.0, 0.5525))  # stiffness, damping, mass, from its slower end on
MATERIALS = {"felt": 0.3, "nylon": 0.03, "gut": 0.02, "wood": 0.01}
CONSTANT_LOSS = (((0.4964, 0.6296, -0.3916), (4.715, 0.8373, -0.2502)),
                 ((0.2132, 2.305, -0.8829), (6.796, 0.6413, -0.128)),
                 ((0.4939, 4.001, -0.8781), (8.876, 0.8478, 0.006458)))  # powers of the loss factor
UNITS = {**dict.fromkeys("m s Hz N J W V rad deg 1".split(), 0), "g": -3}  # powers of ten
PREFIXES = {"": 0, "n": -9, "u": -6, "\u00b5": -6, "m": -3, "c": -2, "k": 3, "M": 6, "G": 9}
QUANTITY = re.compile(r"([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?) *(?![eE][-+]?[0-9])((?:[a-zA-Z%\u00b5]|1/).*)")
NUMBER = re.compile(r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?")
NOTE = re.compile(r"([A-G])([#b]?)(-?[0-9]+)")
BRIEF = {"let", "defaults", "define", "use", "include", "variants", "for", "when", "class"}
NEAREST = ((0, 1), (1, 0), (1, 1), (1, -1))  # of a mesh: rows and columns to the modules it is linked to


def power_of(factor):
    """\return how many powers of ten, and of pi/180, `kN` or `mm^2` is of what has no prefix"""
    name, _, power = factor.partition("^")
    known = next((PREFIXES[p] + UNITS[name[len(p):]], name[len(p):] == "deg") for p in PREFIXES
                 if name.startswith(p) and name[len(p):] in UNITS)  # another is no unit: StopIteration
    return [int(power or 1) * each for each in known]


def plain(said, key=""):
    """A scene without units: each number is that of SI units."""
    if isinstance(said, dict):
        return {name: plain(each, name) for name, each in said.items()}
    if isinstance(said, list):
        return [plain(each, key) for each in said]
    if note := key == "frequency" and NOTE.fullmatch(said):
        semitones = dict(zip("CDEFGAB", (0, 2, 4, 5, 7, 9, 11)))[note[1]] + {"#": 1, "b": -1, "": 0}[note[2]]
        return repr(440.0 * 2 ** ((12 * int(note[3]) + semitones - 57) / 12))
    if NUMBER.fullmatch(said) or not (quantity := QUANTITY.fullmatch(said)):
        return said
    number, unit = quantity[1], quantity[2].strip()
    if unit in ("%", "dB", "cents"):
        value = float(number)
        return repr({"%": value / 100, "dB": 10 ** (value / 20), "cents": 2 ** (value / 1200)}[unit])
    factors, ten, turn = re.split("([ /*])", "*" + unit)[1:], 0, 0
    for sign, factor in zip(factors[::2], factors[1::2]):
        powers = power_of(factor)
        ten, turn = (sum_ + (-each if sign == "/" else each) for sum_, each in zip((ten, turn), powers))
    mantissa, _, exponent = number.lower().partition("e")
    return repr(float(f"{mantissa}e{int(exponent or 0) + ten}") * (math.pi / 180) ** turn)


def is_brief(node):
    """Whether something in it stands for what `expand` would write."""
    if isinstance(node, dict):
        return not BRIEF.isdisjoint(node) or any(map(is_brief, [*node, *node.values()]))
    return any(map(is_brief, node)) if isinstance(node, list) else node[:1] == "=" or "{" in node


def rows_of(part):
    """Names and keys, out of tables, too."""
    for name, keys in (part or {}).items():
        for row in keys.get("rows", [[]]):
            cells = {k: v for k, v in zip(keys.get("columns", []), row) if v not in ("", "~", "null")}
            each = {**keys.get("with", {}), **cells}
            yield each.pop("name", name), each or dict(keys)


def scaled(said, factor):
    """Said so many times: of a number, $name or number*$name."""
    number, dollar, name = said.partition("$")
    return f"{factor * float(number.strip(' *') or 1)!r}" + (f"*${name}" if dollar else "")


def vector(said, size):
    """Of that many coordinates."""
    numbers = [float(each) for each in ([said] if isinstance(said, str) else said or [])]
    return np.array((numbers + [0.0] * size)[:size])


def axes_of(section):
    """Along which it moves: the pose turns about x, then y, then z, which stay where they are."""
    size, turned = AXES[section["geometry"]], np.eye(3)
    for k, angle in enumerate(vector(section.get("pose", {}).get("rotation"), 3)):
        i, j = (k + 1) % 3, (k + 2) % 3
        turn = np.eye(3)
        turn[i, i] = turn[j, j] = math.cos(angle)
        turn[j, i], turn[i, j] = math.sin(angle), -math.sin(angle)
        turned = turn @ turned
    return np.eye(3) if size == 3 else turned.T[:size]


class Said:
    """A scene by its text: in `parts` by name the keys of each element, those that are made, too. A key
    that is None is worked out elsewhere and is not compared."""

    def __init__(self, name, frame, gestural_hz):
        scene, *appended = plain(list(yaml.load_all(open(name, "rb").read(), yaml.BaseLoader)))
        if is_brief({key: each for key, each in scene.items() if key not in ("name", "about")}):
            raise ValueError("this scene is in brief: prove the one that `expand` writes of it")
        self.folder, self.tables = os.path.dirname(name), appended[0]["tables"] if appended else {}
        self.parts = {part: dict(rows_of(scene.get(part))) for part in PARTS}
        self.sections, self.mats, self.lias = (self.parts[part] for part in ("sections", "mats", "lias"))
        for part, elements in self.parts.items():
            for keys in elements.values():
                keys.update({**DEFAULTS[part], **keys})
        self.gestural_hz = float(gestural_hz or scene.get("gestural_rate", 3000))
        self.ratio = min(max(1, math.floor(1 / frame / self.gestural_hz + 0.5)), MOST_FRAMES)
        self.only = next(iter(self.sections)) if len(self.sections) == 1 else None
        self.grids, self.tuned = {}, {}  # of grids the section, columns and rows; strings with a frequency
        for keys in scene.get("generators") or []:
            if "pitch" in keys or keys["type"] in ("resonator", "frets", "barrier", "bridge"):
                raise ValueError(f"{keys['name']}: what a body with a pitch, or what stops or carries a string, "
                                 "is made of is not worked out here")
            getattr(self, "add_" + keys["type"])(keys["name"], {"section": self.only, **keys})
        for keys in self.sections.values():
            keys["modes"] = "no" if keys.get("modes", "all") == "all" else "some"
        for keys in self.mats.values():
            self.complete_mat(keys)
        for keys in self.lias.values():
            self.complete_lia(keys)
        for name, keys in rows_of(scene.get("agents")):
            self.add_agent(name, keys)
        for name, keys in rows_of(scene.get("ports")):
            if "filter" in keys:
                self.add_port_filter(name, keys["mat"], keys["filter"])
        for _, keys in rows_of(scene.get("inputs")):
            self.end_at(keys["mat"])
        for _, keys in rows_of(scene.get("outputs")):
            if self.grids.get(keys["at"].partition("@")[0], (0, 0, 1))[2] > 1:  # on a string it needs no point
                self.end_at(keys["at"])

    def add_mat(self, name, kind, section, **keys):
        self.mats[name] = {**DEFAULTS["mats"], "type": kind, "section": section, **keys}

    def add_lia(self, name, between, **keys):
        self.lias[name] = {**DEFAULTS["lias"], "type": "spring_damper", "between": between, **keys}

    def size_of(self, section):
        return AXES[self.sections[section]["geometry"]]

    def scheme_of(self, keys):
        """Of what a generator makes; what is linear is explicit."""
        turns = self.size_of(keys["section"]) > 1 and scaled(keys.get("damping", "0"), 1.0).partition("*")[0] != "0.0"
        return keys.get("scheme", "auto") if float(keys.get("rest_length_ratio", 0)) or turns else "explicit"

    def rest_length(self, keys, length):
        return repr(float(keys.get("rest_length_ratio", 0)) * float(length))

    def add_string(self, name, keys):
        count, section, is_coarse = int(keys["masses"]), keys["section"], keys.get("coarse") == "true"
        loss, damping, ends = keys.get("loss"), keys.get("damping", "0"), (0, count + 1)
        first, last = (vector(keys.get(end), self.size_of(section)) for end in ("from", "to"))
        self.grids[name] = section, count + 2, 1
        if "frequency" in keys and not is_coarse:
            self.tuned[name] = keys
        for i in range(count + 2):
            kind = "ground" if i in ends else "cell" if loss else "mass"
            self.add_mat(f"{name}.{i}", kind, section, mass=keys["mass"], damping=loss or "0",
                         lies=first + i / (count + 1) * (last - first))
        length = np.linalg.norm(last - first) / (count + 1)
        pairs = [(i, i + 1) for i in range(count + 1)]
        if is_coarse:
            pairs += [(i, i + 2) for i in range(count)] + [(i, i + 3) for i in range(count - 1)]
            pairs += [(0, 1), (0, 2), (1, 2), (count + 1, count), (count + 1, count - 1), (count, count - 1)]
        for i, pair in enumerate(pairs):
            self.add_lia(f"{name}.link.{i}", [f"{name}.{end}" for end in pair], stiffness=keys.get("stiffness"),
                         damping=damping if i <= count else "0", scheme=self.scheme_of(keys),
                         rest_length=self.rest_length(keys, length))

    def add_mesh(self, name, keys):
        rows, columns, spacing = int(keys["rows"]), int(keys["columns"]), float(keys["spacing"])
        section, edges = keys["section"], keys.get("edges", "fixed")
        self.grids[name] = section, columns, rows
        is_held = {"fixed": lambda *sides: any(sides), "corners": lambda *sides: all(sides),
                   "free": lambda *sides: False}[edges]
        mats = {(row, column): "ground" if is_held(row in (0, rows - 1), column in (0, columns - 1)) else "mass"
                for row in range(rows) for column in range(columns)}
        start = vector(keys.get("at"), 3)
        lies = {at: (start + spacing * np.array([*at[::-1], 0]))[:self.size_of(section)] for at in mats}
        for (row, column), kind in mats.items():
            self.add_mat(f"{name}.{row}.{column}", kind, section, mass=keys["mass"], lies=lies[row, column])
        diagonal, number = keys.get("diagonal_stiffness", scaled(keys["stiffness"], 0.25)), itertools.count()
        for at, (down, right) in itertools.product(mats, NEAREST):
            other, is_diagonal = (at[0] + down, at[1] + right), down != 0 != right
            if other in mats and "mass" in (mats[at], mats[other]) and (
                    not is_diagonal or keys.get("neighbours") == "8"):
                self.add_lia(f"{name}.link.{next(number)}", [f"{name}.{row}.{column}" for row, column in (at, other)],
                             stiffness=diagonal if is_diagonal else keys["stiffness"],
                             damping=keys.get("damping", "0"), scheme=self.scheme_of(keys),
                             rest_length=self.rest_length(keys, np.linalg.norm(lies[at] - lies[other])))

    def add_chaplet(self, name, keys):
        """Of two masses, tuned to the gestural rate that is wanted."""
        before, nyquist = keys["from"], math.pi * self.gestural_hz
        for i, (stiffness, damping, mass) in enumerate(CHAPLET):
            self.add_mat(f"{name}.{i}", "mass", keys["section"], mass=scaled(keys["mass"], mass))
            self.add_lia(f"{name}.link.{i}", [before, f"{name}.{i}"], scheme="explicit",
                         stiffness=scaled(keys["mass"], stiffness * nyquist * nyquist),
                         damping=scaled(keys["mass"], damping * nyquist))
            before = f"{name}.{i}"

    def complete_mat(self, keys):
        if keys["type"] == "tap":
            of, weights = ([keys.get(key, [])] if isinstance(keys.get(key), str) else keys.get(key, [])
                           for key in ("of", "weights"))
            keys.update(type="point", section=self.mats[of[0]].get("section", self.only),
                        weights=dict(zip(of, map(float, weights or [1 / len(of)] * len(of)))))
        if "section" not in keys:
            keys["section"] = self.grids[keys["along"]][0] if keys["type"] == "point" else self.only
        if keys["type"] in ("mass", "cell", "ground") and "lies" not in keys:
            place = keys.get("x", keys.get("at")) if keys["type"] == "ground" else keys.get("at")
            keys["lies"] = vector(place, self.size_of(keys["section"]))

    def complete_lia(self, keys):
        """Its ends, and what follows from other numbers."""
        keys.update(type=WORDS.get(keys["type"], keys["type"]), between=list(map(self.end_at, keys["between"])))
        if keys["type"] == "relaxing" and "branches" not in keys:
            eta = float(keys.pop("loss_factor", 0) or MATERIALS[keys.pop("material", "felt")])
            keys["branches"] = [[scaled(keys["stiffness"], eta * math.exp(a + eta * (b + eta * c))), repr(
                1 / (2 * math.pi * math.exp(d + eta * (e + eta * f))))] for (a, b, c), (d, e, f) in CONSTANT_LOSS]
        keys["scheme"] = None if keys.get("scheme") == "auto" else keys.get("scheme")
        keys.setdefault("release", keys.get("engage"))
        for key in keys.keys() & {"table", "elastic", "viscous"}:
            if "file" in keys[key]:
                keys[key] = {**keys[key], "points": self.points_of(keys[key]["file"])}
        if keys["type"] in ("clipped_cubic", "cubic_contact"):
            k, q, limit = (float(keys[key]) for key in ("stiffness", "nonlinearity", "stiffness_limit"))
            if q and k < limit:
                keys.update(tipping_point=repr(math.sqrt((limit - k) / q)), limit_damping="0")
            else:
                keys.update(type="contact" if keys["type"] == "cubic_contact" else "spring_damper",
                            stiffness=repr(limit if q else k))

    def points_of(self, file):
        """Those of a table beside the scene, or appended to its text."""
        if file not in self.tables:
            lines = [line.partition("#")[0] for line in open(os.path.join(self.folder, file), encoding="utf-8-sig")]
            self.tables[file] = [line.replace(",", " ").split() for line in lines if line.strip()]
        return self.tables[file]

    def end_at(self, said):
        """A module by its name, or what lies at `grid@along` or `grid@along:across`."""
        grid, _, place = said.partition("@")
        if not place:
            return said
        section, columns, rows = self.grids[grid]
        at = place.split(":")
        exact = [float(each) * (count - 1) for each, count in zip(at, (columns, rows))]
        if all(abs(each - round(each)) <= 1e-9 for each in exact):
            return ".".join([grid, *(str(round(each)) for each in reversed(exact))])
        name = f"{grid}@" + ":".join(f"{float(each):.12g}" for each in at)
        if name not in self.mats:
            self.add_mat(name, "point", section, along=grid, at=at if rows > 1 else place)
        return name

    def add_agent(self, name, keys):
        mat, gestural = self.end_at(keys["mat"]), [s for s, of in self.sections.items() if of["rate"] == "gestural"]
        own = self.mats[mat]["section"]
        home = own if own in gestural else next(iter(gestural), None)
        self.add_mat(f"{name}.target", "slice", keys.get("section", home))
        self.add_lia(f"{name}.hand", [f"{name}.target", mat], scheme="explicit", **{
            key: keys[key] for key in ("stiffness", "damping", "filter") if key in keys})

    def add_port_filter(self, port, hand, keys):
        """All that is on the hand hangs on a mass then."""
        name, section = f"{port}.filter", self.mats[hand]["section"]
        mass, ratio = float(keys["mass"]), float(keys.get("damping_ratio", 0.7))
        omega = 2 * math.pi * float(keys["frequency"])
        loss, is_straight = 2 * ratio * mass * omega, self.size_of(section) == 1
        for each in self.lias.values():
            each["between"] = [name if end == hand else end for end in each["between"]]
        self.add_mat(name, "mass", keys.get("section", section), mass=keys["mass"])
        self.add_lia(name, [name, hand], scheme="explicit", stiffness=repr(mass * omega * omega),
                     damping=repr(loss if is_straight else 0.0))
        if loss and not is_straight:
            self.add_lia(f"{name}.damper", [name, hand], type="bow", scheme="explicit",
                         table={"points": [["-1000", repr(-1000 * loss)], ["1000", repr(1000 * loss)]]})

    def span_of(self, said):
        number, dollar, name = said.rpartition("$")
        ends = [float(end) for end in self.parts["parameters"][name.strip()]["range"]] if dollar else [float(said)]
        factor = float(number.strip().rstrip("*") or 1) if dollar else 1.0
        return sorted(factor * end for end in (ends[0], ends[-1]))

    def lines_of(self, said, allowed, moves, count):
        """Lines of a grid that a place can lie between; the place if it stays."""
        low, high = (min(max(end, allowed[0]), allowed[1]) for end in (allowed if moves else self.span_of(said)))
        if low == high or count < 2:
            return [low]
        last = math.ceil(high * (count - 1))
        return [line / (count - 1) for line in range(math.floor(low * (count - 1)), last + 1)]

    def places_of(self, name):
        """Of a point all that are judged: names of modules with weights."""
        keys = self.mats[name]
        if "weights" in keys:
            return [{m: weight for m, weight in keys["weights"].items() if weight}]
        (_, columns, rows), at = self.grids[keys["along"]], keys["at"]
        along, across = at if rows > 1 else (at, "0")
        guides, ranges = keys.get("guide", "~"), keys.get("range", "~")
        guides = guides if isinstance(guides, list) else [guides, "~"]
        ranges = ranges if any(isinstance(each, list) for each in ranges) else [ranges, "~"]
        lines = [self.lines_of(said, [float(end) for end in allowed] if isinstance(allowed, list) else (0.0, 1.0),
                               isinstance(guide, dict), count)
                 for said, allowed, guide, count in zip((along, across), ranges, guides, (columns, rows))]
        return [self.around(keys["along"], x, y) for x in lines[0] for y in lines[1]]

    def around(self, grid, *place):
        _, columns, rows = self.grids[grid]
        sides = []
        for fraction, count in zip(place, (columns, rows)):
            index = min(max(fraction, 0.0), 1.0) * (count - 1)
            lower = max(min(int(index), count - 2), 0)
            sides.append({lower + 1: index - lower, lower: 1.0 - (index - lower)} if count > 1 else {0: 1.0})
        return {f"{grid}.{row}.{column}" if rows > 1 else f"{grid}.{column}": right * down
                for column, right in sides[0].items() for row, down in sides[1].items()}
