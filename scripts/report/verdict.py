# SPDX-License-Identifier: BSD-3-Clause
"""What checks came to."""


class Verdict:
    """Prints a line per check; fails if one of them fails."""

    def __init__(self):
        self.passed = True

    def check(self, what, ok, detail):
        self.passed &= bool(ok)
        print(f"{'PASS' if ok else 'FAIL'}  {what}: {detail}")
