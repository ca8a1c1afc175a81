#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/tools.md and lab/README.md against the tools: options, and what it shows of their reports.
usage: documents_test.py FOLDER_OF_TOOLS"""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TOOLS = pathlib.Path(sys.argv.pop())
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")


def sections():
    """{heading: text} of docs/tools.md and lab/README.md."""
    told = {}
    for page in ("docs/tools.md", "lab/README.md"):
        parts = re.split(r"^## (.+)$", (ROOT / page).read_text(), flags=re.MULTILINE)
        told.update(zip(parts[1::2], parts[2::2]))
    return told


def says(tool, *arguments):
    return subprocess.run([TOOLS / tool, *arguments], cwd=ROOT, check=True, capture_output=True,
                          text=True).stdout


def is_same(line, shown):
    """The same words, and numbers that agree to all but the last of the digits shown."""
    number = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
    if number.sub("#", line) != number.sub("#", shown):
        return False
    pairs = zip(number.findall(line), number.findall(shown))
    return all(abs(float(a) - float(b)) <= 2e-5 * abs(float(b)) + 1e-12 for a, b in pairs)


class ToolsTest(unittest.TestCase):
    def test_each_option_is_told_and_there(self):
        tools = [name for name in sections() if (TOOLS / name).exists()]
        self.assertGreaterEqual(len(tools), 6)
        for tool in tools:
            told = set(OPTION.findall(sections()[tool]))
            known = set(OPTION.findall(says(tool, "--help"))) - {"--help"}
            self.assertEqual(known, told, tool)

    def test_a_shown_report_is_what_check_says(self):
        for option in ("--verbose", "--reach"):
            shown = re.search(rf"`check (\S+) {option}` says.*?```yaml\n(.*?)```", sections()["check"], re.DOTALL)
            lines = says("check", shown.group(1), option).splitlines()
            for line in shown.group(2).splitlines():
                self.assertTrue(any(is_same(said, line) for said in lines), line)

    def test_every_tool_is_told(self):
        built = {path.name for path in TOOLS.iterdir() if path.is_file() and "test" not in path.name}
        self.assertEqual(built - {"guardian", "comedi_probe"}, built & set(sections()))


if __name__ == "__main__":
    unittest.main()
