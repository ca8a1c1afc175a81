# SPDX-License-Identifier: BSD-3-Clause
"""Every law of force, with coefficients that suit the elements it joins."""
from random_scene.dice import SPEED, Dice, rounded

ELASTIC = ("spring", "spring_damper", "quadratic", "cubic", "clipped_cubic", "table")
CONTACTS = ("contact", "power_contact", "cubic_contact", "felt")
FRICTION = ("bow", "smooth_bow", "damper", "friction")
ACTIVE = ("pluck", "conditional", "one_way_pluck")
LAWS = ELASTIC + CONTACTS + FRICTION + ACTIVE + ("relaxing",)
ALWAYS_EXPLICIT = ("spring", "spring_damper", "damper", "relaxing") + ACTIVE


class Laws(Dice):
    def law(self, kind, unit, length=0.0, soft=False):
        """Keys of a link, with its scheme."""
        scheme = "explicit" if kind in ALWAYS_EXPLICIT else self.pick("auto", "auto", "energy_stable",
                                                                      "explicit")
        if kind == "friction" and scheme == "explicit":
            scheme = "energy_stable"
        stiff = self.between(0.01, 0.05) * unit.full
        if scheme == "energy_stable" and not soft:
            stiff *= self.between(1, 30)
        damping = self.between(1e-4, 1e-2) * unit.mass / unit.step
        keys = getattr(self, "law_" + kind)(unit, stiff, damping)
        if length > 0 and kind in ELASTIC + ACTIVE + ("relaxing",):
            keys["rest_length"] = rounded(length)
        if length > 0 and kind in CONTACTS:
            keys["threshold"] = rounded(length - 0.1 * unit.reach)
        may_choose = kind == "friction" or "viscous" not in keys and "table" not in keys
        if kind not in ALWAYS_EXPLICIT and may_choose:
            keys["scheme"] = scheme
        elif self.chance(0.5):
            keys["scheme"] = self.pick("auto", "explicit")
        return {"type": kind, **keys}

    def law_spring(self, unit, stiff, damping):
        return {"stiffness": self.value(stiff)}

    def law_damper(self, unit, stiff, damping):
        return {"damping": self.value(damping)}

    def law_spring_damper(self, unit, stiff, damping):
        return {"stiffness": self.value(stiff), "damping": self.value(damping)}

    def law_contact(self, unit, stiff, damping):
        return {"stiffness": self.value(stiff), "damping": self.value(damping)}

    def law_power_contact(self, unit, stiff, damping):
        exponent = rounded(self.within(2.1, 3) if self.chance(0.2) else self.within(1, 3))
        return {"stiffness": self.value(stiff * unit.reach ** (1 - exponent)),
                "exponent": self.value(exponent) if exponent > 2.1 else exponent,
                "damping": self.value(damping)}

    def law_felt(self, unit, stiff, damping):
        exponent = rounded(self.within(1, 3))
        return {"stiffness": self.value(stiff * unit.reach ** (1 - exponent)), "exponent": exponent,
                "damping": self.value(self.within(0.05, 0.5) / SPEED)}

    def law_quadratic(self, unit, stiff, damping):
        return {"stiffness": self.value(stiff), "damping": self.value(damping),
                "nonlinearity": self.value(0.1 * stiff / unit.reach)}

    def law_cubic(self, unit, stiff, damping):
        return {"stiffness": self.value(stiff), "damping": self.value(damping),
                "nonlinearity": self.value(0.1 * stiff / unit.reach ** 2)}

    def law_clipped_cubic(self, unit, stiff, damping):
        return {"stiffness": rounded(stiff), "stiffness_limit": rounded(2 * stiff),
                "nonlinearity": rounded(stiff / unit.reach ** 2), "damping": self.value(damping)}

    law_cubic_contact = law_clipped_cubic

    def law_pluck(self, unit, stiff, damping):
        if self.chance(0.3):
            return {"table": self.table(2 * unit.reach, -0.1 * stiff * unit.reach)}
        return {"stiffness": self.value(stiff), "width": self.value(3 * unit.reach),
                "damping": self.value(damping)}

    def law_bow(self, unit, stiff, damping):
        if self.chance(0.3):
            return {"table": self.table(SPEED, 5 * damping * SPEED)}
        return {"damping": self.value(5 * damping), "width": self.value(SPEED)}

    def law_smooth_bow(self, unit, stiff, damping):
        return {"damping": self.value(5 * damping), "width": self.value(SPEED)}

    def law_relaxing(self, unit, stiff, damping):
        keys = {"stiffness": self.value(stiff), "damping": self.value(damping)}
        return {**keys, **self.pick({"material": self.pick("felt", "nylon", "gut", "wood")},
                                    {"branches": [[self.value(0.3 * stiff), rounded(self.between(1, 300) * unit.step)]]})}

    def law_friction(self, unit, stiff, damping):
        keys = {"normal": self.value(damping * SPEED)}
        if self.chance(0.3):
            return {**keys, "table": {"points": [[0, 1.2], [rounded(0.1 * SPEED), 0.5], [SPEED, 0.3]]}}
        keys["steady"] = rounded(self.within(0, 0.5))
        parts = [[rounded(self.within(0.1, 1)), rounded(SPEED * self.between(1e-2, 1))]
                 for _ in range(self.random.randint(0, 2))]
        return {**keys, "parts": parts} if parts else keys

    def law_table(self, unit, stiff, damping):
        keys = {"elastic": self.table(2 * unit.reach, 2 * stiff * unit.reach),
                "viscous": self.table(SPEED, damping * SPEED)}
        if self.chance(0.5):
            keys.pop(self.pick("elastic", "viscous", "viscous"))
        return keys

    def law_one_way_pluck(self, unit, stiff, damping):
        if self.chance(0.3):
            return {"release_force": self.value(stiff * unit.reach), "stiffness": rounded(stiff)}
        return {"stiffness": self.value(stiff), "width": self.value(2 * unit.reach),
                "damping": self.value(damping)}

    def law_conditional(self, unit, stiff, damping):
        engage = rounded(2 * unit.reach)
        return {"stiffness": self.value(stiff), "damping": self.value(damping), "engage": engage,
                "release": rounded(self.within(1, 3) * engage)}

    def table(self, width, height):
        half = [(0.3 * width, 0.4 * height), (0.7 * width, 0.8 * height), (width, height)]
        points = [[-x, -y] for x, y in reversed(half)] + [[0.0, 0.0]] + [list(p) for p in half]
        smooth = self.chance(0.5)
        self.features["table smooth" if smooth else "table linear"] += 1
        return {"points": rounded(points), "interpolation": "monotone" if smooth else "linear"}

    def link(self, a, b, law):
        self.parts["lias"][self.name("lias", "l")] = {"between": [a, b], **law}
        self.features["link " + law["type"]] += 1
