# SPDX-License-Identifier: BSD-3-Clause
"""What a proof says of laws of force and of modules by themselves, worked out from docs/physics.md alone."""
import math

import numpy as np
from scipy import interpolate
from scipy.sparse import csgraph

NEAR, BREATHES, LENDS = 30.0, 10.0, 1000.0  # 1/how near modes meet; of roots of energy that is kept, and that is lent
FADES, FADING = 10.0, 0.99 * (1 + 1e-9)  # more of what fades; what a period leaves of that


def slopes_of(table):
    """Lowest and highest; monotone tables are the cubic of Fritsch and Butland 1984."""
    x, y = np.array(table["points"] if table else [[0, 0], [1, 0]], dtype=float).T
    slopes = np.diff(y) / np.diff(x)
    if table and table["interpolation"] == "monotone":
        slope = interpolate.PchipInterpolator(x, y).derivative()
        turns = slope.derivative().roots(extrapolate=False)
        slopes = slope(np.concatenate([x, turns[np.isfinite(turns)]]))
    return min(slopes), max(slopes)


def value_of(table, at):
    """Held beyond its ends."""
    x, y = np.array(table["points"] if table else [[0, 0], [1, 0]], dtype=float).T
    is_smooth = table and table["interpolation"] == "monotone"
    return float(interpolate.PchipInterpolator(x, y)(np.clip(at, x[0], x[-1])) if is_smooth else np.interp(at, x, y))


def brakes(table):
    """Whether its force, but for what is there at rest, is against all that moves."""
    x, y = np.array(table["points"], dtype=float).T
    work = (y - value_of(table, 0.0)) * x
    return (np.diff(y) >= 0).all() or (work >= -1e-12 * abs(x * y).max()).all()


def push_out(tables):
    """Whether elastic and viscous force together, held beyond the ends, push outwards or drive."""
    lows, highs = [table[0][1] for table in tables], [table[-1][1] for table in tables]
    return any(low > high for low, high in zip(lows, highs)) or sum(lows) > 0 or sum(highs) < 0


def is_push(link, k, z, e0, still):
    """Whether -k (e - e0) - z v is what may be taken from a table, of which the rest then neither pushes outwards
    nor drives; still: its elongation while nothing moves."""
    elastic, viscous = link.get("elastic"), link.get("viscous")
    rest, near = value_of(viscous, 0.0), lambda a, b, most=0.0: math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9 * most)
    low, high = (y + rest for y in (elastic["points"][0][1], elastic["points"][-1][1])) if elastic else (rest, rest)
    if not near(z, 0.0 if viscous is None or brakes(viscous) else -slopes_of(viscous)[0]):
        return False
    if low <= high:
        return k >= 0 and near(k * e0, np.clip(0.0, low, high)) and (k > 0) == (low > 0 or high < 0)
    most = max(abs(y) for _, y in elastic["points"])
    return near(k, -slopes_of(elastic)[0]) and near(k * (e0 - still), value_of(elastic, still) + rest, most)


def relaxed(link, stiffness, span_of, step):
    """What a spring that remembers counts as, in steps of that length: what swings in two of them."""
    more = [(span_of(k)[1], step / 2 / time) for k, time in link.get("branches", [])]
    return stiffness[0], stiffness[1] + sum(k * math.tanh(x) / x for k, x in more)


def matched(slow, fast, square):
    """What a matched module loses and how it is pulled, at most; square: (w h)^2 of its swing."""
    root = math.sqrt(-square) if square < 0 else min(math.sqrt(square), math.pi)
    fade = slow if square > 0 and math.cos(root) < 0 else fast
    swing = (-math.exp(root - fade) * math.expm1(-root) ** 2 if square < 0 else  # 4 e^-fade sinh^2(root/2)
             4 * math.exp(-fade) * math.sin(root / 2) ** 2)
    return -math.expm1(-2 * fast), math.expm1(-fade) ** 2 + swing + math.exp(-2 * fast) - math.exp(-2 * fade)


def breathes(energy, form, turn, back):
    """|rows of G E^-1/2| |columns of E^1/2 G^-1| of what a period mixes, at most."""
    if np.linalg.eigvalsh(energy).min() <= 0:
        return math.inf
    root, most = np.linalg.cholesky(energy), 0.0
    count, block = csgraph.connected_components(turn, directed=False)
    for mixed in (block == i for i in range(count)):
        fades = abs(np.linalg.eigvals(turn[np.ix_(mixed, mixed)])).max() < FADING
        most = max(most, np.linalg.norm(np.linalg.solve(root, form[mixed].T), 2) * np.linalg.norm(
            root.T @ back[:, mixed], 2) / (FADES if fades else 1.0))
    return most


def meet(form, turn, back, stays, members, links, proof):
    """Whether a motion may become too many times as large: coordinate by coordinate, or by energy, of displacements and
    of what modules are about to move by, as the scheme keeps it at one rate (if positive), and without its cross."""
    of, n = [proof.modules[m] for m in members], len(members)
    springs = np.diag([m["K"][0] for m in of])
    for link in links:
        u = np.zeros(n)
        for sign, places in zip((1, -1), link["at"]):
            for module, weight in places[0]:
                u[members.index(module)] += sign * weight
        springs += link["K"][0] * np.outer(u, u)
    moves = np.diag([m["M"][0] / proof.step(m["divisor"]) ** 2 for m in of])
    kept, plain = (breathes(np.block([[springs, cross], [cross, moves]])[stays][:, stays], form, turn, back)
                   for cross in (springs / 2, 0 * springs))
    is_calm = plain < BREATHES if math.isinf(kept) else kept < BREATHES and plain < LENDS
    return not ((abs(form) @ abs(back)).diagonal().max() < NEAR and is_calm)
