"""Inventor's assembly joints as joints of a bundle."""

from __future__ import annotations

from typing import Any

from ..channel import MemberFailed
from ..draft import Record, exchanged, frame, freedom, reach
from .api import Entity, Intent, Joint, JointDefinition, Parameter
from .constraints import HEALTH, SUPPRESSED, WELL, Owner
from .geometry import entity_shape, numbers

TYPES = {
    102401: ("rigid", "", ""),
    102402: ("revolute", "", "rz"),
    102403: ("slider", "tz", ""),
    102404: ("cylindrical", "tz", "rz"),
    102405: ("planar", "tx", "rz"),
    102406: ("ball", "", ""),
}
"""AssemblyJointTypeEnum: word, the coordinates that LinearPosition and AngularPosition show."""


def read_joint(owner: Owner, joint: Joint) -> None:
    """Add the joint to the draft.  Positions are of the first side against the second, so that one is b."""
    draft = owner.draft
    name = joint.Name
    own = draft.unique(name if owner.frame == "world" else f"{owner.id}/{name}")
    health, definition = joint.HealthStatus, joint.Definition
    word, slide, turn = TYPES[definition.JointType]
    one, two = joint.OccurrenceOne, joint.OccurrenceTwo
    a = owner.itself if two is None else owner.component(two)
    b = owner.itself if one is None else owner.component(one)
    record: Record = {"id": own, "name": name, "type": word, "a": a, "b": b}
    record["frameA"] = _frame(owner, definition.OriginTwo, definition.AlignmentTwo, False, False)
    flipped = bool(definition.FlipAlignmentDirection)
    record["frameB"] = _frame(
        owner, definition.OriginOne, definition.AlignmentOne, bool(definition.FlipOriginDirection), flipped
    )
    dofs = [_slide(definition, slide)] if slide else []
    dofs += [_turn(definition, turn)] if turn else []
    if dofs:
        record["dof"] = dofs
    if b == "ground":  # a joint's second side is a component
        record = exchanged(record)
    if (gap := _number(definition.Gap)) and "extras" not in record:
        record["extras"] = {"gap": gap}
    if bool(joint.Suppressed) or health == SUPPRESSED:
        record["suppressed"] = True
    elif health not in WELL:
        words = HEALTH.get(health, str(health))
        draft.report.add("CAPTURE_SICK", id=own, health=words, program=draft.program)
        record |= {"suppressed": True, "extras": {"health": words}}
    elif joint.Locked and word != "rigid":
        draft.report.approximated(f"joint {own}", "CAPTURE_LOCKED", id=own, program=draft.program)
        record["type"] = "rigid"
        for key in ("dof", "frameA", "frameB"):
            record.pop(key, None)
    draft.owners[own] = owner.frame
    draft.joints.append(record)


def _frame(owner: Owner, origin: Intent, alignment: Entity | None, flip_z: bool, flip_x: bool) -> Record:
    shown = entity_shape(origin.Geometry, owner.frame)
    try:
        point = numbers(origin.Point)
    except (MemberFailed, AttributeError):
        point = shown["p"]
    z: Any = shown.get("d") or [0.0, 0.0, 1.0]
    x = entity_shape(alignment, owner.frame).get("d") if alignment is not None else None
    z = [-v for v in z] if flip_z else z
    x = [-v for v in x] if flip_x and x else x
    return frame(owner.frame, point, z, x)


def _number(parameter: Parameter | None) -> float | None:
    return None if parameter is None else float(parameter.Value)


def _slide(d: JointDefinition, name: str) -> Record:
    low, high = _number(d.LinearPositionStartLimit), _number(d.LinearPositionEndLimit)
    return freedom(
        name,
        _number(d.LinearPosition),
        reach(bool(d.HasLinearPositionStartLimit), low),
        reach(bool(d.HasLinearPositionEndLimit), high),
    )


def _turn(d: JointDefinition, name: str) -> Record:
    limited = bool(d.HasAngularPositionLimits)
    low, high = _number(d.AngularPositionStartLimit), _number(d.AngularPositionEndLimit)
    return freedom(name, _number(d.AngularPosition), reach(limited, low), reach(limited, high))
