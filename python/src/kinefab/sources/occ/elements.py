"""Curves and surfaces of a shape's numbered edges and faces."""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_SurfaceType
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS, TopoDS_Shape

from .tessellation import faces_of, sub_shapes

as_edge = getattr(TopoDS, "Edge", None) or TopoDS.Edge_s
"""A shape that is an edge, as one."""


def surface_of(shape: TopoDS_Shape, number: int) -> tuple[str, float] | None:
    """The word for a face's surface and its radius, in the shape's unit; None where there is no such face.

    number: from 1.  The radius is 0 where the word is neither cylinder nor sphere.
    """
    faces = faces_of(shape)
    if not 1 <= number <= len(faces):
        return None
    surface = BRepAdaptor_Surface(faces[number - 1])
    kind = surface.GetType()
    words = GeomAbs_SurfaceType
    if kind == words.GeomAbs_Plane:
        return "plane", 0.0
    if kind == words.GeomAbs_Cylinder:
        return "cylinder", float(surface.Cylinder().Radius())
    if kind == words.GeomAbs_Sphere:
        return "sphere", float(surface.Sphere().Radius())
    if kind == words.GeomAbs_Cone:
        return "cone", 0.0
    return ("torus" if kind == words.GeomAbs_Torus else "surface"), 0.0


def curve_of(shape: TopoDS_Shape, number: int) -> tuple[str, float] | None:
    """The word for an edge's curve and a circle's radius, as ``surface_of``."""
    edges = sub_shapes(shape, TopAbs_EDGE)
    if not 1 <= number <= len(edges):
        return None
    curve = BRepAdaptor_Curve(as_edge(edges[number - 1]))
    kind = curve.GetType()
    if kind == GeomAbs_CurveType.GeomAbs_Line:
        return "line", 0.0
    if kind == GeomAbs_CurveType.GeomAbs_Circle:
        return "circle", float(curve.Circle().Radius())
    return "curve", 0.0
