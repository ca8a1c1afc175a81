#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What lab/scripts/bench_faust compares: the nets, and what it says when something takes too long."""
import importlib.machinery
import importlib.util
import pathlib
import re
import shutil
import sys
import tempfile
import types
import unittest

import numpy

sys.dont_write_bytecode = True
SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "scripts/bench_faust"
LOADER = importlib.machinery.SourceFileLoader("bench_faust", str(SCRIPT))
bench_faust = importlib.util.module_from_spec(
    importlib.util.spec_from_loader("bench_faust", LOADER))
LOADER.exec_module(bench_faust)

LIMITS = types.SimpleNamespace(time_limit=60, memory_gb=8.0)


class NetTest(unittest.TestCase):
    def test_has_the_links_of_its_shape(self):
        self.assertEqual(bench_faust.string(3).links, [(-1, 0), (0, 1), (1, 2), (2, -1)])
        plate = bench_faust.plate(5)
        self.assertEqual((plate.masses, len(plate.links)), (25, 2 * 5 * 6))
        ends = [end for link in plate.links for end in link if end >= 0]
        self.assertEqual([ends.count(mass) for mass in range(25)], [4] * 25)

    def test_moves_one_mass_as_the_formula_says(self):
        net = bench_faust.string(1)
        stiffness, damping = 2 * bench_faust.KAPPA, 2 * bench_faust.ZETA
        self.assertEqual(net.modules, 3)
        roots = numpy.roots([1, stiffness + damping - 2, 1 - damping])
        n = numpy.arange(100)
        closed = numpy.imag(roots[0] ** n) / numpy.imag(roots[0])  # 0, 1, ...
        numpy.testing.assert_allclose(bench_faust.expected(net, 100), closed, atol=1e-12)

    def test_wires_every_end_of_every_link_in_faust_there_and_back(self):
        net = bench_faust.plate(3)
        routes = re.findall(r"route\((.*?)\)", bench_faust.dsp(net))
        self.assertEqual(len(routes), 2)
        for route in routes:
            inputs, outputs, *wires = [int(number) for number in route.split(",")]
            ends = 2 * len(net.links)
            self.assertEqual(len(wires), 2 * (ends + 2))
            self.assertLessEqual(max(wires[0::2]), inputs)
            self.assertLessEqual(max(wires[1::2]), outputs)


class LimitTest(unittest.TestCase):
    def complaint(self, command):
        limits = types.SimpleNamespace(time_limit=1, memory_gb=8.0)
        with self.assertRaises(bench_faust.Failed) as failure:
            bench_faust.timed(command, limits, "/")
        return str(failure.exception)

    def test_says_what_did_not_end_in_time(self):
        self.assertEqual(self.complaint(["sh", "-c", "while :; do :; done"]),
                         "sh did not end in 1 s")

    def test_says_what_took_too_much_memory(self):
        self.assertEqual(self.complaint(["sh", "-c", "echo std::bad_alloc >&2; exit 1"]),
                         "sh wanted more than 8 GB after 0 s")

    def test_says_what_failed_and_why(self):
        self.assertRegex(self.complaint(["ls", "/nowhere"]),
                         "ls failed after 0 s: .*nowhere")


@unittest.skipUnless(shutil.which("faust"), "faust is not installed")
class FaustTest(unittest.TestCase):
    def test_plays_the_same_net(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            net = bench_faust.plate(3)
            bench_faust.compile_with_faust(net, LIMITS, folder)
            bench_faust.require_same_motion(net, folder)
            open_edge = bench_faust.plate(3)
            open_edge.links.pop()
            with self.assertRaises(SystemExit):
                bench_faust.require_same_motion(open_edge, folder)


if __name__ == "__main__":
    unittest.main()
