"""Couplings as mimics: Newton's for joints of one freedom, PhysX's by the name of an axis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ....diagnostics import Report
from ....model import RX, TX, Coupling, Joint, Scene, Term
from ....unity.joints.coordinates import canonical, coordinates_in
from ....unity.joints.couplings import lead_coupling, uncoupled_screws
from .joints import WrittenJoint

TURNS = ("rotX", "rotY", "rotZ")
"""Axes that PhysX's own mimic knows."""
BOUNDS = {"physics:lowerLimit": -1e30, "physics:upperLimit": 1e30}
"""Degrees or metres: PhysX couples hinges and slides of finite ranges only, and from 1e38 on a bound is none for it.  Kinefab's own
reader takes these for none."""


def write_couplings(
    scene: Scene, joints: Mapping[str, WrittenJoint], trees: Mapping[Any, int], report: Report, ending: str
) -> None:
    """q = ratio q_leader + offset on the prim of the joint that follows; the report tells what no mimic is.

    trees: of what is in an articulation, as ``mark_articulations`` has it."""
    sound: list[Coupling] = []
    for coupling in [*scene.couplings, *_screws(scene, joints)]:
        feature = f"coupling {coupling.id}"
        if len(coupling.terms) != 1:
            report.dropped(
                feature, "COUPLING_TERMS_DROPPED", coupling.where,
                coupling=coupling.id, terms=len(coupling.terms), target=ending,
            )  # fmt: skip
            continue
        ends = [(coupling.joint, coupling.freedom), (coupling.terms[0].joint, coupling.terms[0].freedom)]
        lost = [
            name for name, freedom in ends if name not in joints or freedom not in joints[name].instance_of
        ]
        if lost:
            report.dropped(
                feature, "COUPLING_WITHOUT_JOINT", coupling.where, coupling=coupling.id, joint=lost[0]
            )
            continue
        sound.append(coupling)
    for coupling, follows in zip(sound, _followers(sound, joints)):
        if follows is None:
            feature = f"coupling {coupling.id}"
            report.dropped(
                feature, "COUPLING_FOLLOWS_TWO", coupling.where, coupling=coupling.id, target=ending
            )
            continue
        coupling = coupling if follows else _turned_round(coupling)
        _write(coupling, coupling.terms[0], joints, trees, report, ending)


def _followers(couplings: Sequence[Coupling], joints: Mapping[str, WrittenJoint]) -> list[bool | None]:
    """For each coupling whether its own coordinate follows, or the other one does; None where both follow others already.

    A coordinate follows one other, so each coupling is matched with one of its two coordinates.
    """

    def slot(joint: str, freedom: int) -> tuple[str, int]:
        return joint, -1 if joints[joint].typed else freedom

    ends = [[slot(c.joint, c.freedom), slot(c.terms[0].joint, c.terms[0].freedom)] for c in couplings]
    taken: dict[tuple[str, int], int] = {}
    for number in range(len(couplings)):
        came: dict[tuple[str, int], tuple[str, int] | None] = {}
        waiting: list[tuple[tuple[str, int], tuple[str, int] | None]] = [
            (e, None) for e in ends[number][::-1]
        ]
        while waiting:  # along those who could follow somebody else
            here, before = waiting.pop()
            if here in came:
                continue
            came[here] = before
            if here in taken:
                waiting += [(e, here) for e in ends[taken[here]] if e not in came]
                continue
            at: tuple[str, int] | None = here
            while at is not None:
                above = came[at]
                taken[at] = number if above is None else taken[above]
                at = above
            break
    slots = {number: at for at, number in taken.items()}
    return [slots[n] == ends[n][0] if n in slots else None for n in range(len(couplings))]


def _turned_round(coupling: Coupling) -> Coupling:
    """The same with the other coordinate following: q_leader = (q - offset) / ratio."""
    (term,) = coupling.terms
    terms = (Term(coupling.joint, coupling.freedom, 1.0 / term.ratio),)
    return replace(
        coupling, joint=term.joint, freedom=term.freedom, terms=terms, offset=-coupling.offset / term.ratio
    )


def _write(
    coupling: Coupling,
    term: Term,
    joints: Mapping[str, WrittenJoint],
    trees: Mapping[Any, int],
    report: Report,
    ending: str,
) -> None:
    own, led = joints[coupling.joint], joints[term.joint]
    unit, led_unit = (math.degrees(1.0) if f >= RX else 1.0 for f in (coupling.freedom, term.freedom))
    ratio, offset = term.ratio * unit / led_unit, coupling.offset * unit
    prim, leader = own.prim, led.prim.path
    instance, other = own.instance_of[coupling.freedom], led.instance_of[term.freedom]
    newton = own.typed and led.typed
    if newton:
        prim.apply("NewtonMimicAPI")
        prim.relation("newton:mimicJoint", leader)
        prim.numbers({"newton:mimicCoef0": offset, "newton:mimicCoef1": ratio})
    physx = instance in TURNS and other in TURNS
    if physx or not newton:
        prefix = f"physxMimicJoint:{instance}:"
        prim.apply(f"PhysxMimicJointAPI:{instance}")
        prim.relation(f"{prefix}referenceJoint", leader)
        prim.attribute(f"{prefix}referenceJointAxis", "Token", other, uniform=True)
        prim.numbers({f"{prefix}gearing": -ratio, f"{prefix}offset": -offset})
    detail = f"a mimic of {instance} by {other} stands there, which Kinefab reads and no engine yet"
    if newton or (physx and leader != prim.path):
        if prim.path in trees and trees[prim.path] == trees.get(leader):
            for typed in (own, led) if newton else ():
                typed.prim.finite(BOUNDS)
            report.kept(f"coupling {coupling.id}", coupling.where)
            return
        detail = "a mimic stands there; PhysX wants both its joints in one articulation, as which they are not written"
    report.approximated(
        f"coupling {coupling.id}", "TARGET_FEATURE_APPROXIMATED", coupling.where, target=ending, detail=detail
    )


def _screws(scene: Scene, joints: Mapping[str, WrittenJoint]) -> list[Coupling]:
    """Couplings for screws that nothing couples yet: a generic joint leaves the slide free of the turn."""
    return [
        lead_coupling(joint, *(standing(scene, joint, freedom) for freedom in (TX, RX)))
        for joint in uncoupled_screws(scene.joints, scene.couplings)
        if joint.id in joints
    ]


def standing(scene: Scene, joint: Joint, freedom: int) -> float:
    """A joint's coordinate TX..RZ at the exported pose, metres or radians."""
    shape = canonical(joint)
    at = shape.name_of.index(freedom)
    value = float(coordinates_in(scene, joint, shape).values[at])
    return value if freedom < RX else float(shape.freedoms[at].nearest_turn(value))
