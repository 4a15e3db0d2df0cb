"""From a joint of the model to the one Unity component that moves as it does.

Signs and frames: ``schemas/SPEC.md``, "Joints".  In short, with X Y Z the joint axes in CAD:

* The component's axes are M X, M Y and their cross product, -M Z.
* A HingeJoint on ``b`` has axis -M X, on ``a`` +M X: its angle is the CAD angle less that at export.
* A ConfigurableJoint limits and drives c, PhysX's "actor1 in actor0".  Where c is "b in a" (the component
  is on ``a``, or on ``b`` with swapBodies) distances keep their sign on X and Y; where it is "a in b" (on
  ``b``) all senses turn round.  Only joints that move alike seen from either side may take the second form.
* Zero of an angle is the exported pose, as Unity freezes the frames there.  Zero of a distance is where the
  anchors meet, so the anchors carry it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...diagnostics import Report
from ...findings import JointFinding
from ...model import FREE, RX, Joint, JointKind, Motion, Scene, alike_from_both_sides
from ...rigid import RigidGroups
from ...spatial import Array, Pose
from .. import frames
from ..scene import ConfigurableJoint, FixedJoint, HingeJoint
from ..scene.joints.joint import AnchoredJoint
from ..scene.vectors import vector3
from .configurable import MOTION_TITLES, configurable_fields
from .coordinates import CanonicalJoint, Coordinates, canonical, coordinates_in, removes_nothing
from .hinge import fits_hinge, hinge_fields
from .limits import report_gap, turns_as_travel
from .passive import OWN, stated_of, unbounded
from .placement import Placement, place
from .source_joint import source_of

LOSSES = ("JOINT_BETWEEN_LED", "JOINT_REDUNDANT", "JOINT_REMOVES_NOTHING")
"""Why a joint has no component, where that loses something."""

MappedJoint = HingeJoint | ConfigurableJoint | FixedJoint


@dataclass(frozen=True, slots=True, eq=False)
class UnityCoordinate:
    """How a CAD coordinate q reads on the component: u = sign * (q - zero), metres or radians.

    name: of the scene format (``angle``, ``x`` .. ``angularZ``).
    """

    name: str
    sign: float
    zero: float


@dataclass(frozen=True, slots=True, eq=False)
class UnityJoint:
    """A component, the node whose Rigidbody carries it and the one it is connected to (None: the ground's own, or the world).

    component: without ``connectedBody``.
    coordinates: for each freedom (TX..RZ) that is not locked, how to read it.
    on_a: whether the own side is the joint's a.
    """

    source: Joint
    owner: int
    connected: int | None
    component: MappedJoint
    coordinates: dict[int, UnityCoordinate]
    on_a: bool

    @property
    def parts(self) -> tuple[int | None, int | None]:
        """The nodes that the source joins, the own one first."""
        return (self.source.a, self.source.b) if self.on_a else (self.source.b, self.source.a)

    def beside(self, scene: Scene) -> dict[str, str]:
        """The component's fields of the parts that others have the Rigidbodies of."""
        sides = {"part": (self.parts[0], self.owner), "connectedPart": (self.parts[1], self.connected)}
        return {key: scene.nodes[n].id for key, (n, carrier) in sides.items() if n is not None and n != carrier}


def map_joint(
    joint: Joint,
    scene: Scene,
    groups: RigidGroups,
    carrier: Callable[[int], int],
    report: Report,
    finding: JointFinding | None = None,
    led: Callable[[int], bool] = lambda carrier: False,
    base: Callable[[int], int | None] = lambda node: None,
) -> UnityJoint | None:
    """The component for ``joint``, or None where none is needed or possible; ``report`` says which and why.

    carrier: the node whose GameObject has the Rigidbody that a node moves with.  finding: what is known of the joint.
    led: whether scripts alone move the Rigidbody of a carrier.  base: of a node on the ground the one whose Rigidbody holds it,
    None where the ground's does.
    """
    found = finding or JointFinding(joint.id)
    feature = f"joint {joint.id}"
    if (unbodied := groups.without_body(joint)) is not None:
        report.dropped(
            feature, "JOINT_WITHOUT_BODY", joint.where, joint=joint.id, node=scene.nodes[unbodied].id
        )
        return None
    stands = groups.is_ground(joint.a), groups.is_ground(joint.b)
    a, b = (
        None if n is None else base(n) if still else carrier(n) for n, still in zip((joint.a, joint.b), stands)
    )
    # Unity's solver moves neither side, and lets two kinematic bodies pass each other with a joint or without
    unmoved = a != b and not all(stands) and all(still or (n is not None and led(n)) for n, still in zip((a, b), stands))
    counted = next((c for c in scene.couplings if joint.id in c.joints), None)
    if unmoved and counted is not None:
        joint = idle(joint)
    shape = canonical(joint)
    coordinates = coordinates_in(scene, joint, shape)
    shape = turns_as_travel(joint, shape, coordinates)
    lossless = report_gap(joint, coordinates, report)
    unneeded = _why_none(joint, shape, found, groups, counted is not None, unmoved)
    if unneeded in LOSSES:
        report.dropped(feature, unneeded, joint.where, joint=joint.id)
    elif unneeded == "CLOSURE_NOT_NEEDED":
        report.kept(feature, joint.where, unneeded, joint=joint.id, loop=found.loop_names(scene))
    elif unneeded is not None:
        report.kept(feature, joint.where)
    if unneeded is not None:
        return None
    if unmoved and counted is not None:
        report.add("JOINT_BETWEEN_LED_COUNTED", joint.where, joint=joint.id, coupling=counted.id)
    frame_a = scene.pose(a).inverse() @ scene.pose(joint.a) @ shape.frame_a
    frame_b = scene.pose(b).inverse() @ scene.pose(joint.b) @ shape.frame_b
    placement = place(shape, *stands)
    before = len(report.outcomes)
    component = component_of(joint, shape, found, frame_a, frame_b, placement, coordinates, report)
    owner, connected = (a, b) if placement.on_a else (b, a)
    assert owner is not None, "two parts of the ground are one rigid group"
    if not lossless or any(found.misfit) or len(report.outcomes) > before:
        component = replace(component, exact=False)
    elif found.freed:
        _report_freed(joint, found, shape, component, scene, scene.nodes[owner].id, report)
    else:
        report.kept(feature, joint.where)
    return UnityJoint(joint, owner, connected, component, readings(shape, coordinates, placement), placement.on_a)


def idle(joint: Joint) -> Joint:
    """What there is of a joint whose sides scripts alone move: there to be counted by, however they do."""
    return replace(joint, kind=JointKind.GENERAL, freedoms=(FREE,) * 6)


def with_stated(component: MappedJoint, joint: Joint, coordinates: Mapping[int, UnityCoordinate]) -> MappedJoint:
    """With what the source states of the joint's coordinates.  joint: the source's, with its passive springs."""
    if not isinstance(component, AnchoredJoint):
        return component
    names = {i: at.name for i, at in coordinates.items()}
    component = replace(component, **stated_of(joint, names))
    own = [name for i, name in names.items() if unbounded(joint.freedoms[i]) and joint.slerp is None]
    return replace(component, extras={**component.extras, OWN: own}) if own else component


def with_source(component: MappedJoint, mapped: UnityJoint, joint: Joint, number: int) -> MappedJoint:
    """With all that stands beside Unity's own fields.  joint: the source's, with its passive springs; number: its place there."""
    component = with_stated(component, joint, mapped.coordinates)
    return replace(component, extras={**component.extras, **source_of(joint, number, mapped.on_a)})


def _why_none(
    joint: Joint, shape: CanonicalJoint, found: JointFinding, groups: RigidGroups, counted: bool, unmoved: bool
) -> str | None:
    """Why a joint needs no component: a code of the report, "" where one Rigidbody or a FixedJoint of the group is it, or
    None where it needs one.  counted: whether a coupling counts by it.  unmoved: whether Unity's solver moves neither side."""
    if groups.together(joint.a, joint.b):
        if unmoved:
            return "JOINT_BETWEEN_LED"
        return "JOINT_REDUNDANT" if shape.rotations or shape.translations else ""
    if counted:
        return None
    # between two bodies it still keeps Unity from letting them collide
    apart = found.freed and not (groups.is_ground(joint.a) or groups.is_ground(joint.b))
    if removes_nothing(joint, shape) and not apart:
        return "CLOSURE_NOT_NEEDED" if found.freed else "JOINT_REMOVES_NOTHING"
    return "JOINT_BETWEEN_LED" if unmoved else None


def component_of(
    joint: Joint,
    shape: CanonicalJoint,
    found: JointFinding,
    frame_a: Pose,
    frame_b: Pose,
    placement: Placement,
    coordinates: Coordinates,
    report: Report,
) -> MappedJoint:
    """The component with all of its fields but the connected body.  frame_a, frame_b: the joint frames in their carriers."""
    common = _common_fields(joint, found)
    if placement.on_a and not fits_hinge(shape) and alike_from_both_sides(joint.unlocked):
        common["extras"] |= frames.COUNTS_CONNECTED
    if not (shape.rotations or shape.translations):
        return FixedJoint(**common)
    if fits_hinge(shape):
        anchors, basis = _frame_fields(frame_a, frame_b, placement, coordinates)
        # The axis takes the sense, so that the angle is the CAD angle less that at export.
        axis = vector3(placement.own.angular[0] * basis[:, 0])
        turning = hinge_fields(joint, shape, coordinates, report)
        return HingeJoint(**common, **anchors, axis=axis, **turning)
    limits, middle = configurable_fields(joint, shape, coordinates, placement, report)
    shifted = Pose(frame_a.rotation, frame_a.point(middle))
    anchors, basis = _frame_fields(shifted, frame_b, placement, coordinates)
    common["extras"] |= limits.pop("extras", {})
    axes = {"axis": vector3(basis[:, 0]), "secondaryAxis": vector3(basis[:, 1])}
    return ConfigurableJoint(**common, **anchors, **axes, **limits)


def _frame_fields(
    frame_a: Pose, frame_b: Pose, placement: Placement, coordinates: Coordinates
) -> tuple[dict[str, Any], Array]:
    """Anchors, and the component's axes as columns, shape (3, 3).  frame_a, frame_b: the joint frames in their carriers, their origins the anchors."""
    own, other = (frame_a, frame_b) if placement.on_a else (frame_b, frame_a)
    turn = coordinates.in_a if placement.on_a else coordinates.in_b
    basis = frames.joint_basis(own.rotation @ turn)
    anchors = {
        "anchor": vector3(frames.point(own.translation)),
        "autoConfigureConnectedAnchor": False,
        "connectedAnchor": vector3(frames.point(other.translation)),
    }
    return anchors, basis


def _report_freed(
    joint: Joint,
    found: JointFinding,
    shape: CanonicalJoint,
    component: MappedJoint,
    scene: Scene,
    owner: str,
    report: Report,
) -> None:
    """What the loop holds instead of the joint, by the names that Unity's inspector shows."""
    feature = f"joint {joint.id}"
    names = {"joint": joint.id, "loop": found.loop_names(scene), "object": owner}
    if not joint.locked:
        report.kept(feature, joint.where, "CLOSURE_ALL_FREE", **names)
        return
    axes = [MOTION_TITLES[i] for i, freedom in enumerate(shape.name_of) if freedom in found.freed]
    if isinstance(component, HingeJoint):
        axes = ["The turning"]
    one = len(axes) == 1
    names |= {"axes": ", ".join(axes), "type": type(component).__name__}
    names |= {"are": "is" if one else "are", "motions": "this motion" if one else "these motions"}
    report.kept(feature, joint.where, "CLOSURE_AXES_FREE", **names)


def _common_fields(joint: Joint, found: JointFinding) -> dict[str, Any]:
    return {
        "breakForce": joint.break_force,
        "breakTorque": joint.break_torque,
        "enableCollision": joint.collide,
        "because": tuple(joint.because),
        "closure": found.closure,
        "id": joint.id,
        "name": joint.name,
        "extras": dict(joint.extras),
    }


def readings(
    shape: CanonicalJoint, coordinates: Coordinates, placement: Placement
) -> dict[int, UnityCoordinate]:
    """How each unlocked coordinate is read: the own body's motion against the connected one's."""
    own = placement.own
    hinge = fits_hinge(shape)
    found: dict[int, UnityCoordinate] = {}
    for i in range(6):
        if shape.freedoms[i].motion is Motion.LOCKED:
            continue
        axis = i % 3
        if hinge:
            name, sign = "angle", 1.0  # hinge_fields turns the axis to it
        elif i < RX:
            name, sign = "xyz"[axis], own.linear[axis]
        else:
            name, sign = "angular" + "XYZ"[axis], own.angular[axis]
        zero = shape.freedoms[i].nearest_turn(coordinates.values[i]) if i >= RX else coordinates.values[i]
        found[shape.name_of[i]] = UnityCoordinate(name, sign, float(zero))
    return found
