#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sums what tests were excused for because the machine stood still (test/support/trials.hpp).

Each test counts alike, however often it tried. More than a third of them fails; of less than three
tests what one of them may have.
"""
import pathlib
import sys

SHARE = 1 / 3
OF_ONE = 0.75  # nine of twelve


def read(path):
    """[(name, tries, excused)]"""
    lines = path.read_text().splitlines() if path.exists() else []
    return [(name, int(tries), int(excused)) for name, tries, excused in (line.split("\t") for line in lines)]


def main():
    notes = read(pathlib.Path(sys.argv[1]))
    for name, tries, excused in notes:
        if excused:
            print(f"{name}: {excused} of {tries} tries excused")
    print(f"{sum(n[2] for n in notes)} of {sum(n[1] for n in notes)} tries excused in {len(notes)} tests")
    weight = sum(excused / tries for _, tries, excused in notes)
    if weight > max(OF_ONE, SHARE * len(notes)):
        sys.exit("error: more than a third: the machine stands still too often to be tested on")


if __name__ == "__main__":
    main()
