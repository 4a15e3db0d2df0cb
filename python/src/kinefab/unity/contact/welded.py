"""Bodies that FixedJoints hold together: Unity keeps only the two of each joint from colliding, not all that hang together by them."""

from __future__ import annotations

from ...geometry.contact.nearness import close_pairs
from ...partition import Partition
from ..apart import with_apart
from ..scene import FixedJoint, UnityScene
from .overlaps import bodies_of, joined_pairs
from .placed import placed_colliders


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
    placed = placed_colliders(scene)
    held = joined_pairs(scene, bodies)
    pairs: dict[tuple[int, int], str] = {}
    for first, second in close_pairs(placed.low, placed.high).tolist():
        a, b = (bodies[placed.owners[i]] for i in (first, second))
        if a is None or b is None or a == b or welded.find(a) != welded.find(b) or frozenset((a, b)) in held:
            continue
        held.add(frozenset((a, b)))
        pairs[max(a, b), min(a, b)] = "held together by FixedJoints"
    return with_apart(scene, pairs)
