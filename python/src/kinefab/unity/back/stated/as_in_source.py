"""A written joint as its source had it: with its own frames, sides and zeros, which the component does not hold.

What stands in the file beside the component counts for as long as the component is the one that it makes: where a program has changed
that, or moved a part, the joint is what the component says.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, cast

from ....diagnostics import Report
from ....findings import JointFinding
from ....model import RX, Coupling, Joint, Term
from ....spatial import Pose
from ...frames import COUNTS_CONNECTED
from ...joints.coordinates import CanonicalJoint, Coordinates, canonical, read_coordinates
from ...joints.limits import GAP_ANGLE, GAP_LENGTH, turns_as_travel
from ...joints.mapping import component_of, idle, readings, with_stated
from ...joints.passive import OWN, with_passive_drives
from ...joints.placement import place
from ...scene import Joint as Component
from ...scene.joints.configurable_joint import SWING_RANGES, TWIST_RANGE

CLOSE = 1e-6
"""Of the component's numbers, of which a file has twelve digits."""
BESIDE = frozenset(
    {
        *("connectedBody", "breakForce", "breakTorque", "enableCollision", "enablePreprocessing", "massScale"),
        *("connectedMassScale", "because", "closure", "exact", "id", "name", "part", "connectedPart", "enabled", "extras"),
        *("projectionMode", "projectionDistance", "projectionAngle"),
    }
)
"""Fields of a component that do not come from frames and freedoms."""
EXTRAS = (TWIST_RANGE, *SWING_RANGES, OWN, *COUNTS_CONNECTED)


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """Where a component stands.  a, b: the poses of the parts that the source's joint names, the world's for none.
    own, connected: those of the objects with the bodies.  on_a: whether a moves with the own one.  stands: whether a, and b, does.
    exchanged: whether the restored joint has the two the other way round.  idle: whether forces move neither."""

    a: Pose
    b: Pose
    own: Pose
    connected: Pose
    on_a: bool
    stands: tuple[bool, bool]
    exchanged: bool
    idle: bool


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """How the source counts the coordinates of a written joint.  joint: the source's.  freedom_of, sense, zero: by a freedom q of the
    restored joint its source's, and q = sense * that + zero."""

    joint: Joint
    freedom_of: Mapping[int, int]
    sense: Mapping[int, float]
    zero: Mapping[int, float]


def as_in_source(stated: Joint, component: Component, ends: Ends, restored: Joint, world: tuple[Pose, Pose]) -> Counted | None:
    """None where the component is not the one that ``stated`` makes.

    restored: what the component says.  world: its frames there.
    """
    driven = with_passive_drives(stated, Report())
    if ends.idle:
        driven = idle(driven)
    shape = canonical(driven)
    frame_a, frame_b = ends.a @ shape.frame_a, ends.b @ shape.frame_b
    at = read_coordinates(shape, frame_a.inverse() @ frame_b)
    shape = turns_as_travel(driven, shape, at)
    placement = place(shape, *ends.stands)
    if placement.on_a != ends.on_a or not (_meets(at) or not component.exact):
        return None
    carrier_a, carrier_b = (ends.own, ends.connected) if ends.on_a else (ends.connected, ends.own)
    made = component_of(
        driven, shape, JointFinding(stated.id), carrier_a.inverse() @ frame_a, carrier_b.inverse() @ frame_b,
        placement, at, Report(),
    )  # fmt: skip
    made = with_stated(made, stated, readings(shape, at, placement))
    if not _is_same(made, component):
        return None
    kept = replace(
        stated,
        name=restored.name,
        break_force=restored.break_force,
        break_torque=restored.break_torque,
        enabled=restored.enabled,
        collide=restored.collide,
        closes=restored.closes,
        because=restored.because,
    )
    return _counted(kept, shape, at, frame_a, ends, world)


def in_source_terms(coupling: Coupling, counted: Mapping[str, Counted]) -> Coupling:
    """A coupling of restored coordinates as one of the source's.  counted: by the ids of joints that count otherwise."""

    def of(joint: str, freedom: int) -> tuple[int, float, float]:
        own = counted.get(joint)
        if own is None:
            return freedom, 1.0, 0.0
        return own.freedom_of[freedom], own.sense[freedom], own.zero[freedom]

    freedom, sense, zero = of(coupling.joint, coupling.freedom)
    offset, terms = coupling.offset - zero, list[Term]()
    for term in coupling.terms:
        own, turned, start = of(term.joint, term.freedom)
        offset += term.ratio * start
        terms.append(Term(term.joint, own, sense * turned * term.ratio))
    return replace(coupling, freedom=freedom, terms=tuple(terms), offset=sense * offset)


def _meets(at: Coordinates) -> bool:
    return at.gap_length <= GAP_LENGTH and at.gap_angle <= GAP_ANGLE


def _counted(
    joint: Joint, shape: CanonicalJoint, at: Coordinates, frame_a: Pose, ends: Ends, world: tuple[Pose, Pose]
) -> Counted:
    """The restored joint's axes are the component's or those turned round, and it may have the sides the other way round."""
    relative = world[0].inverse() @ world[1]
    axes = world[0].rotation.T @ frame_a.rotation @ at.in_a
    freedom_of: dict[int, int] = {}
    sense: dict[int, float] = {}
    zero: dict[int, float] = {}
    for i, own in enumerate(shape.name_of):
        sense[i] = math.copysign(1.0, axes[i % 3, i % 3]) * (-1.0 if ends.exchanged else 1.0)
        value = shape.freedoms[i].nearest_turn(at.values[i]) if i >= RX else at.values[i]
        freedom_of[i] = own
        zero[i] = (float(relative.translation[i]) if i < RX else 0.0) - sense[i] * float(value)
    return Counted(joint, freedom_of, sense, zero)


def _is_same(made: object, component: object) -> bool:
    if type(made) is not type(component):
        return False
    extras = [cast("Mapping[str, Any]", getattr(each, "extras", {})) for each in (made, component)]
    return _alike(made, component) and all(_alike(extras[0].get(key), extras[1].get(key)) for key in EXTRAS)


def _alike(one: Any, other: Any) -> bool:
    if is_dataclass(one):
        named = (own.name for own in fields(one) if own.name not in BESIDE)
        return type(one) is type(other) and all(_alike(getattr(one, name), getattr(other, name)) for name in named)
    if isinstance(one, (tuple, list)):
        items, others = cast("list[Any]", one), cast("list[Any]", other)
        return isinstance(other, (tuple, list)) and len(items) == len(others) and all(map(_alike, items, others))
    if isinstance(one, float) and isinstance(other, (int, float)):
        return one == other or abs(one - other) <= CLOSE * max(1.0, abs(one))
    return bool(one == other)
