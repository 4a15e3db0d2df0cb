"""Faces that belong to no solid, as the solids that they enclose.

Most IGES files state a part as its trimmed surfaces alone: each ends at curves of its own, and which side of it is the
outer one is not said.  Where their ends meet they are one surface, and where that is closed it has an inside.
"""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing, BRepBuilderAPI_Transform
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepGProp import BRepGProp
from OCP.BRepLib import BRepLib
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_IN, TopAbs_SHELL, TopAbs_VERTEX
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from .faces import trsf_matrix
from .tessellation import faces_of, sub_shapes

GAP = 1e-2
"""Millimetres that the ends of two faces may be apart and still be one edge: the coarsest resolution that programs state
in their IGES files."""

_as_shell = getattr(TopoDS, "Shell", None) or TopoDS.Shell_s
_as_vertex = getattr(TopoDS, "Vertex", None) or TopoDS.Vertex_s


@dataclass(slots=True)
class _Closed:
    """A solid and what encloses it, its volume in cubic millimetres, its centre, and its box."""

    solid: Any
    volume: float
    center: Any
    box: Any


def sewn(faces: list[Any]) -> tuple[list[Any], list[Any], list[tuple[Any, Any]]]:
    """The solids that faces enclose, the faces that enclose none, and of each sewn face which one it was."""
    sewing = BRepBuilderAPI_Sewing(GAP)
    added = [_in_place(face) for face in faces]
    for face in added:
        sewing.Add(face)
    sewing.Perform()
    shape = sewing.SewedShape()
    shells = [] if shape.IsNull() else [_as_shell(shell) for shell in sub_shapes(shape, TopAbs_SHELL)]
    found = [_closed(shell) for shell in shells if BRep_Tool.IsClosed_s(shell)]
    solids = _hollowed(sorted(found, key=lambda closed: -closed.volume))
    inside = {hash(face.Oriented(TopAbs_FORWARD)) for closed in found for face in faces_of(closed.solid)}
    was = [(sewing.Modified(one), face) for one, face in zip(added, faces, strict=True)]
    rest = [old for new, old in was if hash(new.Oriented(TopAbs_FORWARD)) not in inside]
    return solids, rest, was


def _in_place(face: Any) -> Any:
    """The face; one that is placed by a mirror, as IGES places single surfaces, as a face that stands there."""
    place = face.Location().Transformation()
    if np.linalg.det(trsf_matrix(place)[:, :3]) > 0.0:
        return face
    return BRepBuilderAPI_Transform(face.Located(TopLoc_Location()), place, True).Shape()


def _closed(shell: Any) -> _Closed:
    """The solid in a closed shell, its faces turned outwards."""
    solid = BRepBuilderAPI_MakeSolid(shell).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    weighed, box = GProp_GProps(), Bnd_Box()
    BRepGProp.VolumeProperties_s(solid, weighed)
    BRepBndLib.Add_s(solid, box)
    return _Closed(solid, weighed.Mass(), weighed.CentreOfMass(), box)


def _hollowed(closed: list[_Closed]) -> list[Any]:
    """The solids, largest first; what lies in the material of another one is a hollow in it."""
    found: list[_Closed] = []
    for one in closed:
        corner = BRep_Tool.Pnt_s(_as_vertex(sub_shapes(one.solid, TopAbs_VERTEX)[0]))
        around = next((other for other in found if _holds(other, one, corner)), None)
        if around is None:
            found.append(one)
            continue
        for shell in sub_shapes(one.solid, TopAbs_SHELL):
            BRep_Builder().Add(around.solid, shell.Reversed())
    return [one.solid for one in found]


def _holds(outer: _Closed, inner: _Closed, corner: Any) -> bool:
    """Whether a solid has another one, of which a corner is known, in its material."""
    low, high = outer.box.CornerMin(), outer.box.CornerMax()
    if any(
        getattr(inner.box.CornerMin(), axis)() < getattr(low, axis)()
        or getattr(inner.box.CornerMax(), axis)() > getattr(high, axis)()
        for axis in "XYZ"
    ):
        return False
    classifier = BRepClass3d_SolidClassifier(outer.solid)
    for point in (corner, inner.center):
        classifier.Perform(point, GAP)
        if classifier.State() != TopAbs_IN:
            return False
    return True
