#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What lab/scripts/latency makes of the numbers of cyclictest and of the station."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "scripts/latency"
LOADER = importlib.machinery.SourceFileLoader("latency", str(SCRIPT))
latency = importlib.util.module_from_spec(importlib.util.spec_from_loader("latency", LOADER))
LOADER.exec_module(latency)


def printed(function, *arguments):
    with contextlib.redirect_stdout(io.StringIO()) as text:
        function(*arguments)
    return text.getvalue()


class HistogramTest(unittest.TestCase):
    def setUp(self):
        self.histogram = latency.Histogram("late")
        self.histogram.add([1.0, 2.0, 100.0], [50, 49, 1], 95.0)

    def test_quantiles_are_ends_of_bins_but_not_beyond_the_longest(self):
        self.assertEqual(self.histogram.quantile(0.5), 1.0)
        self.assertEqual(self.histogram.quantile(0.99), 2.0)
        self.assertEqual(self.histogram.quantile(0.9999), 95.0)
        self.assertEqual(self.histogram.quantile(1.0), 95.0)
        self.assertEqual(latency.Histogram("none").quantile(0.5), 0.0)

    def test_turns_add_up(self):
        self.histogram.add([2.0, 3.0], [1, 2], 2.5)
        self.assertEqual(self.histogram.total(), 103)
        self.assertEqual(self.histogram.counts[2.0], 50)
        self.assertEqual(self.histogram.longest, 95.0)

    def test_shares_above_fall_to_zero(self):
        ends, shares = self.histogram.above()
        self.assertEqual(ends, [1.0, 2.0, 100.0])
        self.assertEqual(shares, [0.5, 0.01, 0.0])

    def test_every_duration_is_in_one_row(self):
        self.histogram.add([1e9], [3], 1e9)
        rows = printed(latency.print_histograms, [self.histogram]).splitlines()[2:]
        counts = [int(row.split("|")[2]) for row in rows]
        self.assertEqual(sum(counts), 103)
        self.assertEqual(counts[-1], 3)

    def test_quantiles_are_printed_with_their_share_of_the_period(self):
        text = printed(latency.print_quantiles, [self.histogram], 50.0)
        self.assertIn("| late | 1 (2 %) | 2 (4 %) | 95 (190 %) | 95 (190 %) | 100 |", text)


class ResultsTest(unittest.TestCase):
    def test_bin_n_of_cyclictest_ends_at_n_plus_1(self):
        histogram = latency.Histogram("cyclictest")
        latency.add_cyclictest(histogram, {"thread": {"0": {
            "histogram": {"7": 2, "12": 3}, "max": 12, "cycles": 5}}})
        self.assertEqual(histogram.counts, {8.0: 2, 13.0: 3})
        self.assertEqual(histogram.longest, 12.0)

    def test_what_cyclictest_left_out_is_counted_as_its_longest(self):
        histogram = latency.Histogram("cyclictest")
        latency.add_cyclictest(histogram, {"thread": {"0": {
            "histogram": {"7": 2}, "max": 5000, "cycles": 4}}})
        self.assertEqual(histogram.counts, {8.0: 2, 5001.0: 2})

    def test_histograms_of_the_station_go_by_their_names(self):
        histograms = {"wake_up": latency.Histogram("late"), "tick": latency.Histogram("whole")}
        part = {"up_to_us": [0.5, 1.5], "counts": [1, 2], "us": {"max": 1.4}}
        latency.add_station(histograms, {"wake_up": part, "tick": part})
        self.assertEqual(histograms["tick"].counts, {0.5: 1, 1.5: 2})
        self.assertEqual(histograms["wake_up"].longest, 1.4)


if __name__ == "__main__":
    unittest.main()
