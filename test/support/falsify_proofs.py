#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""falsify_proofs.py FOLDER: lets scripts/check_proof verify all proofs in a folder (F.json of F.yaml), then
each of them with one number changed: as it is, and signed anew, so that only the equations and the scene can
tell, and with one left out. Says how many were verified and refused; exit code 1 if one was not as it must be."""
import copy
import hashlib
import importlib.machinery
import importlib.util
import json
import pathlib
import random
import sys

sys.dont_write_bytecode = True
SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
LOADER = importlib.machinery.SourceFileLoader("check_proof", str(SCRIPTS / "check_proof"))
check_proof = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_proof", LOADER))
LOADER.exec_module(check_proof)
from proof_text import digest  # noqa: E402


def numbers(tree, path=()):
    for key, child in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if isinstance(child, (dict, list)):
            yield from numbers(child, path + (key,))
        elif not (isinstance(child, str) or is_nowhere(tree, path, key)):
            yield path + (key,)


def is_nowhere(entry, path, key):
    """The place of an entry of a factor that is 0: it says the same elsewhere."""
    return "below" in path and key in (0, 1) and entry[2] == 0.0


def changed(value, dice):
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + dice.choice((1, -1))  # 0 to -1, too: of Python's lists the last
    return value * 1.1 if abs(value) > 1e-6 else value + 1.0


def falsified(proof, dice):
    false = copy.deepcopy(proof)
    *path, last = dice.choice(list(numbers(false)))
    part = false
    for key in path:
        part = part[key]
    part[last] = changed(part[last], dice)
    return false, f"{'/'.join(map(str, path))}/{last} changed"


def shortened(proof, dice):
    """Without one of the numbers that are not 0 of a module or link; those of what is not there count as 0."""
    short = copy.deepcopy(proof)
    places = [(each, key) for each in short["modules"] + short["links"] for key in sorted(each)
              if isinstance(each[key], (dict, float)) and each[key]]
    each, key = dice.choice(places)
    del each[key]
    return short, f"{key} of {each['name']} left out"


def signed(proof):
    proof = {key: value for key, value in proof.items() if key != "sha256"}
    return {**proof, "sha256": digest(proof, hashlib.sha256())}


def refusal(path, scene):
    """Empty: it is verified."""
    try:
        check_proof.main(str(path), str(scene))
    except SystemExit as refused:
        return str(refused)
    return ""


def main(folder):
    counts = dict.fromkeys(("verified", "refused", "refused though signed anew", "refused as shortened"), 0)
    faults = []
    for path in sorted(pathlib.Path(folder).glob("*.json")):
        scene, other = path.with_suffix(".yaml"), path.with_suffix(".false")
        reason = refusal(path, scene)
        counts["verified"] += not reason
        if reason:
            faults.append(f"{path.name} is {reason}")
        proof = json.loads(path.read_text())
        dice = random.Random(path.name)
        for falsify, signs, name in ((falsified, dict, "refused"), (shortened, signed, "refused as shortened"),
                                     (falsified, signed, "refused though signed anew")):
            false, where = falsify(proof, dice)
            other.write_text(json.dumps(signs(false)))
            reason = refusal(other, scene)
            counts[name] += bool(reason)
            if not reason:
                faults.append(f"{path.name} is taken for true with {where}")
    print(", ".join(f"{count} {name}" for name, count in counts.items()))
    sys.exit("\n".join(faults) or 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
