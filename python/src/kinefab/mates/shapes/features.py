"""What a part offers to be mated by: bores and shafts, seats, flats, merged from the faces that CAD programs split.

A cylinder cut in halves, or crossed by a slot, is one feature here.  Features are found once for each set of faces
that occurrences share, in the part's own frame, and placed by the occurrence's pose.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np

from ...model import Face, FaceKind, Node
from ...spatial import Array, Pose, cross
from .outlines import Outline, outline_of

SAME = 1e-6
"""Share of a part's size, and sine, by which two faces of it may differ and still lie on one surface."""
WHOLE = 2.0 * math.pi
ROUND = math.radians(200.0)
"""A cylinder that covers this much holds from all sides."""


@dataclass(frozen=True, slots=True, eq=False)
class Round:
    """Faces on one surface of revolution.  kind: CYLINDER, CONE, SPHERE or TORUS.

    point, direction, radius, minor, half_angle, hollow: as ``model.Face``.  spans: extents along the axis, one a face.
    arcs: extents about the axis from ``secondary``, one a face.  faces: their labels, "body/number".
    """

    kind: FaceKind
    point: Array
    direction: Array
    secondary: Array
    radius: float
    minor: float
    half_angle: float
    hollow: bool
    spans: tuple[tuple[float, float], ...]
    arcs: tuple[tuple[float, float], ...]
    faces: tuple[str, ...]
    corners: Array

    @property
    def span(self) -> tuple[float, float]:
        return min(low for low, _ in self.spans), max(high for _, high in self.spans)

    @property
    def coverage(self) -> float:
        """Radians about the axis that the faces cover, at most 2 pi."""
        return sum(high - low for low, high in merged(self.arcs))

    @property
    def is_round(self) -> bool:
        return self.coverage >= ROUND


@dataclass(frozen=True, slots=True, eq=False)
class Flat:
    """A plane face.  normal: outward.  outline: its triangles and edges.  area: m^2."""

    point: Array
    normal: Array
    outline: Outline
    area: float
    face: str

    @property
    def corners(self) -> Array:
        """Its triangles, shape (n, 3, 3)."""
        return self.outline.triangles


@dataclass(frozen=True, eq=False)
class Shape:
    """The features of a part, in one frame.  others: points of faces on no such surface.  low, high: its box's corners.
    volume: m^3.  size: of the box's diagonal."""

    rounds: tuple[Round, ...]
    flats: tuple[Flat, ...]
    others: Array
    low: Array
    high: Array
    volume: float

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self.high - self.low))

    @cached_property
    def round_boxes(self) -> tuple[Array, Array]:
        """Lower and upper corners of the rounds' boxes, shape (n, 3) each."""
        return _boxes([r.corners for r in self.rounds])

    @cached_property
    def flat_boxes(self) -> tuple[Array, Array]:
        return _boxes([f.corners.reshape(-1, 3) for f in self.flats])

    def rounds_near(self, low: Array, high: Array) -> list[Round]:
        """Those whose boxes meet a box."""
        return [self.rounds[i] for i in _meeting(self.round_boxes, low, high)]

    def flats_near(self, low: Array, high: Array) -> list[Flat]:
        """Flats whose boxes meet this box, corners in the shape's frame."""
        return [self.flats[i] for i in _meeting(self.flat_boxes, low, high)]


def _boxes(corners: Sequence[Array]) -> tuple[Array, Array]:
    if not corners:
        return np.zeros((0, 3)), np.zeros((0, 3))
    return np.array([c.min(axis=0) for c in corners]), np.array([c.max(axis=0) for c in corners])


def _meeting(boxes: tuple[Array, Array], low: Array, high: Array) -> list[int]:
    lows, highs = boxes
    return [int(i) for i in np.flatnonzero(np.all((lows <= high) & (highs >= low), axis=1))]


def merged(arcs: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Angular extents brought to 0 .. 2 pi and joined where they touch."""
    pieces: list[tuple[float, float]] = []
    for low, high in arcs:
        if high - low >= WHOLE - 1e-6:
            return [(0.0, WHOLE)]
        start = low % WHOLE
        end = start + high - low
        pieces += [(start, min(end, WHOLE))] + ([(0.0, end - WHOLE)] if end > WHOLE else [])
    joined: list[tuple[float, float]] = []
    for low, high in sorted(pieces):
        if joined and low <= joined[-1][1] + 1e-6:
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return joined


def shape_of(node: Node) -> Shape | None:
    """The features of a node's bodies, in the node's frame; None for a node without exact faces."""
    labelled = [(f"{body.name}/{face.number}", face) for body in node.bodies for face in body.boundary]
    if not labelled:
        return None
    corners = np.concatenate([face.triangles.reshape(-1, 3) for _, face in labelled])
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = float(np.linalg.norm(high - low))
    rounds = _Surfaces(size)
    flats: list[Flat] = []
    others: list[Array] = []
    for label, face in labelled:
        if face.kind is FaceKind.PLANE:
            areas = np.cross(
                face.triangles[:, 1] - face.triangles[:, 0], face.triangles[:, 2] - face.triangles[:, 0]
            )
            flats.append(
                Flat(
                    face.point,
                    face.direction,
                    outline_of(face.triangles),
                    0.5 * float(np.linalg.norm(areas, axis=1).sum()),
                    label,
                )
            )
        elif face.kind is FaceKind.OTHER:
            others.append(face.triangles.reshape(-1, 3))
        else:
            rounds.add(_round(label, face))
    return Shape(
        tuple(rounds.found),
        tuple(flats),
        np.concatenate(others) if others else np.zeros((0, 3)),
        low,
        high,
        _volume(corners.reshape(-1, 3, 3)),
    )


def _volume(triangles: Array) -> float:
    """What closed triangles (n, 3, 3) enclose (divergence theorem)."""
    a, b, c = (triangles[:, i] for i in range(3))
    return abs(float(np.einsum("ni,ni->", a, np.cross(b, c)))) / 6.0


def _round(label: str, face: Face) -> Round:
    return Round(
        face.kind, face.point, face.direction, face.secondary, face.radius, face.minor, face.half_angle, face.hollow,
        (face.along,), (face.around,), (label,), face.triangles.reshape(-1, 3),
    )  # fmt: skip


class _Surfaces:
    """Features so far, found again by where they are; the cells are far wider than faces of one surface differ."""

    def __init__(self, size: float) -> None:
        self.found: list[Round] = []
        self._size = size
        self._cells: dict[tuple[object, ...], list[int]] = {}

    def add(self, new: Round) -> None:
        """Join a face to a feature on the same surface, or keep it as one of its own."""
        keys = self._keys(new)
        for i in sorted({i for key in keys for i in self._cells.get(key, ())}):
            if _same_surface(self.found[i], new, self._size):
                self.found[i] = _joined(self.found[i], new)
                return
        self.found.append(new)
        for key in keys:
            self._cells.setdefault(key, []).append(len(self.found) - 1)

    def _keys(self, new: Round) -> set[tuple[object, ...]]:
        point = new.point
        if new.kind is FaceKind.CYLINDER:  # the axis's point nearest to the origin
            point = point - new.direction * float(point @ new.direction)
        cell = 1e-3 * self._size
        rounded = [{round(float(x) / cell - 0.25), round(float(x) / cell + 0.25)} for x in point]
        return {(new.kind, new.hollow, *key) for key in product(*rounded)}


def _same_surface(a: Round, b: Round, size: float) -> bool:
    if a.kind is not b.kind or a.hollow is not b.hollow or abs(a.radius - b.radius) > SAME * size:
        return False
    if abs(a.minor - b.minor) > SAME * size or abs(a.half_angle - b.half_angle) > SAME:
        return False
    offset = b.point - a.point
    if a.kind is FaceKind.SPHERE:
        return float(np.linalg.norm(offset)) <= SAME * size
    if float(np.linalg.norm(cross(a.direction, b.direction))) > SAME:
        return False
    if a.kind is FaceKind.CYLINDER:
        return float(np.linalg.norm(cross(offset, a.direction))) <= SAME * size
    same_way = a.kind is FaceKind.TORUS or float(a.direction @ b.direction) > 0.0
    return same_way and float(np.linalg.norm(offset)) <= SAME * size


def _joined(a: Round, b: Round) -> Round:
    """b's faces in a's terms."""
    along = float(a.direction @ b.direction)
    shift = float((b.point - a.point) @ a.direction)
    spans, arcs = b.spans, b.arcs
    if a.kind is not FaceKind.SPHERE:
        x, y = a.secondary, cross(a.direction, a.secondary)
        start = math.atan2(float(b.secondary @ y), float(b.secondary @ x))
        sign = 1.0 if along > 0.0 else -1.0
        spans = tuple(sorted_pair(shift + sign * low, shift + sign * high) for low, high in b.spans)
        arcs = tuple(sorted_pair(start + sign * low, start + sign * high) for low, high in b.arcs)
    return replace(
        a,
        spans=a.spans + spans,
        arcs=a.arcs + arcs,
        faces=a.faces + b.faces,
        corners=np.concatenate([a.corners, b.corners]),
    )


def corners_of(shape: Shape) -> Array:
    """All triangles of a shape, (n, 3, 3)."""
    faces = [r.corners for r in shape.rounds] + [f.corners.reshape(-1, 3) for f in shape.flats]
    return np.concatenate([*faces, shape.others]).reshape(-1, 3, 3)


def sorted_pair(a: float, b: float) -> tuple[float, float]:
    return (a, b) if a <= b else (b, a)


def placed(shape: Shape, pose: Pose) -> Shape:
    """The features in the frame that ``pose`` leads to."""
    corners = np.array(np.meshgrid(*zip(shape.low, shape.high))).reshape(3, -1).T
    box = pose.point(corners)
    return Shape(
        tuple(
            replace(
                r,
                point=pose.point(r.point),
                direction=pose.direction(r.direction),
                secondary=pose.direction(r.secondary),
                corners=pose.point(r.corners),
            )
            for r in shape.rounds
        ),
        tuple(
            replace(
                f,
                point=pose.point(f.point),
                normal=pose.direction(f.normal),
                outline=Outline(pose.point(f.outline.triangles), pose.point(f.outline.edges)),
            )
            for f in shape.flats
        ),
        pose.point(shape.others),
        box.min(axis=0),
        box.max(axis=0),
        shape.volume,
    )
