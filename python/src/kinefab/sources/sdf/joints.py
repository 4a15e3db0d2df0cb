"""Joints of SDF models, resolved: which links, which axes in the world, which ranges."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import Report
from ...model import FREE, Freedom, Motion, Passive
from ...spatial import Array, Pose
from ..robots.xml_elements import Element, truth
from .scopes import Entry, Scope, entry_world_pose, frame_pose, link_of, world_pose

TYPES = ("revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "screw", "gearbox", "fixed")
TWO_AXES = frozenset({"universal", "revolute2", "gearbox"})
NO_AXIS = frozenset({"ball", "fixed"})
DEFAULT_STIFFNESS, DEFAULT_DISSIPATION = 1e8, 1.0


@dataclass(slots=True, eq=False)
class Mimic:
    """q = multiplier * (q of the joint's axis - reference) + offset.  axis: "axis" or "axis2" of the one that is followed."""

    joint: Entry
    axis: str
    multiplier: float
    offset: float
    reference: float
    where: str


@dataclass(slots=True, eq=False)
class Axis:
    """direction: unit, in the world at the exported pose.  freedom: its range, and what it is by itself."""

    direction: Array
    freedom: Freedom = FREE
    mimic: Mimic | None = None


@dataclass(slots=True, eq=False)
class SdfJoint:
    """parent, child: links, None for the world.  pose: of the joint's frame in the world.  id: path.

    lead: of a screw, metres a turn, right-handed.  ratio, reference: of a gearbox."""

    entry: Entry
    id: str
    kind: str
    parent: Entry | None
    child: Entry | None
    pose: Pose
    axes: list[Axis] = field(default_factory=list[Axis])
    lead: float = 0.0
    ratio: float = 1.0
    reference: Entry | None = None

    @property
    def name(self) -> str:
        return self.entry.name

    @property
    def where(self) -> str:
        return self.entry.element.where


def read_joint(entry: Entry, report: Report) -> SdfJoint | None:
    """The joint, or None after a fault."""
    element, scope = entry.element, entry.owner
    feature = f"joint {entry.name}"
    kind = element.attributes.get("type", "").strip().lower()  # as libsdformat reads it
    if kind not in TYPES:
        near = ", ".join(difflib.get_close_matches(kind, TYPES, 3)) or "none"
        if kind:
            element.fault("JOINT_TYPE_UNKNOWN", feature=feature, word=kind, near=near, known=", ".join(TYPES))
        else:
            element.fault("XML_MISSING", element="joint", field="type")
        return None
    before = len(report.diagnostics)
    parent, child = (_side(element, side, scope, feature) for side in ("parent", "child"))
    if len(report.diagnostics) > before:
        return None
    if parent is child:
        name = element.content("child") or "world"
        element.fault("SAME_COMPONENT", feature=feature, component=name)
        return None
    joint = SdfJoint(
        entry,
        f"{scope.path}/{entry.name}" if scope.path else entry.name,
        kind,
        parent,
        child,
        entry_world_pose(entry),
    )
    names = () if kind in NO_AXIS else ("axis", "axis2") if kind in TWO_AXES else ("axis",)
    joint.axes = [_axis(element, name, joint, scope, feature, report) for name in names]
    if (
        kind in ("revolute", "prismatic")
        and joint.axes[0].freedom.lower == joint.axes[0].freedom.upper == 0.0
    ):
        element.fault("LIMITS_AT_ZERO", feature=feature)
        joint.kind = "fixed"
    if kind == "screw":
        joint.lead = _lead(element)
    if kind == "gearbox":
        ratio = element.child("gearbox_ratio")
        joint.ratio = 1.0 if ratio is None else ratio.value(1.0)
        named = scope.find(element.content("gearbox_reference_body"), element, feature)
        joint.reference = None if named is None else link_of(named, feature)
    for tag in ("axis", "axis2"):
        if tag not in names and element.child(tag) is not None and kind not in NO_AXIS:
            report.dropped(f"{tag} of {feature}", "ELEMENT_DROPPED", element.where)
    return joint


def _side(element: Element, side: str, scope: Scope, feature: str) -> Entry | None:
    """The link of a side; None for the world, and after a fault."""
    child = element.child(side)
    name = "" if child is None else child.text.strip()
    if child is None or not name:
        element.fault("XML_MISSING", element="joint", field=side)
        return None
    if name == "world":
        return None
    if name in ("__model__",):
        from .scopes import canonical_link

        return canonical_link(scope)
    entry = scope.find(name, child, feature)
    return None if entry is None else link_of(entry, feature)


def _axis(element: Element, tag: str, joint: SdfJoint, scope: Scope, feature: str, report: Report) -> Axis:
    child = element.child(tag)
    if child is None:
        element.fault("XML_MISSING", element="joint", field=tag)
        return Axis(np.array([0.0, 0.0, 1.0]))
    given = child.child("xyz")
    xyz = np.array((0.0, 0.0, 1.0) if given is None else given.values(3, (0.0, 0.0, 1.0)))
    length = float(np.linalg.norm(xyz))
    if not length > 1e-9:
        xyz, length = np.array([0.0, 0.0, 1.0]), 1.0
        if joint.kind in ("revolute", "prismatic") and _never_moves(child):
            report.approximated(feature, "ROBOT_AXIS_ZERO", child.where)
        else:
            child.fault("AXIS_ZERO", field=tag)
    frame = "" if given is None else given.attributes.get("expressed_in", "").strip()
    if scope.version < (1, 7):  # the older spellings: 1.4 always means the model's frame
        flag = truth(child.content("use_parent_model_frame"))
        frame = "__model__" if scope.version < (1, 5) or flag else ""
    outer = world_pose(scope) @ frame_pose(frame, scope, child, feature) if frame else joint.pose
    axis = Axis(outer.rotation @ (xyz / length))
    axis.freedom = _freedom(child, joint.kind, f"{tag} of {feature}", report)
    axis.mimic = _mimic(child, scope, feature)
    return axis


def _never_moves(axis: Element) -> bool:
    """Whether its range is 0 to 0, so that its direction cannot matter."""
    limit = axis.child("limit")
    ends = [None if limit is None else limit.child(tag) for tag in ("lower", "upper")]
    return all(end is not None and end.value(math.inf, infinite=True) == 0.0 for end in ends)


def _freedom(axis: Element, kind: str, feature: str, report: Report) -> Freedom:
    def number(holder: Element | None, tag: str, default: float) -> float:
        child = None if holder is None else holder.child(tag)
        return default if child is None else child.value(default, infinite=True)

    limit, dynamics = axis.child("limit"), axis.child("dynamics")
    lower, upper = number(limit, "lower", -math.inf), number(limit, "upper", math.inf)
    if lower > upper:
        values = {"lower": f"{lower:g}", "upper": f"{upper:g}"}
        report.approximated(feature, "LIMITS_REVERSED_DROPPED", axis.where, **values)
        lower, upper = -math.inf, math.inf
    effort, speed = number(limit, "effort", math.inf), number(limit, "velocity", math.inf)
    values = [
        number(dynamics, tag, 0.0) for tag in ("spring_stiffness", "spring_reference", "damping", "friction")
    ]
    stiffness, rest, damping, friction = values
    for name, value in (("spring_stiffness", stiffness), ("damping", damping), ("friction", friction)):
        if not 0.0 <= value < math.inf:
            axis.wrong(name, "zero or more", f"{value:g}")
            return FREE
    stop, give = (
        number(limit, "stiffness", DEFAULT_STIFFNESS),
        number(limit, "dissipation", DEFAULT_DISSIPATION),
    )
    if (stop, give) != (DEFAULT_STIFFNESS, DEFAULT_DISSIPATION):
        report.dropped(f"limit stiffness and dissipation of {feature}", "ELEMENT_DROPPED", axis.where)
    if axis.child("initial_position") is not None:
        report.dropped(f"initial position of {feature}", "ELEMENT_DROPPED", axis.where)
    passive = Passive(
        stiffness, rest if stiffness else 0.0, damping, friction,
        effort=effort if effort >= 0.0 else math.inf, speed=speed if speed >= 0.0 else math.inf,
    )  # fmt: skip
    stated = None if passive == Passive() else passive
    if kind == "continuous" or (math.isinf(lower) and math.isinf(upper)):
        return Freedom(Motion.FREE, passive=stated)
    return Freedom(Motion.LIMITED, lower, upper, passive=stated)


def _mimic(axis: Element, scope: Scope, feature: str) -> Mimic | None:
    element = axis.child("mimic")
    if element is None:
        return None
    leader = scope.named(name := element.name("joint"))  # also of a model inside
    if leader is None or leader.kind != "joint":
        element.fault("MIMIC_UNKNOWN", feature=feature, joint=name, problem="no joint")
        return None
    word = element.attributes.get("axis", "axis").strip()

    def number(tag: str, default: float) -> float:
        child = element.child(tag)
        return default if child is None else child.value(default)

    if element.choice("axis", word, {"axis": 0, "axis2": 1}) is None:
        return None
    return Mimic(
        leader,
        word,
        number("multiplier", 1.0),
        number("offset", 0.0),
        number("reference", 0.0),
        element.where,
    )


def _lead(element: Element) -> float:
    """Metres a turn, right-handed.  ``thread_pitch`` is radians a metre, left-handed; the newer name goes first."""
    newer, older = element.child("screw_thread_pitch"), element.child("thread_pitch")
    if newer is None and older is not None:
        pitch = older.value(1.0)
        if pitch == 0.0:
            element.fault("SCREW_LEAD_ZERO", feature=f"joint {element.attributes.get('name', '')}")
            return 1.0
        return -2.0 * math.pi / pitch
    lead = 1.0 if newer is None else newer.value(1.0)
    if lead == 0.0:
        element.fault("SCREW_LEAD_ZERO", feature=f"joint {element.attributes.get('name', '')}")
        return 1.0
    return lead
