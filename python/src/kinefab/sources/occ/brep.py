"""OpenCASCADE's own text and binary B-rep, from bytes."""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

import io
from collections.abc import Iterator

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from .elements import curve_of, surface_of
from .tessellation import tessellate
from .triangles import Tessellation, Tolerance


class BrepError(Exception):
    """Bytes that are no shape."""


def tessellations(
    shapes: list[tuple[int, str, bytes]], tolerance: Tolerance, metres: float
) -> Iterator[tuple[int, Tessellation | str]]:
    """Of each shape (number, name, bytes) its triangles, or why there are none; to be run by ``guard.guarded``."""
    for number, name, content in shapes:
        try:
            yield number, tessellate(read_brep(content, name), tolerance, metres)
        except BrepError as error:
            yield number, str(error)
        except RuntimeError as error:
            yield number, f"it cannot be meshed: {error}"


def element(name: str, content: bytes, kind: str, number: int) -> Iterator[tuple[str, float] | None]:
    """The word for a shape's numbered ``Edge`` or ``Face`` and its radius; to be run by ``guard.guarded``."""
    find = curve_of if kind == "Edge" else surface_of
    yield find(read_brep(content, name), number)


def read_brep(content: bytes, name: str) -> TopoDS_Shape:
    """The shape, without the location of its root: that is the place of its owner.  Raises BrepError."""
    shape = TopoDS_Shape()
    try:
        if name.lower().endswith(".bin"):
            BinTools.Read_s(shape, io.BytesIO(content))
        else:
            BRepTools.Read_s(shape, io.BytesIO(content), BRep_Builder())
    except Exception as error:  # the kernel raises classes of its own, by the fault that it meets
        raise BrepError(f"'{name}' is no B-rep: {' '.join(str(error).split())[:120]}") from None
    if shape.IsNull():
        raise BrepError(f"'{name}' holds no shape")
    return shape.Located(TopLoc_Location())
