"""The exact faces of an OpenCASCADE shape: which surface, where, and on which side the material is."""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.gp import gp_Cone, gp_Cylinder, gp_Pln, gp_Sphere
from OCP.ShapeAnalysis import ShapeAnalysis_CanonicalRecognition

from ...model.boundary import Face, FaceKind
from ...spatial import Array, perpendicular
from .tessellation import faces_of
from .triangles import Tessellation

RECOGNISED = 1e-6
"""Largest distance, in the shape's unit, of a spline surface from the plane, cylinder, cone or sphere that it is taken for."""
WHOLE = 2.0 * math.pi

Surface = tuple[FaceKind, Array, Array, Array, float, float, float]
"""Kind, point, direction, secondary, radius, minor radius, half angle; in the shape's frame and unit."""


def boundary_of(shape: Any, mesh: Tessellation) -> tuple[Face, ...]:
    """The faces of a TopoDS_Shape, numbered from 1 in the order of ``faces_of``, in the shape's frame and unit.

    mesh: of the same shape.  Faces without triangles are left out; their numbers stay free.
    """
    ends = np.cumsum(mesh.counts)
    return tuple(
        exact_face(face, number, mesh.vertices[mesh.triangles[end - count : end]])
        for number, (face, count, end) in enumerate(zip(faces_of(shape), mesh.counts, ends, strict=True), 1)
        if count
    )


def exact_face(face: Any, number: int, triangles: Array) -> Face:
    """A TopoDS face as what it is, in its shape's own frame and unit.

    number: of the face in its body, from 1.  triangles: of the face, at least one, outward side counter-clockwise,
    shape (n, 3, 3).
    """
    adaptor = BRepAdaptor_Surface(face)
    kind = adaptor.GetType()
    read = _READERS.get(kind)
    surface = read(adaptor) if read is not None else _recognised(face, triangles)
    analytic = read is not None
    name, point, direction, secondary, radius, minor, half_angle = surface
    corners = triangles.reshape(-1, 3)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    hollow = False
    if name is FaceKind.PLANE:
        if float(normals.sum(axis=0) @ direction) < 0.0:
            direction = -direction
    elif name is not FaceKind.OTHER:
        hollow = bool(np.einsum("ni,ni->", normals, _away(surface, triangles.mean(axis=1))) < 0.0)
    heights = (corners - point) @ direction
    around = (0.0, WHOLE)
    if name in (FaceKind.CYLINDER, FaceKind.CONE, FaceKind.SPHERE, FaceKind.TORUS):
        if analytic:
            first, last, _, _ = BRepTools.UVBounds_s(face)
            around = (float(first), float(last))
        else:
            around = _turned(corners - point, direction, secondary)
    return Face(
        name, number, point, direction, secondary, radius, minor, half_angle, hollow,
        (float(heights.min()), float(heights.max())), around, triangles,
    )  # fmt: skip


def trsf_matrix(trsf: Any) -> Array:
    """A gp_Trsf as an affine matrix, shape (3, 4)."""
    return np.array([[trsf.Value(i, j) for j in (1, 2, 3, 4)] for i in (1, 2, 3)])


def _away(surface: Surface, points: Array) -> Array:
    """Directions away from the surface's axis, centre or small circle, at points of it."""
    kind, point, direction, _, radius, _, half_angle = surface
    offset = points - point
    radial = offset - np.outer(offset @ direction, direction)
    if kind is FaceKind.SPHERE:
        return offset
    if kind is FaceKind.CONE:
        unit = radial / np.maximum(np.linalg.norm(radial, axis=1), 1e-300)[:, None]
        return unit * math.cos(half_angle) - direction * math.sin(half_angle)
    if kind is FaceKind.TORUS:
        unit = radial / np.maximum(np.linalg.norm(radial, axis=1), 1e-300)[:, None]
        return offset - radius * unit
    return radial


def _turned(offsets: Array, direction: Array, secondary: Array) -> tuple[float, float]:
    """The angles that points about an axis cover: all but the largest gap between them, where it is one."""
    angles = np.sort(np.arctan2(offsets @ np.cross(direction, secondary), offsets @ secondary))
    gaps = np.diff(np.append(angles, angles[0] + WHOLE))
    widest = int(np.argmax(gaps))
    others = np.delete(gaps, widest)
    if gaps[widest] <= 2.0 * float(others.max(initial=0.0)) + 1e-6:
        return 0.0, WHOLE
    start = float(angles[(widest + 1) % len(angles)])
    return start, start + WHOLE - float(gaps[widest])


def _axes(position: Any) -> tuple[Array, Array, Array]:
    """Point, main and X direction of a gp_Ax3."""
    return (
        np.array(position.Location().Coord()),
        np.array(position.Direction().Coord()),
        np.array(position.XDirection().Coord()),
    )


def _plane(surface: Any) -> Surface:
    return (FaceKind.PLANE, *_axes(_of(surface, "Plane", gp_Pln).Position()), 0.0, 0.0, 0.0)


def _cylinder(surface: Any) -> Surface:
    cylinder = _of(surface, "Cylinder", gp_Cylinder)
    return (FaceKind.CYLINDER, *_axes(cylinder.Position()), cylinder.Radius(), 0.0, 0.0)


def _cone(surface: Any) -> Surface:
    cone = _of(surface, "Cone", gp_Cone)
    _, direction, x = _axes(cone.Position())
    angle = cone.SemiAngle()
    return (
        FaceKind.CONE, np.array(cone.Apex().Coord()), math.copysign(1.0, angle) * direction, x, 0.0, 0.0, abs(angle),
    )  # fmt: skip


def _sphere(surface: Any) -> Surface:
    sphere = _of(surface, "Sphere", gp_Sphere)
    return (FaceKind.SPHERE, *_axes(sphere.Position()), sphere.Radius(), 0.0, 0.0)


def _torus(surface: Any) -> Surface:
    torus = surface.Torus()
    return (FaceKind.TORUS, *_axes(torus.Position()), torus.MajorRadius(), torus.MinorRadius(), 0.0)


def _of(surface: Any, name: str, elementary: type) -> Any:
    """The elementary surface of an adaptor, or what stands for it already."""
    return surface if isinstance(surface, elementary) else getattr(surface, name)()


_READERS: Mapping[Any, Callable[[Any], Surface]] = {
    GeomAbs_SurfaceType.GeomAbs_Plane: _plane,
    GeomAbs_SurfaceType.GeomAbs_Cylinder: _cylinder,
    GeomAbs_SurfaceType.GeomAbs_Cone: _cone,
    GeomAbs_SurfaceType.GeomAbs_Sphere: _sphere,
    GeomAbs_SurfaceType.GeomAbs_Torus: _torus,
}


def _recognised(face: Any, triangles: Array) -> Surface:
    """A spline, revolved or extruded surface that is an elementary one within RECOGNISED, else OTHER."""
    recognition = ShapeAnalysis_CanonicalRecognition(face)
    for ask, empty, read in (
        (recognition.IsPlane, gp_Pln(), _plane),
        (recognition.IsCylinder, gp_Cylinder(), _cylinder),
        (recognition.IsCone, gp_Cone(), _cone),
        (recognition.IsSphere, gp_Sphere(), _sphere),
    ):
        if ask(RECOGNISED, empty):
            return read(empty)
    centre = triangles.reshape(-1, 3).mean(axis=0)
    z = np.array([0.0, 0.0, 1.0])
    return (FaceKind.OTHER, centre, z, perpendicular(z), 0.0, 0.0, 0.0)
