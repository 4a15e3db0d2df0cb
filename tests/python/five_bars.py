"""Rings of bars in the plane; the five-bar has two cranks on the ground and two rods between their tips."""

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
    d = float(np.linalg.norm(b - a))
    x = (d * d + ROD**2 - ROD_2**2) / (2.0 * d)
    y = math.sqrt(max(0.0, ROD**2 - x * x))
    u = (b - a) / d
    return a + x * u + side * y * np.array([-u[1], u[0], 0.0])


def five_bar(one: float, two: float, side: float = 1.0, ground: float = 1.5) -> Scene:
    """With the cranks at these angles, radians; all parts' frames are the world's."""
    a, b = tip(one), tip_2(two, ground)
    pins = [np.zeros(3), a, elbow(a, b, side), b, np.array([ground, 0.0, 0.0])]
    return ring(pins, ["base", "crank", "rod", "rod2", "crank2"])


def ring(pins: list[np.ndarray], names: list[str]) -> Scene:
    """Bars hinged end to end about z at these points, the first one (from the last pin to the first) on the ground."""
    nodes = [Node(name, name, grounded=i == 0) for i, name in enumerate(names)]

    def insert(i: int) -> Constraint:
        sides = tuple(
            Feature(n, FeatureKind.CIRCLE, pins[i], np.array([0.0, 0.0, 1.0]), radius=0.05)
            for n in (i, (i + 1) % len(pins))
        )
        return Constraint(f"insert:{i + 1}", ConstraintKind.INSERT, sides)

    return Scene(nodes=nodes, constraints=[insert(i) for i in range(len(pins))])
