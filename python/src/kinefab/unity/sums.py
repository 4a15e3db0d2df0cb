"""Couplings of several terms, for a format whose couplings follow one coordinate each: bodies whose motions add up.

Of ``q = r1 q1 + r2 q2`` a light body turns by r1 q1 on the base, another on it by r2 q2, both about one axis: the last one
stands at the sum, and q follows it.  All coordinates here are Unity's own, which are zero at the exported pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..diagnostics import Report
from ..model import free_id
from .scene import (
    ConfigurableJoint,
    Coupling,
    CouplingTerm,
    GameObject,
    Joint,
    JointCoordinate,
    Mobility,
    Rigidbody,
    UnityScene,
)
from .scene.vectors import ONE

_ACROSS = ConfigurableJoint(
    yMotion="Locked", zMotion="Locked", angularYMotion="Locked", angularZMotion="Locked"
)
_SLIDE = replace(_ACROSS, angularXMotion="Locked")
_TURN = replace(_ACROSS, xMotion="Locked")
SHARE = 0.1
"""Mass and inertia of a light body against those of the body that follows the sum."""


def with_one_term_each(scene: UnityScene, report: Report) -> UnityScene:
    """The scene with as many light bodies as its couplings of several terms have terms, each told."""
    if all(len(coupling.terms) == 1 for coupling in scene.couplings):
        return scene
    objects = list(scene.gameObjects)
    taken = {own.id for own in objects}
    couplings: list[Coupling] = []
    analysis = scene.analysis
    for coupling in scene.couplings:
        if len(coupling.terms) == 1:
            couplings.append(coupling)
            continue
        couplings += _chain(coupling, objects, taken)
        analysis = None if analysis is None else _with_loop(analysis, coupling.coordinate.gameObject)
        report.add("COUPLING_BY_MIDDLE_BODIES", coupling=coupling.id, count=len(coupling.terms))
    return replace(scene, gameObjects=tuple(objects), couplings=tuple(couplings), analysis=analysis)


def _chain(coupling: Coupling, objects: list[GameObject], taken: set[str]) -> list[Coupling]:
    """Append the light bodies of a coupling; what ties them to the terms' joints, and the sum to the coupling's own."""
    owner = objects[coupling.coordinate.gameObject]
    joint = owner.components[coupling.coordinate.component]
    assert isinstance(joint, Joint)
    slides = coupling.coordinate.coordinate in ("x", "y", "z")
    base, body = joint.connectedBody, light_body(owner.components)
    kind, counted = (_SLIDE, "x") if slides else (_TURN, "angularX")
    stand = replace(owner.transform, localScale=ONE)
    ties: list[Coupling] = []
    last = base
    for number, term in enumerate(coupling.terms, 1):
        name = free_id(f"{coupling.id}:{number}", taken)
        on = replace(kind, connectedBody=last, because=(coupling.id,))
        last = len(objects)
        objects.append(GameObject(name, name, owner.parent, True, stand, (body, on)))
        place = JointCoordinate(last, 1, counted)
        ties.append(Coupling(name, coupling.kind, place, (term,)))
    # it removes nothing: there for the coupling to count the last body against the base
    whole = ConfigurableJoint(connectedBody=base, because=(coupling.id,), closure=True)
    objects[-1] = replace(objects[-1], components=(*objects[-1].components, whole))
    total = CouplingTerm(JointCoordinate(len(objects) - 1, 2, counted), 1.0)
    return [*ties, replace(coupling, terms=(total,))]


def _with_loop(analysis: Mobility, body: int) -> Mobility:
    """The last light body and the base are joined twice, in the island of the coupling's own body."""
    islands = (replace(i, loops=i.loops + 1) if body in i.gameObjects else i for i in analysis.islands)
    return replace(analysis, islands=tuple(islands))


def light_body(components: Sequence[object]) -> Rigidbody:
    """What neither falls nor weighs much beside the body with these components."""
    beside = next((c for c in components if isinstance(c, Rigidbody)), Rigidbody())
    x, y, z = (SHARE * moment for moment in beside.inertiaTensor)
    return Rigidbody(SHARE * beside.mass, inertiaTensor=(x, y, z), angularDamping=0.0, useGravity=False)
