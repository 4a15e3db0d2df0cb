"""Where prims stand: matrices with scale, taken apart into what a rigid scene can hold.

A prim's matrix is A v + t.  A node takes the rotation of A alone; what is left of A goes to the meshes and colliders below.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...spatial import Array, BoolArray, Pose
from ..reading.source_frame import SourceFrame
from .api import Gf, Usd, UsdGeom, Vt
from .stage import matrix

SQUARE = 1e-6
"""Axes whose cosines are below this are at right angles; files carry float32."""
EXACT = 1e-12
MIRROR = np.diag([-1.0, 1.0, 1.0])


def rotation_of(linear: Array) -> Array:
    """The rotation in A, shape (3, 3): its polar factor; of a mirrored A that of -A, as Gf's and PhysX's factoring has it."""
    if np.abs(linear.T @ linear - np.eye(3)).max() <= EXACT:
        return linear if np.linalg.det(linear) > 0.0 else -linear
    lengths = np.linalg.norm(linear, axis=0)
    if (lengths > 0.0).all():
        axes = linear / lengths
        if np.abs(axes.T @ axes - np.eye(3)).max() <= EXACT:  # its own columns: no digit is lost
            return axes if np.linalg.det(axes) > 0.0 else -axes
    left, _, right = np.linalg.svd(linear)
    return left @ right * np.sign(np.linalg.det(left) * np.linalg.det(right))


def rotations_of(linears: Array) -> tuple[Array, BoolArray]:
    """As ``rotation_of`` of each, shape (n, 3, 3), and which are rotations already, shape (n,); these in one stack."""
    off = np.abs(linears.transpose(0, 2, 1) @ linears - np.eye(3)).max(axis=(1, 2), initial=0.0)
    rigid = (off <= EXACT) & (np.linalg.det(linears) > 0.0)
    found = linears.copy()
    for i in np.flatnonzero(~rigid).tolist():
        found[i] = rotation_of(linears[i])
    return found, rigid


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A linear map taken apart: rotation @ diag(scale) @ bake.

    bake: None, or what must go into the vertices: a mirror, a shear; shape (3, 3).  sheared: whether it is a shear.
    """

    rotation: Array
    scale: Array
    bake: Array | None
    sheared: bool


def taken_apart(linear: Array) -> Stretch | None:
    """None where the map is flat (a scale of zero)."""
    mirrored = np.linalg.det(linear) < 0.0
    own = linear @ MIRROR if mirrored else linear
    lengths = np.linalg.norm(own, axis=0)
    if not (lengths > 0.0).all() or abs(np.linalg.det(own)) <= 1e-12 * lengths.prod():
        return None
    axes = own / lengths
    off = np.abs(axes.T @ axes - np.eye(3)).max()
    if off <= SQUARE:
        rotation = axes if off <= EXACT else rotation_of(axes)
        return Stretch(rotation, _plain(lengths), MIRROR if mirrored else None, False)
    rotation = rotation_of(linear)
    return Stretch(rotation, np.ones(3), rotation.T @ linear, True)


def all_taken_apart(linears: Array) -> list[Stretch | None]:
    """As ``taken_apart`` of each, shape (n, 3, 3); those that only turn and scale in one stack.

    What turns by no more than rounding does not turn: a mesh lies as squarely in a body that is turned as in one that is not.
    """
    lengths = np.linalg.norm(linears, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        axes = linears / lengths[:, None, :]
        off = np.abs(axes.transpose(0, 2, 1) @ axes - np.eye(3)).max(axis=(1, 2), initial=0.0)
        easy = (off <= EXACT) & (np.linalg.det(linears) > 0.0)
    scales = _plain(lengths)
    axes[np.abs(axes - np.eye(3)).max(axis=(1, 2), initial=0.0) <= EXACT] = np.eye(3)
    return [
        Stretch(axes[i], scales[i], None, False) if plain else taken_apart(linears[i])
        for i, plain in enumerate(easy.tolist())
    ]


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A prim as its node sees it.  pose: of its shape in the node's frame.  scale: along the shape's axes, scene axes."""

    stretch: Stretch
    pose: Pose
    scale: tuple[float, float, float]


HOME = Fit(Stretch(np.eye(3), np.ones(3), None, False), Pose(), (1.0, 1.0, 1.0))
"""Of what stands as its node does."""


def fits(worlds: Array, stands: Sequence[Stand]) -> list[Fit | None]:
    """Of prims by their matrices, shape (n, 4, 4), each in its node's frame; None where it is flat."""
    if not stands:
        return []
    frame = stands[0].frame
    turn, back = frame.turn, np.array([at.rotation for at in stands]).transpose(0, 2, 1)
    apart = all_taken_apart(back @ worlds[:, :3, :3])
    away = worlds[:, :3, 3] - np.array([at.origin for at in stands])
    points = (back @ away[..., None])[..., 0] @ turn.T * frame.length
    flat = Stretch(np.eye(3), np.zeros(3), None, False)
    rotations = turn @ np.array([(s or flat).rotation for s in apart]) @ turn.T
    scales: list[list[float]] = (np.array([(s or flat).scale for s in apart]) @ np.abs(turn.T)).tolist()
    return [
        None if s is None else Fit(s, Pose(rotation, point), (x, y, z))
        for s, rotation, point, (x, y, z) in zip(apart, rotations, points, scales)
    ]


def _plain(lengths: Array) -> Array:
    """Scales that are one but for rounding are one."""
    return np.where(np.abs(lengths - 1.0) <= 1e-9, 1.0, lengths)


@dataclass(frozen=True, slots=True, eq=False)
class Local:
    """A prim's matrix in its parent's, whether it ignores the parent, and whether it has several time samples.

    mistyped: name of an attribute that is no part of it, as its type is another than the operation's; "" for none.
    """

    matrix: Array
    resets: bool
    moves: bool = False
    mistyped: str = ""


_TYPES: dict[str, Any] = {
    "transform": (Gf.Matrix4d, Gf.Matrix4f),
    "orient": (Gf.Quatd, Gf.Quatf, Gf.Quath),
    **dict.fromkeys(
        ("translate", "scale", *(f"rotate{order}" for order in ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"))),
        (Gf.Vec3d, Gf.Vec3f, Gf.Vec3h),
    ),
}
"""Of the values of operations on all three axes; of those on one, they are numbers."""

IDENTITY = Local(np.eye(4), False)
WHOLE = "xformOp:transform"
"""The operation that is a matrix by itself."""


def local_of(prim: Any, time: Any = None) -> Local:
    """time: None for the exported pose: default values, and the first sample of what has samples only."""
    xform = UsdGeom.Xformable(prim)
    if not xform:
        return IDENTITY
    stated = xform.GetXformOpOrderAttr()
    order = stated.Get()
    if not isinstance(order, Vt.TokenArray):
        return Local(np.eye(4), False, mistyped="xformOpOrder") if stated.HasAuthoredValue() else IDENTITY
    if time is None and len(order) == 1 and order[0] == WHOLE:  # as most of many parts have it
        attribute = prim.GetAttribute(WHOLE)
        if isinstance(value := attribute.Get(), Gf.Matrix4d):
            return Local(matrix(value) + 0.0, False, attribute.ValueMightBeTimeVarying())
    ops = xform.GetOrderedXformOps()
    attributes = [op.GetAttr() for op in ops]  # an inverse operation has that of the one that it undoes
    asked = Usd.TimeCode.Default() if time is None else time
    values = [attribute.Get(asked) for attribute in attributes]
    if time is None and any(v is None and knots_of(a) for v, a in zip(values, attributes)):
        curves = [knots_of(a)[0] for a in attributes if not a.GetNumTimeSamples() and knots_of(a)]
        asked = Usd.TimeCode(min(curves)) if curves else Usd.TimeCode.EarliestTime()
        values = [attribute.Get(asked) for attribute in attributes]
    for attribute, value in zip(attributes, values):
        if not _is_typed(attribute, value):
            return Local(np.eye(4), False, mistyped=attribute.GetName())
    moves = any(attribute.ValueMightBeTimeVarying() for attribute in attributes)
    resets = len(ops) < len(order) and xform.GetResetXformStack()
    return Local(matrix(xform.GetLocalTransformation(ops, asked)), resets, moves)


def knots_of(attribute: Any) -> list[float]:
    """Time codes of an attribute's samples, or of the knots of its curve, which young releases of USD have."""
    times = attribute.GetTimeSamples()
    if times or not hasattr(attribute, "HasSpline") or not attribute.HasSpline():
        return list(times)
    return list(attribute.GetSpline().GetKnots().keys())


def _is_typed(attribute: Any, value: Any) -> bool:
    """Whether an operation's value is of the type that its name says, or there is none; pxr raises, or passes it over."""
    return value is None or isinstance(value, _TYPES.get(attribute.GetName().split(":")[1], float))


def placed(parent: Array, local: Local) -> Array:
    """World matrix of a prim below ``parent``'s, shape (4, 4), for column vectors, stage units."""
    return local.matrix if local.resets else parent if local is IDENTITY else parent @ local.matrix


@dataclass(frozen=True, slots=True, eq=False)
class Stand:
    """A rigid frame of the source: of a node, or the world's.

    rotation, origin: in the source's world and units, shapes (3, 3) and (3,).
    rigid: whether the prim's matrix is known to be no more than that.
    """

    rotation: Array
    origin: Array
    frame: SourceFrame
    rigid: bool = False

    @property
    def pose(self) -> Pose:
        """In the scene's world."""
        turn = self.frame.turn
        return Pose(turn @ self.rotation @ turn.T, turn @ self.origin * self.frame.length)

    def linear(self, world: Array) -> Array:
        """The linear part of a prim's matrix, seen from here, source axes, shape (3, 3)."""
        return self.rotation.T @ world[:3, :3]

    def point(self, world: Array) -> Array:
        """A point of the source's world in the scene's node frame, metres."""
        return self.frame.turn @ (self.rotation.T @ (world - self.origin)) * self.frame.length

    def turned(self, linear: Array) -> Array:
        """A map between source axes as a map between the scene's axes."""
        return self.frame.turn @ linear @ self.frame.turn.T

    def axes(self, world: Array) -> Array:
        """Axes (columns) of the source's world in the scene's node frame."""
        return self.frame.turn @ (self.rotation.T @ world)


def stand(world: Array, frame: SourceFrame) -> Stand:
    return Stand(rotation_of(world[:3, :3]), world[:3, 3].copy(), frame)


def stands(worlds: Array, frame: SourceFrame) -> list[tuple[Stand, Pose]]:
    """As ``stand`` of each, shape (n, 4, 4), with its pose."""
    rotations, rigid = rotations_of(worlds[:, :3, :3])
    origins = worlds[:, :3, 3].copy()
    turned, moved = frame.turn @ rotations @ frame.turn.T, origins @ frame.turn.T * frame.length
    return [
        (Stand(rotation, origin, frame, plain), Pose(r, t))
        for rotation, origin, plain, r, t in zip(rotations, origins, rigid.tolist(), turned, moved)
    ]
