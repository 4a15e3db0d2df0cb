"""Machines of boxes at random: trees on bases of one or several parts, and on the world itself."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from itertools import combinations

import kinefab
import trimesh


@dataclass(frozen=True)
class Machine:
    """passing: pairs of parts that do not collide: those of two rigid groups that a joint connects, of which one moves."""

    scene: kinefab.Scene
    parts: set[str]
    passing: set[frozenset[str]]


def standing_machine(seed: int) -> Machine:
    """Of the world itself nothing passes through anything."""
    draw = random.Random(seed)
    scene, box, count = kinefab.Scene(), trimesh.creation.box((0.1, 0.1, 0.1)), draw.randint(3, 9)
    stands, groups, hinged, hinges = list[bool](), list(range(count)), list[tuple[int, int]](), list[int]()
    for i in range(count):
        stands.append(draw.random() < 0.45)
        at = tuple(draw.uniform(-9, 9) for _ in range(3))
        scene.add_part(f"p{i}", box, translation=at, grounded=stands[i], mass=None if stands[i] else 1.0)
        other = draw.randrange(i) if i else None
        if other is not None and stands[i] and draw.random() < 0.4:
            _join_bases(scene, other, i, stands, groups)
        if other is None or stands[i]:
            continue
        point = (draw.uniform(-1, 1), 0, 0)
        if draw.random() < 0.3:
            scene.add_fixed(other, i)
            groups[i], stands[i] = groups[other], stands[other]
        elif draw.random() < 0.25:
            hinges.append(scene.add_hinge(None, i, point=point, axis=(0, 0, 1)))
        else:
            hinges.append(scene.add_hinge(other, i, point=point, axis=(0, 0, 1)))
            hinged.append((other, i))
    if len(hinges) > 1 and draw.random() < 0.5:
        scene.add_coupling(hinges[0], hinges[-1], ratio=2.0)
    linked = {frozenset((groups[a], groups[b])) for a, b in hinged}
    found = {
        frozenset((f"p{a}", f"p{b}"))
        for a, b in combinations(range(count), 2)
        if groups[a] != groups[b] and not (stands[a] and stands[b])
        if frozenset((groups[a], groups[b])) in linked
    }
    return Machine(scene, {f"p{i}" for i in range(count)}, found)


def _join_bases(scene: kinefab.Scene, a: int, b: int, stands: list[bool], groups: list[int]) -> None:
    """Fix b, which stands, to a, where that stands too: one base."""
    if stands[a]:
        scene.add_fixed(a, b)
        groups[b] = groups[a]


def built_machine(seed: int) -> Machine:
    """The same with parts below parts: what stands on the ground is then built onto the one above it, and passes through what that does."""
    machine, draw = standing_machine(seed), random.Random(seed)
    nodes = machine.scene.nodes
    for i in range(1, len(nodes)):
        if draw.random() < 0.4:
            nodes[i] = replace(nodes[i], parent=draw.randrange(i))
    return machine
