# SPDX-License-Identifier: BSD-3-Clause
"""What is thrown, and where: numbers, parameters, sections."""
import collections
import math
import random

DIMENSIONS = {"scalar": 1, "line": 1, "plane": 2, "space": 3}
SPEED = 0.5  # m/s of what strikes

# Of a section's elements: step in s, kg, N/m of kappa = 1, and how far they go in m.
Unit = collections.namedtuple("Unit", "step mass full reach")


def rounded(value):
    """Four digits, as people write them."""
    if isinstance(value, (list, tuple)):
        return [rounded(each) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


class Dice:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.parts = {key: {} for key in ("parameters", "sections", "mats", "lias", "ports", "agents",
                                          "inputs", "outputs")}
        self.sets, self.features = {}, collections.Counter()
        self.may_follow = True  # parameters
        self.rate_hz = self.pick(44100, 44100, 44100, 48000, 32000)
        self.ratio = self.pick(1, 4, 8, 12, 14, 16, 24)
        self.chain = self.divisors()

    def chance(self, share):
        return self.random.random() < share

    def pick(self, *choices):
        return self.random.choice(choices)

    def within(self, low, high):
        return self.random.uniform(low, high)

    def between(self, low, high):
        """Evenly over the orders of magnitude."""
        return low * (high / low) ** self.random.random()

    def name(self, part, stem):
        return f"{stem}{len(self.parts[part])}"

    def value(self, number):
        """A constant, or now and then a parameter that is so much."""
        number = rounded(number)
        if not self.may_follow or number <= 0 or not self.chance(0.15):
            return number
        name = self.name("parameters", "p")
        self.features["parameter"] += 1
        ends = rounded([0.5 * number, 1.1 * number])
        self.parts["parameters"][name] = {"value": number, "range": ends}
        if self.chance(0.3):
            self.features["parameter set"] += 1
            self.sets[name] = rounded(self.within(*ends))
        if self.chance(0.3):
            self.parts["parameters"][name] = {"value": rounded(number / 2),
                                              "range": rounded([end / 2 for end in ends])}
            self.sets.pop(name, None)
            return f"2*${name}"
        return f"${name}"

    def divisors(self):
        """Each a multiple of the one before: any two sections can be joined."""
        chain = [1]
        for divisor in (2, 3, 4, 6, 7, 8, 12, 14, 16, 24, 32, 48):
            fits = self.ratio % divisor == 0 or divisor % self.ratio == 0
            if fits and divisor % chain[-1] == 0 and self.chance(0.6):
                chain.append(divisor)
        return [each for each in chain if self.ratio % each == 0 or each % self.ratio == 0]

    # Sections.

    def geometry(self):
        return self.pick("scalar", "scalar", "scalar", "line", "plane", "space")

    def section(self, geometry, **keys):
        name = self.name("sections", "at")
        divisor = self.random.choice([1, 1, 1] + self.chain)
        kinds = [{"divisor": divisor}] + (["auto"] if self.chance(0.3) else [])
        section = {"geometry": geometry, "rate": "audio" if divisor == 1 else self.pick(*kinds)}
        if divisor == self.ratio and self.chance(0.7):
            section["rate"] = "gestural"
        if self.chance(0.5):
            section["pose"] = {"position": [rounded(self.within(-1e-3, 1e-3)) for _ in range(3)],
                               "rotation": [rounded(self.within(-3, 3)) for _ in range(3)]}
        if self.chance(0.2):
            size = DIMENSIONS[geometry]
            gravity = [rounded(self.within(-9.81, 9.81)) for _ in range(size)]
            section["gravity"] = gravity if geometry != "scalar" else gravity[0]
        if self.chance(0.2):
            section["medium"] = self.value(1e-3)
        section.update(keys)
        self.parts["sections"][name] = section
        step = divisor / self.rate_hz
        mass = self.between(3e-4, 3e-3)
        unit = Unit(step, mass, mass / step ** 2, SPEED * step / math.sqrt(0.1))
        return name, unit

    def geometry_of(self, body):
        return self.parts["sections"][body.section]["geometry"]
