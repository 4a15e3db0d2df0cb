"""Bodies that no source has, between two joints of one body: what they weigh, and whom they keep from colliding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np

from ...model import Apart, MassProperties, Node, Scene
from ...partition import Partition
from ..mass import ball_inertia, moved

SHARE = 0.1
"""Of the mass of the body that it helps; what solvers of joints take well."""
MOST = 0.5
"""Of a body's mass that all that help it take together."""


def with_helpers(scene: Scene) -> Scene:
    """The scene in which bodies between joints are nobody's mass and in nobody's way.

    A helper without a mass gets a share of the body that it helps, in the same place, so that mass, centre and inertia of both
    together stay at the exported pose.  One that has a mass takes it off that body.
    """
    helping: dict[int, list[int]] = {}
    for i, node in enumerate(scene.nodes):
        if node.helps is not None:
            helping.setdefault(node.helps, []).append(i)
    if not helping:
        return scene
    nodes = list(scene.nodes)
    for helped, helpers in helping.items():
        _share(nodes, helped, helpers)
        for i in helpers:
            nodes[i] = replace(nodes[i], extras={**nodes[i].extras, "helps": nodes[helped].id})
    return replace(scene, nodes=nodes, apart=[*scene.apart, *_through(scene, helping)])


def _share(nodes: list[Node], helped: int, helpers: list[int]) -> None:
    own = nodes[helped]
    if own.mass is None:
        for i in helpers:
            if nodes[i].mass is None:
                nodes[i] = replace(nodes[i], mass=MassProperties(SHARE, np.zeros(3), ball_inertia(SHARE)))
        return
    whole, taken = own.mass, 0.0
    wanted = [nodes[i].mass for i in helpers]
    shares = [SHARE if mass is None else mass.mass / whole.mass for mass in wanted]
    fewer = min(1.0, MOST / sum(shares))
    for i, mass, share in zip(helpers, wanted, shares):
        part = scaled(whole, fewer * share)
        at = nodes[i].pose.inverse() @ own.pose
        nodes[i] = replace(nodes[i], mass=moved(part, at) if mass is None else scaled(mass, fewer))
        taken += fewer * share
    nodes[helped] = replace(own, mass=scaled(whole, 1.0 - taken))


def scaled(mass: MassProperties, factor: float) -> MassProperties:
    return MassProperties(factor * mass.mass, mass.center, factor * mass.inertia)


def _through(scene: Scene, helping: Mapping[int, list[int]]) -> list[Apart]:
    """Pairs of bodies that are joined through helpers alone: joined they would not collide."""
    helpers = {i for those in helping.values() for i in those}
    joints = [j for j in scene.joints if not j.collide and j.a is not None and j.b is not None]
    sets = Partition(len(scene.nodes))
    for joint in joints:
        if joint.a in helpers and joint.b in helpers:
            sets.join(joint.a, joint.b)
    ends: dict[int, set[int]] = {}
    for joint in joints:
        for helper, end in ((joint.a, joint.b), (joint.b, joint.a)):
            if helper in helpers and end not in helpers and end is not None:
                ends.setdefault(sets.find(helper), set()).add(end)
    stated = {frozenset((pair.a, pair.b)) for pair in [*scene.apart, *scene.colliding]}
    pairs = dict.fromkeys(pair for those in ends.values() for pair in combinations(sorted(those), 2))
    return [
        Apart(a, b, "a joint through a light body", stated=False)
        for a, b in pairs
        if frozenset((a, b)) not in stated
    ]
