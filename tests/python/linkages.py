"""Bars in the plane: rings of them, the five-bar (two cranks and two rods between their tips), and flat ladders."""

from __future__ import annotations

import math

import numpy as np
from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind, Node, Scene

CRANK, ROD, ROD_2, CRANK_2 = 0.7, 0.6, 0.5, 0.65


def tip(angle: float) -> np.ndarray:
    """Of the first crank, which turns about the origin."""
    return CRANK * np.array([math.cos(angle), math.sin(angle), 0.0])


def tip_2(angle: float, ground: float = 1.5) -> np.ndarray:
    """Of the second crank, which turns about (ground, 0)."""
    return np.array([ground, 0.0, 0.0]) + CRANK_2 * np.array([math.cos(angle), math.sin(angle), 0.0])


def elbow(a: np.ndarray, b: np.ndarray, side: float) -> np.ndarray:
    """Where rods from a (ROD) and b (ROD_2) meet, left of the way from a to b for side 1."""
    return elbow_of(a, ROD, b, ROD_2, side)


def elbow_of(a: np.ndarray, rod: float, b: np.ndarray, rod_2: float, side: float = 1.0) -> np.ndarray:
    """As ``elbow``, of rods of these lengths."""
    d = float(np.linalg.norm(b - a))
    x = (d * d + rod**2 - rod_2**2) / (2.0 * d)
    y = math.sqrt(max(0.0, rod**2 - x * x))
    u = (b - a) / d
    return a + x * u + side * y * np.array([-u[1], u[0], 0.0])


def five_bar(one: float, two: float, side: float = 1.0, ground: float = 1.5) -> Scene:
    """With the cranks at these angles, radians; all parts' frames are the world's."""
    a, b = tip(one), tip_2(two, ground)
    pins = [np.zeros(3), a, elbow(a, b, side), b, np.array([ground, 0.0, 0.0])]
    return ring(pins, ["base", "crank", "rod", "rod2", "crank2"])


def ring(pins: list[np.ndarray], names: list[str]) -> Scene:
    """Bars hinged end to end at these points, the first one (from the last pin to the first) on the ground."""
    return hinged(names, [(i, (i + 1) % len(pins), pin) for i, pin in enumerate(pins)])


def flat_ladder(rods: int, loose: int = 0) -> Scene:
    """Cranks of length 1 a metre apart, one more than rods, all lying in the line of their pivots, each tip joined to the
    next by a rod.  loose: bars of an arch from the last tip down to the ground."""
    names = ["base", *(f"crank{i}" for i in range(rods + 1)), *(f"rod{i}" for i in range(rods))]
    hinges = [(0, 1 + i, np.array([i, 0.0, 0.0])) for i in range(rods + 1)]
    for i in range(rods):
        for crank in (i, i + 1):
            hinges.append((1 + crank, 2 + rods + i, np.array([crank + 1.0, 0.0, 0.0])))
    first = len(names)
    names += [f"loose{i}" for i in range(loose)]
    chain = [1 + rods, *range(first, first + loose), 0] if loose else []
    for i, (a, b) in enumerate(zip(chain, chain[1:])):
        hinges.append((a, b, np.array([rods + 1.0 + i, math.sin(math.pi * i / max(loose, 1)), 0.0])))
    return hinged(names, hinges)


def hinged(names: list[str], hinges: list[tuple[int, int, np.ndarray]]) -> Scene:
    """Parts, the first one on the ground, with hinges about z: (part, part, point)."""
    nodes = [Node(name, name, grounded=i == 0) for i, name in enumerate(names)]
    constraints = []
    for a, b, point in hinges:
        sides = tuple(
            Feature(n, FeatureKind.CIRCLE, point, np.array([0.0, 0.0, 1.0]), radius=0.05) for n in (a, b)
        )
        constraints.append(Constraint(f"insert:{len(constraints) + 1}", ConstraintKind.INSERT, sides))
    return Scene(nodes=nodes, constraints=constraints)
