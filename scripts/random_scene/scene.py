# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes that sound, with everything that docs/scene.md offers. One seed, one scene."""
import json

from random_scene.bodies import Bodies
from random_scene.dice import DIMENSIONS, SPEED, rounded
from random_scene.laws import CONTACTS

HAMMER = 0.003  # m from a hammer to what it strikes, where lengths count
ACROSS = ("spring_damper", "damper", "contact", "power_contact", "smooth_bow", "bow", "conditional")
TOUCHES = ("contact", "power_contact", "pluck", "spring_damper", "smooth_bow", "bow")


class Scene(Bodies):
    """text: YAML; sets: parameters that are not at their value; inputs: names; gesture: CSV or
    None; rate_hz; seconds; features: what is in it, counted."""

    def __init__(self, seed):
        super().__init__(seed)
        self.seconds = self.pick(0.2, 0.3, 0.4)
        self.gesture = None
        bodies = []
        for _ in range(self.random.randint(1, 4)):
            bodies += self.pick(self.string, self.string, self.mesh, self.net, self.net,
                                self.lattice, self.choir, self.modal, self.cells, self.sleeper,
                                self.bar)()
        for first, second in zip(bodies, bodies[1:]):
            if self.chance(0.5):
                self.join(first, second)
        if self.chance(0.6):
            self.play(bodies)
        for body in bodies:
            self.excite(body)
            self.hear(body)
        self.text = self.written()

    @property
    def inputs(self):
        return list(self.parts["inputs"])

    def section_of(self, body):
        return self.parts["sections"][body.section]

    def is_modal(self, body):
        return "modes" in self.section_of(body)

    def place(self, body):
        """A module, a tap on some of them, or a connection point."""
        if not self.is_modal(body) and self.chance(0.1):
            self.features["tap"] += 1
            of = self.random.sample(body.modules, min(len(body.modules), self.random.randint(1, 4)))
            return self.mat({"type": "tap", "of": of, "weights": [
                rounded(self.within(-1, 1)) for _ in of]}, "tap")
        if body.along is None or not self.chance(0.4):
            return self.random.choice(body.modules)
        self.features["point"] += 1
        across = "" if body.along.startswith("s") else f":{rounded(self.within(0.2, 0.8))}"
        return f"{body.along}@{rounded(self.within(0.1, 0.9))}{across}"

    def moving_point(self, body, guide):
        """A point that a parameter, or a hand, takes along a string, or about a mesh."""
        is_string = body.along.startswith("s")
        at = [self.value(rounded(self.within(0.3, 0.6))) for _ in range(1 if is_string else 2)]
        keys = {"type": "point", "along": body.along, "at": at[0] if is_string else at}
        if guide and self.chance(0.7):
            keys["guide"] = {"mat": guide, "scale": rounded(self.within(5, 30))}
            if not is_string and self.chance(0.5):
                keys["guide"] = [keys["guide"], {"mat": guide, "axis": "x", "scale": rounded(self.within(5, 30))}]
            self.features["guide"] += 1
        if self.chance(0.5):
            keys["range"] = [0.1, 0.9] if is_string or self.chance(0.5) else [[0.1, 0.9], [0.2, 0.7]]
        if self.chance(0.5):
            keys["speed"] = rounded(self.within(0.5, 5))
        self.features["moving point"] += 1
        return self.mat(keys, "point")

    def join(self, first, second):
        """By a law that takes any distance, as soft as the slower one wants it."""
        slower = max(first.unit, second.unit, key=lambda unit: unit.step)
        unit = slower._replace(mass=min(first.unit.mass, second.unit.mass))
        unit = unit._replace(full=unit.mass / unit.step ** 2)
        self.link(self.place(first), self.place(second),
                  self.law(self.pick(*ACROSS), unit, soft=True))
        self.features["rates joined" if first.unit.step != second.unit.step else "joined"] += 1

    # Hands.

    def hand_section(self):
        if "hands" not in self.parts["sections"]:
            self.parts["sections"]["hands"] = {
                "rate": "gestural", "geometry": self.pick("scalar", "scalar", "line", "plane")}
        return self.parts["sections"]["hands"]

    def hand_unit(self, body):
        step = max(self.ratio / self.rate_hz, body.unit.step)
        return body.unit._replace(step=step, full=min(body.unit.mass / step ** 2, 2e4))

    def play(self, bodies):
        """Slices that touch, and a gesture for them."""
        section, slices = self.hand_section(), self.random.randint(1, 3)
        for i in range(slices):
            keys = {"type": "slice", "section": "hands"}
            if section["geometry"] == "scalar":
                keys["rest"] = rounded(self.within(-2e-3, 2e-3))
            hand = self.mat(keys, "hand")
            self.parts["ports"][f"port{i}"] = {"mat": hand, "slice": i, "position_scale":
                                               rounded(self.within(0.5, 2))}
            self.touch(hand, self.random.choice(bodies), section["geometry"])
        rows = [f"{t},{i},{rounded(self.within(-5e-3, 5e-3)) if t else 0}"
                for i in range(slices) for t in (0, 0.05, 0.1, 0.15, 0.2)]
        rows.sort(key=lambda row: float(row.split(",")[0]))
        self.gesture = "time_s,slice,target_m\n" + "\n".join(rows) + "\n"

    def touch(self, hand, body, geometry):
        self.features["hand"] += 1
        unit, other = self.hand_unit(body), self.place(body)
        is_scalar = "scalar" == geometry == self.section_of(body)["geometry"]
        rate = self.section_of(body)["rate"]
        is_sleepy = "sleep" in self.section_of(body)
        if body.along and not self.is_modal(body) and self.chance(0.4):
            other = self.moving_point(body, hand)
        elif is_scalar and rate == "audio" and self.ratio >= 4 and not is_sleepy and self.chance(0.4):
            other_end, name = other, f"ch{len(self.generators)}"
            self.generators.append({"type": "chaplet", "name": name, "section": body.section,
                                    "from": hand, "mass": self.value(20 * unit.mass)})
            self.features["chaplet"] += 1
            hand, other = f"{name}.1", other_end
        law = self.law(self.pick(*TOUCHES) if is_scalar else self.pick("spring_damper", "contact"),
                       unit, soft=True)
        if self.chance(0.3) and hand.startswith("hand") and is_scalar and rate == "audio" and (
                self.ratio >= 4 and not self.is_modal(body)):
            law["filter"] = "auto"
            self.features["filter auto"] += 1
        self.link(hand, other, law)

    def agent(self, body):
        self.hand_section()
        unit, reach = self.hand_unit(body), 5 * body.unit.reach
        points = [[0, 0], [0.03, reach], [0.06, -reach], [0.09, 0]]
        name = self.name("agents", "agent")
        self.parts["agents"][name] = {
            "mat": self.random.choice(body.modules), "stiffness": self.value(0.02 * unit.full),
            "damping": self.value(0.01 * unit.mass / unit.step), "points": rounded(points),
            "loop": self.chance(0.5), "section": "hands"}
        self.features["agent"] += 1

    # What makes a body sound, and how it is heard.

    def excite(self, body):
        ways = [self.strike, self.strike, self.push, self.drive, self.agent]
        if self.is_modal(body):
            ways = ways[:3]
        if "sleep" in self.section_of(body):
            ways = [self.push, self.agent]
        for _ in range(self.pick(1, 1, 2)):
            self.random.choice(ways)(body)

    def channel(self):
        return len(self.parts["inputs"]) + 1

    def push(self, body):
        self.parts["inputs"][self.name("inputs", "in")] = {
            "mat": self.place(body), "quantity": "force", "channel": self.channel(),
            "gain": self.value(0.2 * body.unit.full * body.unit.reach)}
        self.features["force input"] += 1

    def drive(self, body):
        driven = self.mat({"type": "driven", "section": body.section}, "driven")
        self.parts["inputs"][self.name("inputs", "in")] = {
            "mat": driven, "quantity": "position", "channel": self.channel(),
            "gain": self.value(3 * body.unit.reach)}
        geometry = self.section_of(body)["geometry"]
        kinds = ("spring_damper", "smooth_bow", "bow") if geometry == "scalar" else ("spring_damper",)
        self.link(driven, self.place(body), self.law(self.pick(*kinds), body.unit))
        self.features["position input"] += 1

    def strike(self, body):
        """By a hammer that flies."""
        struck, unit = self.random.choice(body.modules), body.unit
        size = DIMENSIONS[self.section_of(body)["geometry"]]
        hammer = {"type": "mass", "section": body.section, "mass": rounded(3 * unit.mass)}
        if self.section_of(body)["geometry"] == "scalar":
            hammer.update(x=rounded(-3 * unit.reach), v=SPEED)
            law = self.law(self.pick(*CONTACTS), unit)
        else:
            place = list(body.places[struck])
            place[size - 1] -= HAMMER
            speed = [0.0] * size
            speed[size - 1] = SPEED
            hammer.update(at=rounded(place[:max(2, size)]), v=speed)
            law = self.law(self.pick(*CONTACTS), unit, HAMMER - unit.reach)
        self.link(self.mat(hammer, "hammer"), struck, law)
        self.features["hammer"] += 1

    def hear(self, body):
        unit = body.unit
        scale = {"position": unit.reach, "velocity": SPEED, "force": 0.1 * unit.full * unit.reach}
        axes = "xyz"[:DIMENSIONS[self.section_of(body)["geometry"]]]
        for _ in range(self.random.randint(1, 2)):
            at = self.place(body)
            quantity = self.pick("position", "velocity",
                                 "velocity" if self.is_modal(body) or "@" in at else "force")
            self.parts["outputs"][self.name("outputs", "out")] = {
                "at": at, "quantity": quantity, "axis": axes[-1] if self.chance(0.6) else
                self.pick(*axes), "channel": self.pick(1, 2, 3),
                "gain": self.value(0.1 / scale[quantity])}
            self.features["hear " + quantity] += 1

    def written(self):
        """YAML, an element in a line."""
        lines = ["ergotic: 1", f"gestural_rate: {self.rate_hz / self.ratio:.6f}"]
        for part, elements in self.parts.items():
            if elements:
                lines += [f"{part}:"] + [f"  {name}: {json.dumps(keys)}"
                                         for name, keys in elements.items()]
        if self.generators:
            lines += ["generators:"] + [f"  - {json.dumps(keys)}" for keys in self.generators]
        return "\n".join(lines) + "\n"
