"""Triangles of an OpenCASCADE shape, with the normals of its surfaces.

The edges of a solid are divided once for both faces that meet there, so a closed solid gives a closed mesh.
Written for OCP 7.8 to 8.0, whose names for a cast differ.
"""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepLib import BRepLib_ToolTriangulatedShape
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Shape

from ...spatial import Array, IntArray
from .seams import straighten_seams
from .triangles import RELATIVE_CHORD, Tessellation, Tolerance

as_face = getattr(TopoDS, "Face", None) or TopoDS.Face_s
"""A shape that is a face, as one."""


def faces_of(shape: TopoDS_Shape) -> list[Any]:
    """The faces of a shape, each once, in the order in which every CAD program of this kernel numbers them."""
    return [as_face(face) for face in sub_shapes(shape, TopAbs_FACE)]


def sub_shapes(shape: TopoDS_Shape, kind: Any) -> list[Any]:
    """The sub-shapes of a kind (``TopAbs_FACE``, ...), each once whichever way it is turned; as ``faces_of``."""
    found: list[Any] = []
    known: dict[int, list[Any]] = {}
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        one = explorer.Current()
        alike = known.setdefault(hash(one.Oriented(TopAbs_FORWARD)), [])
        if not any(one.IsSame(other) for other in alike):
            alike.append(one)
            found.append(one)
        explorer.Next()
    return found


def diagonal(shape: TopoDS_Shape) -> float:
    """Diagonal of the shape's box, in its own unit; 0 for an empty shape."""
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    return 0.0 if box.IsVoid() or box.IsOpen() else float(box.SquareExtent()) ** 0.5


def tessellate(shape: TopoDS_Shape, tolerance: Tolerance, metres: float) -> Tessellation:
    """The shape's triangles in its own frame and unit, its location included.

    metres: in one unit of the shape.  Same shape and tolerance, same triangles; what an earlier call or the file
    left on the shape is not used.
    """
    chord = diagonal(shape) * RELATIVE_CHORD if tolerance.chord is None else tolerance.chord / metres
    faces = faces_of(shape)
    _mesh(shape, chord, tolerance.angle)
    if chord > 0.0 and any([straighten_seams(face) for face in faces if not _count(face)]):
        _mesh(shape, chord, tolerance.angle)
    vertices, normals, triangles, counts, start = [], [], [], [], 0
    for face in faces:
        points, directions, corners = _face(face)
        vertices.append(points)
        normals.append(directions)
        triangles.append(corners + start)
        counts.append(len(corners))
        start += len(points)
    return Tessellation(
        np.concatenate([np.zeros((0, 3)), *vertices]),
        np.concatenate([np.zeros((0, 3)), *normals]),
        np.concatenate([np.zeros((0, 3), dtype=np.int64), *triangles]),
        tuple(counts),
    )


def _mesh(shape: TopoDS_Shape, chord: float, angle: float) -> None:
    BRepTools.Clean_s(shape)  # keeps triangles that are all the file has
    if chord > 0.0:
        BRepMesh_IncrementalMesh(shape, chord, False, angle, False)


def _count(face: Any) -> int:
    """Triangles of a face."""
    mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
    return 0 if mesh is None else mesh.NbTriangles()


def _face(face: Any) -> tuple[Array, Array, IntArray]:
    """Points, normals and triangles of one face, in the shape's frame; none where it has no triangulation."""
    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, location)
    if mesh is None or mesh.NbTriangles() == 0:
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    BRepLib_ToolTriangulatedShape.ComputeNormals_s(face, mesh)
    count = mesh.NbNodes()
    points = np.array([mesh.Node(i).Coord() for i in range(1, count + 1)])
    given = [mesh.Normal(i) for i in range(1, count + 1)]
    normals = np.array([(n.X(), n.Y(), n.Z()) for n in given])
    corners = np.array([mesh.Triangle(i).Get() for i in range(1, mesh.NbTriangles() + 1)], dtype=np.int64) - 1
    if not location.IsIdentity():
        matrix = _matrix(location)
        points = points @ matrix[:, :3].T + matrix[:, 3]
        normals = normals @ np.linalg.inv(matrix[:, :3])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
        if np.linalg.det(matrix[:, :3]) < 0.0:
            corners = corners[:, ::-1]  # a mirror turns the winding; the orientation has its own say below
    if face.Orientation() == TopAbs_REVERSED:
        corners, normals = corners[:, ::-1], -normals
    proper = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    return points, normals, corners[proper]


def _matrix(location: TopLoc_Location) -> Array:
    """A location as an affine map, shape (3, 4)."""
    trsf = location.Transformation()
    return np.array([[trsf.Value(row, column) for column in range(1, 5)] for row in range(1, 4)])
