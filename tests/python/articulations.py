"""Exports every mechanism of ``fixtures``, and random ones, twice: by joints and by links: ``python tests/python/articulations.py FOLDER COUNT``.

``NAME.joints.kinefab`` and ``NAME.links.kinefab``; instead of the latter ``NAME.refused`` where no articulation holds the joints.  What the C#
library makes of the former must be the latter; the C# tests compare them, field by field.
"""

from __future__ import annotations

import math
import random
import sys
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
from golden import golden_pairs
from kinefab.model import AnimationClip, Apart, Dynamics, Freedom, Joint, Motion, Passive, SphericalDrive, Track
from kinefab.spatial import rotation_exp
from prefabs import LINKS, MORE

KINDS = ["revolute"] * 6 + ["prismatic"] * 4 + ["spherical"] * 3 + ["universal", "fixed"]


def machine(seed: int) -> kinefab.Scene:
    """Some bodies on the ground or on none, loops, couplings, every field that a joint's link may get something from."""
    draw = random.Random(seed)
    scene = kinefab.Scene()
    base = scene.add_part("base", mass=5.0, grounded=draw.random() < 0.6)
    parts: list[int | None] = [None if draw.random() < 0.3 else base]
    for i in range(draw.randint(1, 7)):
        parts.append(scene.add_part(f"part{i}", mass=1.0 + 0.3 * i, translation=_vector(draw), rotation=rotation_exp(np.array(_vector(draw)))))
    if draw.random() < 0.2:
        moved = parts[-1]
        assert moved is not None
        scene.nodes[moved] = replace(scene.nodes[moved], dynamics=Dynamics(kinematic=True))
    pairs = [(draw.randrange(i), i) for i in range(1, len(parts))]
    if len(parts) > 3 and draw.random() < 0.6:
        pairs.append(tuple(sorted(draw.sample(range(1, len(parts)), 2))))  # pyright: ignore
    for k, (a, b) in enumerate(pairs):
        _join(draw, scene, parts[a], parts[b], f"joint{k}" if draw.random() < 0.8 else "")
    scene.joints[:] = [_stated(draw, joint) for joint in scene.joints]
    lone = [joint for joint in scene.joints if len(joint.unlocked) == 1 and joint.enabled]
    if len(lone) > 1 and draw.random() < 0.4:
        scene.add_coupling(*draw.sample(lone, 2), ratio=draw.choice([-2.0, 0.5]), offset=draw.choice([0.0, 3.0]))
    if len(parts) > 2 and draw.random() < 0.3:
        scene.apart.append(Apart(parts[1], parts[2], "said", "", True))  # pyright: ignore
    if draw.random() < 0.2:
        track = Track(draw.randrange(len(scene.nodes)), np.array([[0.0, 0, 0], [0.1, 0, 0]]), None)
        scene.animations.append(AnimationClip("sway", np.array([0.0, 1.0]), (track,)))
    return scene


def _vector(draw: random.Random) -> tuple[float, float, float]:
    return tuple(round(draw.uniform(-0.5, 0.5), 3) for _ in range(3))  # pyright: ignore


def _join(draw: random.Random, scene: kinefab.Scene, a: int | None, b: int | None, name: str) -> None:
    assert b is not None
    kind, axis = draw.choice(KINDS), np.array(_vector(draw) if draw.random() < 0.7 else draw.choice([(1, 0, 0), (0, 1, 0), (0, 0, 1)]))
    second = np.cross(axis, (0.3, -0.2, 0.9))
    options = {"secondary": tuple(second)} if kind == "universal" else {}
    broken = {"break_force": 50.0} if draw.random() < 0.03 else {}
    scene.add_joint(kind, a, b, point=_vector(draw), axis=tuple(axis), name=name, collide=draw.random() < 0.1, **options, **broken)


def _stated(draw: random.Random, joint: Joint) -> Joint:
    """The joint with ranges, drives and what it is by itself."""
    alike = _passive(draw, lone=len(joint.unlocked) == 1) if draw.random() < 0.5 else None
    freedoms, lone = list(joint.freedoms), len(joint.unlocked) == 1 or draw.random() < 0.1
    for i in joint.unlocked:
        unit = 1.0 if i < 3 else math.pi
        freedom = replace(freedoms[i], passive=alike if draw.random() < 0.7 else _passive(draw, lone=len(joint.unlocked) == 1))
        if draw.random() < 0.6:
            low, high = -unit * draw.uniform(0.05, 0.9), unit * draw.uniform(0.05, 0.9)
            wide = draw.choice([1.0, 1.0, 1.0, 1.7]) if i >= 3 else 1.0
            freedom = Freedom(Motion.LIMITED, wide * low, wide * high if draw.random() < 0.7 else -wide * low, passive=freedom.passive)
        freedoms[i] = replace(freedom, drive=_drive(draw, unit, lone) if draw.random() < 0.5 else None)
    slerp = None
    if len(joint.unlocked) == 3 and draw.random() < 0.3:
        freedoms = [replace(freedom, drive=None) for freedom in freedoms]
        slerp = SphericalDrive(np.eye(3), np.zeros(3), 40.0, 2.0, draw.choice([math.inf, 9.0]))
    return replace(joint, freedoms=tuple(freedoms), slerp=slerp, enabled=draw.random() > 0.05)


def _passive(draw: random.Random, lone: bool) -> Passive:
    """lone: of several freedoms one drive of the component has the springs of two, and nobody could tell which effort bounds which."""
    effort = draw.choice([math.inf, 4.0, 30.0])
    own = {"stiffness": draw.choice([0.0, 20.0]), "damping": draw.choice([0.1, 2.0])} if lone and draw.random() < 0.4 else {}
    return Passive(
        **own,
        friction=draw.choice([0.0, 0.0, 0.2]), armature=draw.choice([0.0, 0.01]), effort=effort, speed=draw.choice([math.inf, 2.5])
    )


def _drive(draw: random.Random, unit: float, aims: bool) -> kinefab.Drive:
    """aims: where it turns about several axes to a target, no articulation has it."""
    if not aims:
        return kinefab.Drive(stiffness=draw.choice([0.0, 100.0]), damping=3.0, max_force=draw.choice([2.0, 40.0]))
    if draw.random() < 0.2:
        return kinefab.Drive(target_velocity=unit * draw.uniform(-1, 1), max_force=draw.choice([3.0, 20.0]), motor=True)
    return kinefab.Drive(
        target=unit * draw.uniform(-0.1, 0.1),
        target_velocity=draw.choice([0.0, 0.1 * unit]),
        stiffness=draw.choice([0.0, 100.0]),
        damping=3.0,
        max_force=draw.choice([2.0, 40.0]),
        acceleration=draw.random() < 0.2,
    )


def main(folder: Path, count: int) -> int:
    sources: dict[str, object] = {source.name.partition(".")[0]: source for source, _ in golden_pairs()}
    sources |= {f"{path.parent.name} {path.name}": path for path in MORE}
    sources |= {f"random {seed:04d}": machine(seed) for seed in range(count)}
    for name, source in sources.items():
        stem = folder / name.replace("/", " ")
        try:
            kinefab.export(source, f"{stem}.joints.kinefab")
        except kinefab.KinefabError as fault:
            print(f"{name}: {fault}", file=sys.stderr)
            continue
        try:
            kinefab.export(source, f"{stem}.links.kinefab", replace(LINKS))
        except kinefab.KinefabError as fault:
            Path(f"{stem}.refused").write_text(str(fault), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2])))
