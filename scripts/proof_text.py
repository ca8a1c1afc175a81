# SPDX-License-Identifier: BSD-3-Clause
"""Reads a proof: nothing in its text was changed, and the numbers that are written out in a scene, not made
by its generators, are those of the proof."""
import hashlib
import json
import math
import struct
import sys

import numpy as np
import yaml
from scipy import interpolate, sparse

DEFAULTS = {"sections": {"medium": "0"}, "lias": {"rest_length": "0", "threshold": "0", "damping": "0"},
            "mats": {"stiffness": "0", "damping": "0", "matched": "true"}, "parameters": {}}
WORDS = {"spring": "spring_damper", "damper": "spring_damper"}
SPRING, CLIPPED = "stiffness damping rest_length", "nonlinearity stiffness_limit tipping_point limit_damping "
KEYS = {  # what each word must say
    "mass": "mass", "cell": "mass stiffness damping matched", "spring_damper": SPRING,
    "quadratic": "nonlinearity " + SPRING, "cubic": "nonlinearity " + SPRING, "clipped_cubic": CLIPPED + SPRING,
    "contact": "stiffness damping threshold", "power_contact": "stiffness exponent damping threshold",
    "felt": "stiffness exponent damping threshold", "cubic_contact": CLIPPED + "stiffness damping threshold",
    "pluck": "width " + SPRING, "conditional": "engage release " + SPRING, "bow": "damping width",
    "smooth_bow": "damping width", "table": "rest_length", "ground": "", "driven": "", "slice": "", "point": ""}


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


def slopes_of(table):
    """Lowest and highest; monotone tables are the cubic of Fritsch and Butland 1984."""
    x, y = np.array(table["points"] if table else [[0, 0], [1, 0]], dtype=float).T
    slopes = np.diff(y) / np.diff(x)
    if table and table["interpolation"] == "monotone":
        slope = interpolate.PchipInterpolator(x, y).derivative()
        turns = slope.derivative().roots(extrapolate=False)
        slopes = slope(np.concatenate([x, turns[np.isfinite(turns)]]))
    return min(slopes), max(slopes)


def push_out(tables):
    """Whether elastic and viscous force together, held beyond the ends, push outwards or drive."""
    lows, highs = [table[0][1] for table in tables], [table[-1][1] for table in tables]
    return any(low > high for low, high in zip(lows, highs)) or sum(lows) > 0 or sum(highs) < 0


def matrix_of(entries, rows, columns=None):
    """Sparse, of its entries that are not 0."""
    i, j, values = zip(*entries) if entries else ((), (), ())
    return sparse.csc_matrix((values, (i, j)), (rows, columns or rows), dtype=float)


def need_all_keys(proof):
    """A key that is left out would count as 0."""
    for each in proof["modules"] + proof["links"]:
        keys = KEYS[each["type"]].split() if "table" not in each else []
        need(all(key in each for key in keys), f"{each['name']}: not all of its numbers are there")
        need(each["type"] != "table" or "elastic" in each or "viscous" in each, f"{each['name']}: no table")


def rows_of(part):
    """Names and keys, out of tables, too."""
    for name, keys in part.items():
        for row in keys.get("rows", [[]]):
            each = {**keys.get("with", {}), **dict(zip(keys.get("columns", []), row))}
            yield each.pop("name", name), each or keys


def same(said, has):
    if isinstance(has, dict) and "parameter" in has:
        factor, _, name = said.rpartition("$")
        return name == has["parameter"] and same(factor.rstrip("*") or "1", has["times"])
    if isinstance(has, dict):
        return "file" in said or all(same(said.get(key, "linear"), has[key]) for key in has)
    if isinstance(has, list):
        return len(said) == len(has) and all(map(same, said, has))
    if isinstance(has, (str, bool)):
        return said == str(has) or said == str(has).lower()
    return math.isclose(float(said), has, rel_tol=1e-12)


def has_of(proof, known):
    """By the words of scenes."""
    has = dict(known)
    if "section" in has:
        has["section"] = proof["sections"][has["section"]]["name"].removesuffix(".raised")
    if "between" in has:
        has["between"] = [proof["modules"][end]["name"] for end in has["between"]]
    return has


def times(value):
    return value["times"] if isinstance(value, dict) else value


def whole(spring, tension):
    """A guarded spring that is stretched is in two parts: one pulls at any length, the other rests at l."""
    def both(key):
        total = times(spring[key]) + times(tension[key])
        follows = next((v for v in (spring[key], tension[key]) if isinstance(v, dict)), None)
        return {**follows, "times": total} if follows else total
    share = times(spring["stiffness"]) / (times(both("stiffness")) or 1.0)
    return {**spring, "stiffness": both("stiffness"), "damping": both("damping"),
            "rest_length": spring["rest_length"] * share}


def differences(proof, text):
    """\\return what a scene says otherwise than its proof, one line each"""
    scene = yaml.load(text, yaml.BaseLoader)
    filtered = {port["mat"] for _, port in rows_of(scene.get("ports") or {}) if "filter" in port}
    for part, ours in (("parameters", "parameters"), ("sections", "sections"), ("mats", "modules"),
                       ("lias", "links")):
        known = {each["name"]: has_of(proof, each) for each in proof[ours]}
        for point in proof["points"] if part == "mats" else []:
            known[proof["modules"][point["module"]]["name"]]["power"] = point["power"]
        for name, keys in rows_of(scene.get(part) or {}):
            said = {"release": keys.get("engage"), **DEFAULTS[part], **keys}
            has = known.get(name, {})
            if name + ".tension" in known:
                has = whole(has, known[name + ".tension"])
            if "stiffness_limit" in keys and "tipping_point" in has:
                k, q, limit = (float(keys[key]) for key in ("stiffness", "nonlinearity", "stiffness_limit"))
                said.update(tipping_point=math.sqrt((limit - k) / q), limit_damping="0")
            is_open = {"scheme": said.get("scheme") == "auto", "section": has.get("type") == "point",
                       "between": "filter" in said or any(
                           "@" in end or end in filtered for end in said.get("between", []))}
            if said.get("type") == "point":
                said.setdefault("power", "1")
            said["type"] = WORDS.get(said.get("type"), said.get("type"))
            if name not in known:
                yield f"{name} of {part} is not in the proof"
            for key in sorted(said.keys() & has.keys()):
                if not is_open.get(key) and not same(said[key], has[key]):
                    yield f"{name}: {key} is {said[key]}, not {has[key]}"


def read(path, scene=None):
    """\return the proof; refuses it if it is not that of the scene"""
    proof = json.load(open(path))
    said = proof.pop("sha256")
    need(proof["proof"] == 1 and digest(proof, hashlib.sha256()) == said, "something in it was changed")
    need_all_keys(proof)
    if scene:
        text = open(scene, "rb").read()
        need(hashlib.sha256(text).hexdigest() == proof["scene"]["sha256"], "it is of another scene")
        others = [] if scene.endswith(".mdl") else list(differences(proof, text))
        need(not others, "; ".join(others))
    return proof
