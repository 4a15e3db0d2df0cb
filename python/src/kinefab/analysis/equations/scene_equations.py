"""From a scene's constraints, joints and couplings to one ``System`` of equations."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from ...diagnostics import Report
from ...model import (
    RX,
    RY,
    RZ,
    TX,
    Constraint,
    ConstraintKind,
    Coupling,
    FeatureKind,
    Joint,
    JointKind,
    Scene,
)
from ...spatial import Array
from .atoms import Atom
from .bounded import RangedCoordinate
from .building import constraint_rows
from .constraints import Context
from .features import LEAST_LENGTH, Numbers, Sides, numbers_of, sides_of
from .rows import Rows, Side, has_direction
from .system import System

NEEDED_FEATURES = {ConstraintKind.SYMMETRY: 3, ConstraintKind.GROUND: 0}
_NOT_PLAIN = (ConstraintKind.GROUND, ConstraintKind.OTHER, ConstraintKind.SYMMETRY)
DEFAULT_LENGTH = 0.1
"""Characteristic length of an assembly whose geometry is all in one point, metres."""


@dataclass(slots=True)
class Equations:
    """The system and what its rows stand for.

    statements: the constraints, joints and couplings that rows belong to (``System.owner``).
    ranges: coordinates that the source bounds instead of fixing.
    length: metres, the assembly's characteristic length.
    directions: for each constraint between two directions the cosine of the angle between them at the
        exported pose, by statement number.
    places: the statements' places in the source, by id.
    """

    system: System
    statements: list[Constraint | Joint | Coupling]
    ranges: list[RangedCoordinate] = field(default_factory=list[RangedCoordinate])
    length: float = DEFAULT_LENGTH
    directions: dict[int, float] = field(default_factory=dict[int, float])
    places: dict[str, int] = field(default_factory=dict[str, int])

    def names(self, owners: Iterable[int]) -> list[str]:
        """Ids of statements, each once, in the source's order."""
        ids = {self.statements[i].id for i in owners}
        return sorted(ids, key=self.places.__getitem__)


def equations_of(
    scene: Scene, report: Report, axes: Array | None = None, source: Scene | None = None
) -> Equations:
    """All equations in the scene's order, body = node + 1.  What cannot be turned into equations is reported.

    axes: see ``System.axes``.  source: the same statements in the source's order, where that is another one.
    """
    axes = np.eye(3) if axes is None else axes
    given = numbers_of([f for c in scene.constraints for f in c.features])
    used = [plain or _usable(c, scene, report) for c, plain in zip(scene.constraints, _plain(scene, given))]
    usable = [c for c, own in zip(scene.constraints, used) if own]
    if not all(used):
        counts = [len(c.features) for c in scene.constraints]
        given = given.kept(np.flatnonzero(np.repeat(np.array(used, dtype=bool), counts)))
    sides = sides_of(scene, given, axes)
    rows, context = Rows(axes), Context()
    statements: list[Constraint | Joint | Coupling] = [*usable]
    constraint_rows(rows, usable, sides, context, report)
    by_id: dict[str, Joint] = {}
    for joint in scene.joints:
        rows.owner = len(statements)
        statements.append(joint)
        by_id[joint.id] = joint
        joint_rows(rows, joint, *joint_sides(joint, scene))
    for coupling in scene.couplings:
        rows.owner = len(statements)
        statements.append(coupling)
        _coupling_rows(rows, coupling, by_id, scene)
    system = rows.system(len(scene.nodes) + 1)
    stated = scene if source is None else source
    places = {s.id: i for i, s in enumerate([*stated.constraints, *stated.joints, *stated.couplings])}
    return Equations(
        system,
        statements,
        context.ranges,
        characteristic_length(system, scene),
        _directions(usable, sides),
        places,
    )


def _directions(constraints: list[Constraint], sides: Sides) -> dict[int, float]:
    """The cosine of the angle between the first two directions of each constraint that has two features."""
    counts = np.array([len(c.features) for c in constraints], dtype=np.int64)
    two = np.flatnonzero(counts > 1)
    at = (np.cumsum(counts) - counts)[two]
    cosines = np.einsum("ni,ni->n", sides.z[at], sides.z[at + 1])
    return dict(zip(two.tolist(), cosines.tolist()))


def characteristic_length(system: System, scene: Scene) -> float:
    """Radius of the constraints' points and their parts' origins about their middle, metres.

    Moves and scales with the assembly.  0.1 where everything is in one place.
    """
    used = np.unique(np.concatenate([system.body_a, system.body_b])) - 1
    nodes: list[int] = used[used >= 0].tolist()
    origins = [scene.nodes[i].pose.translation for i in nodes]
    on_b, on_a = np.any(system.p_b != 0.0, axis=1), np.any(system.p_a != 0.0, axis=1)
    points = np.concatenate([system.p_b[on_b], system.p_a[on_a], np.array(origins).reshape(-1, 3)])
    if not len(points):
        return DEFAULT_LENGTH
    radius = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    return radius if radius > 1e-12 * float(np.abs(points).max()) else DEFAULT_LENGTH


def _plain(scene: Scene, given: Numbers) -> list[bool]:
    """Constraints that are usable at first sight, all looked at together; the others go through ``_usable``.

    given: all their features.
    """
    constraints = scene.constraints
    plain = np.array([not (c.suppressed or c.kind in _NOT_PLAIN) for c in constraints], dtype=bool)
    plain &= np.isfinite(np.array([c.value for c in constraints], dtype=float))
    counts = np.array([len(c.features) for c in constraints], dtype=np.int64)
    plain &= counts > 1
    first = (np.cumsum(counts) - counts)[plain]
    plain[plain] = given.node[first] != given.node[first + 1]
    active = np.array([True, *(not n.suppressed for n in scene.nodes), False])
    there = active[np.minimum(given.node + 1, len(active) - 1)]  # NO_NODE: the last, as those beyond it
    plain[np.repeat(np.arange(len(constraints)), counts)[~(there & given.sound())]] = False
    return plain.tolist()


def _usable(c: Constraint, scene: Scene, report: Report) -> bool:
    feature = f"constraint {c.id}"
    if c.suppressed or c.kind is ConstraintKind.GROUND:
        return False
    if c.kind is ConstraintKind.OTHER:
        report.dropped(feature, "CONSTRAINT_NOT_INTERPRETED", c.where, id=c.id, kind=c.raw_kind or "other")
        return False
    if len(c.features) < NEEDED_FEATURES.get(c.kind, 2):
        report.dropped(feature, "CONSTRAINT_FEATURES_MISSING", c.where, id=c.id, count=len(c.features))
        return False
    for f in c.features:
        if f.node is not None and not 0 <= f.node < len(scene.nodes):
            report.dropped(feature, "CONSTRAINT_NODE_MISSING", c.where, id=c.id, node=f.node)
            return False
        numbers = [f.point] + [v for v in (f.direction, f.secondary) if v is not None]
        if not all(map(math.isfinite, chain(*numbers, (c.value, f.radius, f.half_angle)))):
            report.dropped(feature, "CONSTRAINT_NOT_FINITE", c.where, id=c.id)
            return False
        if has_direction(f.kind) and (f.direction is None or not math.hypot(*f.direction) > LEAST_LENGTH):
            report.dropped(feature, "CONSTRAINT_AXIS_ZERO", c.where, id=c.id, kind=f.kind.value)
            return False
    if any(f.node is not None and scene.nodes[f.node].suppressed for f in c.features):
        report.dropped(feature, "CONSTRAINT_PART_SUPPRESSED", c.where, id=c.id)
        return False
    # A slot is centred on another's plane.
    joined = c.features if c.kind is ConstraintKind.SYMMETRY else c.features[:2]
    if len({f.node for f in joined}) == 1:
        name = "ground" if c.features[0].node is None else scene.nodes[c.features[0].node].id
        report.dropped(feature, "CONSTRAINT_WITH_ITSELF", c.where, id=c.id, part=name)
        return False
    return True


def joint_sides(joint: Joint, scene: Scene) -> tuple[Side, Side]:
    """The joint's two frames in the WORLD at the exported pose, X as the sides' z (main axis)."""
    ends = ((joint.a, joint.frame_a), (joint.b, joint.frame_b))
    worlds = [(0 if node is None else node + 1, scene.pose(node) @ frame) for node, frame in ends]
    a, b = (frame_side(body, world.rotation, world.translation) for body, world in worlds)
    return a, b


def frame_side(body: int, rotation: Array, place: Array) -> Side:
    """A joint's WORLD frame on a body, X as the side's z (main axis)."""
    x, y, z = rotation.T
    return Side(body, place, x, y, z, FeatureKind.FRAME, framed=True)


def joint_rows(rows: Rows, joint: Joint, a: Side, b: Side) -> None:
    """Equations of a joint's locked freedoms, as a D6 joint means them (see ``model.Joint``).

    a, b: its two frames as ``joint_sides`` gives them.
    """
    axes_a, axes_b = (a.z, a.x, a.y), (b.z, b.x, b.y)  # X, Y, Z
    locked = joint.locked
    screw = joint.kind is JointKind.SCREW and joint.lead != 0.0
    for i in range(3):
        if i in locked:
            rows.plane(a, axes_a[i], b)
    turns = [i - RX for i in locked if i >= RX]
    if len(turns) == 3:
        rows.parallel(a, b)
        rows.dot(a, axes_a[1], b, axes_b[2])
    elif len(turns) == 2:
        free = 3 - sum(turns)
        for i in turns:
            rows.dot(a, axes_a[i], b, axes_b[free])
    elif turns == [RY - RX]:
        rows.dot(a, axes_a[2], b, axes_b[0])  # X of b stays across Z of a: the Cardan equation
    elif turns == [RZ - RX]:
        rows.dot(a, axes_a[1], b, axes_b[0])
    elif turns == [0]:
        rows.dot(a, axes_a[1], b, axes_b[2])
    if screw:
        row = rows.row(True)
        coordinate(rows, row, a, b, TX, 1.0)
        coordinate(rows, row, a, b, RX, -joint.lead / math.tau)


def coordinate(
    rows: Rows, row: slice, a: Side, b: Side, freedom: int, weight: float, offset: float = 0.0
) -> None:
    """weight * (joint coordinate - offset), added to a row."""
    axes_a, axes_b = (a.z, a.x, a.y), (b.z, b.x, b.y)
    i = freedom % 3
    if freedom < RX:
        rows.atom(row, Atom.PIP, a.body, b.body, p_a=a.p, dir_a=axes_a[i], p_b=b.p, d=offset, weight=weight)
    else:
        across = (i + 1) % 3
        rows.atom(
            row,
            Atom.ANG,
            a.body,
            b.body,
            dir_a=axes_a[across],
            k=axes_a[i],
            p_b=b.p,
            dir_b=axes_b[across],
            d=offset,
            weight=weight,
        )


def is_about_an_axis_of_b(freedom: int, joint: Joint) -> bool:
    """Whether it is the first (RX; RY where X is locked) of two rotations: b carries its axis."""
    turns = [i for i in joint.unlocked if i >= RX]
    return len(turns) == 2 and freedom == turns[0]


def joint_coordinate(rows: Rows, row: slice, a: Side, b: Side, freedom: int, joint: Joint) -> None:
    """A coordinate as the joint means it, added to a row.

    One about an axis that b carries is measured from a's second axis, which is always square to it.
    """
    if not is_about_an_axis_of_b(freedom, joint):
        coordinate(rows, row, a, b, freedom, 1.0)
        return
    turns = [i for i in joint.unlocked if i >= RX]
    axes_a, axes_b = (a.z, a.x, a.y), (b.z, b.x, b.y)
    about, across = axes_b[turns[0] - RX], turns[1] - RX
    rows.atom(
        row,
        Atom.ANG,
        b.body,
        a.body,
        dir_a=axes_b[across],
        k=-about,
        p_b=a.p,
        dir_b=axes_a[across],
    )


def _coupling_rows(rows: Rows, coupling: Coupling, by_id: dict[str, Joint], scene: Scene) -> None:
    # C = q - sum of ratio_i q_i - offset
    if not coupling.joints <= by_id.keys():
        return  # the reader has reported the missing joint
    row = rows.row(coupling.freedom < RX)
    own = joint_sides(by_id[coupling.joint], scene)
    coordinate(rows, row, *own, coupling.freedom, 1.0, coupling.offset)
    for term in coupling.terms:
        coordinate(rows, row, *joint_sides(by_id[term.joint], scene), term.freedom, -term.ratio)
