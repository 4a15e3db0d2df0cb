"""Which bodies of a written scene pass through each other, and which do not in spite of their groups."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...model import Apart, Colliding
from ..contact.grouped import colliding_in_spite_of_groups
from ..scene import UnityScene
from ..scene.joints.configurable_joint import APART

UNTOLD = "ignoreCollision"
"""The reason of a pair whose rule the file does not tell."""


def pairs_apart(written: UnityScene, node_of: Mapping[int, int]) -> list[Apart]:
    """The pairs that the file lists, in version 1.0 by ids in its extras, then those of joints that hold nothing, with the reason
    that stands there.  node_of: the node of each object that is one."""
    index = {entry.id: number for number, entry in enumerate(written.gameObjects)}
    reasons: dict[frozenset[int], str] = {}
    for own, entry in enumerate(written.gameObjects):
        for c in entry.components:
            extras: Mapping[str, Any] = getattr(c, "extras", {})
            connected = getattr(c, "connectedBody", None)
            if APART in extras and connected is not None:
                reasons[frozenset((own, connected))] = str(extras[APART])
    listed = [(pair.a, pair.b, pair.reason) for pair in written.ignoredCollisions]
    stated = written.extras.get("ignoreCollision")
    for pair in stated if isinstance(stated, list) else ():
        if isinstance(pair, list) and len(pair) == 2 and all(isinstance(name, str) and name in index for name in pair):
            listed.append((index[pair[0]], index[pair[1]], ""))
    known = {frozenset((a, b)) for a, b, _ in listed}
    for pair in (pair for pair in reasons if pair not in known):
        a, b = sorted(pair, key=lambda i: written.gameObjects[i].id)
        listed.append((a, b, ""))
    return [
        Apart(node_of[a], node_of[b], reason or reasons.get(frozenset((a, b)), UNTOLD), stated=False)
        for a, b, reason in listed
        if a in node_of and b in node_of
    ]


def pairs_colliding(written: UnityScene, node_of: Mapping[int, int]) -> list[Colliding]:
    """The pairs that are to collide whatever their groups: those that the groups would part and the file does not."""
    return [
        Colliding(node_of[a], node_of[b], "contact pair")
        for a, b in colliding_in_spite_of_groups(written)
        if a in node_of and b in node_of
    ]
