"""Bodies that CAD puts into each other: a shaft in its bore, teeth that mesh.  Their motion is a joint's or a coupling's, not contact's."""

from __future__ import annotations

from dataclasses import replace

from ...model import Apart, ConstraintKind, Scene
from ...rigid import RigidGroups
from ..bodies.rigidbodies import place_rigidbodies
from ..joints.coordinates import removes_nothing

BY_CONTACT = frozenset(
    {
        ConstraintKind.DISTANCE,
        ConstraintKind.TANGENT,
        ConstraintKind.ANGLE,
        ConstraintKind.PARALLEL,
        ConstraintKind.PERPENDICULAR,
        ConstraintKind.SYMMETRY,
        ConstraintKind.LOCK_ORIENTATION,
        ConstraintKind.LINEAR,
        ConstraintKind.OTHER,
    }
)
"""What is said of bodies that need not touch, or touch from outside, as a follower does its cam."""


def with_mated_apart(scene: Scene, groups: RigidGroups) -> Scene:
    """The scene in which bodies that a constraint puts into each other do not collide, also where no joint is made between them:
    teeth that mesh, and bearings whose joint hangs the body on another one.  Nor do those of a joint that removes nothing, as one that
    only counts an angle for a coupling, or whose rows the rest of a loop holds: not every target writes it."""
    known = {frozenset((pair.a, pair.b)) for pair in [*scene.apart, *scene.colliding]}
    joints = [joint for joint in scene.joints if not joint.collide]
    holding = [joint for joint in joints if not removes_nothing(joint)]
    known |= {frozenset((joint.a, joint.b)) for joint in holding}
    mated: dict[frozenset[int | None], Apart] = {}
    for joint in joints:
        pair = frozenset((joint.a, joint.b))
        if joint.a is not None and joint.b is not None and pair not in known and not groups.together(joint.a, joint.b):
            mated.setdefault(pair, Apart(joint.a, joint.b, f"joint {joint.name or joint.id}", joint.where, stated=False))
    for constraint in scene.constraints:
        if constraint.kind in BY_CONTACT or constraint.suppressed or len(constraint.features) < 2:
            continue
        a, b = (feature.node for feature in constraint.features[:2])
        pair = frozenset((a, b))
        if a is not None and b is not None and pair not in known and not groups.together(a, b):
            reason = f"{constraint.kind.value} {constraint.name or constraint.id}"
            mated.setdefault(pair, Apart(a, b, reason, constraint.where, stated=False))
    if not mated:
        return scene
    carrier_of = place_rigidbodies(scene, groups).carrier_of

    def body(node: int | None) -> int | None:
        """What moves as one: the carrier of a Rigidbody, or the lowest node of what is rigid on the ground."""
        if node is None or not groups.is_ground(node):
            return None if node is None else carrier_of[node]
        return groups.standing[node] if groups.standing else node

    joined = {frozenset((body(joint.a), body(joint.b))) for joint in holding}
    found = [pair for pair in mated.values() if frozenset((body(pair.a), body(pair.b))) not in joined]
    return replace(scene, apart=[*scene.apart, *found]) if found else scene
