"""Named shapes and mesh files of robot formats as bodies that are drawn and colliders that are touched."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...geometry import primitives
from ...geometry.mass import moved, shape_properties, solid_properties
from ...model import Body, Collider, ColliderKind, MassProperties, Mesh, MeshReference, PhysicsMaterial
from ...spatial import Pose
from .packages import Packages
from .robot_frame import TURN, placed, shape_placed

PLANE_DEPTH = 0.1
"""Metres of the box that collides for a plane, below it."""
PLANE_EXTENT = 100.0
"""Metres of a plane that has no end."""


@dataclass(frozen=True, slots=True)
class Shape:
    """kind: box, sphere, cylinder, capsule, cone, ellipsoid, plane, mesh or surface (a mesh that is touched as it is).

    size: metres: box: extents; sphere: (radius,); cylinder, capsule, cone: (radius, length); ellipsoid: half extents;
    plane: (width, length); mesh: scale of the file's coordinates.  file: of a mesh.  key: the body in it, None for all.
    mesh: index of one that the scene has already, in the shape's own axes.
    """

    kind: str
    size: tuple[float, ...]
    file: Path | None = None
    key: str | None = None
    where: str = ""
    mesh: int | None = None


@dataclass(slots=True)
class Shapes:
    """Makes bodies and colliders; shapes of one size share one of ``meshes``."""

    meshes: list[Mesh]
    report: Report
    _known: dict[tuple[str, tuple[float, ...]], int] = field(
        default_factory=dict[tuple[str, tuple[float, ...]], int]
    )

    def body(self, name: str, shape: Shape, pose: Pose, surfaces: tuple[int, ...], weighed: bool) -> Body:
        """pose: of the shape in its node's frame, source axes.  weighed: see ``Body``."""
        if shape.file is not None:
            return Body(name, None, surfaces, reference=_reference(shape), pose=placed(pose), weighed=weighed)
        return Body(name, self._mesh(shape), surfaces, pose=shape_placed(pose), weighed=weighed)

    def solid(self, shape: Shape, pose: Pose) -> MassProperties | None:
        """Of density 1, in the node's frame, turned into the scene; None of a file, which is not loaded yet, and of what has
        no volume.  pose: as of ``body``."""
        if shape.file is not None or shape.kind in ("plane", "surface"):
            return None
        if shape.mesh is not None:
            mesh = self.meshes[shape.mesh]
            return moved(solid_properties(mesh.vertices, mesh.faces, 1.0), shape_placed(pose))
        return moved(shape_properties(shape.kind, shape.size), shape_placed(pose))

    def collider(
        self, name: str, shape: Shape, pose: Pose, material: PhysicsMaterial | None = None, group: str = ""
    ) -> Collider:
        made = self._shaped(name, shape, pose)
        return replace(made, name=name, material=material, group=group, where=shape.where)

    def _shaped(self, name: str, shape: Shape, pose: Pose) -> Collider:
        if shape.file is not None:
            return Collider(ColliderKind.MESH, placed(pose), reference=_reference(shape))
        at = shape_placed(pose)
        if shape.mesh is not None:
            kind = ColliderKind.MESH if shape.kind == "surface" else ColliderKind.HULL
            return Collider(kind, at, mesh=shape.mesh)
        if shape.kind == "box":
            x, y, z = shape.size
            return Collider(ColliderKind.BOX, at, size=(x, y, z))
        if shape.kind == "plane":
            width, length = shape.size
            below = at @ Pose(np.eye(3), np.array([0.0, 0.0, -0.5 * PLANE_DEPTH]))
            self.report.approximated(
                f"collider {name}", "COLLIDER_PLANE_AS_BOX", shape.where, depth=PLANE_DEPTH
            )
            return Collider(ColliderKind.BOX, below, size=(width, length, PLANE_DEPTH))
        if shape.kind == "sphere":
            return Collider(ColliderKind.SPHERE, at, radius=shape.size[0])
        if shape.kind in ("capsule", "cylinder"):
            kind = ColliderKind.CAPSULE if shape.kind == "capsule" else ColliderKind.CYLINDER
            return Collider(kind, at, radius=shape.size[0], length=shape.size[1])
        return Collider(ColliderKind.HULL, at, mesh=self._mesh(shape))

    def _mesh(self, shape: Shape) -> int:
        if shape.mesh is not None:
            return shape.mesh
        key = (shape.kind, shape.size)
        if key not in self._known:
            make: Callable[..., Mesh] = getattr(primitives, shape.kind)
            whole = shape.kind in ("box", "ellipsoid")  # these take their sizes as one
            self._known[key] = len(self.meshes)
            made = make(shape.size) if whole else make(*shape.size)
            sizes = " ".join(f"{x:.9g}" for x in shape.size)
            self.meshes.append(replace(made, origin=f"{shape.kind} {sizes}"))
        return self._known[key]


def _reference(shape: Shape) -> MeshReference:
    """The file's coordinates, scaled along its own axes, turned into the scene's."""
    assert shape.file is not None
    matrix = np.eye(4)
    matrix[:3, :3] = TURN * (np.array(shape.size) * file_unit(shape.file))
    return MeshReference(shape.file, matrix, shape.key, where=shape.where, needed=False)


def mesh_shape(
    uri: str,
    scale: tuple[float, ...],
    packages: Packages,
    feature: str,
    where: str,
    report: Report,
    key: str | None = None,
) -> Shape | None:
    """The shape of a mesh file; None where it is not found or scaled to nothing, and then it is dropped by name."""
    if not all(scale):
        report.dropped(feature, "SHAPE_EMPTY", where, shape="mesh")
        return None
    found = packages.find(uri)
    if found.path is not None:
        if (up := stated_up(found.path)) not in ("", "Z_UP"):
            report.add("COLLADA_UP_AXIS", where, file=found.path.name, up=up)
        return Shape("mesh", scale, found.path, key, where)
    report.dropped(feature, "MESH_OUTSIDE" if found.outside else "MESH_NOT_FOUND", where, file=uri)
    return None


_UNIT = re.compile(rb"<unit\b[^>]*\bmeter\s*=\s*[\"']([^\"']+)[\"']")
_UP = re.compile(rb"<up_axis>\s*(\w+)\s*</up_axis>")
HEAD = 16384
"""Bytes of a Collada file in which its unit and up axis stand."""


def file_unit(path: Path) -> float:
    """Metres in one unit of a mesh file: what Collada states, 1 elsewhere."""
    match = _UNIT.search(_collada_head(path))
    try:
        unit = float(match[1]) if match else 1.0
    except ValueError:
        return 1.0
    return unit if 0.0 < unit < 1e6 else 1.0


def stated_up(path: Path) -> str:
    """The up axis that Collada states ("" elsewhere).  Robot programs (RViz, Gazebo, Newton's converter) take the
    coordinates as they stand in the file, and so does this reader: exporters write Y_UP beside meshes that are Z up."""
    match = _UP.search(_collada_head(path))
    return match[1].decode("ascii", "replace") if match else ""


def _collada_head(path: Path) -> bytes:
    if path.suffix.lower() != ".dae":
        return b""
    try:
        with path.open("rb") as stream:
            return stream.read(HEAD)
    except OSError:
        return b""
