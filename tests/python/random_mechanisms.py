"""Random mechanisms for the count of mobility: loops, couplings, idle freedoms, singular starts.

Points and axes lie on a grid, in a plane, on one axis, through one point, or anywhere; legs hold a platform by rods and rams.
"""

from __future__ import annotations

import math
import random

import kinefab
import numpy as np

AXES = np.eye(3)
KINDS = {
    "grid": ["revolute"] * 5 + ["prismatic"] * 3 + ["cylindrical"] * 2 + ["spherical"] * 2
    + ["universal", "planar", "pin_slot", "screw", "fixed", "point_on_plane"],
    "plane": ["revolute"] * 6 + ["prismatic", "cylindrical", "spherical"],
    "axis": ["revolute"] * 5 + ["cylindrical"] * 3 + ["prismatic"] * 2 + ["screw"],
    "point": ["revolute"] * 6 + ["spherical", "universal"],
    "slides": ["prismatic"] * 5 + ["planar", "translate_2", "parallel_planes"],
}  # fmt: skip


def mechanism(seed: int) -> kinefab.Scene:
    draw = random.Random(seed)
    style = draw.choice(["grid", "plane", "point", "axis", "anywhere", "slides", "legs"])
    return _platform(draw) if style == "legs" else _linkage(draw, style)


def _linkage(draw: random.Random, style: str) -> kinefab.Scene:
    scene = kinefab.Scene()
    count = draw.randint(2, 6)
    parts = [scene.add_part("base", grounded=True)]
    for i in range(count):
        place = 0.1 * _point(draw, style) + 0.05 * i
        parts.append(scene.add_part(f"part{i}", mass=1.0 + 0.1 * i, translation=tuple(place)))
    pairs = [(draw.randrange(i), i) for i in range(1, count + 1)]
    for _ in range(draw.choice([0, 1, 1, 1, 2, 2, 3])):
        a, b = sorted(draw.sample(range(count + 1), 2))
        pairs.append((a, b))
    joints = [_join(draw, style, scene, parts[a], parts[b], f"joint{i}") for i, (a, b) in enumerate(pairs)]
    coordinates = [(joint, "rx") for joint, kind in joints if kind == "revolute"]
    coordinates += [(joint, "tx") for joint, kind in joints if kind in ("prismatic", "cylindrical")]
    if draw.random() < 0.3 and len(coordinates) > 1:
        for _ in range(draw.choice([1, 1, 2])):
            scene.add_coupling(*draw.sample(coordinates, 2), ratio=draw.choice([1.0, -1.0, 2.0, -0.5]))
    return scene


def _point(draw: random.Random, style: str) -> np.ndarray:
    if style == "plane":
        return np.array([draw.randint(0, 3), draw.randint(0, 3), 0.0])
    if style == "axis":
        return np.array([0.0, 0.0, draw.randint(0, 3)])
    if style in ("grid", "slides"):
        return np.array([draw.randint(0, 2) for _ in range(3)], dtype=float)
    return np.array([round(draw.uniform(-1, 1), 3) for _ in range(3)])


def _axis(draw: random.Random, style: str, point: np.ndarray, kind: str) -> np.ndarray:
    if style == "plane" and kind == "prismatic":
        return np.array(draw.choice([(1, 0, 0), (0, 1, 0), (1, 1, 0)]), dtype=float)
    if style in ("plane", "axis"):
        return AXES[2]
    if style == "point":
        return point if np.linalg.norm(point) > 0.1 else AXES[2]
    if style in ("grid", "slides"):
        return AXES[draw.randrange(3)]
    return np.array([draw.gauss(0, 1) for _ in range(3)])


def _join(
    draw: random.Random, style: str, scene: kinefab.Scene, a: int, b: int, name: str
) -> tuple[kinefab.Joint, str]:
    point = _point(draw, style)
    kind = draw.choice(KINDS.get(style, KINDS["grid"]))
    axis = _axis(draw, style, point, kind)
    axis = axis / np.linalg.norm(axis)
    across = np.cross(axis, AXES[draw.randrange(3)])
    if np.linalg.norm(across) < 1e-6:
        across = np.cross(axis, [0.36, 0.48, 0.8])
    lead = 0.1 * draw.randint(1, 3) if kind == "screw" else 0.0
    secondary = tuple(across / np.linalg.norm(across))
    joint = scene.add_joint(
        kind, a, b, point=tuple(point), axis=tuple(axis), secondary=secondary, lead=lead, name=name
    )
    return joint, kind


def _platform(draw: random.Random) -> kinefab.Scene:
    scene = kinefab.Scene()
    base = scene.add_part("base", grounded=True)
    top = scene.add_part("top", mass=3.0, translation=(0.1, 0.9, 0.0))
    count, regular = draw.randint(1, 6), draw.random() < 0.5
    for i in range(count):
        foot, head = _leg_ends(draw, count, i, regular)
        along = (head - foot) / np.linalg.norm(head - foot)
        across = np.cross(along, [0, 1, 0] if draw.random() < 0.7 else [0.3, 0.5, 0.8])
        if np.linalg.norm(across) < 1e-6:
            across = np.cross(along, [1, 0, 0])
        across = across / np.linalg.norm(across)
        first = draw.choice(["universal", "spherical", "spherical", "revolute"])
        last = draw.choice(["spherical", "spherical", "universal"])
        style = draw.choice(["rod", "ram", "ram", "loose ram", "none"])
        if style == "none":
            _end(draw, scene, "spherical", base, top, head, along, across)
            continue
        low = scene.add_part(f"low{i}", mass=1.0, translation=tuple(foot + 0.2 * along))
        _end(draw, scene, first, base, low, foot, along, across)
        high = low
        if style != "rod":
            high = scene.add_part(f"high{i}", mass=1.0, translation=tuple(head - 0.2 * along))
            slide = "prismatic" if style == "ram" else "cylindrical"
            _end(draw, scene, slide, low, high, foot, along, across)
        _end(draw, scene, last, high, top, head, along, across)
    return scene


def _leg_ends(draw: random.Random, count: int, i: int, regular: bool) -> tuple[np.ndarray, np.ndarray]:
    if regular:
        turn = math.tau * i / count
        foot = np.array([math.cos(turn), 0.0, math.sin(turn)])
        return foot, np.array([0.5 * math.cos(turn + 0.5), 1.0, 0.5 * math.sin(turn + 0.5)])
    foot = np.array([draw.randint(-2, 2), 0, draw.randint(-2, 2)], dtype=float)
    return foot, np.array([draw.randint(-2, 2), draw.randint(1, 2), draw.randint(-2, 2)], dtype=float)


def _end(
    draw: random.Random,
    scene: kinefab.Scene,
    kind: str,
    a: int,
    b: int,
    point: np.ndarray,
    along: np.ndarray,
    across: np.ndarray,
) -> None:
    axis, secondary = along, across
    if kind == "universal":
        axis, secondary = draw.choice([(across, along), (along, across), (across, np.cross(across, along))])
    elif kind == "revolute":
        axis, secondary = draw.choice([across, along]), np.cross(across, along)
    scene.add_joint(kind, a, b, point=tuple(point), axis=tuple(axis), secondary=tuple(secondary))
