"""Joints that couplings count by between bodies that scripts alone move, for a format in which such a joint is a fault.

Nothing that the solver moves hangs on such a joint.  A light body that is fixed to the led one carries it instead: its own
motions are all free, so what it counts stays the led body's motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..model import FreeIds
from .scene import ArticulationBody, Coupling, FixedJoint, GameObject, Joint, JointCoordinate, Rigidbody, UnityScene
from .scene.vectors import ONE

SHARE = 0.1
"""Mass and inertia of a light body against those of the body whose motion it counts."""


def with_led_joints_on_light_bodies(scene: UnityScene) -> UnityScene:
    """The scene with a light body for each joint that a coupling counts by and whose two sides are led, or stand."""
    objects = list(scene.gameObjects)
    moved = {
        (at.gameObject, at.component): -1
        for coupling in scene.couplings
        for at in (coupling.coordinate, *(term.coordinate for term in coupling.terms))
        if _holds_nothing(objects, at)
    }
    if not moved:
        return scene
    free_ids = FreeIds(own.id for own in objects)
    for owner, number in moved:
        led = scene.gameObjects[owner]
        joint = led.components[number]
        id = free_ids.take(f"{led.id}/counted:{number}")
        carried = (light_body(led.components), FixedJoint(connectedBody=owner), joint)
        moved[owner, number] = len(objects)
        stand = replace(led.transform, localScale=ONE)
        objects.append(GameObject(id, id, led.parent, led.active, stand, carried))
    for owner in {owner for owner, _ in moved}:
        left = [c for i, c in enumerate(objects[owner].components) if (owner, i) not in moved]
        objects[owner] = replace(objects[owner], components=tuple(left))

    def now(at: JointCoordinate) -> JointCoordinate:
        if (place := (at.gameObject, at.component)) in moved:
            return replace(at, gameObject=moved[place], component=2)
        gone = sum(owner == at.gameObject and number < at.component for owner, number in moved)
        return replace(at, component=at.component - gone)

    def counting(coupling: Coupling) -> Coupling:
        terms = tuple(replace(term, coordinate=now(term.coordinate)) for term in coupling.terms)
        return replace(coupling, coordinate=now(coupling.coordinate), terms=terms)

    couplings = tuple(counting(coupling) for coupling in scene.couplings)
    return replace(scene, gameObjects=tuple(objects), couplings=couplings)


def led_bodies(scene: UnityScene) -> dict[int, int]:
    """The way back: of each light body the object whose led body it counts for."""
    found: dict[int, int] = {}
    for index, own in enumerate(scene.gameObjects):
        kinds = tuple(type(c) for c in own.components[:2])
        if kinds != (Rigidbody, FixedJoint) or len(own.components) != 3 or not isinstance(own.components[2], Joint):
            continue
        hold = own.components[1]
        assert isinstance(hold, Joint)
        led = hold.connectedBody
        if led is not None and not hold.id and own.id.startswith(f"{scene.gameObjects[led].id}/counted:"):
            found[index] = led
    return found


def _holds_nothing(objects: list[GameObject], at: JointCoordinate) -> bool:
    """Whether the solver moves neither side of a joint."""
    joint = objects[at.gameObject].components[at.component]
    if isinstance(joint, ArticulationBody):
        return False
    assert isinstance(joint, Joint), "couplings count by joints"
    return not any(
        isinstance(c, Rigidbody) and not c.isKinematic
        for side in (at.gameObject, joint.connectedBody)
        if side is not None
        for c in objects[side].components
    )


def light_body(components: Sequence[object]) -> Rigidbody:
    """What neither falls nor weighs much beside the body with these components."""
    beside = next((c for c in components if isinstance(c, Rigidbody)), Rigidbody())
    x, y, z = (SHARE * moment for moment in beside.inertiaTensor)
    return Rigidbody(SHARE * beside.mass, inertiaTensor=(x, y, z), angularDamping=0.0, useGravity=False)
