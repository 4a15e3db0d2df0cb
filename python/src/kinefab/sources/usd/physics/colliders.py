"""CollisionAPI prims as colliders of a node."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ....diagnostics import Report
from ....model import Collider, ColliderKind, PhysicsMaterial
from ....spatial import Array, Pose
from ..api import Vt
from ..found import Piece
from ..looks.gprims import axis_turn
from ..looks.library import Library
from ..stage import OpenStage
from ..transforms import Fit, Stand, Stretch
from ..values import Values, identity, shown

THICKNESS = 0.01
"""Metres of the box that stands for a plane."""
EVEN = 1e-6
"""Scales closer than this share are one."""
_WIDTHS = (Vt.FloatArray, Vt.DoubleArray, Vt.HalfArray)
PIECES = frozenset(("convexDecomposition", "sdf", "sphereFill"))
KNOWN = frozenset(("none", "convexHull", "meshSimplification", "boundingSphere", "boundingCube")) | PIECES


class Colliders:
    """Makes the colliders of pieces.  Shapes are those that PhysX makes of them: it takes the largest of uneven scales."""

    def __init__(self, opened: OpenStage, values: Values, library: Library, report: Report):
        self._opened, self._values, self._library, self._report = opened, values, library, report

    def of(
        self, piece: Piece, stand: Stand, fit: Fit | None, dynamic: bool,
        material: PhysicsMaterial | None, group: str,
    ) -> list[Collider]:  # fmt: skip
        """fit: of the piece as its part sees it, None for a flat one.  dynamic: the body moves, so that a mesh must be
        convex."""
        prim = piece.prim
        kind = piece.seen.traits.kind
        where = self._opened.place(piece.path)
        if fit is None:
            self._report.dropped(f"collider {piece.path}", "USD_SCALE_ZERO", where)
            return []
        stretch, at = fit.stretch, fit.pose
        common = Collider(
            ColliderKind.BOX,
            name=piece.id,
            material=material,
            trigger="PhysxTriggerAPI" in piece.seen.traits.schemas,
            enabled=self._values.flag(prim, "physics:collisionEnabled", True),
            group=group,
            where=where,
        )
        if kind == "Mesh":
            return self._mesh(piece, common, fit, dynamic)
        if kind == "Points":
            return self._points(piece, common, stand, stretch)
        if stretch.sheared or kind in ("Cone", "Capsule_1", "Cylinder_1"):
            return self._hull(piece, common, fit)
        found = self._shape(kind, prim, common, at, stretch)
        if found is None:
            self._dropped(prim, f"a {kind or 'prim without type'} has no shape")
            return []
        return [found]

    def _shape(self, kind: str, prim: Any, common: Collider, at: Pose, stretch: Stretch) -> Collider | None:
        length, turn = self._opened.frame.length, self._opened.frame.turn
        scale = stretch.scale
        if kind == "Cube":
            size = np.abs(turn) @ (self._size(prim, "size", 2.0) * scale * length)
            return replace(common, kind=ColliderKind.BOX, pose=at, size=_triple(size))
        if kind == "Sphere":
            if np.ptp(scale) > EVEN * scale.max():
                self._approximated(
                    prim, f"a sphere scaled by {_shown(scale)} collides with its largest radius"
                )
            radius = self._size(prim, "radius", 1.0) * scale.max() * length
            return replace(common, kind=ColliderKind.SPHERE, pose=at, radius=float(radius))
        if kind in ("Capsule", "Cylinder"):
            axis = "XYZ".index(self._values.token(prim, "axis", tuple("XYZ"), "Z"))
            across = np.delete(scale, axis)
            if np.ptp(across) > EVEN * across.max():
                self._approximated(
                    prim, f"a {kind.lower()} scaled by {_shown(scale)} collides with its largest radius"
                )
            radius = self._size(prim, "radius", 0.5 if kind == "Capsule" else 1.0) * across.max() * length
            height = self._size(prim, "height", 1.0 if kind == "Capsule" else 2.0) * scale[axis] * length
            # The shape's own Z is the prim's axis, turned like the world.
            pose = Pose(at.rotation @ turn @ axis_turn("XYZ"[axis]), at.translation)
            made = ColliderKind.CAPSULE if kind == "Capsule" else ColliderKind.CYLINDER
            return replace(common, kind=made, pose=pose, radius=float(radius), length=float(height))
        if kind == "Plane":
            return self._plane(prim, common, at, scale)
        return None

    def _plane(self, prim: Any, common: Collider, at: Pose, scale: Array) -> Collider:
        """A thin box below the plane."""
        length, turn = self._opened.frame.length, self._opened.frame.turn
        axis = "XYZ".index(self._values.token(prim, "axis", tuple("XYZ"), "Z"))
        extents = np.zeros(3)
        width, long = self._size(prim, "width", 2.0), self._size(prim, "length", 2.0)
        extents[2 if axis == 0 else 0] = width
        extents[2 if axis == 1 else 1] = long
        extents = extents * scale * length
        extents[axis] = THICKNESS
        normal = turn[:, axis]
        self._approximated(
            prim, f"a plane, endless in most engines, became a box of its size, {THICKNESS:g} m thick"
        )
        pose = Pose(at.rotation, at.point(-0.5 * THICKNESS * normal))
        return replace(common, kind=ColliderKind.BOX, pose=pose, size=_triple(np.abs(turn) @ extents))

    def _points(self, piece: Piece, common: Collider, stand: Stand, stretch: Stretch) -> list[Collider]:
        points = self._values.array(piece.prim, "points", 3)
        if points is None or not np.isfinite(points).all():
            self._dropped(piece.prim, "it has no points")
            return []
        world = points @ piece.world[:3, :3].T + piece.world[:3, 3]
        radii = 0.5 * self._widths(piece.prim, len(world)) * stretch.scale.max() * self._opened.frame.length
        return [
            replace(common, kind=ColliderKind.SPHERE, pose=Pose(np.eye(3), stand.point(p)), radius=float(r), name=f"{common.name}[{i}]")
            for i, (p, r) in enumerate(zip(world, radii))
        ]  # fmt: skip

    def _widths(self, prim: Any, count: int) -> Array:
        """Of that many points; what cannot be theirs is told, and they are 1 wide as without."""
        value = self._values.get(prim, "widths")
        if value is None or (isinstance(value, _WIDTHS) and not len(value)):
            return np.ones(count)
        found = np.array(value, dtype=np.float64) if isinstance(value, _WIDTHS) else np.zeros(0)
        if len(found) not in (1, count) or not np.isfinite(found).all():
            self._report.dropped(
                f"widths of {identity(prim)}", "USD_FEATURE_DROPPED", self._opened.place(prim, "widths"),
                detail=f"they cannot be {shown(value)}",
            )  # fmt: skip
            return np.ones(count)
        return np.abs(np.broadcast_to(found, (count,)))

    def _hull(self, piece: Piece, common: Collider, fit: Fit) -> list[Collider]:
        shared = self._library.shared(piece, fit.stretch.bake)
        if shared is None:
            return []
        return [replace(common, kind=ColliderKind.HULL, pose=fit.pose, mesh=shared.mesh, scale=fit.scale)]

    def _mesh(self, piece: Piece, common: Collider, fit: Fit, dynamic: bool) -> list[Collider]:
        prim, at, scale = piece.prim, fit.pose, fit.scale
        shared = self._library.shared(piece, fit.stretch.bake)
        if shared is None:
            return []
        wanted = self._values.word(prim, "physics:approximation", "none")
        if wanted not in KNOWN:
            self._approximated(prim, f"the unknown approximation '{wanted}' was taken for none")
            wanted = "none"
        if wanted.startswith("bounding"):
            vertices = self._library.meshes[shared.mesh].vertices * np.array(scale)
            low, high = vertices.min(axis=0), vertices.max(axis=0)
            middle = 0.5 * (low + high)
            pose = Pose(at.rotation, at.point(middle))
            if wanted == "boundingCube":
                return [replace(common, kind=ColliderKind.BOX, pose=pose, size=_triple(high - low))]
            radius = float(np.linalg.norm(vertices - middle, axis=1).max())
            return [replace(common, kind=ColliderKind.SPHERE, pose=pose, radius=radius)]
        convex = wanted == "convexHull" or (wanted in PIECES and dynamic)
        if wanted in ("sdf", "sphereFill") and dynamic:
            self._approximated(prim, f"convex pieces stand for the approximation '{wanted}'")
        elif dynamic and not convex:
            self._approximated(
                prim,
                f"a body that moves needs a convex collider; a hull stands for the approximation '{wanted}'",
            )
        elif wanted == "meshSimplification":
            self._approximated(prim, "the mesh itself stands for its simplification")
        kind = ColliderKind.HULL if convex or dynamic else ColliderKind.MESH
        if wanted in PIECES and dynamic:
            kind = ColliderKind.PIECES
        return [replace(common, kind=kind, pose=at, mesh=shared.mesh, scale=scale)]

    def _size(self, prim: Any, name: str, default: float) -> float:
        return abs(self._values.number(prim, name, default))

    def _approximated(self, prim: Any, detail: str) -> None:
        self._report.approximated(
            f"collider {identity(prim)}", "USD_FEATURE_APPROXIMATED", self._opened.place(prim), detail=detail
        )

    def _dropped(self, prim: Any, detail: str) -> None:
        self._report.dropped(
            f"collider {identity(prim)}", "USD_FEATURE_DROPPED", self._opened.place(prim), detail=detail
        )


def _triple(values: Array) -> tuple[float, float, float]:
    return (float(values[0]), float(values[1]), float(values[2]))


def _shown(scale: Array) -> str:
    return " ".join(f"{s:g}" for s in scale)
