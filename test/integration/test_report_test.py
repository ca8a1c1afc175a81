#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/test_report.py makes of what ctest and gtest wrote."""
import json
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/test_report.py"


def case(name, status="run", inside=""):
    return f'<testcase name="{name}" classname="{name}" time="0.1" status="{status}">{inside}</testcase>'


def test(name, **said):
    return {"name": name, "status": "RUN", "result": "COMPLETED", **said}


class TestReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)

    def write_run(self, name, *cases, log=""):
        (self.results / f"{name}.xml").write_text(f"<testsuite>{''.join(cases)}</testsuite>")
        (self.results / f"{name}.log").write_text(log)

    def write_shard(self, name, suite, *tests):
        (self.results / f"{name}.json").write_text(
            json.dumps({"testsuites": [{"name": suite, "testsuite": tests}]}))

    def report(self):
        run = subprocess.run([SCRIPT, self.results], text=True, stdout=subprocess.PIPE)
        return run.returncode, run.stdout

    def test_sums_tests(self):
        self.write_run("deterministic", case("scripts.build"),
                       case("a", "notrun", '<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>'))
        self.write_run("live", case("tgr.B"), case("tgr.C"))
        self.assertEqual(self.report(), (0, "3 passed, 0 failed, 1 skipped\n"))

    def test_counts_the_tests_of_a_shard_and_not_the_shard(self):
        self.write_run("deterministic", case("physics.0", "fail"), case("physics.1"))
        self.write_shard("physics.0", "StringTest", test("A"), test("B", failures=[{"failure": "it"}]),
                         test("OfAnotherShard", status="NOTRUN", result="SUPPRESSED"))
        self.write_shard("physics.1", "StringTest", test("C", result="SKIPPED"))
        self.assertEqual(self.report(), (1, "failed: physics.StringTest.B\n1 passed, 1 failed, 1 skipped\n"))

    def test_a_shard_that_ends_without_a_word_has_failed(self):
        self.write_run("deterministic", case("physics.0", "fail"), case("physics.1", "fail"))
        self.write_shard("physics.1", "StringTest", test("A"))
        self.assertEqual(self.report(),
                         (1, "failed: physics.0\nfailed: physics.1\n1 passed, 2 failed, 0 skipped\n"))

    def test_tells_of_tests_that_were_tried_again(self):
        self.write_run("live", case("tgr.B with blanks"), case("tgr.C"), log="""
    Start 7: tgr.B with blanks
1/2 Test #7: tgr.B with blanks ................***Failed    0.03 sec
    Start 7: tgr.B with blanks
    Test #7: tgr.B with blanks ................   Passed    0.02 sec
    Start 8: tgr.C
2/2 Test #8: tgr.C ............................   Passed    0.02 sec
""")
        self.assertEqual(self.report(), (0, "live tests that needed more than one try:\n  2  tgr.B with blanks\n"
                                            "2 passed, 0 failed, 0 skipped\n"))

    def test_a_run_of_nothing_has_failed(self):
        self.assertEqual(self.report(), (1, "0 passed, 0 failed, 0 skipped\n"))


if __name__ == "__main__":
    unittest.main()
