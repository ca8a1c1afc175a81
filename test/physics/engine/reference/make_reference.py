#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes bow_periods.hpp: stick-slip periods of a bowed mass, by integration to 1e-13.

  m x'' = -k x - c x' + F(v_bow - x'),  F(v) = N sqrt(2 a) v exp(-a v^2 + 1/2)

from x = 0 at the speed of the bow, with Dormand and Prince's pair of orders 5 and 4 (1980,
J. Comput. Appl. Math. 6(1)). A period is the time between two moments at which the mass turns
around at its far end; the last 20 of 60 are averaged. Plain Python 3, takes some seconds:

  python3 make_reference.py > bow_periods.hpp
"""
import math

MASS = 1e-3
FREQUENCY = 200.0
DAMPING_RATIO = 0.01
BOW_SPEED = 0.2
BOW_FORCE = 0.5
TOLERANCE = 1e-13

W = 2 * math.pi * FREQUENCY
STAGES = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
FOURTH = (5179 / 57600, 0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40)


def acceleration(a, x, v):
    slip = BOW_SPEED - v
    force = BOW_FORCE * math.sqrt(2 * a) * slip * math.exp(-a * slip * slip + 0.5)
    return -W * W * x - 2 * DAMPING_RATIO * W * v + force / MASS


def step(a, x, v, h):
    """State after h, and its error in units of the tolerance."""
    kx, kv = [v], [acceleration(a, x, v)]
    for row in STAGES:
        nx = x + h * sum(b * k for b, k in zip(row, kx))
        nv = v + h * sum(b * k for b, k in zip(row, kv))
        kx.append(nv)
        kv.append(acceleration(a, nx, nv))
    ex = abs(nx - x - h * sum(b * k for b, k in zip(FOURTH, kx)))
    ev = abs(nv - v - h * sum(b * k for b, k in zip(FOURTH, kv)))
    return nx, nv, max(ex * W, ev) / (TOLERANCE * BOW_SPEED)


def turning(a, x, v, h):
    """Time after which v falls through 0 within a step of length h, by bisection."""
    low, high = 0.0, h
    for _ in range(60):
        middle = (low + high) / 2
        if step(a, x, v, middle)[1] > 0:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def period(a, count=60, averaged=20):
    x, v, t, h = 0.0, BOW_SPEED, 0.0, 1e-7
    turns = []
    while len(turns) < count:
        nx, nv, error = step(a, x, v, h)
        if error > 1:
            h *= max(0.2, 0.9 * error ** -0.2)
            continue
        if v > 0 >= nv and nx > 0:
            turns.append(t + turning(a, x, v, h))
        x, v, t = nx, nv, t + h
        h *= min(3.0, 0.9 * max(error, 1e-10) ** -0.2)
    return (turns[-1] - turns[-1 - averaged]) / averaged


def main():
    print("// SPDX-License-Identifier: BSD-3-Clause")
    print("// Written by make_reference.py; see there for the model.")
    print("#pragma once\n")
    print("namespace ergotic::physics::reference {\n")
    print("struct BowPeriod {")
    print("  double steepness;  ///< a, s^2/m^2")
    print("  double period_s;")
    print("};")
    print("constexpr BowPeriod kBowPeriods[] = {")
    for a in (100.0, 1000.0, 10000.0):
        print(f"    {{{a:.1f}, {period(a):.10e}}},")
    print("};\n")
    print("}  // namespace ergotic::physics::reference")


if __name__ == "__main__":
    main()
