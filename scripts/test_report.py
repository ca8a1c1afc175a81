#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sums a run of scripts/test: usage: scripts/test_report.py RESULTS

RESULTS holds what ctest wrote, NAME.xml (JUnit) and NAME.log, and SHARD.json of each shard of a gtest
program, whose single tests are counted in place of the shard. Prints the live tests that needed more than
one try, the failed ones, and `N passed, N failed, N skipped`. Exit status 1 if a test failed, or none ran.
"""
import collections
import json
import re
import sys
import xml.etree.ElementTree
from pathlib import Path

STARTED = re.compile(r"^ *(?:\d+/\d+ )?Test +#\d+: (.+?) \.\.", re.MULTILINE)
PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"


def outcome_of(case):
    """Of an entry of JUnit."""
    if case.get("status") == "run":
        return PASSED
    return SKIPPED if case.find("skipped") is not None else FAILED


def tests_of_shard(path):
    """(name, outcome) of each test of a shard of a gtest program."""
    for suite in json.loads(path.read_text())["testsuites"]:
        for test in suite["testsuite"]:
            name = f"{path.stem.split('.')[0]}.{suite['name']}.{test['name']}"
            if "failures" in test:
                yield name, FAILED
            elif test["result"] == "SKIPPED":
                yield name, SKIPPED
            elif test["status"] == "RUN":
                yield name, PASSED


def tests_of_run(path):
    """(name, outcome) of each test of one call of ctest."""
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        outcome = outcome_of(case)
        shard = path.parent / f"{case.get('name')}.json"
        tests = list(tests_of_shard(shard)) if shard.exists() else []
        yield from tests
        if not tests or (outcome == FAILED and all(o != FAILED for _, o in tests)):
            yield case.get("name"), outcome  # not gtest, or one that ended before it could say so


def tries_of_run(log):
    """{name: tries} of the tests of one call of ctest that were tried more than once."""
    tries = collections.Counter(STARTED.findall(log.read_text(errors="replace")))
    return {name: count for name, count in tries.items() if count > 1}


def main():
    results = Path(sys.argv[1])
    tests = [test for path in sorted(results.glob("*.xml")) for test in tests_of_run(path)]
    retried = [(name, count) for log in sorted(results.glob("live*.log")) for name, count in tries_of_run(log).items()]
    if retried:
        print("live tests that needed more than one try:")
        for name, count in retried:
            print(f"  {count}  {name}")
    for name in [name for name, outcome in tests if outcome == FAILED]:
        print(f"failed: {name}")
    count = collections.Counter(outcome for _, outcome in tests)
    print(f"{count[PASSED]} passed, {count[FAILED]} failed, {count[SKIPPED]} skipped")
    sys.exit(0 if count[PASSED] > 0 and count[FAILED] == 0 else 1)


if __name__ == "__main__":
    main()
