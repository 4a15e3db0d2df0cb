"""Shapes of a STEP document as triangles, each solid a piece, with the colours of its faces and its exact surfaces."""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.Quantity import Quantity_ColorRGBA
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_SHAPE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound
from OCP.XCAFDoc import XCAFDoc_ColorType

from ..occ.faces import boundary_of
from ..occ.sewing import sewn
from ..occ.tessellation import faces_of, tessellate
from ..occ.triangles import Tolerance
from .records import Color, Piece

KINDS = (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen)
MILLIMETRE = 1e-3
"""Metres in OpenCASCADE's own unit, into which it brings every file."""


class Colors:
    """What colour a face of a part has: its own, else its solid's, else the part's.

    names: those of its solids, with their shapes.
    """

    def __init__(self, tool: Any, whole: Color | None, names: list[tuple[Any, str]]) -> None:
        self._tool, self._whole, self._names = tool, whole, names
        self._was: dict[int, Any] = {}

    def know(self, sewn: list[tuple[Any, Any]]) -> None:
        """Faces that stand in the place of others, whose colours they have."""
        self._was = {hash(new.Oriented(TopAbs_FORWARD)): old for new, old in sewn}

    def of(self, *shapes: Any) -> Color | None:
        """The colour of the first of these shapes that has one."""
        color = Quantity_ColorRGBA()
        for shape in shapes:
            stated = self._was.get(hash(shape.Oriented(TopAbs_FORWARD)), shape)
            for kind in KINDS:
                if self._tool.GetColor(stated, kind, color):
                    return linear(color)
        return self._whole

    def name(self, solid: Any) -> str:
        return next((name for shape, name in self._names if shape.IsPartner(solid)), "")


def linear(color: Any) -> Color:
    """A Quantity_ColorRGBA, which holds linear values, as numbers."""
    rgb = color.GetRGB()
    return rgb.Red(), rgb.Green(), rgb.Blue(), color.Alpha()


def meshed_shape(shape: Any, name: str, colors: Colors, tolerance: Tolerance) -> list[Piece]:
    """The shape's solids, then those that its other faces enclose, then what is left of these, as pieces; its own
    location is left out."""
    shape = shape.Located(TopLoc_Location())
    solids = list(_explored(shape, TopAbs_SOLID))
    enclosed, loose, was = sewn(list(_explored(shape, TopAbs_FACE, TopAbs_SOLID)))
    colors.know(was)
    solids += enclosed
    pieces = [
        _piece(solid, colors.name(solid) or (name if len(solids) == 1 else f"{name}:{i}"), colors, tolerance)
        for i, solid in enumerate(solids, 1)
    ]
    if loose:
        compound, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(compound)
        for face in loose:
            builder.Add(compound, face)
        pieces.append(_piece(compound, f"{name}:faces" if solids else name, colors, tolerance))
    return [piece for piece in pieces if len(piece.mesh.triangles)]


def _piece(shape: Any, name: str, colors: Colors, tolerance: Tolerance) -> Piece:
    mesh = tessellate(shape, tolerance, MILLIMETRE)
    looks = tuple(colors.of(face, shape) for face in faces_of(shape))
    return Piece(name, mesh, looks, boundary_of(shape, mesh))


def _explored(shape: Any, kind: Any, avoid: Any = TopAbs_SHAPE) -> Iterator[Any]:
    explorer = TopExp_Explorer(shape, kind, avoid)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()
