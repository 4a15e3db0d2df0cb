"""A bundle's joints: two frames, a coordinate for each freedom, and the limits the designer switched on.

A coordinate is the one the CAD displays, so that its limits hold; the frames are placed so that they read it
at the exported pose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from ...model import UNLOCKED, Freedom, Joint, JointKind, Motion, freedoms_of
from ...spatial import Array, Pose, perpendicular
from ..reading.joint_frames import coordinates, frame_axes, freedom_names, relabel, shifted
from ..reading.placement import Placement
from ..reading.record import Log, Record
from ..reading.source_frame import SourceFrame
from .components import Components
from .joint_draft import JOINT, FrameDraft, JointDraft, read_draft

GAP_LENGTH, GAP_ANGLE = 1e-5, 1e-4
"""Metres and radians within which two statements of a source say the same: it prints six digits or so."""

WITHOUT_AXIS = frozenset({JointKind.SPHERICAL, JointKind.UNIVERSAL})
"""Kinds whose two z axes need not lie on one line."""
WITHOUT_TURN = frozenset({JointKind.FIXED, JointKind.PRISMATIC})
"""Kinds that let nothing turn: axes that are half a turn apart are the same axes, named the other way."""


@dataclass(frozen=True, slots=True, eq=False)
class Joints:
    """joints: as read.  positions: coordinates at the exported pose, as the joint's frames read them, shape
    (6,).
    turns: what to add to get the coordinate the CAD displays (whole turns), shape (6,).  Both by joint id.
    inactive: ids of joints left out because they, or a component of theirs, are suppressed, or because
    their type is unknown.
    """

    joints: list[Joint] = field(default_factory=list[Joint])
    positions: dict[str, Array] = field(default_factory=dict[str, Array])
    turns: dict[str, Array] = field(default_factory=dict[str, Array])
    inactive: set[str] = field(default_factory=set[str])


def read_joints(bundle: Record, components: Components, frame: SourceFrame, log: Log) -> Joints:
    """The explicit joints of a bundle."""
    found = Joints()
    drafts: list[JointDraft] = []
    seen: dict[str, str] = {}
    for record in bundle.records("joints", JOINT):
        name = record.identity(seen)
        if (draft := read_draft(record, name, components, frame, found.inactive)) is not None:
            drafts.append(draft)
    if drafts:
        _build(drafts, components.placement, frame, found, log)
    return found


def _build(
    drafts: list[JointDraft], placement: Placement, frame: SourceFrame, found: Joints, log: Log
) -> None:
    """Frames of all joints at once, then the joints one by one."""
    pairs = _bring_together(drafts, placement)
    for i, draft in enumerate(drafts):
        _check_flip(draft, bool(pairs.opposed[i]))
        unlocked, known = UNLOCKED[draft.kind], pairs.known[i]
        here = np.array([pairs.measured[i, k] if k in unlocked and known[k] else 0.0 for k in range(6)])
        stated = _named(draft.kind, frame)
        wanted, turns = _positions(draft, stated, here, known)
        world_b = np.eye(4)
        world_b[:3, :3], world_b[:3, 3] = pairs.axes_b[i], pairs.origins_b[i]
        if not np.array_equal(here, wanted):
            world_b = shifted(world_b, here, wanted)
        found.joints.append(
            Joint(
                id=draft.id,
                kind=draft.kind,
                a=None if draft.a < 0 else draft.a,
                b=draft.b,
                frame_a=_in_node(placement, draft.a, pairs.axes_a[i], pairs.origins_a[i]),
                frame_b=_in_node(placement, draft.b, world_b[:3, :3], world_b[:3, 3]),
                freedoms=_freedoms(draft, stated, wanted, turns, log),
                name=draft.name,
                lead=draft.lead,
                because=draft.because,
                where=log.place(draft.record.pointer),
            )
        )
        found.positions[draft.id], found.turns[draft.id] = wanted, turns


@dataclass(frozen=True, slots=True, eq=False)
class FramePairs:
    """Joint frames in the world, X-main, shapes (n, 3, 3) and (n, 3).  opposed: the z axes as given pointed
    against each other, shape (n,).  known: whether the frames as given say the coordinate, shape (n, 6).
    measured: coordinates of b's frame in a's, shape (n, 6).
    """

    axes_a: Array
    origins_a: Array
    axes_b: Array
    origins_b: Array
    opposed: np.ndarray
    known: np.ndarray
    measured: Array


def _bring_together(drafts: list[JointDraft], placement: Placement) -> FramePairs:
    axes_a, origins_a = _world_frames([(d.a, d.frame_a) for d in drafts], placement)
    axes_b, origins_b = _world_frames([(d.b, d.frame_b or d.frame_a) for d in drafts], placement)
    universal = np.array([d.kind is JointKind.UNIVERSAL for d in drafts])
    given = np.array([d.frame_b is not None for d in drafts])
    has_x = np.array([d.frame_b is not None and None not in (d.frame_a.x, d.frame_b.x) for d in drafts])
    opposed = np.einsum("ni,ni->n", axes_a[:, :, 2], axes_b[:, :, 2]) < 0.0
    opposed &= np.array([d.kind not in WITHOUT_AXIS for d in drafts])
    # Half a turn about b's x: then both z axes point one way and angles count from x to x about a's z.
    axes_b = np.where(opposed[:, None, None], axes_b * [1.0, -1.0, -1.0], axes_b)
    half_round = has_x & np.array([d.kind in WITHOUT_TURN for d in drafts])
    half_round &= np.einsum("ni,ni->n", axes_a[:, :, 0], axes_b[:, :, 0]) < -math.cos(GAP_ANGLE)
    axes_b = np.where(half_round[:, None, None], axes_b * [-1.0, -1.0, 1.0], axes_b)
    # Where an x is missing the angle is not stated: b's x lies along a's at the exported pose.
    across = np.abs(np.einsum("ni,ni->n", axes_b[:, :, 2], axes_a[:, :, 0])) < 0.99
    borrow = given & ~has_x & across
    axes_b[borrow] = frame_axes(axes_b[borrow, :, 2], axes_a[borrow, :, 0])
    axes_a, axes_b = relabel(axes_a, universal, second=False), relabel(axes_b, universal, second=True)
    # Without a frame of its own b's coincides with a's now.
    axes_b[~given], origins_b[~given] = axes_a[~given], origins_a[~given]
    back = np.swapaxes(axes_a, 1, 2)
    return FramePairs(
        axes_a,
        origins_a,
        axes_b,
        origins_b,
        opposed,
        known=np.column_stack([given] * 3 + [has_x] * 3),
        measured=coordinates(back @ axes_b, np.einsum("nij,nj->ni", back, origins_b - origins_a)),
    )


def _world_frames(given: list[tuple[int, FrameDraft]], placement: Placement) -> tuple[Array, Array]:
    """Axes (columns x, y, z) and origins in the world of frames on nodes; an absent x is chosen."""
    inside = [draft.inside for _, draft in given]
    world = np.full(len(given), -1)
    origins = placement.points(world, inside, [draft.o for _, draft in given])
    z = placement.directions(world, inside, [draft.z for _, draft in given])
    x = placement.directions(world, inside, [draft.x or (0.0, 0.0, 0.0) for _, draft in given])
    for i, (_, draft) in enumerate(given):
        if draft.x is None:
            x[i] = perpendicular(z[i])
    return frame_axes(z, x), origins


def _in_node(placement: Placement, node: int, axes: Array, origin: Array) -> Pose:
    return placement.pose(node).inverse() @ Pose(axes, origin) if node >= 0 else Pose(axes, origin)


def _check_flip(draft: JointDraft, opposed: bool) -> None:
    """The geometry decides; a flag that says otherwise is worth a word."""
    compared = draft.frame_b is not None and draft.kind not in WITHOUT_AXIS
    if compared and draft.flipped is not None and opposed != draft.flipped:
        draft.record.fault(
            "JOINT_FLIP_MISMATCH", "flipped", feature=f"joint {draft.id}", stated=draft.flipped
        )


def _positions(
    draft: JointDraft, stated: tuple[Freedom, ...], here: Array, known: np.ndarray
) -> tuple[Array, Array]:
    """Coordinates at the exported pose, and the whole turns by which the CAD displays more.

    The displayed value rules: the limits are stated beside it.
    """
    positions, turns = here.copy(), np.zeros(6)
    for freedom, said in draft.dof.items():
        if said.value is None:
            continue
        if draft.kind is JointKind.SPHERICAL:
            if said.value != 0.0:
                said.record.fault("BALL_VALUE_IGNORED", "value", feature=f"joint {draft.id}")
            continue
        if freedom >= 3:
            turns[freedom] = 2.0 * math.pi * round((said.value - here[freedom]) / (2.0 * math.pi))
        value = said.value - turns[freedom]
        if not known[freedom]:
            positions[freedom] = value
        elif abs(value - here[freedom]) > (GAP_ANGLE if freedom >= 3 else GAP_LENGTH):
            unit, factor = ("degrees", math.degrees(1.0)) if freedom >= 3 else ("m", 1.0)
            shown = [factor * stated[freedom].sign * q for q in (said.value, here[freedom])]
            said.record.fault(
                "JOINT_VALUE_MISMATCH", "value", feature=f"joint {draft.id}", stated=f"{shown[0]:.6g}",
                measured=f"{shown[1]:.6g}", unit=unit,
            )  # fmt: skip
            positions[freedom] = value
    return positions, turns


def _freedoms(
    draft: JointDraft, stated: tuple[Freedom, ...], wanted: Array, turns: Array, log: Log
) -> tuple[Freedom, ...]:
    freedoms = list(stated)
    for freedom, said in draft.dof.items():
        lower, upper = said.lower - turns[freedom], said.upper - turns[freedom]
        freedoms[freedom] = replace(
            freedoms[freedom],
            motion=Motion.LIMITED if lower > -math.inf or upper < math.inf else Motion.FREE,
            lower=lower,
            upper=upper,
            at=None if said.value is None else float(wanted[freedom]),
            turns=round(turns[freedom] / (2.0 * math.pi)),
            where=log.place(said.record.pointer),
        )
    return tuple(freedoms)


@lru_cache(maxsize=64)
def _named(kind: JointKind, frame: SourceFrame) -> tuple[Freedom, ...]:
    """The freedoms of a kind under the bundle's names, counted as the bundle does."""
    names = {freedom: name for name, freedom in freedom_names(kind).items()}
    return tuple(
        replace(freedom, name=names[i], sign=math.copysign(1.0, frame.coordinate(names[i])))
        for i, freedom in enumerate(freedoms_of(kind))
    )
