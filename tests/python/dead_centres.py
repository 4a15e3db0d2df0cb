"""Random mechanisms at dead centres, as a CAD program's solver leaves them: noise of 1e-9 to 1e-4 in their points and axes, on both sides
of a joint alike or on each alone, from 1 cm to 10 m, with and without the rounding of a file in millimetres."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import kinefab
import numpy as np
from kinefab.analysis.equations.system import exponential
from kinefab.spatial import Array, Pose

Z = (0.0, 0.0, 1.0)


class DeadCentre:
    """One of them.  exact: without noise and rounding, which tells what is meant."""

    def __init__(self, seed: int, exact: bool = False):
        self.draw = draw = random.Random(seed)
        self.noise = draw.choice([0] + [10 ** draw.uniform(-9, -4)] * 6)
        self.size = 10 ** draw.uniform(-2, 1)
        self.sides = draw.choice(["alike", "apart", "both"])
        self.what = draw.choice(["point", "axis", "both"])
        self.digit = draw.choice([None, None, 1e-7, 1e-9])
        if exact:
            self.noise, self.digit = 0, None
        self.scene = kinefab.Scene()
        self.turn = exponential(self.gauss(1) * draw.choice([0, 1]))
        self.base = self.scene.add_part("base", grounded=True)
        self.parts = 0
        self.hinges: list[kinefab.Joint] = []
        self.slides: list[kinefab.Joint] = []
        families = [draw.choice(FAMILIES)]
        if draw.random() < 0.15:
            families.append(draw.choice(FAMILIES))
        for family in families:
            family(self)
        if draw.random() < 0.6:
            self._extras()

    def gauss(self, size: float) -> Array:
        return np.array([self.draw.gauss(0, 1) for _ in range(3)]) * size

    def _at(self, point: Array | tuple[float, float, float]) -> Array:
        return self.size * (self.turn @ np.asarray(point, dtype=float))

    def part(self, point: Array | tuple[float, float, float] = (0, 0, 0)) -> int:
        self.parts += 1
        place = self._at(np.asarray(point, dtype=float) + 0.1 * self.gauss(1))
        return self.scene.add_part(f"p{self.parts}", mass=1.0, translation=tuple(place))

    def joint(self, kind: str, a: int, b: int, point, axis=Z) -> None:
        place, way = self._at(point), self.turn @ (np.asarray(axis, dtype=float) / np.linalg.norm(axis))
        if self.sides != "apart":
            if self.what != "axis":
                place = place + self.gauss(self.noise) * self.size
            if self.what != "point":
                way = exponential(self.gauss(self.noise)) @ way
        if self.digit:
            place = np.round(place / self.digit) * self.digit
        joint = self.scene.add_joint(kind, a, b, point=tuple(place), axis=tuple(way))
        if self.sides != "alike":
            moved = joint.frame_b.translation + (self.gauss(self.noise) * self.size if self.what != "axis" else 0)
            turned = joint.frame_b.rotation @ (exponential(self.gauss(self.noise)) if self.what != "point" else np.eye(3))
            if self.digit:
                moved = np.round(moved / self.digit) * self.digit
            joint = replace(joint, frame_b=Pose(turned, moved))
            self.scene.joints[-1] = joint
        {"revolute": self.hinges, "prismatic": self.slides}.get(kind, []).append(joint)

    def hinge(self, a: int, b: int, point, axis=Z) -> None:
        self.joint("revolute", a, b, point, axis)

    def slide(self, a: int, b: int, point, axis=(1, 0, 0)) -> None:
        self.joint("prismatic", a, b, point, axis)

    def lengths(self, count: int) -> list[float]:
        return [round(self.draw.uniform(0.2, 1.5), 2) for _ in range(count)]

    def _extras(self) -> None:
        """Gears, a part that hangs on another, a rod between balls."""
        draw = self.draw
        if draw.random() < 0.3 and len(self.hinges) > 1:
            for _ in range(draw.choice([1, 1, 2])):
                first, second = draw.sample(self.hinges + self.slides, 2)
                ratio = draw.choice([1, -1, 2, -0.5])
                try:
                    self.scene.add_coupling(first, second, ratio=ratio)
                except ValueError:
                    pass
        if draw.random() < 0.3:
            hung = self.part()
            on = draw.randrange(1, self.parts)
            self.hinge(on, hung, self.gauss(0.5), self.gauss(1))
        if draw.random() < 0.3:
            rod = self.part()
            on = draw.randrange(0, self.parts - 1)
            self.joint("spherical", self.base, rod, (0.3, -0.4, 0.1), (1, 0, 0))
            if on:
                self.joint("spherical", on, rod, (0.9, -0.2, 0.1), (1, 0, 0))


def four_bar(m: DeadCentre) -> None:
    """All of it in line."""
    (a, b, c), way = m.lengths(3), [m.draw.choice([1, -1]) for _ in range(3)]
    x = [0, a * way[0], a * way[0] + b * way[1], a * way[0] + b * way[1] + c * way[2]]
    p = [m.part((at, 0, 0)) for at in x[:3]]
    points = [(at, 0, m.draw.choice([0, 0.2])) for at in x]
    for (first, second), point in zip([(m.base, p[0]), (p[0], p[1]), (p[1], p[2]), (m.base, p[2])], points):
        m.hinge(first, second, point)


def parallelogram(m: DeadCentre) -> None:
    count, length, angle = m.draw.choice([2, 2, 3, 4]), m.lengths(1)[0], m.draw.choice([0, 0, 0, math.pi, 1.0])
    feet, bar = np.cumsum([0, *m.lengths(count - 1)]), m.part()
    along = np.array([math.cos(angle), math.sin(angle), 0]) * length
    for x in feet:
        crank = m.part((x, 0, 0))
        m.hinge(m.base, crank, (x, 0, 0))
        m.hinge(crank, bar, np.array([x, 0, 0]) + along)


def toggle(m: DeadCentre) -> None:
    """Two bars in line between fixed hinges: it stands, though not to first order."""
    (a, b), p = m.lengths(2), m.part()
    q = m.part((a, 0, 0))
    for first, second, x in ((m.base, p, 0), (p, q, a), (m.base, q, a + b)):
        m.hinge(first, second, (x, 0, 0))


def slider_crank(m: DeadCentre) -> None:
    a, b = m.lengths(2)
    if m.draw.random() < 0.4:
        b = a
    one, two = m.draw.choice([1, -1]), m.draw.choice([1, -1])
    crank, rod, slider = m.part(), m.part((a, 0, 0)), m.part((a + b, 0, 0))
    beside, end = m.draw.choice([0, 0, 0.3]), one * a + two * b
    for first, second, x in ((m.base, crank, 0), (crank, rod, one * a), (rod, slider, end)):
        m.hinge(first, second, (x, 0, 0))
    m.slide(m.base, slider, (end, beside, 0), m.draw.choice([(1, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]))


def spherical(m: DeadCentre) -> None:
    """Axes through one point, most of them in a plane."""
    count, flat, axes = m.draw.choice([3, 4, 4, 5, 6]), m.draw.random() < 0.7, list[Array]()
    for _ in range(count):
        if flat:
            turn = round(m.draw.uniform(0, 2 * math.pi), 2)
            axes.append(np.array([math.cos(turn), math.sin(turn), 0]))
        else:
            axes.append(m.gauss(1))
    p = [m.base] + [m.part() for _ in range(count - 1)]
    for i, axis in enumerate(axes):
        a, b = sorted((p[i], p[(i + 1) % count]))
        unit = axis / np.linalg.norm(axis)
        m.hinge(a, b, unit * m.draw.choice([0.5, 1]), unit)


def sarrus(m: DeadCentre) -> None:
    height, count, top, length = m.draw.choice([0, 0, 0.4]), m.draw.choice([2, 3]), m.part((0, 0, 1)), 0.8
    for i in range(count):
        turn = 2 * math.pi * i / (3 if m.draw.random() < 0.7 else 4)
        out, axis = np.array([math.cos(turn), math.sin(turn), 0]), np.array([-math.sin(turn), math.cos(turn), 0])
        a, b = m.part(), m.part()
        middle = out * (1 + math.sqrt(length**2 - height**2)) + np.array([0, 0, height])
        m.hinge(m.base, a, out, axis)
        m.hinge(a, b, middle, axis)
        m.hinge(b, top, out + np.array([0, 0, 2 * height]), axis)


def chain(m: DeadCentre) -> None:
    """A closed one of five or six bars, all in line."""
    count, x = m.draw.choice([5, 6]), [0.0]
    for length in m.lengths(count - 1):
        x.append(x[-1] + length * m.draw.choice([1, -1]))
    p = [m.part((at, 0, 0)) for at in x[:-1]]
    m.hinge(m.base, p[0], (0, 0, 0))
    for i in range(1, len(p)):
        m.hinge(p[i - 1], p[i], (x[i], 0, 0))
    m.hinge(m.base, p[-1], (x[-1], 0, 0))


def scotch_yoke(m: DeadCentre) -> None:
    turn = m.draw.choice([0, 0, math.pi / 2, 0.7])
    crank, block, yoke = m.part(), m.part(), m.part()
    pin = np.array([math.cos(turn), math.sin(turn), 0]) * 0.5
    m.hinge(m.base, crank, (0, 0, 0))
    m.hinge(crank, block, pin)
    m.slide(block, yoke, pin, (0, 1, 0))
    m.slide(m.base, yoke, (0, 0, 0), m.draw.choice([(1, 0, 0), (1, 0, 0), (0, 1, 0)]))


FAMILIES = [four_bar, parallelogram, toggle, slider_crank, spherical, sarrus, chain, scotch_yoke]
