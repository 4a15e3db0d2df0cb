"""Bodies that FixedJoints hold together: Unity keeps only the two of each joint from colliding, not all that hang together by them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ..geometry.contact.nearness import close_pairs
from ..partition import Partition
from .overlaps import bodies_of, joined_pairs
from .scene import Component, ConfigurableJoint, FixedJoint, UnityScene
from .scene.joints.configurable_joint import APART
from .standing import standing_colliders


def with_welded_apart(scene: UnityScene) -> UnityScene:
    """The scene in which no two bodies of one rigid group collide: pairs whose colliders come near each other, which they do for
    good, get a joint that holds nothing.  Where they may touch, contact would work against the FixedJoints for ever."""
    bodies = bodies_of(scene)
    welded = Partition(len(bodies))
    weld = False
    for i, entry in enumerate(scene.gameObjects):
        for component in entry.components:
            other = component.connectedBody if isinstance(component, FixedJoint) else None
            own = bodies[i]
            if own is not None and other is not None:
                welded.join(own, other)
                weld = True
    if not weld:
        return scene
    standing = standing_colliders(scene)
    held = joined_pairs(scene, bodies)
    added: dict[int, list[Component]] = {}
    for first, second in close_pairs(standing.low, standing.high).tolist():
        a, b = (bodies[standing.owners[i]] for i in (first, second))
        if a is None or b is None or a == b or welded.find(a) != welded.find(b) or frozenset((a, b)) in held:
            continue
        held.add(frozenset((a, b)))
        own, other = max(a, b), min(a, b)
        added.setdefault(own, []).append(apart_joint(scene, own, other, "held together by FixedJoints"))
    return _with(scene, added)


def apart_joint(scene: UnityScene, own: int, other: int, reason: str) -> ConfigurableJoint:
    """A joint that holds nothing and keeps two bodies, by their objects, from colliding."""
    id = f"apart:{scene.gameObjects[own].id} - {scene.gameObjects[other].id}"
    return ConfigurableJoint(
        connectedBody=other,
        autoConfigureConnectedAnchor=False,
        closure=True,
        id=id,
        extras={APART: reason},
    )


def _with(scene: UnityScene, added: Mapping[int, list[Component]]) -> UnityScene:
    if not added:
        return scene
    objects = tuple(
        replace(entry, components=(*entry.components, *added.get(i, ())))
        for i, entry in enumerate(scene.gameObjects)
    )
    return replace(scene, gameObjects=objects)
