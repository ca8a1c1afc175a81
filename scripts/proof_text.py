# SPDX-License-Identifier: BSD-3-Clause
"""Reads a proof: nothing in its text was changed, and its network is the one that the text of a scene says."""
import hashlib
import json
import math
import struct
import sys

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from proof_laws import brakes, is_push, slopes_of
from proof_scene import AXES, CHAPLET, DEFAULTS, PARTS, Said, axes_of, scaled

MOST_RAISED = 100  # modules of a section
SPRING, CLIPPED = "stiffness damping rest_length", "nonlinearity stiffness_limit tipping_point limit_damping "
KEYS = {  # what each word must say
    "mass": "mass", "cell": "mass stiffness damping matched", "spring_damper": SPRING,
    "quadratic": "nonlinearity " + SPRING, "cubic": "nonlinearity " + SPRING, "clipped_cubic": CLIPPED + SPRING,
    "contact": "stiffness damping threshold", "power_contact": "stiffness exponent damping threshold",
    "felt": "stiffness exponent damping threshold", "cubic_contact": CLIPPED + "stiffness damping threshold",
    "pluck": "width " + SPRING, "conditional": "engage release " + SPRING, "bow": "damping width",
    "smooth_bow": "damping width", "friction": "normal steady parts", "table": "rest_length",
    "bend": "weights " + SPRING, "relaxing": "branches " + SPRING, "ground": "", "driven": "", "slice": "", "point": ""}


def need(condition, reason):
    if not condition:
        sys.exit(f"refused: {reason}")


def digest(tree, to):
    """Of numbers the bits, as texts differ in how they write them."""
    for key, child in tree.items() if isinstance(tree, dict) else enumerate(tree):
        to.update(key.encode() + b"\0" if isinstance(key, str) else b"")
        if isinstance(child, (dict, list)):
            digest(child, to)
        else:
            to.update(child.encode() + b"\0" if isinstance(child, str) else struct.pack("<d", child))
    return to.hexdigest()


def matrix_of(entries, rows, columns=None):
    """Sparse, of its entries that are not 0."""
    i, j, values = zip(*entries) if entries else ((), (), ())
    return sparse.csc_matrix((values, (i, j)), (rows, columns or rows), dtype=float)


def ends_of(link, places, modules):
    """Of both ends all places, as modules with weights, without what no force moves; of a link of many
    ends these as one, linked to what does not move."""
    if "weights" in link:
        return [[[[m, w] for m, w in zip(link["between"], link["weights"]) if modules[m]["free"]]], [[]]]
    return [places.get(m, [[[m, 1.0]] if modules[m]["free"] else []]) for m in link["between"]]


def apart(a, b):
    """A place less another, each module once."""
    sums = {}
    for m, w in [*a, *((m, -w) for m, w in b)]:
        sums[m] = sums.get(m, 0.0) + w
    return [(m, w) for m, w in sums.items() if w]


def need_all_keys(proof):
    """A key that is left out would count as 0."""
    for each in proof["modules"] + proof["links"]:
        keys = KEYS[each["type"]].split()[:None if "table" not in each else each["type"] == "friction"]
        need(all(key in each for key in keys), f"{each['name']}: not all of its numbers are there")
        need(each["type"] != "table" or "elastic" in each or "viscous" in each, f"{each['name']}: no table")
    ends = [end for each in proof["links"] for end in each["between"]] + [at["module"] for at in proof["points"]]
    need(min(ends, default=0) >= 0, "an end that is no module")


def same(said, has):
    if said is None:  # not written anywhere
        return True
    if isinstance(has, dict) and "parameter" in has:
        factor, _, name = said.rpartition("$")
        return name.strip() == has["parameter"] and same(factor.strip().rstrip("*") or "1", has["times"])
    if isinstance(has, dict):
        return all(same(said.get(key, "linear"), has[key]) for key in has)
    if isinstance(has, list):
        return len(said) == len(has) and all(map(same, said, has))
    if isinstance(has, (str, bool)):
        return said == str(has) or said == str(has).lower()
    return "$" not in said and math.isclose(float(said), has, rel_tol=1e-12)


def times(value):
    return value["times"] if isinstance(value, dict) else value


def total(a, b):
    follows = next((v for v in (a, b) if isinstance(v, dict)), None)
    return {**follows, "times": times(a) + times(b)} if follows else times(a) + times(b)


def whole(spring, tension):
    """A guarded spring that is stretched is in two parts: one pulls at any length, the other rests at l."""
    both = {key: total(spring[key], tension[key]) for key in ("stiffness", "damping")}
    share = times(spring["stiffness"]) / (times(both["stiffness"]) or 1.0)
    return {**spring, **both, "rest_length": spring["rest_length"] * share}


class Comparison:
    """Each difference between a proof and what is said is a line."""

    def __init__(self, proof, said):
        self.proof, self.said, self.sections, self.modules = proof, said, proof["sections"], proof["modules"]
        self.mats, self.lias = ({each["name"]: each for each in proof[part]} for part in ("modules", "links"))
        self.divisors = [s["divisor"] for s in self.sections]
        self.points = {at["module"]: at["places"] for at in proof["points"]}

    def base_of(self, section):
        name = section["name"]
        return name if name in self.said.sections else name.removesuffix(".raised")

    def has_of(self, each):
        """By the words of scenes."""
        has = dict(each)
        if "section" in has:
            has["section"] = self.base_of(self.sections[has["section"]])
        if "between" in has:
            has["between"] = [self.modules[end]["name"] for end in has["between"]]
        if "geometry" in has:
            has = {"modes": "no", "axes": np.eye(3)[:AXES[has["geometry"]]], **has}
        return has

    def differences(self):
        for link in [name for name, keys in self.said.lias.items() if self.is_filtered(name, keys)]:
            yield from self.filter_of(link)
        for name, keys in self.said.tuned.items():
            self.tune(name, keys)
        for part, ours in PARTS.items():
            known, said = {each["name"]: self.has_of(each) for each in self.proof[ours]}, self.said.parts[part]
            if len(known) < len(self.proof[ours]):
                yield f"a name of {part} is there twice"
            if part in ("sections", "lias"):
                yield from self.whole_sections(known) if part == "sections" else self.whole_links(known)
            yield from (f"{name} of {part} is not in the proof" for name in said.keys() - known.keys())
            yield from (f"{name} of {part} is not in the scene" for name in known.keys() - said.keys())
            for name in sorted(said.keys() & known.keys()):
                yield from self.keys_of(name, said[name], known[name])
        for number, section in enumerate(self.sections):
            if not self.is_at_its_rate(number, section["divisor"]):
                yield f"{section['name']}: divisor is not {section['divisor']}"
        yield from self.places()

    def keys_of(self, name, said, has):
        tables = said.keys() & {"elastic", "viscous", "table"}
        said = said | {key: {"points": said[key]} for key in tables if isinstance(said[key], list)}
        for key in sorted(has.keys() - {"name", "divisor", "step", "axes"} | tables):
            if key not in said or key not in has or not same(said[key], has[key]):
                yield f"{name}: {key} is {said.get(key, 'not in the scene')}, not {has.get(key)}"
        scheme = has.get("scheme", "explicit")
        if scheme != "explicit" and not (scheme == "guarded" and self.is_guardable(has)):
            yield f"{name}: its scheme"
        if "axes" in has and not np.allclose(has["axes"], axes_of(said), rtol=0, atol=1e-12):
            yield f"{name}: it is turned otherwise"

    def tune(self, name, keys):
        """The springs of a string, unless what damps it follows a parameter: then its value counts, not its range."""
        section = self.mats[f"{name}.1"]["section"]
        medium, size = self.said.sections[keys["section"]]["medium"], self.said.size_of(keys["section"])
        (mass, most), *losses = (self.said.span_of(each) for each in (
            keys["mass"], keys["damping"] if size == 1 and "damping" in keys else "0", keys.get("loss", "0"), medium))
        if any(low != high or high and mass != most for low, high in losses):
            return
        step, count = self.divisors[section] * self.proof["frame"], int(keys["masses"])
        one = 4 * math.sin(math.pi / (2 * (count + 1))) ** 2
        (between, _), (own, _), (around, _) = losses
        zeta = one * between * step / mass - math.expm1(-(own + around) * step / mass)
        rho, share = math.sqrt(1 - zeta), 1 - float(keys.get("rest_length_ratio", 0)) * (size > 1)
        kappa = (zeta / (1 + rho)) ** 2 + 4 * rho * math.sin(math.pi * float(keys["frequency"]) * step) ** 2
        for i in range(count + 1):
            self.said.lias[f"{name}.link.{i}"]["stiffness"] = scaled(keys["mass"], kappa / (one * share * step ** 2))

    def whole_sections(self, known):
        """With what was raised out of them."""
        for number, section in enumerate(self.sections):
            base = self.base_of(section)
            if base != section["name"] and base in known:
                raised, left = ([self.stays(i) for i, m in enumerate(self.modules) if self.is_written(i)
                                 and self.sections[m["section"]]["name"] == name] for name in (section["name"], base))
                if any(raised) or not all(left) or not left:
                    yield f"{section['name']}: its modules"
                yield from self.keys_of(section["name"], self.said.sections[base], known.pop(section["name"]))

    def whole_links(self, known):
        """Without what settling has split off, which is added again, or linear and holds less than nothing."""
        for name in sorted(known.keys() - self.said.lias.keys()):
            stem, _, part = name.rpartition(".")
            if stem in known and stem in self.said.lias and part in ("tension", "push"):
                link, split = known[stem], known.pop(name)
                is_part = split["type"] == "spring_damper" and split["scheme"] == "explicit" and (
                    link["scheme"] == "guarded" and link["between"] == split["between"])
                if part == "tension":
                    is_part = is_part and self.is_stretched(link, split)
                    known[stem] = whole(link, split)
                else:
                    is_part = is_part and link["type"] == "table" and self.is_pushed(link, split)
                if not is_part:
                    yield f"{name}: it is no part of {stem}"
        for name, link in known.items():
            if link["scheme"] == "guarded" and link["type"] == "spring_damper" and (
                    f"{name}.tension" not in self.lias and self.is_tense(link)):
                yield f"{name}: what pulls at any length is not split off"

    def is_tense(self, link):
        """Where its ends rest, by more than rounding."""
        rest = link["rest_length"]
        return times(link["stiffness"]) != 0 if rest == 0 else rest < self.length_of(link) * (1 - 1e-9)

    def length_of(self, link):
        """Where its ends rest; NaN where they do not in the same section."""
        a, b = (self.said.mats[end] for end in link["between"])
        may_rest = a["section"] == b["section"] and "lies" in a and "lies" in b
        return np.linalg.norm(a["lies"] - b["lies"]) if may_rest else math.nan

    def is_stretched(self, link, split):
        a, b = (self.said.mats[end] for end in link["between"])
        is_straight = all(self.said.sections[end["section"]]["geometry"] == "line" for end in (a, b))
        is_slack = link["rest_length"] == times(link["stiffness"]) == 0
        return split["rest_length"] == 0 == times((link if is_straight else split)["damping"]) and (
            is_slack or math.isclose(link["rest_length"], self.length_of(link), rel_tol=1e-9))

    def is_pushed(self, link, split):
        still = np.subtract(*(self.said.mats[end].get("lies", [math.nan])[0] for end in link["between"]))
        return is_push(link, -times(split["stiffness"]), -times(split["damping"]),
                       split["rest_length"] - link["rest_length"], still - link["rest_length"])

    def is_filtered(self, link, keys):
        """By its own word, or by that of a slice, which may mean a filter or none."""
        couplings = {self.said.mats.get(end, {}).get("coupling") for end in keys["between"]}
        return keys.get("filter") == "auto" or (
            bool(couplings & {"chaplet", "auto"}) and f"{link}.filter.1" in self.mats)

    def filter_of(self, link):
        """Two masses before its slower end, in the section of the faster one or in their own."""
        said, name, keys = self.said, f"{link}.filter", self.said.lias[link]
        ends = [self.modules[end] for end in self.lias.get(link, {"between": []})["between"]]
        slow = [end for end, there in zip(keys["between"], ends) if there["name"] == f"{name}.1"]
        fast = [there for there in ends if there["name"] != f"{name}.1"]
        if len(slow) != 1 or len(fast) != 1 or slow[0] not in self.mats or (
                self.divisors[self.mats[slow[0]]["section"]] <= self.divisors[fast[0]["section"]]):
            yield f"{link}: its filter"
            return
        keys["between"] = [f"{name}.1" if end == slow[0] else end for end in keys["between"]]
        home, section = said.mats[slow[0]]["section"], self.base_of(self.sections[fast[0]["section"]])
        if any(s["name"] == name for s in self.sections):
            of, section = said.sections[home], name
            said.sections[name] = {**DEFAULTS["sections"], "geometry": of["geometry"], "pose": of.get("pose", {}),
                                   "modes": "no", "rate": {"divisor": self.divisors[fast[0]["section"]]}}
        for i, before in enumerate((slow[0], f"{name}.0")):
            said.add_mat(f"{name}.{i}", "mass", section, mass=None)
            said.add_lia(f"{name}.link.{i}", [before, f"{name}.{i}"], scheme="explicit", stiffness=None, damping=None)
        if f"{name}.ground" in self.mats:
            said.add_mat(f"{name}.ground", "ground", home)
            said.add_lia(f"{name}.dashpot", [slow[0], f"{name}.ground"], scheme="explicit", damping=None)

    def written_of(self, number):
        """The divisor that is written for a section, or what it is raised out of."""
        rate = self.said.sections[self.base_of(self.sections[number])]["rate"]
        return int(rate["divisor"]) if isinstance(rate, dict) else 1 if rate == "audio" else self.said.ratio

    def is_at_its_rate(self, number, divisor):
        """The one that is written; `auto` says that of a tick, or one that divides it; or a raised one."""
        base, ratio = self.base_of(self.sections[number]), self.said.ratio
        if base not in self.said.sections:
            return False
        rate, written = self.said.sections[base]["rate"], self.written_of(number)
        is_felt = any(m["type"] == "slice" and self.base_of(self.sections[m["section"]]) == base for m in self.modules)
        return divisor == written or rate == "auto" and not is_felt and ratio % divisor == 0 or (
            divisor < written and self.is_raised(number, divisor))

    def is_raised(self, number, divisor):
        """To the rate of what it is linked to, as a link that is not linear and is left open is joined to it."""
        own = [i for i, m in enumerate(self.modules) if m["section"] == number]
        beside = {self.modules[other]["section"] for l in self.joining() for end, other in (
            l["between"], l["between"][::-1]) if self.modules[end]["section"] == number and self.moved(end)}
        return sum(map(self.is_written, own)) <= MOST_RAISED and not any(map(self.stays, own)) and any(
            s != number and self.divisors[s] == divisor for s in beside) and not (
                self.opened().isdisjoint(own) or self.has_chaplet(own))

    def has_chaplet(self, own):
        """Whether one hangs on what explicit links join to these, at the rates that are written: it keeps them."""
        rates = [self.written_of(m["section"]) for m in self.modules]
        pairs = []
        for l in self.proof["links"]:
            a, b = sorted(l["between"], key=lambda end: rates[end])
            is_open = self.said.lias.get(l["name"], {"scheme": ""}).get("scheme") is None
            if l["scheme"] == "explicit" or is_open and rates[a] < rates[b] and self.moved(b):
                ends = [*self.moved(a), *self.moved(b)]
                pairs += [(ends[0], m, 1.0) for m in ends]
        bodies = csgraph.connected_components(matrix_of(pairs, len(self.modules)), directed=False)[1]
        return any(bodies[m] in bodies[own] and self.is_chaplet(m, rates) for m in range(len(self.modules)))

    def is_chaplet(self, first, rates):
        """Whether a mass is the first one of a chaplet, which hangs on something slower."""
        links = [l for l in self.proof["links"] if first in l["between"]]
        if len(links) != 2 or any(l["type"] != "spring_damper" for l in links):
            return False
        ends = [sum(l["between"]) - first for l in links]
        (hanging, slow), (between, last) = sorted(zip(links, ends), key=lambda each: -rates[each[1]])
        near = [times(v) for v in (hanging["stiffness"], hanging["damping"], self.modules[first].get("mass", 0.0))]
        far = [times(v) for v in (between["stiffness"], between["damping"], self.modules[last].get("mass", 0.0))]
        (k, z, m), (l, _, n) = CHAPLET
        return rates[slow] > rates[first] and far[1] == 0 and all(math.isclose(a, b, rel_tol=1e-5) for a, b in (
            (near[0] * l, far[0] * k), (near[2] * n, far[2] * m), ((near[1] / z) ** 2, near[0] * near[2] / (k * m))))

    def opened(self):
        """Modules that hang together with a link that is not linear and whose scheme is left open."""
        moved = [[m for end in l["between"] for m in self.moved(end)] for l in self.joining()]
        pairs = [(ends[0], m, 1.0) for ends in moved for m in ends]
        bodies = csgraph.connected_components(matrix_of(pairs, len(self.modules)), directed=False)[1]
        opening = [l for l in self.proof["links"] if (l["type"] != "spring_damper" or l["scheme"] == "guarded")
                   and self.said.lias.get(l["name"], {"scheme": ""}).get("scheme") is None]
        open_bodies = {bodies[m] for l in opening for end in l["between"] for m in self.moved(end)}
        return {i for i, m in enumerate(self.modules) if "mass" in m and bodies[i] in open_bodies}

    def joining(self):
        """Links that may be explicit, whatever the rates."""
        return [l for l in self.proof["links"] if self.said.lias.get(l["name"], {}).get("scheme") != "guarded"]

    def moved(self, end):
        places = self.points.get(end, [[[end, 1.0]]])
        return {m for place in places for m, _ in place if "mass" in self.modules[m]}

    def stays(self, i):
        """What can be felt, and what the samples of an input move, stays where a section is raised."""
        return self.modules[i]["type"] in ("slice", "driven")

    def is_written(self, i):
        return ".filter." not in self.modules[i]["name"]

    def is_guardable(self, link):
        """Neither a linear spring whose line does not turn, nor a table that drives what moves."""
        over = [self.said.sections[self.said.mats[end]["section"]]["geometry"] for end in link["between"]]
        is_straight = "scalar" in over or over == ["line", "line"]
        if link["type"] == "table":
            push = next((l for l in self.proof["links"] if l["name"] == f"{link['name']}.push"), {"damping": 0})
            return "viscous" not in link or brakes(link["viscous"]) or -times(push["damping"]) >= -slopes_of(
                link["viscous"])[0] * (1 - 1e-9)
        return link["type"] != "spring_damper" or link["rest_length"] > 0 or (
            times(link["damping"]) > 0 and not (is_straight and link["rest_length"] == 0))

    def places(self):
        """Of points."""
        has = {self.modules[at["module"]]["name"]: at for at in self.proof["points"]}
        points = {name for name, keys in self.said.mats.items() if keys["type"] == "point"}
        if len(has) < len(self.proof["points"]) or has.keys() != points:
            yield "its points are others"
        for name in sorted(has.keys() & points):
            if not same(self.said.mats[name]["power"], has[name]["power"]):
                yield f"{name}: power is {self.said.mats[name]['power']}, not {has[name]['power']}"
            if not self.are_same(self.said.places_of(name), has[name]["places"]):
                yield f"{name}: it lies elsewhere"

    def are_same(self, said, has):
        """Places, without modules that are not free."""
        named = [{self.modules[m]["name"]: weight for m, weight in place} for place in has]
        free = [{m: weight for m, weight in place.items() if "mass" in self.mats[m]} for place in said]
        return len(said) == len(has) and all(len(ours) == len(place) and all(
            math.isclose(a.get(m, 0.0), b.get(m, 0.0), rel_tol=0, abs_tol=1e-12) for m in a.keys() | b.keys())
            for ours, place, a, b in zip(named, has, free, named))


def need_scene(proof, name, gestural_hz):
    """It is of that text, and says what is written there; of `.mdl`, that nothing is turned, slower or led."""
    text = open(name, "rb").read()
    need(hashlib.sha256(text).hexdigest() == proof["scene"]["sha256"], "it is of another scene")
    if name.endswith(".mdl"):
        has = [(s["name"], s["divisor"], s["geometry"], s["medium"], len(s)) for s in proof["sections"]]
        led = any(len(at["places"]) > 1 for at in proof["points"])
        need(has == [("model", 1, "scalar", 0.0, 5)] and not led, "its section")
    else:
        others = list(Comparison(proof, Said(name, proof["frame"], gestural_hz)).differences())
        need(not others, "; ".join(others))


def read(path, scene=None, gestural_hz=None):
    """\return the proof; refuses it if it is not that of the scene"""
    proof = json.load(open(path))
    said = proof.pop("sha256")
    need(proof["proof"] == 1 and digest(proof, hashlib.sha256()) == said, "something in it was changed")
    need_all_keys(proof)
    if scene:
        need_scene(proof, scene, gestural_hz)
    return proof
