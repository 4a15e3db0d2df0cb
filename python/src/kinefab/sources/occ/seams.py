"""Seams of round faces that lean by a rounding: their ends are beside those of the edges that they meet.

The parameters of a face that goes all the way round often miss each other by 1e-14, above all in countersinks from other
kernels.  OpenCASCADE takes its border for one that crosses itself, and gives the face no triangle.
"""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from typing import Any

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Dir2d, gp_Pnt2d
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

ROUNDING = 1e-9
"""Of the parameters: radians about the axis."""

_as_edge = getattr(TopoDS, "Edge", None) or TopoDS.Edge_s


def straighten_seams(face: Any) -> bool:
    """Draw the seams of a face along its axis exactly, from where the other edges end; whether there was one."""
    seams: list[Any] = []
    ends: list[float] = []
    explorer = TopExp_Explorer(face, TopAbs_EDGE)
    while explorer.More():
        edge = _as_edge(explorer.Current())
        if BRep_Tool.IsClosed_s(edge, face):
            seams.append(edge)
        else:
            curve = BRepAdaptor_Curve2d(edge, face)
            ends += [curve.Value(t).X() for t in (curve.FirstParameter(), curve.LastParameter())]
        explorer.Next()
    straightened = False
    for seam in seams:
        if seam.Orientation() != TopAbs_FORWARD:
            continue
        lines = [_straight(turned, face, ends) for turned in (seam, seam.Oriented(TopAbs_REVERSED))]
        if None not in lines:
            if face.Orientation() == TopAbs_REVERSED:
                lines.reverse()
            BRep_Builder().UpdateEdge(seam, *lines, face, BRep_Tool.Tolerance_s(seam))
            straightened = True
    return straightened


def _straight(seam: Any, face: Any, ends: list[float]) -> Any:
    """One side of a seam at the parameter at which another edge ends; None where it is no line along the axis."""
    curve = BRepAdaptor_Curve2d(_as_edge(seam), face)
    first, last = curve.FirstParameter(), curve.LastParameter()
    start, end = curve.Value(first), curve.Value(last)
    near = [u for u in ends if abs(u - start.X()) <= ROUNDING]
    way = 1.0 if end.Y() > start.Y() else -1.0
    if (
        not near
        or abs(end.X() - start.X()) > ROUNDING
        or abs(way * (end.Y() - start.Y()) - (last - first)) > ROUNDING
    ):
        return None
    return Geom2d_Line(gp_Pnt2d(near[0], start.Y() - way * first), gp_Dir2d(0.0, way))
