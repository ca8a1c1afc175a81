# SPDX-License-Identifier: BSD-3-Clause
"""What sounds: strings, meshes, nets and the like, each in a section or beside others in it."""
import collections
import math

from random_scene.dice import DIMENSIONS, rounded
from random_scene.laws import ELASTIC, LAWS, Laws

SPACING = 0.01  # m between modules

# What can be touched: places are at rest, m; modules move; `along` has connection points.
Body = collections.namedtuple("Body", "section modules places along unit")


class Bodies(Laws):
    def __init__(self, seed):
        super().__init__(seed)
        self.generators = []

    def losses(self, unit):
        return rounded(self.between(1e-5, 1e-3) * unit.mass / unit.step)

    def ties(self, geometry):
        """Rest length and scheme of generated springs."""
        if geometry == "scalar":
            return {}
        scheme = self.pick("explicit", "explicit", "energy_stable")
        self.features["generator " + scheme] += 1
        return {"rest_length_ratio": rounded(self.within(0.01, 0.9)), "scheme": scheme}

    def string(self, home=None, masses=None):
        geometry = self.geometry() if home is None else self.parts["sections"][home[0]]["geometry"]
        section, unit = home or self.section(geometry)
        masses = masses or self.random.randint(8, 90)
        coarse = geometry == "scalar" and home is None and self.chance(0.25)
        name, length = f"s{len(self.generators)}", (masses + 1) * SPACING
        kappa, size = self.within(0.03, 0.5), max(2, DIMENSIONS[geometry])
        string = {"type": "string", "name": name, "section": section, "masses": masses,
                  "mass": self.value(unit.mass), "damping": self.value(self.losses(unit)),
                  "from": [0, 0, 0][:size], "to": [rounded(length), 0, 0][:size], **self.ties(geometry)}
        if self.chance(0.4) and string.get("scheme") != "energy_stable" or coarse:  # those may be flat
            string["frequency"] = rounded(
                math.sqrt(kappa) / unit.step / math.pi * math.sin(math.pi / (2 * (masses + 1))))
        else:
            string["stiffness"] = self.value(kappa * unit.full)
        if coarse:
            string.update(coarse=True, mass=rounded(unit.mass), frequency=rounded(
                0.3 * string["frequency"]))
        if self.chance(0.4):
            string["loss"] = self.value(self.losses(unit))
        if self.chance(0.5):
            string["pluck"] = {"at": rounded(self.within(0.1, 0.9)),
                               "height": rounded(self.within(2, 10) * unit.reach)}
        self.generators.append(string)
        self.features["coarse string" if coarse else f"string {geometry}"] += 1
        modules = [f"{name}.{i}" for i in range(1, masses + 1)]
        places = {m: [(i + 1) * SPACING, 0.0, 0.0] for i, m in enumerate(modules)}
        return [Body(section, modules, places, name, unit)]

    def sleeper(self):
        """Comes to rest: only what is linear, and lies at 0, may."""
        home = self.section("scalar", sleep=self.pick(1e-13, 1e-10))
        self.parts["sections"][home[0]].pop("gravity", None)
        self.features["sleep"] += 1
        return self.pick(self.string, self.mesh)(home)

    def mesh(self, home=None):
        geometry = self.pick("scalar", "scalar", "plane", "space")
        section, unit = home or self.section(geometry)
        geometry = self.parts["sections"][section]["geometry"]
        rows, columns = self.random.randint(3, 12), self.random.randint(3, 12)
        name, edges = f"m{len(self.generators)}", self.pick("fixed", "fixed", "corners", "free")
        ties = self.ties(geometry)
        if ties and edges == "free":
            ties["rest_length_ratio"] = 1
        self.generators.append(
            {"type": "mesh", "name": name, "section": section, "rows": rows, "columns": columns,
             "spacing": SPACING, "edges": edges, "mass": self.value(unit.mass),
             "stiffness": self.value(self.within(0.02, 0.2) * unit.full),
             "damping": self.value(self.losses(unit)), "neighbours": self.pick(4, 8), **ties})
        self.features[f"mesh {geometry}"] += 1
        places = {f"{name}.{r}.{c}": [c * SPACING, r * SPACING, 0.0]
                  for r in range(1, rows - 1) for c in range(1, columns - 1)}
        return [Body(section, list(places), places, name, unit)]

    def choir(self):
        """Equal strings side by side: they are stepped together, or shared by threads."""
        home = self.section(self.pick("scalar", "scalar", "scalar", "plane"))
        masses = self.random.randint(10, 60)
        self.features["choir"] += 1
        return [self.string(home, masses)[0] for _ in range(self.random.randint(3, 9))]

    def modal(self):
        home = self.section("scalar", modes=self.pick("all", "auto", self.random.randint(5, 40)))
        section = self.parts["sections"][home[0]]
        section.pop("medium", None)
        self.may_follow = False
        body = self.pick(self.string, self.mesh)(home)
        self.may_follow = True
        made = self.generators[-1]
        if made.get("neighbours") == 8:  # the same Z/K in all links
            made["diagonal_stiffness"] = made["stiffness"]
        if self.chance(0.5):
            made.pop("loss", None)
        self.features[f"modes {section['modes'] if section['modes'] in ('all', 'auto') else 'N'}"] += 1
        return body

    def cells(self):
        section, unit = self.section(self.geometry())
        geometry, names = self.parts["sections"][section]["geometry"], []
        for i in range(self.random.randint(1, 20)):
            cell = {"type": "cell", "section": section, "mass": self.value(unit.mass),
                    "stiffness": self.value(self.between(1e-3, 0.5) * unit.full),
                    "damping": self.value(self.losses(unit)), "matched": self.chance(0.7),
                    "at": [i * SPACING, 0.0, 0.0][:max(2, DIMENSIONS[geometry])]}
            names.append(self.mat(cell, "c"))
            self.features["cell"] += 1
        places = {n: [i * SPACING, 0.0, 0.0] for i, n in enumerate(names)}
        return [Body(section, names, places, None, unit)]

    def mat(self, keys, stem="m"):
        name = self.name("mats", stem)
        self.parts["mats"][name] = keys
        return name

    def grid(self, count, geometry):
        """Places of so many modules, about SPACING apart."""
        side = {1: count, 2: math.isqrt(count) + 1, 3: round(count ** (1 / 3)) + 1}
        side, size = side[DIMENSIONS[geometry]], DIMENSIONS[geometry]
        for i in range(count):
            index = (i, 0, 0) if size == 1 else (i % side, i // side % side, i // side ** 2)
            yield [rounded((each + self.within(-0.2, 0.2)) * SPACING if k < size else 0.0)
                   for k, each in enumerate(index)]

    def net(self):
        """Masses and grounds, written out, with links of every kind."""
        section, unit = self.section(self.geometry())
        geometry = self.parts["sections"][section]["geometry"]
        size, places = DIMENSIONS[geometry], {}
        for i, place in enumerate(self.grid(self.random.randint(5, 25), geometry)):
            keys = {"type": "ground" if i % 7 == 0 else "mass", "section": section,
                    "at": place[:max(2, size)]}
            if keys["type"] == "mass":
                keys["mass"] = self.value(unit.mass * self.within(0.7, 1.5))
            elif geometry == "scalar" and self.chance(0.5):
                keys["x"] = rounded(self.within(-1, 1) * unit.reach)
            places[self.mat(keys)] = place
        names = list(places)
        for i, name in enumerate(names[1:], start=1):
            for other in {names[max(0, i - self.random.randint(1, 4))], names[i - 1]}:
                kinds = LAWS if self.chance(0.6) else ELASTIC[:2]
                length = 0.0 if geometry == "scalar" else math.dist(places[name], places[other])
                self.link(other, name, self.law(self.pick(*kinds), unit, length))
        moving = [n for n in names if self.parts["mats"][n]["type"] == "mass"]
        return [Body(section, moving, places, None, unit)]

    def lattice(self):
        """Masses and springs as tables, without a pattern."""
        section, unit = self.section(self.geometry())
        geometry = self.parts["sections"][section]["geometry"]
        count, name = self.random.randint(40, 250), self.name("mats", "t")
        places = {f"{name}.{i}": p for i, p in enumerate(self.grid(count, geometry))}
        names = list(places)
        self.parts["mats"][name] = {
            "with": {"type": "mass", "section": section}, "columns": ["name", "mass", "at"],
            "rows": [[n, rounded(unit.mass * self.within(0.7, 1.5)),
                      p[:max(2, DIMENSIONS[geometry])]] for n, p in places.items()]}
        rows = []
        for i in range(1, count):
            for other in {i - 1, max(0, i - self.random.randint(2, 30))} - {i}:
                far = 0.0 if geometry == "scalar" else 0.8 * math.dist(places[names[i]],
                                                                      places[names[other]])
                rows.append([f"{name}.link.{len(rows)}", [names[other], names[i]],
                             rounded(self.within(0.02, 0.1) * unit.full), rounded(far)])
        for row in self.random.sample(rows, 3):  # takes away of what another spring gives
            rows.append([f"{name}.link.{len(rows)}", row[1], rounded(-0.1 * row[2]), row[3]])
        self.parts["lias"][name] = {
            "with": {"type": "spring_damper", "damping": self.losses(unit)},
            "columns": ["name", "between", "stiffness", "rest_length"], "rows": rows}
        self.features[f"lattice {geometry}"] += 1
        return [Body(section, names, places, None, unit)]

    def bar(self):
        """Masses whose curvature counts: clamped, hinged or free, now and then bent at rest."""
        section, unit = self.section(self.pick("scalar", "scalar", "scalar", "line", "space"))
        geometry = self.parts["sections"][section]["geometry"]
        held, count = self.pick(0, 1, 2), self.random.randint(5, 40)
        size, names, places = max(2, DIMENSIONS[geometry]), [], {}
        for i in range(count + held):
            keys = {"type": "ground" if i < held else "mass", "section": section,
                    "at": [rounded(i * SPACING), 0.0, 0.0][:size]}
            if i >= held:
                keys["mass"] = rounded(unit.mass)
            names.append(self.mat(keys))
            places[names[-1]] = [i * SPACING, 0.0, 0.0]
        bend = {"type": "bend", "weights": [1, -2, 1],
                "stiffness": self.value(self.within(0.02, 0.15) * unit.full)}
        if geometry in ("scalar", "line"):
            bend["damping"] = self.value(self.losses(unit))
        if geometry == "scalar" and self.chance(0.3):
            bend["rest_length"] = rounded(self.within(-1, 1) * unit.reach)
        for ends in zip(names, names[1:], names[2:]):
            self.parts["lias"][self.name("lias", "l")] = {"between": list(ends), **bend}
        self.features[f"bar {geometry}"] += 1
        return [Body(section, names[held:], places, None, unit)]
