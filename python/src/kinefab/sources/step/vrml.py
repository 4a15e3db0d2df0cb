"""A VRML file through OpenCASCADE; runs in the guarded process (``sources.guard``), nothing else imports it."""

# OCP is a binding of C++ that need not be installed, and its stubs are not those of every version.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from OCP.Message import Message_ProgressRange
from OCP.RWMesh import RWMesh_CoordinateSystem
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDocStd import TDocStd_Document
from OCP.VrmlAPI import VrmlAPI_CafReader
from OCP.XCAFApp import XCAFApp_Application

from ..occ.tessellation import tessellate
from ..occ.triangles import Tolerance
from .xcaf import walked


def meshes(path: str) -> Iterator[tuple[Any, ...]]:
    """(name, vertices, triangles, matrix, material, color) of every shape.  Raises ValueError for what is no VRML."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = VrmlAPI_CafReader()
    reader.SetDocument(document)
    # The file's own axes and unit; what is left unset scales by -1.
    reader.SetFileCoordinateSystem(RWMesh_CoordinateSystem.RWMesh_CoordinateSystem_Undefined)
    reader.SetSystemCoordinateSystem(RWMesh_CoordinateSystem.RWMesh_CoordinateSystem_Undefined)
    reader.SetFileLengthUnit(1.0)
    reader.SetSystemLengthUnit(1.0)
    if not reader.Perform(TCollection_AsciiString(path), Message_ProgressRange()):
        raise ValueError("OpenCASCADE cannot parse it as VRML 97")
    tree, shapes = walked(document)
    poses: list[Any] = []
    for found in tree.occurrences:
        own = np.vstack([found.matrix, [0.0, 0.0, 0.0, 1.0]])
        poses.append(own if found.parent is None else poses[found.parent] @ own)
        if found.shape is not None:
            mesh = tessellate(shapes[found.shape], Tolerance(), 1.0)
            yield found.name, mesh.vertices, mesh.triangles, poses[-1][:3], found.product, found.color
